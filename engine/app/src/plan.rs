//! `toile plan`: what a scene needs and takes, before it runs.

mod table;

use toile_assets::scene_file::SceneFile;
use toile_engine::cloth::Cloth;
use toile_engine::colliders::Colliders;
use toile_engine::frame::Frame;
use toile_engine::meter::CLOTH;
use toile_fitting::dress::measured::{self, Told};
use toile_fitting::dress::recipe::{Parts, Recipe};
use toile_fitting::dress::session;
use toile_fitting::dress::wish::Wish;
use toile_fitting::heap::HeapProbe;
use toile_fitting::plan::calibrate;
use toile_fitting::plan::cost::Costs;
use toile_fitting::plan::reach::reach;
use toile_fitting::plan::report::{self, GarmentPlan, Held, Memory, Plan};
use toile_fitting::plan::scene::Scene;
use toile_fitting::plan::verdict::{Priced, Verdict, judge};
use toile_fitting::plan::weigh;
use toile_fitting::plan::work::STAGES;

use crate::cli::{PlanArgs, PlanScene, RunScene};
use crate::exit::AppError;
use crate::heap::counted;
use crate::report::Document;
use crate::terminal::{self, Paint, Words};

/// Runs `toile plan`.
///
/// # Errors
/// A scene that cannot be read or made, and [`AppError::Threshold`] for one that does not fit into its period.
pub fn run(args: &PlanArgs) -> Result<(), AppError> {
    let words = Words::new(args.quiet || args.json);
    let workers = args.workers.count();
    let (scene, costs, memory) = match &args.scene() {
        PlanScene::Run(scene) => file(scene, workers)?,
        PlanScene::Worn(session, wish) => worn(session.as_deref(), wish, workers)?,
    };
    let priced = Priced::of(&scene, &costs, workers);
    let verdict = judge(&scene, &priced, &costs, workers);
    let mut plan = Plan {
        scene: scene.name.clone(),
        quality: scene.settings[0].quality.name(),
        workers,
        lanes: scene.settings[0].width.lanes(),
        period_us: scene.period_us,
        garments: garments(&scene, &priced),
        reach: reach(&scene),
        memory,
        stages: report::stages(&priced.stages_us, scene.period_us),
        verdict,
        units: report::units(&costs),
        held: None,
        played: None,
    };
    if plan.verdict.fits && !args.quick {
        words.say("playing it, with each model and without");
        let played = weigh::play(&scene, workers).map_err(AppError::internal)?;
        let one_core = priced.times.iter().map(|t| t.one_us).sum();
        plan.held = Some(Held::of(priced.stages_us[CLOTH], one_core, &played));
        plan.played = Some(played);
    }
    let refused = (!plan.verdict.fits).then(|| AppError::Threshold(refusal(&plan.scene, &plan.verdict)));
    if args.json {
        terminal::print_json(&Document::new("plan", plan))?;
    } else {
        terminal::print(&table::table(&plan, args.costs, Paint::for_stdout()))?;
    }
    refused.map_or(Ok(()), Err)
}

/// Why a scene is refused, and the cure.
fn refusal(scene: &str, verdict: &Verdict) -> String {
    let cure = match &verdict.cures[..] {
        [] => "no one change brings it within; take a coarser mesh and fewer garments".to_owned(),
        cures => cures.join(", or "),
    };
    format!(
        "{scene} cannot fit: a step is predicted to take {:.1} ms of the {:.2} ms that there are; {cure}",
        verdict.step_us * 1e-3,
        verdict.period_us * 1e-3
    )
}

/// A scene file.
fn file(scene: &RunScene, workers: usize) -> Result<(Scene, Costs, Vec<Memory>), AppError> {
    let file = match scene {
        RunScene::File(path) => SceneFile::read(path),
        RunScene::Example(name) => SceneFile::example(name),
    };
    let scene = Scene::file(file.map_err(AppError::input)?).map_err(AppError::input)?;
    let costs = calibrate::measure(None, workers).map_err(AppError::internal)?;
    let mut memory = vec![part("colliders", size_of::<Colliders>())];
    memory.extend(cloth_memory(&scene));
    Ok((scene, costs, memory))
}

/// A shopper, dressed.
fn worn(
    session: Option<&std::path::Path>,
    wish: &Wish,
    workers: usize,
) -> Result<(Scene, Costs, Vec<Memory>), AppError> {
    let mut session = session::open(session, None)?;
    let measured = measured::measure(&session, Told { sex: wish.sex, ..Told::default() })?;
    measured::add_joints(&mut session, &measured)?;
    let track = session::standing(&session)?;
    let recipe = Recipe::choose(&session.name, &measured, wish)?;
    let probe = HeapProbe::new(counted);
    let before = probe.read();
    let parts = recipe.parts()?;
    let made = probe.read();
    let baked: usize = parts.garments.iter().map(toile_assets::garment::Garment::bytes).sum();
    let body = before.zip(made).map_or(0, |(a, b)| (b.live_bytes - a.live_bytes - baked as i64).max(0));
    let costs = calibrate::measure(Some((&parts.body, &parts.rig, &track)), workers).map_err(AppError::internal)?;
    let frame = frame_bytes(&parts, &probe)?;
    let Parts { body: shape, rig, garments, settings } = parts;
    let mut scene = Scene::worn(&shape, &rig, garments, settings, &track).map_err(AppError::input)?;
    scene.name = recipe.words();
    let mut memory = vec![part("body", body as usize)];
    memory.extend(cloth_memory(&scene));
    memory.push(part("frame: skin, colliders, meters, three snapshots", frame));
    Ok((scene, costs, memory))
}

/// What a frame holds beside the states of its garments (bytes), counted while one is made.
fn frame_bytes(parts: &Parts, probe: &HeapProbe) -> Result<usize, AppError> {
    let Parts { body, rig, garments, settings } = parts.clone();
    let before = probe.read();
    let made = Frame::new(body, &rig, garments, settings).map_err(AppError::input)?;
    let after = probe.read();
    let cloths: usize = made.0.cloths().iter().map(Cloth::bytes).sum();
    // Body and garments were there before and are the frame's now.
    let grown = before.zip(after).map_or(0, |(a, b)| b.live_bytes - a.live_bytes);
    Ok((grown - cloths as i64).max(0) as usize + size_of::<Frame>())
}

fn part(name: &str, bytes: usize) -> Memory {
    Memory { part: name.to_owned(), bytes: bytes as u64 }
}

fn cloth_memory(scene: &Scene) -> Vec<Memory> {
    let both = scene.garments.iter().zip(scene.cloths());
    let rows = both.flat_map(|(garment, cloth)| {
        [
            part(&format!("{}: baked, shared", garment.name), garment.bytes()),
            part(&format!("{}: state", garment.name), cloth.bytes()),
        ]
    });
    rows.collect()
}

fn garments(scene: &Scene, priced: &Priced) -> Vec<GarmentPlan> {
    let all = scene.garments.iter().zip(&priced.first).zip(&priced.times);
    let plan = all.map(|((garment, first), time)| GarmentPlan {
        name: garment.name.clone(),
        size: garment.size.clone(),
        fabric: garment.fabric.name.clone(),
        particles: garment.particles(),
        free: garment.inverse_mass.iter().filter(|w| **w > 0.0).count(),
        spacing_mm: report::spacing_mm(garment),
        substeps: first.substeps,
        near: first.near as u64,
        us: [time.one_us, time.two_us],
        stages_us: STAGES.into_iter().zip(time.stages_us).collect(),
    });
    plan.collect()
}
