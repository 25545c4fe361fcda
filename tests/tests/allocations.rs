//! The frame allocates nothing: every allocation of the thread is counted while the shopper moves.

#![expect(unsafe_code, reason = "a counting allocator has to implement an unsafe trait")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::hint::black_box;

use toile_assets::drafting;
use toile_base::clock::SECOND_NS;
use toile_engine::clock::{Clock, SimClock};
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::event::{EVENTS, EVENTS_NAME, EventKind};
use toile_engine::frame_loop::physics_thread::{PhysicsOutputs, PhysicsThread, WorldScene};
use toile_engine::frame_loop::queue::bounded;
use toile_engine::frame_loop::recording::{ENTRIES, ENTRIES_NAME};
use toile_engine::frame_loop::render_thread::{RenderThread, Renderer};
use toile_engine::frame_loop::sensor_thread::{Playback, SensorFrame, SensorThread};
use toile_engine::triple_buffer::TripleBuffer;
use toile_engine::world::Snapshot;
use toile_fitting::live::lateness::ThreadAccount;
use toile_sensors::filter::JointFilter;
use toile_sensors::sample::sample;
use toile_workspace::dressed;

thread_local! {
    /// Allocations of this thread; the test's own, because the harness allocates on others meanwhile.
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

/// The system's allocator, which counts what it hands out; giving back is free.
struct Counting;

fn count() {
    // The counter is gone while a thread ends; nothing is measured then.
    let _ = COUNT.try_with(|c| c.set(c.get() + 1));
}

// SAFETY: every call is passed on as it came to the system's allocator, which keeps the contract; the counter is a
// plain cell without a destructor and allocates nothing itself.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `alloc`, and it is the same.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `alloc_zeroed`, and it is the same.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the block came from the system's allocator through `alloc`; the contract is the same.
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the block came from the system's allocator through `alloc`; the contract is the same.
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of this thread during a job.
fn allocations(job: impl FnOnce()) -> u64 {
    let before = COUNT.with(Cell::get);
    job();
    COUNT.with(Cell::get) - before
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(black_box(Box::new(7)))), 1);
    assert_eq!(allocations(|| drop(black_box(vec![0u8; 100]))), 1, "zeroed memory counts");
    let mut grown: Vec<u64> = Vec::with_capacity(1);
    assert_eq!(allocations(|| grown.reserve_exact(black_box(1000))), 1, "growing counts");
    assert_eq!(allocations(|| drop(black_box(grown))), 0, "giving back is free");
}

/// Sensor frames in which allocations are counted: a second and more, in which the arms begin to rise.
const SENSOR_FRAMES: u64 = 32;

/// The default dress, and outfits of two and of three layers.
const OUTFITS: [&[&str]; 3] =
    [&["strap-dress"], &["mens-trousers", "mens-shirt"], &["straight-trousers", "shirt", "blazer"]];

#[test]
fn no_outfit_costs_an_allocation_a_step() {
    OUTFITS.iter().for_each(|names| costs_no_allocation(names));
}

#[test]
#[ignore = "takes minutes; .ci/long runs it"]
fn no_garment_of_the_wardrobe_costs_an_allocation_a_step() {
    drafting::names().into_iter().for_each(|name| costs_no_allocation(&[name]));
}

fn costs_no_allocation(names: &[&str]) {
    let body = dressed::shopper();
    // The sensor's frames are its own thread's business and are made beforehand.
    let first = 40;
    let seen: Vec<_> = (first..first + SENSOR_FRAMES)
        .map(|i| dressed::joints(&body, i * 1_000_000_000 / dressed::SENSOR_HZ))
        .collect();
    let mut filter = JointFilter::default();
    let mut world = dressed::dressed(names, &seen);
    let mut last = filter.push(&seen[0]);
    let found = allocations(|| {
        for raw in &seen[1..] {
            let joints = filter.push(raw);
            for quarter in 1..=4 {
                let time = last.time_ns + (joints.time_ns - last.time_ns) * quarter / 4;
                let seen = sample(&[last, joints], time).expect("two frames");
                world.step(black_box(&seen));
            }
            last = joints;
        }
    });
    assert_eq!(world.tick(), (SENSOR_FRAMES - 1) * 4);
    assert!(world.tick() >= 120);
    assert_eq!(found, 0, "{names:?}: {found} allocations in {} steps", world.tick());
}

/// A picture that is only looked at.
struct Glance(f32);

impl Renderer for Glance {
    type Outfit = ();

    fn set_outfit(&mut self, _outfit: &mut ()) {}

    fn draw(&mut self, snapshot: &Snapshot) {
        self.0 += snapshot.skin.position(0).x;
    }
}

#[test]
fn no_turn_of_the_loop_costs_an_allocation_whatever_happens() {
    let body = dressed::shopper();
    let garment = dressed::dress_coarsely("strap-dress", &body);
    let seen: Vec<_> = (40..100).map(|i| dressed::joints(&body, i * SECOND_NS / dressed::SENSOR_HZ)).collect();
    let (mut world, reader) = dressed::world_and_reader(body, vec![garment]);
    world.dress(&seen[0]);
    let clock = SimClock::default();
    let TripleBuffer { writer, reader: news } = TripleBuffer::new(&SensorFrame::default());
    // Few places, so that both queues are full in the end as well.
    let (sender, mut events) = bounded(EVENTS_NAME, EVENTS / 64);
    let (recording, entries) = bounded(ENTRIES_NAME, ENTRIES / 8);
    let outlets = PhysicsOutputs { events: sender, recording: Some(recording) };
    let account = ThreadAccount::new();
    let mut physics =
        PhysicsThread::new(WorldScene::new(world), clock.clone(), 0, news, outlets, account).warming_up(60);
    let mut sense = SensorThread::new(Playback::new(&seen, 0, 1), JointFilter::default(), clock.clone(), writer);
    let mut render = RenderThread::new(Glance(0.0), clock.clone(), 0, reader);
    let found = allocations(|| {
        for tick in 0..360u64 {
            // The thread wakes late, steps are dropped, the sensor ends after two seconds.
            let late = if tick % 50 == 49 { 70_000_000 } else { 0 };
            clock.sleep_until(tick * SECOND_NS / 120);
            clock.spend(late);
            sense.run_due();
            physics.run_due();
            render.run_due();
        }
    });
    assert_eq!(found, 0, "{found} allocations in {} steps", physics.ticks());
    assert!(physics.gauges.dropped > 0 && physics.ticks() > 300 && render.pictures > 100);
    let events_seen: Vec<EventKind> = std::iter::from_fn(|| events.pop()).map(|e| e.what).collect();
    assert!(events_seen.iter().any(|w| matches!(w, EventKind::Missed(_))), "{events_seen:?}");
    let full = entries.capacity();
    assert!(full.lost > 0 && full.high_water == full.bound, "{full:?}");
}
