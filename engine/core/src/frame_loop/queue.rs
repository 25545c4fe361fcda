//! Queue: bounded, from one thread to another, wait-free at both ends. It counts its high-water mark and the entries that did not fit.
//!
//! The entries lie in a ring of `rtrb`, made at load. A push or a pop reads the other end's position and stores its own, so
//! neither end ever waits for the other, also where the other was preempted in the middle of a call.

use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicU64, AtomicUsize};

use rtrb::{Consumer, Producer, RingBuffer};

/// How full something bounded was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Capacity {
    /// Name of the constant that bounds it, and what it bounds in brackets.
    pub constant: &'static str,
    /// The most that it can hold.
    pub bound: usize,
    /// The most that was in it at once.
    pub high_water: usize,
    /// Number of entries that did not fit.
    pub lost: u64,
}

impl Capacity {
    /// What was lost and the cure, where something did not fit.
    pub fn warning(&self) -> Option<String> {
        (self.lost > 0).then(|| {
            let Self { constant, bound, lost, .. } = self;
            format!(
                "{lost} entries were lost, for {constant} holds {bound}; give the program more processor time, or build it with a \
                 larger value"
            )
        })
    }
}

/// Counts of a queue, for both ends.
#[derive(Debug)]
struct QueueCounts {
    constant: &'static str,
    /// Relaxed, both: counters that guard nothing; a reader wants them sooner or later.
    high_water: AtomicUsize,
    lost: AtomicU64,
}

/// The end that pushes.
#[derive(Debug)]
pub struct Sender<T> {
    entries: Producer<T>,
    counts: Arc<QueueCounts>,
}

/// The end that pops.
#[derive(Debug)]
pub struct Receiver<T> {
    entries: Consumer<T>,
    counts: Arc<QueueCounts>,
}

/// Makes a queue with space for `bound` entries; `constant` is the name of the bound. At load.
pub fn bounded<T>(constant: &'static str, bound: usize) -> (Sender<T>, Receiver<T>) {
    let (producer, consumer) = RingBuffer::new(bound.max(1));
    let counts = Arc::new(QueueCounts { constant, high_water: AtomicUsize::new(0), lost: AtomicU64::new(0) });
    (Sender { entries: producer, counts: counts.clone() }, Receiver { entries: consumer, counts })
}

impl<T> Sender<T> {
    /// Whether the next entry would be lost. Only this end fills the queue, so free space stays free.
    pub fn is_full(&self) -> bool {
        self.entries.is_full()
    }

    /// Pushes an entry and returns whether it fitted. An entry without space is dropped here and counted.
    pub fn push(&mut self, entry: T) -> bool {
        let fits = self.entries.push(entry).is_ok();
        self.counts.high_water.fetch_max(self.entries.buffer().capacity() - self.entries.slots(), Relaxed);
        if !fits {
            self.counts.lost.fetch_add(1, Relaxed);
        }
        fits
    }
}

impl<T> Receiver<T> {
    /// Takes the oldest entry, if there is one.
    pub fn pop(&mut self) -> Option<T> {
        self.entries.pop().ok()
    }

    /// How full it was so far.
    pub fn capacity(&self) -> Capacity {
        Capacity {
            constant: self.counts.constant,
            bound: self.entries.buffer().capacity(),
            high_water: self.counts.high_water.load(Relaxed),
            lost: self.counts.lost.load(Relaxed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_queue_loses_the_newest_and_names_its_bound() {
        let (mut sender, mut receiver) = bounded("PLACES (queue of this test)", 3);
        assert_eq!(receiver.capacity().warning(), None);
        let fitted: Vec<bool> = (0..5).map(|i| sender.push(i)).collect();
        assert_eq!(fitted, [true, true, true, false, false]);
        let capacity = receiver.capacity();
        assert_eq!((capacity.high_water, capacity.lost, capacity.bound), (3, 2, 3));
        assert!(
            capacity.warning().unwrap().starts_with("2 entries were lost, for PLACES (queue of this test) holds 3; ")
        );
        assert_eq!(std::iter::from_fn(|| receiver.pop()).collect::<Vec<_>>(), [0, 1, 2]);
        assert!(sender.push(9) && receiver.pop() == Some(9));
    }

    #[test]
    fn entries_come_in_order_across_threads() {
        let (mut sender, mut receiver) = bounded("", 16);
        std::thread::scope(|scope| {
            scope.spawn(move || (0..50_000u64).for_each(|i| _ = sender.push(i)));
            let (mut last, mut popped) = (None, 0);
            while last != Some(49_999) && popped + receiver.capacity().lost < 50_000 {
                let Some(i) = receiver.pop() else { continue };
                assert!(last.is_none_or(|l| i > l));
                (last, popped) = (Some(i), popped + 1);
            }
        });
    }
}
