//! What contact of cloth with cloth costs where it is off: the skirt by way of layers that have nothing to do.

use std::time::Instant;

use toile_base::numeric::statistics::median_of;
use toile_engine::cloth::contact::garments::GarmentContact;
use toile_engine::cloth::{Settings, Step};
use toile_engine::colliders::Colliders;
use toile_engine::workers::WorkerPool;
use toile_fitting::heap::HeapProbe;

use super::row::{ContactError, ContactRow};
use crate::skirt::SkirtScene;
use crate::skirt::options::SkirtOptions;

/// Turns of both ways, of which the median ratio counts.
const TURNS: usize = 9;

/// Steps of a turn.
const STEPS: usize = 240;

/// Steps before the first turn.
const WARM_UP: usize = 240;

/// Most that the way through layers may take, over the way without (1).
const LONGER: f64 = 1.02;

/// The skirt by itself, and one whose layers have both models off: the same bits in the same time, as frames step it, which ask
/// the layers first, and by way of the layers all the same.
pub fn off() -> Result<Vec<ContactRow>, ContactError> {
    let mut rows = Vec::new();
    for (asks, how) in [(true, "as frames step it"), (false, "by way of the layers")] {
        let found = compare(&SkirtOptions::default(), asks, WARM_UP, [TURNS, STEPS])?;
        let name = |what: &str| format!("skirt of 4,096, contact off, {how}, over without layers: {what}");
        let differ = f64::from(u8::from(!found.same));
        rows.push(ContactRow::at_most(name("states that differ at the end"), 0.0, differ, "hashes"));
        rows.push(ContactRow::at_most(name("time"), LONGER, found.ratio, "times"));
    }
    Ok(rows)
}

/// How both ways compare.
struct OffFindings {
    /// Whether they have come to the same bits.
    same: bool,
    /// Median over the turns of one's median time of a step over the other's.
    ratio: f64,
}

fn compare(
    options: &SkirtOptions,
    asks: bool,
    warm_up: usize,
    [turns, steps]: [usize; 2],
) -> Result<OffFindings, ContactError> {
    let mut plain = SkirtScene::new(options, &HeapProbe::none())?;
    let mut layered = LayeredSkirt::new(options, asks)?;
    for _ in 0..warm_up {
        step_ns(&mut plain);
        layered.step_ns();
    }
    let mut ratios = Vec::new();
    for _ in 0..turns {
        let mut ns = [Vec::with_capacity(steps), Vec::with_capacity(steps)];
        for step in 0..steps {
            // Step by step, each first in every other one: what slows the machine down meanwhile slows both.
            for way in [step % 2, 1 - step % 2] {
                ns[way].push(if way == 0 { step_ns(&mut plain) } else { layered.step_ns() });
            }
        }
        let [without, with] = ns.map(|ns| median_of(ns).unwrap_or(0) as f64);
        ratios.push(with / without);
    }
    let same = plain.state_hash() == layered.scene.state_hash();
    Ok(OffFindings { same, ratio: median_of(ratios).unwrap_or(f64::NAN) })
}

fn step_ns(scene: &mut SkirtScene) -> u64 {
    scene.prepare();
    let begun = Instant::now();
    scene.step();
    begun.elapsed().as_nanos() as u64
}

/// The skirt stepped by layers.
struct LayeredSkirt {
    scene: SkirtScene,
    layers: GarmentContact,
    colliders: Colliders,
    settings: Settings,
    pool: WorkerPool,
    /// Whether the layers are asked first whether there is anything to do.
    asks: bool,
}

impl LayeredSkirt {
    fn new(options: &SkirtOptions, asks: bool) -> Result<Self, ContactError> {
        let scene = SkirtScene::new(options, &HeapProbe::none())?;
        let layers = GarmentContact::new(std::slice::from_ref(&scene.garment)).ok_or(ContactError::NoFaces)?;
        let mut settings = *scene.settings();
        (settings.contact.layers, settings.contact.folds) = (0, 0);
        let (colliders, pool) = (scene.colliders().clone(), WorkerPool::new(options.threads)?);
        Ok(Self { scene, layers, colliders, settings, pool, asks })
    }

    /// A step, and how long it took (ns).
    fn step_ns(&mut self) -> u64 {
        let Self { scene, layers, colliders, settings, pool, .. } = self;
        if self.asks && !layers.asked(settings) {
            return step_ns(scene);
        }
        scene.prepare();
        let begun = Instant::now();
        colliders.place_spheres(&scene.spheres);
        let step = Step { palette: &scene.palette, colliders, settings };
        let done = layers.step(pool, &mut scene.cloths, std::slice::from_ref(&scene.garment), &step);
        done.expect("a share of the step panicked");
        begun.elapsed().as_nanos() as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contact_that_is_off_changes_no_bit() {
        let small = SkirtOptions { verts: 256, ..SkirtOptions::default() };
        for asks in [false, true] {
            let found = compare(&small, asks, 10, [2, 10]).unwrap();
            assert!(found.same && found.ratio > 0.0);
        }
        // What the other way would do is seen where a skirt of this many vertices folds.
        let mut folded = LayeredSkirt::new(&SkirtOptions { verts: 1_024, ..small }, true).unwrap();
        folded.settings.contact.folds = 1;
        for _ in 0..240 {
            folded.step_ns();
        }
        assert!(folded.layers.counts().asked > 0, "folds were not looked for");
    }
}
