//! `toile plan`: predicts memory and time of a scene before it runs.

mod table;

use clap::builder::PossibleValuesParser;
use std::path::PathBuf;
use toile_assets::scene_file::examples;
use toile_cli::arguments::{Printing, WorkersArg, WornArgs};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::heap::counted;
use toile_cli::terminal::{self, Paint};
use toile_engine::cloth::{Cloth, Settings};
use toile_engine::colliders::Colliders;
use toile_engine::meter::CLOTH;
use toile_engine::world::World;
use toile_fitting::dress::measured;
use toile_fitting::dress::session;
use toile_fitting::dress::try_on::{DressedBody, TryOn};
use toile_fitting::heap::HeapProbe;
use toile_fitting::plan::calibrate;
use toile_fitting::plan::cost::Costs;
use toile_fitting::plan::reach::reach;
use toile_fitting::plan::report::{self, GarmentPlan, Held, Memory, Plan};
use toile_fitting::plan::scene::PlannedScene;
use toile_fitting::plan::verdict::{PlanVerdict, Priced, judge};
use toile_fitting::plan::weigh;
use toile_fitting::plan::work::STAGES;

use crate::commands::run::RunScene;

/// The scene that is planned.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanScene {
    /// A scene of `toile run`.
    Run(RunScene),
    /// A shopper of a session, or of the embedded one, dressed.
    Worn(Option<PathBuf>, TryOn),
}

/// What a shopper's scene is made of; a scene file has none of it.
const WORN: [&str; 5] = ["session", "garments", "size", "quality", "measures"];

/// Say what a scene needs, whether it fits into its time, and what each model is worth, before it runs.
///
/// Counts the work of a scene and learns what this machine takes for it: which colliders each part of a garment can ever
/// touch, memory by part, the predicted time of each stage against its budget. Then plays ten seconds of it: how the
/// prediction held, and for each model the error of leaving it out and the time that it takes. A scene that cannot fit is
/// refused with exit code 3 and the cure, before anything is played.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: see whether a shirt and trousers fit at the finest quality\n  toile plan --garment \
                        tee --garment wide-leg-trousers --quality fine")]
pub struct PlanArgs {
    /// Scene file of `toile run` (default: the shopper of the embedded session, dressed)
    #[arg(value_name = "SCENE.toml", conflicts_with_all = WORN)]
    scene: Option<PathBuf>,
    /// A scene file that comes with the program
    #[arg(
        long,
        value_name = "NAME",
        value_parser = PossibleValuesParser::new(examples::names()),
        conflicts_with = "scene",
        conflicts_with_all = WORN
    )]
    example: Option<String>,
    /// Recording that the shopper comes from (default: the embedded session)
    #[arg(long, value_name = "F")]
    session: Option<PathBuf>,
    #[command(flatten)]
    worn: WornArgs,
    #[command(flatten)]
    workers: WorkersArg,
    /// Play nothing: no measured error, no models weighed
    #[arg(long)]
    pub quick: bool,
    /// List what this machine takes for each unit of work
    #[arg(long)]
    pub costs: bool,
    #[command(flatten)]
    printing: Printing,
}

impl PlanArgs {
    /// The scene that the arguments name.
    ///
    /// # Errors
    /// TapeReadings measures that are none.
    pub fn scene(&self) -> Result<PlanScene, AppError> {
        Ok(match RunScene::of(self.scene.as_ref(), self.example.as_ref()) {
            Some(scene) => PlanScene::Run(scene),
            None => PlanScene::Worn(self.session.clone(), self.worn.request()?),
        })
    }
}

/// Runs `toile plan`.
///
/// # Errors
/// A scene that cannot be read or made, and [`AppError::Threshold`] for one that does not fit into its period.
pub fn run(args: &PlanArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let workers = args.workers.count();
    let (scene, costs, memory) = match &args.scene()? {
        PlanScene::Run(scene) => file(scene, workers)?,
        PlanScene::Worn(session, request) => worn(session.as_deref(), request, workers)?,
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
        words.print_line("playing it, with each model and without");
        let played = weigh::play(&scene, workers).map_err(AppError::internal)?;
        let one_core = priced.times.iter().map(|t| t.one_us).sum();
        plan.held = Some(Held::of(priced.stages_us[CLOTH], one_core, &played));
        plan.played = Some(played);
    }
    let refused = (!plan.verdict.fits).then(|| AppError::Threshold(refusal(&plan.scene, &plan.verdict)));
    if args.printing.json {
        terminal::print_json(&Document::new("plan", plan))?;
    } else {
        terminal::print(&table::table(&plan, args.costs, Paint::for_stdout()))?;
    }
    refused.map_or(Ok(()), Err)
}

