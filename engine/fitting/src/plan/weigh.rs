//! What each model of the cloth is worth: the scene without it, or with one that it leaves out, against the scene as it is.
//!
//! Cloth is chaotic: a second after the least difference the folds of two runs are others. So moments of one run are gone on
//! from, for 50 ms, with the model and without, and the figure is how far the particles are apart then.

use std::time::Instant;

use glam::Vec3A;
use serde::Serialize;
use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, Layout, LayoutError};
use toile_base::numeric::statistics::{quantile, quantile_of};
use toile_engine::cloth::{Cloth, Quality, Settings, Step, Wind};
use toile_engine::workers::WorkerPool;

use super::PlanError;
use super::calibrate::quartile;
use super::left_out;
use super::scene::{PlannedScene, Playing};
use super::work::STAGES;
use crate::scene::contact::ContactReport;

/// Steps of a window: 50 ms.
const WINDOW: usize = 6;

/// Most moments that are gone on from.
const MOMENTS: usize = 8;

/// Coefficients of cloth in air (1): the scene files' own defaults.
const DRAG_LIFT: [f32; 2] = [0.1, 0.05];

/// A model and what it is worth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Weighed {
    /// Name of the model.
    pub model: &'static str,
    /// Whether the scene has it.
    pub on: bool,
    /// How far particles that move are from where they are in the scene as it is, after 50 ms: mean, 99 %, worst (mm).
    pub error_mm: [f64; 3],
    /// Time of a step with it, less that without it, on one core (us).
    pub us: f64,
}

/// Figures from playing the scene.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Played {
    /// Time of the cloth's part of a step, median and 99 % (us), with the workers of the plan.
    pub cloth_us: [f64; 2],
    /// Pairs of particle and capsule that were near, a step, all garments.
    pub near: u64,
    /// Time of each stage on one core, all garments (us).
    pub stages_us: [f64; STAGES.len()],
    /// What contact of cloth with cloth did; none where no garment can meet anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<ContactReport>,
    /// Steps that were played.
    pub steps: usize,
    /// Moments that were gone on from.
    pub moments: usize,
    /// The models that were weighed.
    pub models: Vec<Weighed>,
}

/// A scene changed by one model.
struct Variant {
    model: &'static str,
    on: bool,
    garments: Vec<Garment>,
    settings: Vec<Settings>,
}

/// Plays a scene and weighs its models.
///
/// # Errors
/// Where the workers cannot be started.
pub fn play(scene: &PlannedScene, workers: usize) -> Result<Played, PlanError> {
    let mut pool = WorkerPool::new(workers)?;
    let variants = variants(scene)?;
    let mut tallies: Vec<Tally> = variants.iter().map(|_| Tally::default()).collect();
    let mut playing = Playing::new(scene);
    let steps = scene.steps();
    let apart = (steps.saturating_sub(scene.dressing) / MOMENTS).max(WINDOW);
    let (mut times, mut moments) = (Vec::new(), 0);
    for step in 0..steps {
        let met = step >= scene.dressing;
        if met && (step - scene.dressing) % apart == apart / 2 && step + WINDOW <= steps {
            weigh(&playing, &variants, &mut tallies);
            moments += 1;
        }
        playing.place();
        pool.wake();
        let begun = Instant::now();
        playing.take(&scene.settings, &mut pool);
        if met {
            times.push(begun.elapsed().as_secs_f64() * 1e6);
        }
    }
    let as_is = tallies.remove(0);
    let stages_us = as_is.stages_us();
    let models = variants[1..].iter().zip(tallies).map(|(v, tally)| tally.weighed(v, &as_is)).collect();
    let cloth_us = [0.5, 0.99].map(|share| quantile(&mut times, share).unwrap_or(0.0));
    let near = playing.cloths.iter().map(|c| c.contact_counts().near).sum::<u64>() / steps.max(1) as u64;
    let contact = playing.layers.as_ref().map(|l| ContactReport::from(l.counts()));
    Ok(Played { cloth_us, near, stages_us, contact, steps: times.len(), moments, models })
}

