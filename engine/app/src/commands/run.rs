//! `toile run`: any scene of the user's own, headless.

mod dump;

use clap::builder::PossibleValuesParser;
use clap::value_parser;
use std::path::{Path, PathBuf};
use toile_assets::scene_file::examples;
use toile_assets::scene_file::{SceneError, SceneFile};
use toile_engine::cloth::Cloth;
use toile_engine::cloth::step::program::METERED_STAGES;
use toile_fitting::heap::HeapProbe;
use toile_fitting::scene::Runner;
use toile_fitting::scene::contact::ContactReport;
use toile_fitting::scene::events::ClothEvents;
use toile_fitting::scene::reference_time;

use crate::commands::crossings::CrossingCount;
use crate::report::{self, CrossingReport, RunGarment, RunReport};
use crate::summary;
use dump::{Dump, Format};
use toile_cli::arguments::{Printing, one_of};
use toile_cli::document::{Document, hash_text};
use toile_cli::exit::AppError;
use toile_cli::heap::counted;
use toile_cli::output::Inputs;
use toile_cli::output::OutputFolder;
use toile_cli::terminal::{self, Paint, Words};

/// Most steps that `run` takes: ten days at 120 Hz.
const MAX_RUN_STEPS: u64 = 100_000_000;

/// Where the scene of `toile run` comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum RunScene {
    /// A scene file, by its path.
    File(PathBuf),
    /// A scene inside the program.
    Example(String),
}

impl RunScene {
    /// Reads the scene.
    ///
    /// # Errors
    /// [`AppError::Input`] for a scene that cannot be used.
    pub fn read(&self) -> Result<SceneFile, AppError> {
        let scene = match self {
            Self::File(path) => SceneFile::read(path),
            Self::Example(name) => SceneFile::example(name),
        };
        scene.map_err(|error| match error {
            SceneError::Read { .. } => AppError::input(format!("{error}, or `--example NAME`")),
            error => AppError::input(error),
        })
    }

    /// The scene that these arguments name, if they name one.
    pub fn of(file: Option<&PathBuf>, example: Option<&String>) -> Option<Self> {
        file.cloned().map(Self::File).or_else(|| example.cloned().map(Self::Example))
    }
}

/// Run any scene of your own: meshes, pins, fabric, colliders and their motion.
///
/// Runs a scene file without pictures: garments from OBJ, glTF or built-in meshes, pins, fabrics, spheres, capsules and
/// planes with their motion from CSV, gravity, wind and settings. It reports time and strain together, and writes positions
/// for your own tools. docs/scene.md describes the file.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: let a cloth fall on a ball, and write where it is 30 times a second\n  toile run --example \
                        cloth-on-sphere --dump positions --every 4"
)]
pub struct RunArgs {
    /// Scene file
    #[arg(value_name = "SCENE.toml", required_unless_present = "example", conflicts_with = "example")]
    scene: Option<PathBuf>,
    /// Run a scene that comes with the program
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(examples::names()))]
    example: Option<String>,
    /// Steps to run (default: the scene's duration)
    #[arg(long, value_name = "N", value_parser = value_parser!(u64).range(1..=MAX_RUN_STEPS))]
    pub frames: Option<u64>,
    /// Folder for the positions of every vertex; it is made if missing
    #[arg(long, value_name = "DIR")]
    pub dump: Option<PathBuf>,
    /// How positions are written: csv or ply, a file a frame; glb, usd, mdd or pc2, all frames in one (docs/export.md)
    #[arg(
        long = "dump-format",
        value_name = "F",
        value_parser = one_of(Format::ALL, Format::ending),
        default_value = Format::Csv.ending()
    )]
    pub format: Format,
    /// Write positions every K steps
    #[arg(long, value_name = "K", value_parser = value_parser!(u64).range(1..=MAX_RUN_STEPS), default_value = "1")]
    pub every: u64,
    #[command(flatten)]
    printing: Printing,
}

impl RunArgs {
    /// The scene.
    ///
    /// # Errors
    /// None that the command line lets through.
    pub fn scene(&self) -> Result<RunScene, AppError> {
        let scene = RunScene::of(self.scene.as_ref(), self.example.as_ref());
        scene.ok_or_else(|| AppError::Usage("no scene is given; see `toile run --help`".to_owned()))
    }

    /// The scene's file and all files that it names, which must not be overwritten.
    pub fn inputs(&self) -> Inputs {
        let Some(scene) = &self.scene else { return Inputs::default() };
        let folder = scene.parent().unwrap_or(Path::new(""));
        let text = std::fs::read_to_string(scene).unwrap_or_default();
        let mut files = vec![scene.clone()];
        if let Ok(table) = text.parse::<toml::Table>() {
            strings(&toml::Value::Table(table), &mut |text| files.push(folder.join(text)));
        }
        Inputs::new(files)
    }
}

/// Visits every string of a TOML value.
fn strings(value: &toml::Value, visit: &mut impl FnMut(&str)) {
    match value {
        toml::Value::String(text) => visit(text),
        toml::Value::Array(values) => values.iter().for_each(|value| strings(value, visit)),
        toml::Value::Table(table) => table.values().for_each(|value| strings(value, visit)),
        _ => {}
    }
}

