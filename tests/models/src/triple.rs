//! The protocol of the triple buffer that `triple_buffer` uses. The crate's own atomics cannot be replaced, so this is its algorithm
//! written again: three places, of which each side owns one and the third is exchanged, with a bit that says
//! whether it is news. The orderings are parameters, so that the model can show which of them are needed.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use loom::cell::UnsafeCell;
use loom::sync::atomic::AtomicU8;

/// Set in the exchanged number where the writer has put news there.
const NEWS: u8 = 4;

struct Shared<T> {
    places: [UnsafeCell<T>; 3],
    back: AtomicU8,
}

// SAFETY: the protocol gives each place to one side at a time; the model ends where it does not.
unsafe impl<T: Send> Sync for Shared<T> {}

/// The end that publishes values.
pub struct Writer<T> {
    shared: Arc<Shared<T>>,
    mine: u8,
    order: Ordering,
}

/// The end that reads the newest value.
pub struct Reader<T> {
    shared: Arc<Shared<T>>,
    mine: u8,
    order: Ordering,
}

/// A buffer whose exchanges have these orderings, the writer's first.
pub fn triple<T: Clone>(initial: &T, [writes, reads]: [Ordering; 2]) -> (Writer<T>, Reader<T>) {
    let places = [(); 3].map(|()| UnsafeCell::new(initial.clone()));
    let shared = Arc::new(Shared { places, back: AtomicU8::new(0) });
    (Writer { shared: shared.clone(), mine: 1, order: writes }, Reader { shared, mine: 2, order: reads })
}

impl<T> Writer<T> {
    /// Fills the writer's place and exchanges it.
    pub fn publish(&mut self, fill: impl FnOnce(&mut T)) {
        // SAFETY: the place is the writer's until the exchange.
        self.shared.places[usize::from(self.mine)].with_mut(|place| fill(unsafe { &mut *place }));
        self.mine = self.shared.back.swap(self.mine | NEWS, self.order) & !NEWS;
    }
}

impl<T> Reader<T> {
    /// Looks at the newest value; says whether it is news.
    pub fn look<R>(&mut self, look: impl FnOnce(&T) -> R) -> (bool, R) {
        // Relaxed: only asks; the exchange that follows acquires.
        let news = self.shared.back.load(Ordering::Relaxed) & NEWS != 0;
        if news {
            self.mine = self.shared.back.swap(self.mine, self.order) & !NEWS;
        }
        // SAFETY: the place is the reader's until the next exchange.
        (news, self.shared.places[usize::from(self.mine)].with(|place| look(unsafe { &*place })))
    }
}
