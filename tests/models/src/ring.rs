//! The protocol of the bounded queue that `rtrb` uses. The crate's own atomics cannot be replaced, so this is its algorithm written
//! again: a ring of places, a position that only the sender stores and one that only the receiver stores. The orderings are
//! parameters, so that the model can show which of them are needed.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use loom::cell::UnsafeCell;
use loom::sync::atomic::AtomicUsize;

/// The orderings of the four accesses that order the entries.
#[derive(Debug, Clone, Copy)]
pub struct Orders {
    /// The sender stores its position.
    pub sent: Ordering,
    /// The receiver loads the sender's position.
    pub look: Ordering,
    /// The receiver stores its position.
    pub taken: Ordering,
    /// The sender loads the receiver's position.
    pub free: Ordering,
}

struct Ring<T> {
    places: Box<[UnsafeCell<Option<T>>]>,
    sent: AtomicUsize,
    taken: AtomicUsize,
}

// SAFETY: the protocol gives each place to one side at a time; the model ends where it does not.
unsafe impl<T: Send> Sync for Ring<T> {}

/// The end that pushes. It keeps its own position beside the shared one.
pub struct Sender<T> {
    ring: Arc<Ring<T>>,
    orders: Orders,
    sent: usize,
}

/// The end that pops. It keeps its own position beside the shared one.
pub struct Receiver<T> {
    ring: Arc<Ring<T>>,
    orders: Orders,
    taken: usize,
}

/// A queue with space for `bound` entries.
pub fn ring<T>(bound: usize, orders: Orders) -> (Sender<T>, Receiver<T>) {
    let places = (0..bound).map(|_| UnsafeCell::new(None)).collect();
    let ring = Arc::new(Ring { places, sent: AtomicUsize::new(0), taken: AtomicUsize::new(0) });
    (Sender { ring: ring.clone(), orders, sent: 0 }, Receiver { ring, orders, taken: 0 })
}

impl<T> Sender<T> {
    /// Whether the next entry would not fit.
    pub fn is_full(&self) -> bool {
        self.sent - self.ring.taken.load(self.orders.free) == self.ring.places.len()
    }

    /// Pushes an entry.
    ///
    /// # Errors
    /// The entry, where there is no space.
    pub fn push(&mut self, entry: T) -> Result<(), T> {
        if self.is_full() {
            return Err(entry);
        }
        let Self { ring, orders, sent } = self;
        // SAFETY: the receiver has left the place, and comes back to it only after the store below.
        ring.places[*sent % ring.places.len()].with_mut(|place| unsafe { *place = Some(entry) });
        *sent += 1;
        ring.sent.store(*sent, orders.sent);
        Ok(())
    }
}

impl<T> Receiver<T> {
    /// Takes the oldest entry, if there is one.
    pub fn pop(&mut self) -> Option<T> {
        let Self { ring, orders, taken } = self;
        if ring.sent.load(orders.look) == *taken {
            return None;
        }
        // SAFETY: the sender has filled the place, and comes back to it only after the store below.
        let entry = ring.places[*taken % ring.places.len()].with_mut(|place| unsafe { (*place).take() });
        *taken += 1;
        ring.taken.store(*taken, orders.taken);
        entry
    }
}
