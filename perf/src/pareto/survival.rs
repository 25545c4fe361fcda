//! The survival map: a skirt whose hem is heavier and heavier, at longer and longer steps.

use toile_assets::scene::skirt;
use toile_bake::Shape;
use toile_fitting::heap::HeapProbe;

use super::error::ParetoError;
use super::report::{Fate, Survival};
use crate::skirt::options::SkirtOptions;
use crate::skirt::{Gauge, SkirtError, SkirtScene};

/// Vertices a side.
const SIDE: usize = 24;

/// Substeps of a step, whatever its length: those of the garment at 1/120 s.
const SUBSTEPS: u32 = 4;

/// Time that is walked (s).
const SECONDS: f64 = 2.0;

/// Strain from which the cloth counts as strained: beyond what cotton bears (1).
const STRAINED_P99: f64 = 0.06;

/// Mass of a hem particle over its fabric's.
const RATIOS: [f64; 6] = [1.0, 10.0, 100.0, 1e3, 1e4, 1e5];

/// Steps a second.
const HZ: [f64; 6] = [240.0, 120.0, 60.0, 30.0, 15.0, 8.0];

/// The whole map, or every second row and column of it.
pub fn map(quick: bool) -> Result<Survival, ParetoError> {
    let every = if quick { 2 } else { 1 };
    let mass_ratios: Vec<f64> = RATIOS.into_iter().step_by(every).collect();
    let steps_s: Vec<f64> = HZ.into_iter().step_by(every).map(f64::recip).collect();
    let (mut fate, mut strain_p99) = (Vec::new(), Vec::new());
    for step_s in &steps_s {
        let (mut fates, mut strains) = (Vec::new(), Vec::new());
        for ratio in &mass_ratios {
            let (became, strain) = run(*ratio, *step_s)?;
            fates.push(became);
            strains.push(strain);
        }
        fate.push(fates);
        strain_p99.push(strains);
    }
    Ok(Survival { mass_ratios, steps_s, substeps: SUBSTEPS, strained_p99: STRAINED_P99, fate, strain_p99 })
}

/// Walks once; what became of the skirt, and its strain in the second half.
fn run(ratio: f64, step_s: f64) -> Result<(Fate, f64), SkirtError> {
    let options =
        SkirtOptions { verts: SIDE * SIDE, substeps: Some(SUBSTEPS), step_s: step_s as f32, ..SkirtOptions::default() };
    let heavy = |shape: &mut Shape| {
        shape.heavier = vec![1.0; shape.cut.len()];
        skirt::hem(SIDE).for_each(|v| shape.heavier[v] = ratio as f32);
    };
    let mut scene = SkirtScene::with(&options, &HeapProbe::none(), heavy)?;
    let mut gauge = Gauge::new(&scene);
    let steps = (SECONDS / step_s).round() as u64;
    let mut worst = 0.0f64;
    for step in 0..steps {
        scene.prepare();
        scene.step();
        if step >= steps / 2 {
            worst = worst.max(gauge.read(&scene.cloths[0].positions, &scene.spheres).strain_p99);
        }
    }
    let fate = match (scene.events().rolled_back, worst <= STRAINED_P99) {
        (0, true) => Fate::Stable,
        (0, false) => Fate::Strained,
        _ => Fate::RolledBack,
    };
    Ok((fate, worst))
}