/// Most files that one dump writes: beyond it a folder is slow to list, and the disk fills unnoticed.
const MAX_FILES: u64 = 1_000_000;

/// Runs `toile run`.
///
/// # Errors
/// A scene that cannot be used, a folder that cannot be written, or a closed stdout.
pub fn run(args: &RunArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let mut scene = args.scene()?.read()?;
    if let Some(frames) = args.frames {
        shorten(&mut scene, frames)?;
    }
    let mut dump = None;
    if let Some(folder) = &args.dump {
        let files = (scene.steps() / args.every + 1) * scene.garments.len() as u64;
        if files > MAX_FILES && !args.format.is_one_file() {
            let cure = "give a larger --every or fewer --frames";
            return Err(AppError::Usage(format!("--dump would write {files} files, more than {MAX_FILES}; {cure}")));
        }
        let folder = OutputFolder::prepare(folder)
            .map_err(|e| AppError::Input(e.to_string().replace("--out", "--dump")))?
            .sparing(args.inputs());
        dump = Some(Dump::new(folder, args.format, args.every));
    }
    let mut runner = Runner::counting(scene, HeapProbe::new(counted)).map_err(AppError::input)?;
    dump.iter_mut().try_for_each(|dump| dump.begin(&runner))?;
    let crossings = play(&mut runner, &words, dump.as_mut())?;
    let dumped = dump.as_ref().map_or(0, Dump::frames);
    dump.map_or(Ok(()), Dump::finish)?;
    let yardstick_us =
        if args.printing.json { Some(reference_time::measure().map_err(AppError::internal)?) } else { None };
    let report = RunReport { crossings, ..report(&runner, args, dumped, yardstick_us) };
    if args.printing.json {
        return terminal::print_json(&Document::new("run", report));
    }
    terminal::print(&summary::run(&report, Paint::for_stdout()))
}

/// Makes a scene as long as the command line asks for.
fn shorten(scene: &mut SceneFile, frames: u64) -> Result<(), AppError> {
    scene.duration = frames as f64 / scene.step_hz;
    if scene.measure_from >= scene.duration {
        let from = scene.measure_from;
        return Err(AppError::Usage(format!(
            "--frames {frames} ends at {} s, before the scene's measure_from = {from}; give more frames or an earlier time",
            scene.duration
        )));
    }
    Ok(())
}

fn play(runner: &mut Runner, words: &Words, mut dump: Option<&mut Dump>) -> Result<Option<CrossingReport>, AppError> {
    let steps = runner.scene().steps();
    let bar = words.bar(steps, "running");
    let seconds = runner.scene().step_hz.recip();
    let mut crossings = runner.layers().is_some().then(|| CrossingCount::new(runner.garments(), seconds));
    for step in 0..=steps {
        if step > 0 {
            runner.step();
            bar.inc(1);
        }
        if let Some(crossings) = &mut crossings {
            crossings.after(step, runner.cloths());
        }
        if let Some(dump) = dump.as_deref_mut() {
            dump.add(runner)?;
        }
    }
    bar.finish_and_clear();
    Ok(crossings.map(|c| c.report()))
}

fn report(runner: &Runner, args: &RunArgs, dumped: u64, yardstick_us: Option<f64>) -> RunReport {
    let (scene, figures) = (runner.scene(), runner.figures());
    // Quality and lanes are the same for every garment.
    let settings = runner.settings().first().copied().unwrap_or_default();
    let garments = scene.garments.iter().zip(runner.garments()).map(|(given, baked)| RunGarment {
        name: given.name.clone(),
        vertices: given.mesh.start.len(),
        particles: baked.particles(),
        pinned: baked.fixed.len(),
        fabric: given.fabric.name.clone(),
        mass_kg: given.mass_kg,
    });
    RunReport {
        scene: scene.name.clone(),
        garments: garments.collect(),
        spheres: scene.colliders.spheres(),
        capsules: scene.colliders.capsules.len(),
        planes: scene.colliders.planes.len(),
        hz: scene.step_hz,
        steps: runner.steps(),
        seconds: runner.time(),
        measured_steps: figures.steps,
        quality: settings.quality.name(),
        substeps: runner.cloths().iter().map(Cloth::substeps).max().unwrap_or_default(),
        lanes: settings.width.lanes(),
        step_us: figures.step_us,
        stages_us: METERED_STAGES.into_iter().zip(figures.stages_us).collect(),
        yardstick_us,
        allocations_per_step: figures.allocations_per_step,
        memory_bytes: figures.memory_bytes.map(|bytes| bytes.iter().sum()),
        strain: report::StrainReport { mean: figures.strain_mean, p99: figures.strain_p99, max: figures.strain_max },
        penetration_mm: report::RunPenetration { max: figures.penetration_mm, fraction: figures.penetration_fraction },
        kinetic_energy_j: report::KineticEnergy { end: figures.kinetic_j, max: figures.kinetic_max_j },
        nonfinite: figures.nonfinite,
        events: runner.cloths().iter().map(|cloth| ClothEvents::from(cloth.events)).sum(),
        crossings: None,
        contact: runner.layers().map(|l| ContactReport::from(l.counts())),
        warnings: runner.warnings(),
        state_hash: hash_text(runner.state_hash()),
        dump: args.dump.clone(),
        dumped_frames: dumped,
    }
}
