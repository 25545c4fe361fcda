//! The hard cases: what a fault of one frame does to the skirt, and how soon it is over.

use glam::{Affine3A, Vec3, Vec3A, Vec4};
use toile_assets::scene::skirt;
use toile_bake::Shape;
use toile_fitting::heap::HeapProbe;
use toile_perf::skirt::options::{SkirtOptions, WARM_UP};
use toile_perf::skirt::{FrameErrors, Gauge, SkirtScene};

/// Something that is wrong for one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SkirtFault {
    /// The left lower leg is 1 m to the side, and back in the next frame.
    Jump,
    /// A sphere of the body, all of it this value.
    Collider(f32),
    /// A particle's position.
    Particle(f32),
    /// The root that carries the pinned ring.
    Pin(f32),
}

/// Steps that are watched from the fault on: two cycles of the walk.
const WATCHED: usize = 240;

/// Times the undisturbed skirt's strain up to which strain counts as back: a skirt that was pushed swings differently
/// ever after, and no two cycles of it are equal.
const BACK: f64 = 1.25;

/// Steps for which it has to stay there (a quarter of a second): a peak a cycle later is the walk's, not the fault's.
const STAYS: usize = 30;

/// How the skirt took a fault.
#[derive(Debug, Clone, Copy)]
pub struct SkirtRecovery {
    /// Greatest stretch of an edge from the fault on.
    pub worst_stretch: f64,
    /// Steps from the faulty one on, which is the first, until strain, mean and 99th percentile, is back within a quarter
    /// above its baseline and stays there for a quarter of a second.
    pub recovered_steps: usize,
    /// Vertices published that were not finite, summed over the frames.
    pub nonfinite: usize,
}

/// Runs the scene into a fault, and once more without it, and compares what follows.
pub fn recover(options: &SkirtOptions, fault: SkirtFault) -> SkirtRecovery {
    let undisturbed = watch(options, None);
    let frames = watch(options, Some(fault));
    let greatest = |of: fn(&FrameErrors) -> f64, frames: &[FrameErrors]| frames.iter().map(of).fold(0.0, f64::max);
    let baseline_mean = greatest(|f| f.strain_mean, &undisturbed);
    let baseline_p99 = greatest(|f| f.strain_p99, &undisturbed);
    let back = |f: &FrameErrors| {
        f.nonfinite == 0 && f.strain_mean <= BACK * baseline_mean && f.strain_p99 <= BACK * baseline_p99
    };
    SkirtRecovery {
        worst_stretch: greatest(|f| f.stretch_max, &frames),
        recovered_steps: frames.windows(STAYS).position(|w| w.iter().all(back)).unwrap_or(frames.len()),
        nonfinite: frames.iter().map(|f| f.nonfinite).sum(),
    }
}

/// The frames from the fault on.
fn watch(options: &SkirtOptions, fault: Option<SkirtFault>) -> Vec<FrameErrors> {
    let mut scene = SkirtScene::new(options, &HeapProbe::none()).expect("the scene can be built");
    let mut gauge = Gauge::new(&scene);
    for _ in 0..WARM_UP {
        scene.prepare();
        scene.step();
    }
    (0..WATCHED).map(|after| step(&mut scene, &mut gauge, fault.filter(|_| after == 0))).collect()
}

fn step(scene: &mut SkirtScene, gauge: &mut Gauge, fault: Option<SkirtFault>) -> FrameErrors {
    scene.prepare();
    let asked = scene.spheres;
    match fault {
        None => {}
        Some(SkirtFault::Jump) => [7, 9].into_iter().for_each(|s| scene.spheres[s].x += 1.0),
        Some(SkirtFault::Collider(value)) => scene.spheres[7] = Vec4::splat(value),
        Some(SkirtFault::Particle(value)) => {
            let middle = scene.particle_of()[scene.side * scene.side / 2];
            scene.spoil(middle as usize, Vec3A::splat(value));
        }
        Some(SkirtFault::Pin(value)) => scene.palette[0] = Affine3A::from_translation(Vec3::splat(value)),
    }
    scene.step();
    gauge.read(&scene.cloths[0].positions, &asked)
}

/// Vertices a side of a patch.
const PATCH: usize = 8;

/// Makes every second patch of 8 x 8 vertices, and so half of the skirt, 1,000 times heavier.
pub fn patches(shape: &mut Shape) {
    let n = shape.cut.len().isqrt();
    let heavy = |v: usize| (v / n / PATCH + v % n / PATCH) % 2 == 1;
    shape.heavier = (0..n * n).map(|v| if heavy(v) { 1_000.0 } else { 1.0 }).collect();
}

/// Makes the hem 1,000 times heavier.
pub fn heavy_hem(shape: &mut Shape) {
    let n = shape.cut.len().isqrt();
    shape.heavier = vec![1.0; n * n];
    shape.heavier[skirt::hem(n)].fill(1_000.0);
}

#[test]
fn patches_are_half_of_the_skirt_and_a_heavy_hem_is_a_row() {
    let mut shape = skirt::shape(32);
    patches(&mut shape);
    assert_eq!(shape.heavier.iter().filter(|x| **x == 1_000.0).count(), 512);
    heavy_hem(&mut shape);
    assert_eq!(shape.heavier.iter().filter(|x| **x == 1_000.0).count(), 32);
}
