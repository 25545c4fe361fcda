//! Time of a unit of work on this machine: some cloths of the program's own are stepped, and the times of their stages are fitted
//! to the counts of their units.
//!
//! None of the cloths is of the wardrobe, so that the prediction for its garments was learnt from others. They differ
//! in what decides the time: rows and scattered triangles, threads that give and threads that do not, near the body and
//! far from it, wind, tethers.

use std::hint::black_box;
use std::time::Instant;

use glam::Vec3;
use toile_assets::scene_file::{SceneFile, SceneSource};
use toile_base::body::Body;
use toile_base::frame::Joints;
use toile_base::garment::Garment;
use toile_base::mesh::SkinWeights;
use toile_base::numeric::statistics::quantile;
use toile_base::rig::Rig;
use toile_base::skeleton::Joint;
use toile_engine::cloth::{Settings, step::program};
use toile_engine::meter::STAGES as STEP_STAGES;
use toile_engine::workers::{SHARES, WorkerPool};

use super::PlanError;
use super::cost::Costs;
use super::fit::fit;
use super::scene::{PlannedScene, Playing};
use super::work::{FirstStep, STAGES, Work, beside};
use crate::dress::try_on::DressedBody;
use crate::timing;

/// Steps of each cloth that are not timed, and those that are.
const WARM_UP: usize = 24;
const TIMED: usize = 40;

/// Steps of a world without garments.
const EMPTY_STEPS: usize = 60;

/// The colliders that all of them lie on: the benchmark's body, walking.
const WALKING: &str = "duration = 7\n[colliders]\nmotion = \"walk\"\n";

/// Waist, pinned to the body that walks.
const WAIST: &str = "motion = \"walk\"\n";

/// A fabric whose bending rubs.
const RUBBING: &str = "fabric = \"wool-tropical\"";

/// Each cloth's own part of its scene file.
fn texts() -> [String; 11] {
    let scene = |more: &str, garment: &str, pinned: &str| {
        format!("{WALKING}{more}\n[[garment]]\n{garment}\n[[garment.pin]]\nvertices = [\"{pinned}\"]\n{WAIST}")
    };
    let wind = "[wind]\nvelocity = [0.5, 0.0, 0.3]\n";
    let draft = "[settings]\nquality = \"draft\"\n";
    let folds = "[settings]\nfolds = true\n";
    let tube = |rows: u32, columns: u32| {
        format!(
            "tube = {{ rows = {rows}, columns = {columns}, top_radius = 0.19, bottom_radius = 0.3, height = 0.6 }}\nposition \
             = [0, 1.05, 0]"
        )
    };
    [
        scene("", "skirt = { side = 64 }\nfabric = \"cotton-lawn\"", "0-63"),
        scene(wind, "skirt = { side = 32 }\nfabric = \"linen-twill\"", "0-31"),
        scene(wind, "skirt = { side = 40, layout = \"irregular\" }\nfabric = \"cotton-jersey\"", "0-39"),
        scene(draft, "skirt = { side = 48 }\nfabric = \"cotton-jersey\"", "0-47"),
        scene("", &format!("{}\nfabric = \"cotton-jersey\"", tube(40, 96)), "0-95"),
        scene(draft, "skirt = { side = 24, layout = \"irregular\" }\nfabric = \"cotton-lawn\"", "0-23"),
        scene("", &format!("skirt = {{ side = 60 }}\n{RUBBING}"), "0-59"),
        scene("", &format!("skirt = {{ side = 44, layout = \"irregular\" }}\n{RUBBING}"), "0-43"),
        scene(folds, "skirt = { side = 56 }\nfabric = \"linen-twill\"", "0-55"),
        format!(
            "{}\n[[garment]]\n{}\nscale = 1.05\n[[garment.pin]]\nvertices = [\"0-95\"]\n{WAIST}",
            scene("", &tube(40, 96), "0-95"),
            tube(30, 96)
        ),
        // Nothing holds it, so that all of its fibers are solved by index.
        format!(
            "{WALKING}[[garment]]\ngrid = {{ rows = 32, columns = 40, width = 1.0, height = 0.8, plane = \"level\" }}\n\
                 position = [0, 1.2, 0]\n"
        ),
    ]
}

/// Measured times of one cloth.
struct Sample {
    work: Work,
    /// Time of each stage (us).
    stages_us: [f64; STAGES.len()],
}

/// What this machine takes for a body: some seconds' tenths. `track` moves the body.
///
/// # Errors
/// Where a cloth or the world cannot be made.
pub fn measure(body: Option<(&Body, &Rig, &[Joints])>, workers: usize) -> Result<Costs, PlanError> {
    let mut scenes = Vec::new();
    for text in texts() {
        scenes.push(PlannedScene::file(SceneFile::parse("calibration", &text, SceneSource::Inside(&[]))?)?);
    }
    if let Some((body, rig, track)) = body {
        scenes.push(skirt_on(&scenes[0], body, rig, track)?);
    }
    let samples = scenes.iter().map(sample).collect::<Result<Vec<_>, _>>()?;
    let mut costs = Costs { copy_us: copy_us(), ..Costs::default() };
    for (stage, unit) in costs.unit_us.iter_mut().enumerate() {
        let rows: Vec<_> = samples.iter().map(|s| s.work.counts[stage]).collect();
        let times: Vec<_> = samples.iter().map(|s| s.stages_us[stage]).collect();
        *unit = fit(&rows, &times);
    }
    if workers > 1 {
        costs.barrier_us = barrier_us(&scenes[0], &costs)?;
    }
    if let Some((body, rig, track)) = body {
        costs.body_us = body_us(body, rig, track, workers)?;
    }
    Ok(costs)
}