/// Why a scene is refused, and the cure.
fn refusal(scene: &str, verdict: &PlanVerdict) -> String {
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

/// Plans a scene file.
fn file(scene: &RunScene, workers: usize) -> Result<(PlannedScene, Costs, Vec<Memory>), AppError> {
    let scene = PlannedScene::file(scene.read()?).map_err(AppError::input)?;
    let costs = calibrate::measure(None, workers).map_err(AppError::internal)?;
    let mut memory = vec![part("colliders", size_of::<Colliders>())];
    memory.extend(cloth_memory(&scene));
    Ok((scene, costs, memory))
}

/// Plans a dressed shopper.
fn worn(
    session: Option<&std::path::Path>,
    request: &TryOn,
    workers: usize,
) -> Result<(PlannedScene, Costs, Vec<Memory>), AppError> {
    let mut session = session::open(session, None)?;
    let measured = measured::measure(&session, request.facts())?;
    measured::add_joints(&mut session, &measured)?;
    let track = session::standing(&session)?;
    let request = request.sized_for(&session.name, &measured)?;
    let probe = HeapProbe::new(counted);
    let before = probe.read();
    let dressed = request.dress()?;
    let made = probe.read();
    let baked: usize = dressed.garments.iter().map(toile_base::garment::Garment::bytes).sum();
    let body = before.zip(made).map_or(0, |(a, b)| (b.live_bytes - a.live_bytes - baked as i64).max(0));
    let costs = calibrate::measure(Some((&dressed.body, &dressed.rig, &track)), workers).map_err(AppError::internal)?;
    let world = world_bytes(&dressed, &request, &probe)?;
    let DressedBody { body: shape, rig, garments, .. } = dressed;
    let settings = Settings { workers: 1, ..request.settings() };
    let mut scene = PlannedScene::worn(&shape, &rig, garments, settings, &track).map_err(AppError::input)?;
    scene.name = request.words();
    let mut memory = vec![part("body", body as usize)];
    memory.extend(cloth_memory(&scene));
    memory.push(part("frame: skin, colliders, meters, three snapshots", world));
    Ok((scene, costs, memory))
}

/// Memory of a world beside the states of its garments (bytes), counted while one is built.
fn world_bytes(dressed: &DressedBody, request: &TryOn, probe: &HeapProbe) -> Result<usize, AppError> {
    let settings = Settings { workers: 1, ..request.settings() };
    let DressedBody { body, rig, garments, .. } = dressed.clone();
    let dressed = DressedBody::new(rig, body, garments);
    let before = probe.read();
    let made = dressed.build(settings).map_err(AppError::input)?;
    let after = probe.read();
    let cloths: usize = made.0.cloths().iter().map(Cloth::bytes).sum();
    // Body and garments were there before and are the world's now.
    let grown = before.zip(after).map_or(0, |(a, b)| b.live_bytes - a.live_bytes);
    Ok((grown - cloths as i64).max(0) as usize + size_of::<World>())
}

fn part(name: &str, bytes: usize) -> Memory {
    Memory { part: name.to_owned(), bytes: bytes as u64 }
}

fn cloth_memory(scene: &PlannedScene) -> Vec<Memory> {
    let both = scene.garments.iter().zip(scene.cloths());
    let rows = both.flat_map(|(garment, cloth)| {
        [
            part(&format!("{}: baked, shared", garment.name), garment.bytes()),
            part(&format!("{}: state", garment.name), cloth.bytes()),
        ]
    });
    rows.collect()
}

fn garments(scene: &PlannedScene, priced: &Priced) -> Vec<GarmentPlan> {
    let all = scene.garments.iter().zip(&priced.first).zip(&priced.times);
    let plan = all.map(|((garment, first), time)| GarmentPlan {
        name: garment.name.clone(),
        size: garment.size.clone(),
        fabric: garment.fabric.name.clone(),
        particles: garment.particles(),
        free: garment.inverse_mass.iter().filter(|w| **w > 0.0).count(),
        spacing_mm: toile_fitting::plan::scene::spacing_mm(garment),
        substeps: first.substeps,
        near: first.near as u64,
        us: [time.one_us, time.two_us],
        stages_us: STAGES.into_iter().zip(time.stages_us).collect(),
    });
    plan.collect()
}
