//! Outfits in layers on a performing mannequin.

use std::time::Instant;

use toile_base::numeric::statistics::quantile;
use toile_fitting::heap::HeapProbe;
use toile_gpu::backend::Backend;

use super::row::{ContactError, ContactRow};
use crate::worn::{WornOptions, WornScene};
use toile_fitting::crossings::{CrossingFigures, CrossingWatch};

/// Steps of the outfit: 30 s.
const OUTFIT_STEPS: usize = 3_600;

/// Length of a step (ms): what takes longer is late.
const STEP_MS: f64 = 1e3 / 120.0;

/// Some garments of the wardrobe over one another.
pub(super) struct Outfit {
    /// What it is called in the table.
    pub name: &'static str,
    /// Its garments, in wearing order.
    pub garments: &'static [&'static str],
    /// Longest median time of a step, longest of 999 in 1,000 (ms); none where times are only reported.
    within_ms: Option<[f64; 2]>,
}

/// An outfit of the shop, which has to keep its time, and a dress over all else, which no shopper wears and is only reported.
pub(super) const OUTFITS: [Outfit; 2] = [
    Outfit {
        name: "trousers, tee and blazer",
        garments: &["wide-leg-trousers", "tee", "blazer"],
        within_ms: Some([4.5, 6.7]),
    },
    Outfit {
        name: "trousers, tee and dress over them",
        garments: &["wide-leg-trousers", "tee", "strap-dress"],
        within_ms: None,
    },
];

/// How garments are worn here.
pub fn options(garments: &[&str], threads: usize) -> WornOptions {
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

/// Outfits over one another for 30 s.
pub fn outfits() -> Result<Vec<ContactRow>, ContactError> {
    let mut rows = Vec::new();
    for outfit in &OUTFITS {
        rows.extend(outfit.rows()?);
    }
    Ok(rows)
}

impl Outfit {
    fn rows(&self) -> Result<Vec<ContactRow>, ContactError> {
        let mut scene = WornScene::new(&options(self.garments, 2), &HeapProbe::none())?;
        let faces: Vec<&[[u32; 3]]> = scene.garments.iter().map(|g| &*g.triangles).collect();
        let mut watch = CrossingWatch::new(&faces, STEP_MS * 1e-3);
        let particles: usize = scene.garments.iter().map(|g| g.particles()).sum();
        let (mut times, mut deepest) = (Vec::with_capacity(OUTFIT_STEPS), 0.0f64);
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
        let name = |what: &str| format!("{}, {particles} particles, two cores: {what}", self.name);
        let mut rows = self.times(&mut times, &name);
        rows.push(ContactRow::at_most(name("deepest in skin or cones"), 5.0, deepest, "mm"));
        rows.extend(crossings(watch.figures(), &name));
        Ok(rows)
    }

    /// The times of steps (ms), held against what they may be.
    fn times(&self, times: &mut [f64], name: &impl Fn(&str) -> String) -> Vec<ContactRow> {
        let late = times.iter().filter(|ms| **ms > STEP_MS).count();
        let [p50, p999] = [0.5, 0.999].map(|share| quantile(times, share).unwrap_or(0.0));
        let row = |what: &str, most: Option<f64>, got: f64, unit: &'static str| match most {
            Some(most) => ContactRow::at_most(name(what), most, got, unit),
            None => ContactRow::reported(name(what), got, unit),
        };
        vec![
            row("step p50", self.within_ms.map(|most| most[0]), p50, "ms"),
            row("step p99.9", self.within_ms.map(|most| most[1]), p999, "ms"),
            row("late steps in 30 s", self.within_ms.map(|_| 0.0), late as f64, "steps"),
        ]
    }
}

/// Rows of what was seen of crossings.
fn crossings(found: CrossingFigures, name: &impl Fn(&str) -> String) -> [ContactRow; 6] {
    let share = |frames: u64| 100.0 * frames as f64 / found.frames.max(1) as f64;
    [
        ContactRow::at_most(name("moments with crossings"), 1.0, share(found.frames_with), "%"),
        ContactRow::at_most(name("longest with crossings"), 0.5, found.longest_s, "s"),
        ContactRow::reported(name("most crossings"), found.max as f64, "edges"),
        ContactRow::at_most(name("moments with crossings between garments"), 1.0, share(found.frames_between), "%"),
        ContactRow::at_most(name("longest with crossings between garments"), 0.5, found.longest_between_s, "s"),
        ContactRow::at_most(name("most crossings between garments"), 0.0, found.max_between as f64, "edges"),
    ]
}
