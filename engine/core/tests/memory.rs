//! The memory that states report is the memory that they hold: every byte that is handed out to this thread is counted.

#![expect(unsafe_code, reason = "a counting allocator has to implement an unsafe trait")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use glam::Vec3;
use toile_bake::{Shape, bake};
use toile_base::garment::Garment;
use toile_engine::cloth::Cloth;
use toile_engine::cloth::contact::garments::GarmentContact;
use toile_engine::colliders::Colliders;

thread_local! {
    /// Bytes that this thread holds; those that it gives back for others count against it.
    static HELD: Cell<isize> = const { Cell::new(0) };
}

struct Counting;

fn count(change: isize) {
    // The counter is gone while a thread ends; nothing is measured then.
    let _ = HELD.try_with(|held| held.set(held.get() + change));
}

// SAFETY: every call is passed on as it came to the system's allocator, which keeps the contract; the counter is a
// plain cell without a destructor and allocates nothing itself.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: the caller keeps the contract of `alloc`, and it is the same.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: the block came from the system's allocator through `alloc`; the contract is the same.
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What a job makes, and the bytes that it holds.
fn held<T>(job: impl FnOnce() -> T) -> (T, usize) {
    let before = HELD.with(Cell::get);
    let made = job();
    (made, usize::try_from(HELD.with(Cell::get) - before).unwrap())
}

/// A sheet of a fabric whose bending and links rub, fixed along its upper edge.
fn sheet(name: &str, fabric: &str) -> Garment {
    let place = |row: u32, column: u32| (Vec3::new(column as f32 * 0.02, 2.0 - row as f32 * 0.02, 0.0), row == 0);
    let fabric = toile_assets::fabric::built_in(fabric).unwrap();
    bake(name, "one size", &Shape::sheet(24, 31, place), &fabric).unwrap()
}

/// Names, the programs of a step and lists of a few places are not reported (bytes).
const SMALL: usize = 10 * 1024;

fn assert_reported(what: &str, reported: usize, held: usize) {
    let small = held.checked_sub(reported).is_some_and(|rest| rest < SMALL);
    assert!(small, "{what}: {reported} bytes are reported of {held}");
}

#[test]
fn a_state_reports_the_memory_that_it_holds() {
    let colliders = Colliders::new(&[], &[], false).unwrap();
    for fabric in ["cotton-lawn", "wool-tropical"] {
        let garment = sheet("curtain", fabric);
        let (cloth, bytes) = held(|| Cloth::new(&garment, &colliders));
        assert_reported(&format!("state of {fabric}"), cloth.bytes(), bytes);
        let (layout, bytes) = held(|| garment.layout().clone());
        assert_reported(&format!("constraints of {fabric}"), layout.bytes(), bytes);
    }
}

#[test]
fn contact_reports_the_memory_that_it_holds() {
    let mut garments = ["inner", "outer"].map(|name| sheet(name, "cotton-lawn"));
    garments[1].set_layer(1);
    let (contact, bytes) = held(|| GarmentContact::new(&garments).unwrap());
    assert_reported("contact of two sheets", contact.bytes(), bytes);
}
