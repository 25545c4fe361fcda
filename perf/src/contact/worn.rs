//! Garments on a performing mannequin: the skin in place of cones, and an outfit in layers.

use std::time::Instant;

use toile_fitting::heap::HeapProbe;
use toile_gpu::backend::Backend;

use super::row::{ContactError, ContactRow};
use crate::crossings::{CrossingFigures, CrossingWatch};
use crate::worn::{WornOptions, WornScene};

/// Steps of the outfit: 30 s.
const OUTFIT_STEPS: usize = 3_600;

/// Steps in which stages are metered.
const METERED: usize = 240;

fn options(garments: &[&str], threads: usize) -> WornOptions {
    WornOptions {
        garments: garments.iter().map(|g| (*g).to_owned()).collect(),
        threads,
        lanes: None,
        quality: None,
        substeps: None,
        layers: true,
        folds: true,
        skin: true,
        runs: 1,
        steps: OUTFIT_STEPS,
        backend: Backend::Cpu,
    }
}

/// Time of contact with the skin less that with cones, of a T-shirt and trousers, 9,967 particles.
pub fn skin() -> Result<Vec<ContactRow>, ContactError> {
    let mut us = [0.0; 2];
    let mut particles = 0;
    for (k, skin) in [false, true].into_iter().enumerate() {
        let asked = WornOptions { skin, layers: false, folds: false, ..options(&["wide-trousers", "t-shirt"], 1) };
        let mut scene = WornScene::new(&asked, &HeapProbe::none())?;
        particles = scene.garments.iter().map(|g| g.particles()).sum();
        scene.stages_us(METERED);
        us[k] = scene.stages_us(METERED).into_iter().filter(|(stage, _)| *stage == "contact").map(|(_, us)| us).sum();
    }
    let name = format!("body of triangles in place of cones, {particles} particles: contact takes longer by");
    Ok(vec![ContactRow::at_most(name, 0.5, (us[1] - us[0]) * 1e-3, "ms")])
}

/// Three garments over one another for 30 s.
pub fn outfit() -> Result<Vec<ContactRow>, ContactError> {
    let mut scene = WornScene::new(&options(&["wide-trousers", "t-shirt", "sun-dress"], 2), &HeapProbe::none())?;
    let faces: Vec<&[[u32; 3]]> = scene.garments.iter().map(|g| &*g.triangles).collect();
    let mut watch = CrossingWatch::new(&faces, 1.0 / 120.0);
    let particles: usize = scene.garments.iter().map(|g| g.particles()).sum();
    let (mut times, mut deepest) = (Vec::new(), 0.0f64);
    for step in 1..=OUTFIT_STEPS as u64 {
        scene.prepare();
        let begun = Instant::now();
        scene.step();
        times.push(begun.elapsed().as_secs_f64() * 1e3);
        if CrossingWatch::wants(step) {
            deepest = deepest.max(scene.penetration() * 1e3);
            let at = scene.cloths.iter().map(|c| c.positions.iter().map(|p| (*p).into()).collect());
            watch.look(&at.collect::<Vec<_>>());
        }
    }
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times[((times.len() - 1) as f64 * share) as usize];
    let late = times.iter().filter(|ms| **ms > 1e3 / 120.0).count();
    let name = |what: &str| format!("trousers, T-shirt and dress over them, {particles} particles, two cores: {what}");
    let CrossingFigures { frames, frames_with, max_between, longest_s, .. } = watch.figures();
    Ok(vec![
        ContactRow::at_most(name("step p50"), 4.5, at(0.5), "ms"),
        ContactRow::at_most(name("step p99.9"), 6.7, at(0.999), "ms"),
        ContactRow::at_most(name("late steps in 30 s"), 0.0, late as f64, "steps"),
        ContactRow::at_most(name("deepest in skin or cones"), 5.0, deepest, "mm"),
        ContactRow::at_most(name("moments with crossings"), 1.0, 100.0 * frames_with as f64 / frames as f64, "%"),
        ContactRow::at_most(name("most crossings between garments"), 0.0, max_between as f64, "edges"),
        ContactRow::at_most(name("longest with crossings"), 0.5, longest_s, "s"),
    ])
}
