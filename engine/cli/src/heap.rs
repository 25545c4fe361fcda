//! Heap: the program's allocator, which counts allocations and bytes of the process, and the allocations of each thread. So a loop
//! can be tested to allocate nothing while other threads allocate freely.

#![expect(unsafe_code, reason = "a counting allocator has to implement an unsafe trait")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicI64, AtomicU64};

use toile_fitting::heap::Heap;

/// Allocations of the process so far.
static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

/// Bytes that the process holds.
static LIVE_BYTES: AtomicI64 = AtomicI64::new(0);

thread_local! {
    /// Allocations of this thread. Without a destructor, so that it is there for as long as its thread is.
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

/// The system's allocator, counted for the process and for each thread. Giving back is free.
#[derive(Debug, Clone, Copy, Default)]
pub struct Counted;

/// Counts an allocation by which the process holds so many bytes more.
fn count(bytes: i64) {
    let _ = COUNT.try_with(|c| c.set(c.get() + 1));
    ALLOCATIONS.fetch_add(1, Relaxed);
    LIVE_BYTES.fetch_add(bytes, Relaxed);
}

// SAFETY: every call is passed on as it came to an allocator that keeps the contract; the counters are atomic numbers and a plain
// cell without a destructor, and allocate nothing themselves.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as i64);
        // SAFETY: the caller keeps the contract of `alloc`, and it is the same.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as i64);
        // SAFETY: the caller keeps the contract of `alloc_zeroed`, and it is the same.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size as i64 - layout.size() as i64);
        // SAFETY: the block came from the same allocator through `alloc`; the contract is the same.
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        LIVE_BYTES.fetch_sub(layout.size() as i64, Relaxed);
        // SAFETY: the block came from the same allocator through `alloc`; the contract is the same.
        unsafe { System.dealloc(block, layout) }
    }
}

/// The heap as the program's allocator counts it.
pub fn counted() -> Heap {
    Heap { allocations: ALLOCATIONS.load(Relaxed), live_bytes: LIVE_BYTES.load(Relaxed) }
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