/// The scene as it is, then each model left out that it has, then each added that it has not.
fn variants(scene: &PlannedScene) -> Result<Vec<Variant>, LayoutError> {
    let mut all = Vec::new();
    let mut add = |model, on, garment: &dyn Fn(&mut Fabric, &mut Layout), settings: &dyn Fn(&mut Settings)| {
        let garments = scene.garments.iter().map(|g| left_out::changed(g, garment)).collect::<Result<_, _>>()?;
        let mut with = scene.settings.clone();
        with.iter_mut().for_each(settings);
        all.push(Variant { model, on, garments, settings: with });
        Ok(())
    };
    let (same, alike) = (|_: &mut Fabric, _: &mut Layout| (), |_: &mut Settings| ());
    add("as it is", true, &same, &alike)?;
    let (wind, tethers) = (scene.settings[0].wind, scene.settings[0].tethers);
    let quality = scene.settings[0].quality;
    add("bending", true, &|_, layout| left_out::bending(layout), &alike)?;
    if scene.garments.iter().any(|g| !g.layout().friction.slots.is_empty()) {
        add("friction in bending", true, &|_, layout| left_out::bend_friction(layout), &alike)?;
    }
    let fabrics = || scene.garments.iter().map(|g| &g.fabric);
    if fabrics().any(|f| f.stretch.warp.is_some() || f.stretch.weft.is_some() || f.shear_lock.is_some()) {
        add("second slopes of stretch and shear", true, &|_, layout| left_out::second_slopes(layout), &alike)?;
    }
    if fabrics().any(Fabric::rubs_in_links) {
        add("friction in shear and stretch", true, &|_, layout| left_out::link_friction(layout), &alike)?;
    }
    if fabrics().any(|f| f.buckling) {
        add("threads that buckle", true, &|_, layout| left_out::buckling(layout), &alike)?;
    }
    add("shear", true, &|_, layout| left_out::shear(layout), &alike)?;
    add("friction", true, &|fabric, _| fabric.friction = 0.0, &alike)?;
    add("continuous contact", true, &same, &|s| s.continuous = false)?;
    add("damping by air", true, &|fabric, _| fabric.damping_per_s = 0.0, &alike)?;
    let [skin, layers, folds] = models(scene);
    if scene.skinning.is_some() {
        add("the skin that is seen, in place of cones", skin, &same, &|s| s.contact.skin = u8::from(!skin))?;
    }
    if scene.garments.len() > 1 {
        add("garments over one another", layers, &same, &|s| s.contact.layers = u8::from(!layers))?;
    }
    add("a garment against itself", folds, &same, &|s| s.contact.folds = u8::from(!folds))?;
    match wind {
        Some(_) => add("wind", true, &same, &|s| s.wind = None)?,
        None => add("still air on each triangle", false, &same, &|s| s.wind = Some(still()))?,
    }
    if quality != Quality::Draft {
        add("repeated passes over hoops and fibers", true, &same, &|s| s.quality = Quality::Draft)?;
        let model_name = if tethers { "tethers" } else { "tethers in every substep" };
        add(model_name, tethers, &same, &|s| s.tethers = !tethers)?;
    }
    if quality != Quality::Fine {
        add("three times the substeps, shear in each (fine)", false, &same, &|s| s.quality = Quality::Fine)?;
    }
    add("threads that do not give (zero stretch)", false, &|_, layout| left_out::stretch(layout), &alike)?;
    Ok(all)
}

/// Whether a scene has skin, layers and folds.
fn models(scene: &PlannedScene) -> [bool; 3] {
    let every = scene.settings[0].contact;
    [every.skin > 0 && scene.skinning.is_some(), every.layers > 0, every.folds > 0]
}

/// Air that does not move.
fn still() -> Wind {
    Wind { velocity: Vec3A::ZERO, drag: DRAG_LIFT[0], lift: DRAG_LIFT[1] }
}