/// The skirt of another scene on a shopper, whose skin it then meets.
fn skirt_on(other: &PlannedScene, body: &Body, rig: &Rig, track: &[Joints]) -> Result<PlannedScene, PlanError> {
    let (mut skirt, layout) = other.garments[0].clone().into_parts();
    let (pelvis, _) = SkinWeights::strongest([(Joint::Pelvis.index() as u8, 1.0)]);
    skirt.fixed_weights.iter_mut().for_each(|w| *w = pelvis);
    let skirt = Garment::new(skirt, layout).expect("other bones leave the constraints as they are");
    let mut settings = other.settings[0];
    settings.contact.folds = 0;
    PlannedScene::worn(body, rig, vec![skirt], settings, track)
}

fn sample(scene: &PlannedScene) -> Result<Sample, PlanError> {
    let mut pool = WorkerPool::new(1)?;
    let settings: Vec<Settings> = scene.settings.iter().map(|s| Settings { timed: true, ..*s }).collect();
    let mut playing = Playing::new(scene);
    let mut times: [Vec<f64>; STAGES.len()] = Default::default();
    let before = |p: &Playing<'_>| -> Vec<u64> { p.cloths.iter().map(|c| c.contact_counts().near).collect() };
    let mut near = Vec::new();
    for step in 0..WARM_UP + TIMED {
        playing.place();
        if step == WARM_UP {
            near = before(&playing);
        }
        let begun = Instant::now();
        playing.take(&settings, &mut pool);
        let us = begun.elapsed().as_secs_f64() * 1e6;
        if step >= WARM_UP {
            let sum = |k: usize| playing.cloths.iter().map(|c| c.stage_ns[k] as f64 * 1e-3).sum();
            let stages: [f64; program::METERED_STAGES.len()] = std::array::from_fn(sum);
            times.iter_mut().zip(stages).for_each(|(all, us)| all.push(us));
            times[program::METERED_STAGES.len()].push((us - stages.iter().sum::<f64>()).max(0.0));
        }
    }
    let now = before(&playing);
    let work = |k: usize| {
        let near = (now[k] - near[k]) as f64 / TIMED as f64;
        let first = FirstStep::of(&playing.cloths[k], near);
        let first = FirstStep { beside: beside(k, &scene.garments), ..first };
        Work::of(&scene.garments[k], &settings[k], &first)
    };
    let work = (1..scene.garments.len()).fold(work(0), |all, k| all.and(&work(k)));
    Ok(Sample { work, stages_us: times.map(|mut all| quartile(&mut all)) })
}

/// Time of a barrier of two workers, from a cloth that they share (us).
fn barrier_us(scene: &PlannedScene, costs: &Costs) -> Result<f64, PlanError> {
    let mut pool = WorkerPool::new(SHARES)?;
    let mut playing = Playing::new(scene);
    let (mut times, mut one) = (Vec::new(), Vec::new());
    let mut alone = Playing::new(scene);
    let mut single = WorkerPool::new(1)?;
    for step in 0..WARM_UP + TIMED {
        playing.place();
        timing::wake(&mut pool);
        let begun = Instant::now();
        playing.take(&scene.settings, &mut pool);
        let two = begun.elapsed();
        alone.place();
        let begun = Instant::now();
        alone.take(&scene.settings, &mut single);
        if step >= WARM_UP {
            times.push(two.as_secs_f64() * 1e6);
            one.push(begun.elapsed().as_secs_f64() * 1e6);
        }
    }
    let first = FirstStep::of(&playing.cloths[0], 0.0);
    let work = Work::of(&scene.garments[0], &scene.settings[0], &first);
    let rest = costs.garment(&work).stages_us[STAGES.len() - 1];
    let (two, one) = (quartile(&mut times), quartile(&mut one));
    Ok(((two - rest - (one - rest) * work.share) / work.phases).max(0.0))
}

/// Times of the stages of a world without garments (us).
fn body_us(body: &Body, rig: &Rig, track: &[Joints], workers: usize) -> Result<[f64; STEP_STAGES.len()], PlanError> {
    let settings = Settings { workers, ..Settings::default() };
    let (mut world, _reader) = DressedBody::new(rig.clone(), body.clone(), Vec::new()).build(settings)?;
    world.measure_every(0);
    for k in 0..EMPTY_STEPS {
        if let Some(joints) = track.get(k * track.len() / EMPTY_STEPS) {
            world.step(joints);
        }
    }
    let half = |k: usize| world.meters().stages[k].histogram().value_at_quantile(0.5) as f64 * 1e-3;
    Ok(std::array::from_fn(half))
}

/// A particle's copy into a snapshot (us).
fn copy_us() -> f64 {
    const PARTICLES: usize = 4_096;
    let from = vec![glam::Vec3A::ONE; PARTICLES];
    let mut to = vec![Vec3::ZERO; PARTICLES];
    let copy = || {
        to.iter_mut().zip(black_box(&from)).for_each(|(t, p)| *t = (*p).into());
        black_box(&to);
    };
    timing::median_us(copy) / PARTICLES as f64
}

/// The lower quartile: what a machine takes where nothing else wants it, in most of the times.
pub(super) fn quartile(values: &mut [f64]) -> f64 {
    quantile(values, 0.25).unwrap_or(0.0)
}
