//! One run of garments on a mannequin: time and error of the same steps.

use std::time::Instant;

use toile_base::numeric::statistics::{median, quantile};
use toile_engine::cloth::step::measure as engine;
use toile_fitting::heap::HeapProbe;
use toile_fitting::scene::StepTimes;
use toile_fitting::scene::events::ClothEvents;

use super::error::WornError;
use super::report::{WornReport, WornStrain};
use super::scene::{WornOptions, WornScene};
use crate::backend::SteppedBy;

/// Steps before the first that counts: the garment is let down, the mannequin takes its pose.
const WARM_UP: usize = 240;

/// Steps after the last that counts in which the engine times its stages: a second's, and two of the slowest parts.
const METERED_STEPS: usize = 360;

/// Runs the garments as asked.
///
/// # Errors
/// Where the options cannot be met.
pub fn measure(options: &WornOptions, heap: &HeapProbe) -> Result<WornReport, WornError> {
    let mut scene = WornScene::new(options, heap)?;
    let mut sums = WornSums::default();
    for _ in 0..WARM_UP {
        scene.prepare();
        scene.step();
    }
    let before = events(&scene);
    let (mut times, mut medians) = (Vec::with_capacity(options.runs * options.steps), Vec::new());
    for _ in 0..options.runs.max(1) {
        let first = times.len();
        for _ in 0..options.steps.max(1) {
            times.push(sums.step(&mut scene, heap));
        }
        medians.push(median(&mut times[first..].to_vec()).unwrap_or(0.0));
    }
    let p50 = median(&mut medians.clone()).unwrap_or(0.0);
    let mut time = |part| quantile(&mut times, part).unwrap_or(0.0);
    let step_us = StepTimes { p50, p99: time(0.99), p999: time(0.999), max: time(1.0) };
    let moving = |g: &toile_base::garment::Garment| g.inverse_mass.iter().filter(|w| **w > 0.0).count();
    let frames = sums.frames.max(1) as f64;
    Ok(WornReport {
        garments: options.garments.clone(),
        sizes: scene.sizes.clone(),
        moving: scene.garments.iter().map(moving).sum(),
        quality: scene.settings().quality.name(),
        substeps: scene.cloths.iter().map(|c| c.substeps()).collect(),
        lanes: scene.settings().width.lanes(),
        threads: options.threads,
        runs: options.runs,
        steps: options.steps,
        step_us,
        run_p50_us: medians,
        strain: WornStrain { mean: sums.strain[0] / frames, p99: sums.strain[1] / frames, max: sums.worst },
        deepest_mm: sums.deepest * 1e3,
        allocations_per_step: heap.read().map(|_| sums.allocations as f64 / times.len() as f64),
        memory_bytes: scene.memory_bytes,
        events: events(&scene).since(before),
        stepped_by: SteppedBy::of(scene.backends()),
        state_hash: format!("{:016x}", scene.state_hash()),
        stages_us: scene.stages_us(METERED_STEPS).into_iter().collect(),
    })
}

fn events(scene: &WornScene) -> ClothEvents {
    scene.cloths.iter().map(|c| ClothEvents::from(c.events)).sum()
}

/// What is gathered while the steps go by.
#[derive(Default)]
struct WornSums {
    strain: [f64; 2],
    worst: f64,
    deepest: f64,
    allocations: u64,
    frames: u64,
}

impl WornSums {
    /// Takes a step; gives its time (us).
    fn step(&mut self, scene: &mut WornScene, heap: &HeapProbe) -> f64 {
        scene.prepare();
        let before = heap.read();
        let start = Instant::now();
        scene.step();
        let elapsed = start.elapsed();
        if let Some((before, after)) = before.zip(heap.read()) {
            self.allocations += after.allocations - before.allocations;
        }
        let WornScene { cloths, garments, .. } = scene;
        for (cloth, garment) in cloths.iter_mut().zip(&*garments) {
            let strain = engine::strain(cloth, garment);
            self.strain[0] += f64::from(strain.mean);
            self.strain[1] += f64::from(strain.p99);
            self.worst = self.worst.max(f64::from(strain.max));
            self.frames += 1;
        }
        self.deepest = self.deepest.max(scene.penetration());
        elapsed.as_secs_f64() * 1e6
    }
}