/// What the windows of one variant came to.
#[derive(Default)]
struct Tally {
    apart_mm: Vec<f32>,
    /// The shortest step of each window (us): what nothing else of the machine got into.
    times_us: Vec<f64>,
    stages: [Vec<f64>; STAGES.len()],
}

impl Tally {
    fn stages_us(&self) -> [f64; STAGES.len()] {
        std::array::from_fn(|k| quartile(&mut self.stages[k].clone()))
    }

    fn weighed(mut self, variant: &Variant, as_is: &Self) -> Weighed {
        let n = self.apart_mm.len();
        let mean = self.apart_mm.iter().map(|mm| f64::from(*mm)).sum::<f64>() / n.max(1) as f64;
        let [p99, max] = [0.99, 1.0].map(|share| quantile(&mut self.apart_mm, share).map_or(0.0, f64::from));
        // Window by window, so that a machine that changes its pace does not count.
        let more = as_is.times_us.iter().zip(&self.times_us).map(|(a, b)| a - b);
        let us = quantile_of(more, 0.5).unwrap_or(0.0);
        let us = if variant.on { us } else { -us };
        Weighed { model: variant.model, on: variant.on, error_mm: [mean, p99, max], us }
    }
}

/// Goes on from where a run is, once with each variant; the first is what the others are held against.
fn weigh(from: &Playing<'_>, variants: &[Variant], tallies: &mut [Tally]) {
    let mut as_is: Vec<Box<[Vec3A]>> = Vec::new();
    for (variant, tally) in variants.iter().zip(tallies) {
        let ends = window(from, variant, tally);
        if as_is.is_empty() {
            as_is = ends;
            continue;
        }
        for ((a, b), garment) in as_is.iter().zip(&ends).zip(&variant.garments) {
            let free = a.iter().zip(b.iter()).zip(&garment.inverse_mass).filter(|(_, w)| **w > 0.0);
            tally.apart_mm.extend(free.map(|((a, b), _)| a.distance(*b) * 1e3));
        }
    }
}

/// Plays a window and gives where the particles end. All variants start in the same way: a cloth of their own,
/// placed by a step, then put into the state of the run.
fn window(from: &Playing<'_>, variant: &Variant, tally: &mut Tally) -> Vec<Box<[Vec3A]>> {
    let mut playing = from.moment();
    let settings: Vec<Settings> = variant.settings.iter().map(|s| Settings { timed: true, ..*s }).collect();
    for ((garment, settings), run) in variant.garments.iter().zip(&settings).zip(&from.cloths) {
        let mut cloth = Cloth::new(garment, &playing.colliders);
        if settings.wind.is_some() {
            cloth = cloth.in_wind(garment);
        }
        cloth.step(garment, &Step { palette: &playing.bones, colliders: &playing.colliders, settings });
        (0..garment.particles()).for_each(|i| cloth.disturb(i, run.positions[i], run.velocity(i)));
        cloth.remember(run);
        playing.cloths.push(cloth);
    }
    // One worker is the caller.
    let Ok(mut pool) = WorkerPool::new(1) else { return Vec::new() };
    let mut shortest = f64::INFINITY;
    for _ in 0..WINDOW {
        playing.place();
        let begun = Instant::now();
        playing.take_as(&variant.garments, &settings, &mut pool);
        let us = begun.elapsed().as_secs_f64() * 1e6;
        let sum = |k: usize| playing.cloths.iter().map(|c| c.stage_ns[k]).sum::<u64>() as f64 * 1e-3;
        let rest = STAGES.len() - 1;
        (0..rest).for_each(|k| tally.stages[k].push(sum(k)));
        tally.stages[rest].push((us - (0..rest).map(sum).sum::<f64>()).max(0.0));
        shortest = shortest.min(us);
    }
    tally.times_us.push(shortest);
    playing.cloths.into_iter().map(|c| c.positions).collect()
}
