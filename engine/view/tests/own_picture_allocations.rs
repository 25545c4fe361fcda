//! The mirror that shows the shopper's own picture allocates nothing once it has drawn a picture of a size: every allocation of the thread is
//! counted while a shopper moves, leaves the picture, and comes back.

#![expect(unsafe_code, reason = "a counting allocator has to implement an unsafe trait")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use glam::{Affine3A, Mat3, Vec2, Vec3};
use toile_assets::drafting;
use toile_assets::scene::{SHOPPER, shopper};
use toile_base::frame::{DepthFrame, Intrinsics, Joints};
use toile_engine::body::JointFrames;
use toile_engine::cloth::Settings;
use toile_engine::world::{Snapshot, World};
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::lens::BrownConrady;
use toile_sensors::person_mask::PersonMask;
use toile_sensors::source::live::ColourImage;
use toile_view::image::Size;
use toile_view::own_picture::{OwnPicture, OwnPictureInput, OwnPictureModel, OwnPictureOptions};

thread_local! {
    /// Allocations of this thread; the test's own, because the harness allocates on others meanwhile.
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

/// The system's allocator, which counts what it hands out.
struct Counting;

// SAFETY: every call is passed on as it came to the system's allocator, which keeps the contract; the counter is a plain cell
// without a destructor and allocates nothing itself.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = COUNT.try_with(|c| c.set(c.get() + 1));
        // SAFETY: the caller keeps the contract of `alloc`, and it is the same.
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        let _ = COUNT.try_with(|c| c.set(c.get() + 1));
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

/// Size of the mirror, and pictures in which allocations are counted: two seconds.
const SIZE: Size = Size::new(304, 540);
const PICTURES: u64 = 60;

/// What is seen at a moment: joints, and the snapshot of the same.
struct Moment {
    joints: Joints,
    snapshot: Snapshot,
}

/// A dressed woman who lifts her arms.
fn moments(world: &mut World, latest: &mut dyn FnMut() -> Snapshot) -> Vec<Moment> {
    let skeleton = world.body().skeleton.clone();
    let joints = |tick: u64| {
        let pose = shopper(&skeleton, 2.0 + tick as f32 / 120.0);
        Joints::seen(tick, JointFrames::new(&skeleton, &pose).position)
    };
    world.dress(&joints(0));
    let mut all = Vec::new();
    for picture in 0..PICTURES {
        (0..4).for_each(|step| world.step(&joints(4 * picture + step)));
        all.push(Moment { joints: joints(4 * picture + 3), snapshot: latest() });
    }
    all
}

/// The camera of a distance, with a lens or without.
fn camera(lens: Option<BrownConrady>) -> ColourCamera {
    let intrinsics = Intrinsics { width: 320, height: 240, fx: 280.0, fy: 280.0, cx: 159.5, cy: 119.5 };
    let to_world = Mat3::from_diagonal(Vec3::new(1.0, -1.0, -1.0));
    let camera_to_world = Affine3A::from_mat3_translation(to_world, Vec3::new(0.0, 0.9, 3.0));
    ColourCamera { camera_to_world, ..ColourCamera::beside(intrinsics, lens, Mat3::IDENTITY, Vec3::ZERO) }
}

#[test]
fn a_picture_costs_no_allocation_once_one_was_drawn() {
    let body = toile_assets::body::build(SHOPPER.0, &SHOPPER.1).unwrap();
    let dress = drafting::package("strap-dress").unwrap().dress("38", &body).unwrap();
    let (mut world, mut reader) =
        World::new(body.clone(), &toile_assets::rig::fit(&body), vec![dress], Settings::default()).unwrap();
    let seen = moments(&mut world, &mut || reader.latest().clone());
    let model = OwnPictureModel::of(world.body(), world.garments());
    let picture = ColourImage { width: 320, height: 240, rgb: [150, 140, 130].repeat(320 * 240) };
    let lens =
        BrownConrady { k: [-0.1, 0.02, 0.0, 0.0, 0.0, 0.0], p: [0.0; 2], centre: [0.0; 2], widest: f32::INFINITY };
    let (straight, bent) = (camera(None), camera(Some(lens)));
    let depth = DepthFrame {
        time_ns: 0,
        intrinsics: straight.intrinsics,
        camera_to_world: straight.camera_to_world,
        depth_mm: vec![2_900; 320 * 240].into(),
    };
    let from_picture = glam::Affine2::from_scale(Vec2::splat(1.0 / 320.0));
    let mask = PersonMask { side: 1, odds: vec![0.9], from_picture };
    let absent = Joints::absent(0);
    for (name, camera, depth, mask) in [
        ("depth", &straight, Some(&depth), None),
        ("a lens", &bent, Some(&depth), None),
        ("a mask", &straight, None, Some(&mask)),
    ] {
        let mut mirror = OwnPicture::new();
        let input =
            |joints| OwnPictureInput { picture: &picture, camera: Some(camera), joints, depth, mask, colours: &[] };
        let options = OwnPictureOptions::of(SIZE);
        let (mut drawn, mut plain) = (0, 0);
        // The first two bear her out, and the storage grows.
        for moment in &seen[..3] {
            _ = mirror.draw(&model, &moment.snapshot, &input(&moment.joints), &options);
        }
        let before = COUNT.with(Cell::get);
        for (number, moment) in seen.iter().enumerate().skip(3) {
            // For a while no person is seen.
            let joints = if (20..25).contains(&number) { &absent } else { &moment.joints };
            match mirror.draw(&model, &moment.snapshot, &input(joints), &options) {
                Ok(()) => drawn += 1,
                Err(_) => plain += 1,
            }
        }
        let found = COUNT.with(Cell::get) - before;
        assert!(drawn >= 45 && plain >= 5, "{name}: {drawn} with the garment, {plain} plain");
        assert_eq!(found, 0, "{name}: {found} allocations in {} pictures", drawn + plain);
    }
}
