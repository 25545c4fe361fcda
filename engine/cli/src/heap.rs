//! Heap: the program's allocator, which also counts the allocations of each thread. So a loop can be tested to allocate nothing
//! while other threads allocate freely.

#![expect(unsafe_code, reason = "a counting allocator has to implement an unsafe trait")]

use std::alloc::{GlobalAlloc, Layout};
use std::cell::Cell;

use stats_alloc::INSTRUMENTED_SYSTEM;
use toile_fitting::heap::Heap;

thread_local! {
    /// Allocations of this thread. Without a destructor, so that it is there for as long as its thread is.
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

/// The system's allocator, counted for the process (`stats_alloc`) and for each thread. Giving back is free.
#[derive(Debug, Clone, Copy, Default)]
pub struct Counted;

fn count() {
    let _ = COUNT.try_with(|c| c.set(c.get() + 1));
}

// SAFETY: every call is passed on as it came to an allocator that keeps the contract; the counter is a plain cell without
// a destructor and allocates nothing itself.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `alloc`, and it is the same.
        unsafe { INSTRUMENTED_SYSTEM.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `alloc_zeroed`, and it is the same.
        unsafe { INSTRUMENTED_SYSTEM.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the block came from the same allocator through `alloc`; the contract is the same.
        unsafe { INSTRUMENTED_SYSTEM.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the block came from the same allocator through `alloc`; the contract is the same.
        unsafe { INSTRUMENTED_SYSTEM.dealloc(block, layout) }
    }
}

/// The heap as the program's allocator counts it.
pub fn counted() -> Heap {
    let s = INSTRUMENTED_SYSTEM.stats();
    Heap {
        allocations: (s.allocations + s.reallocations) as u64,
        live_bytes: s.bytes_allocated as i64 - s.bytes_deallocated as i64,
    }
}

/// Allocations of the calling thread so far.
pub fn of_this_thread() -> u64 {
    COUNT.with(Cell::get)
}

/// The same, where the program's allocator is the one that counts; none where it is another.
pub fn probe() -> Option<fn() -> u64> {
    let before = of_this_thread();
    drop(std::hint::black_box(Box::new(std::hint::black_box(7u64))));
    (of_this_thread() > before).then_some(of_this_thread as fn() -> u64)
}
