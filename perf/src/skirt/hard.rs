//! The hard cases: what a fault of one frame does to the skirt, and how soon it is over.

use glam::{Affine3A, Vec3, Vec3A, Vec4};
use serde::Serialize;
use toile_assets::garment::Shape;
use toile_assets::scene::skirt;

use super::SkirtError;
use super::gauge::{Frame, Gauge};
use super::heap::HeapProbe;
use super::options::{Options, WARM_UP};
use super::report::Events;
use super::stage::Stage;

/// Something that is wrong for one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
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
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Recovery {
    /// Greatest mean strain of a frame of the same skirt undisturbed, over the same steps.
    pub baseline_mean: f64,
    /// Greatest 99th percentile of a frame of the same.
    pub baseline_p99: f64,
    /// Greatest stretch of an edge of the same.
    pub baseline_stretch: f64,
    /// Greatest stretch of an edge from the fault on.
    pub worst_stretch: f64,
    /// Steps from the faulty one on, which is the first, until strain, mean and 99th percentile, is back within a quarter
    /// above its baseline and stays there for a quarter of a second.
    pub recovered_steps: usize,
    /// Vertices published that were not finite, summed over the frames.
    pub nonfinite: usize,
    /// What the engine says has happened.
    pub events: Events,
}

/// Runs the scene into a fault, and once more without it, and compares what follows.
///
/// # Errors
/// Where the options cannot be met.
pub fn recover(options: &Options, fault: Fault, heap: &HeapProbe) -> Result<Recovery, SkirtError> {
    let (undisturbed, _) = watch(options, None, heap)?;
    let (frames, events) = watch(options, Some(fault), heap)?;
    let greatest = |of: fn(&Frame) -> f64, frames: &[Frame]| frames.iter().map(of).fold(0.0, f64::max);
    let baseline_mean = greatest(|f| f.strain_mean, &undisturbed);
    let baseline_p99 = greatest(|f| f.strain_p99, &undisturbed);
    let back =
        |f: &Frame| f.nonfinite == 0 && f.strain_mean <= BACK * baseline_mean && f.strain_p99 <= BACK * baseline_p99;
    Ok(Recovery {
        baseline_mean,
        baseline_p99,
        baseline_stretch: greatest(|f| f.stretch_max, &undisturbed),
        worst_stretch: greatest(|f| f.stretch_max, &frames),
        recovered_steps: frames.windows(STAYS).position(|w| w.iter().all(back)).unwrap_or(frames.len()),
        nonfinite: frames.iter().map(|f| f.nonfinite).sum(),
        events,
    })
}

/// The frames from the fault on, and what happened in them.
fn watch(options: &Options, fault: Option<Fault>, heap: &HeapProbe) -> Result<(Vec<Frame>, Events), SkirtError> {
    let mut stage = Stage::new(options, heap)?;
    let mut gauge = Gauge::new(&stage);
    for _ in 0..WARM_UP {
        stage.prepare();
        stage.step();
    }
    let before = stage.events();
    let frames = (0..WATCHED).map(|after| step(&mut stage, &mut gauge, fault.filter(|_| after == 0))).collect();
    Ok((frames, stage.events().since(before)))
}

fn step(stage: &mut Stage, gauge: &mut Gauge, fault: Option<Fault>) -> Frame {
    stage.prepare();
    let asked = stage.spheres;
    match fault {
        None => {}
        Some(Fault::Jump) => [7, 9].into_iter().for_each(|s| stage.spheres[s].x += 1.0),
        Some(Fault::Collider(value)) => stage.spheres[7] = Vec4::splat(value),
        Some(Fault::Particle(value)) => {
            let middle = stage.particle_of()[stage.side * stage.side / 2];
            stage.spoil(middle as usize, Vec3A::splat(value));
        }
        Some(Fault::Pin(value)) => stage.palette[0] = Affine3A::from_translation(Vec3::splat(value)),
    }
    stage.step();
    gauge.read(&stage.cloths[0].positions, &asked)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_are_half_of_the_skirt_and_a_heavy_hem_is_a_row() {
        let mut shape = skirt::shape(32);
        patches(&mut shape);
        assert_eq!(shape.heavier.iter().filter(|x| **x == 1_000.0).count(), 512);
        heavy_hem(&mut shape);
        assert_eq!(shape.heavier.iter().filter(|x| **x == 1_000.0).count(), 32);
    }
}
