//! Use of the heap, as reported by the program's allocator, which this library cannot see by itself.

use std::hint::black_box;

/// The heap at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Heap {
    /// Allocations and growths since the program started, of all threads.
    pub allocations: u64,
    /// Bytes that are allocated and not freed.
    pub live_bytes: i64,
}

/// Reads the heap, where the program counts it.
#[derive(Debug, Clone, Copy)]
pub struct HeapProbe(Option<fn() -> Heap>);

impl HeapProbe {
    /// A probe by this reading. One that does not see an allocation is none: a program without the counting allocator
    /// would report that nothing is ever allocated.
    pub fn new(reading: fn() -> Heap) -> Self {
        let before = reading().allocations;
        drop(black_box(Box::new(black_box(7u64))));
        Self((reading().allocations > before).then_some(reading))
    }

    /// No probe: allocations and memory are not reported.
    pub const fn none() -> Self {
        Self(None)
    }

    /// The heap now.
    pub fn read(&self) -> Option<Heap> {
        self.0.map(|reading| reading())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_that_sees_nothing_is_no_probe() {
        // This test has the system's own allocator.
        assert_eq!(HeapProbe::new(|| Heap { allocations: 3, live_bytes: 10 }).read(), None);
    }
}
