//! Queue: a bounded lock-free queue that counts its high-water mark and the entries that did not fit.
//!
//! The queue is crossbeam's `ArrayQueue`: all places are made at load; pushing and popping is one exchange each.

use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicU64, AtomicUsize};

use crossbeam_queue::ArrayQueue;

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

#[derive(Debug)]
struct QueueState<T> {
    entries: ArrayQueue<T>,
    constant: &'static str,
    /// Relaxed, both: counters that guard nothing; a reader wants them sooner or later.
    high_water: AtomicUsize,
    lost: AtomicU64,
}

/// The end that pushes, on the thread that must not wait.
#[derive(Debug)]
pub struct Sender<T>(Arc<QueueState<T>>);

/// The end that pops.
#[derive(Debug)]
pub struct Receiver<T>(Arc<QueueState<T>>);

/// A queue of so many places; `constant` is the name of the bound. At load.
pub fn bounded<T>(constant: &'static str, bound: usize) -> (Sender<T>, Receiver<T>) {
    let entries = ArrayQueue::new(bound.max(1));
    let shared = Arc::new(QueueState { entries, constant, high_water: AtomicUsize::new(0), lost: AtomicU64::new(0) });
    (Sender(shared.clone()), Receiver(shared))
}

impl<T> Sender<T> {
    /// Whether the next entry would be lost. Only this end fills the queue, so what is free stays free.
    pub fn is_full(&self) -> bool {
        self.0.entries.is_full()
    }

    /// Pushes an entry; where there is no place it is lost and counted. Says whether it fitted. Never waits.
    pub fn push(&mut self, entry: T) -> bool {
        let fits = self.0.entries.push(entry).is_ok();
        if fits {
            self.0.high_water.fetch_max(self.0.entries.len(), Relaxed);
        } else {
            self.0.high_water.fetch_max(self.0.entries.capacity(), Relaxed);
            self.0.lost.fetch_add(1, Relaxed);
        }
        fits
    }
}

impl<T> Receiver<T> {
    /// Takes the oldest entry, if there is one.
    pub fn pop(&mut self) -> Option<T> {
        self.0.entries.pop()
    }

    /// How full it was so far.
    pub fn capacity(&self) -> Capacity {
        Capacity {
            constant: self.0.constant,
            bound: self.0.entries.capacity(),
            high_water: self.0.high_water.load(Relaxed),
            lost: self.0.lost.load(Relaxed),
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
