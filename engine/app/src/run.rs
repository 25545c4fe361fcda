//! `toile run`: any scene of the user's own, headless.

use toile_assets::scene_file::SceneFile;
use toile_engine::cloth::Cloth;
use toile_engine::cloth::program::STAGES;
use toile_fitting::heap::HeapProbe;
use toile_fitting::scene::Runner;
use toile_fitting::scene::yardstick;
use toile_perf::skirt::report::Events;

use crate::cli::{RunArgs, RunScene};
use crate::dump::Dump;
use crate::exit::AppError;
use crate::heap::counted;
use crate::output::OutputFolder;
use crate::report::{self, Document, RunGarment, RunReport};
use crate::summary;
use crate::terminal::{self, Paint, Words};

/// Most files that one dump writes: beyond it a folder is slow to list, and the disk fills unnoticed.
const MAX_FILES: u64 = 1_000_000;

/// Runs `toile run`.
///
/// # Errors
/// A scene that cannot be used, a folder that cannot be written, or a closed stdout.
pub fn run(args: &RunArgs) -> Result<(), AppError> {
    let words = Words::new(args.quiet || args.json);
    let scene = match &args.scene()? {
        RunScene::File(path) => SceneFile::read(path),
        RunScene::Example(name) => SceneFile::example(name),
    };
    let mut scene = scene.map_err(AppError::input)?;
    if let Some(frames) = args.frames {
        shorten(&mut scene, frames)?;
    }
    let mut dump = None;
    if let Some(folder) = &args.dump {
        let files = (scene.steps() / args.every + 1) * scene.garments.len() as u64;
        if files > MAX_FILES {
            let cure = "give a larger --every or fewer --frames";
            return Err(AppError::Usage(format!("--dump would write {files} files, more than {MAX_FILES}; {cure}")));
        }
        let folder = OutputFolder::prepare(folder)
            .map_err(|e| AppError::Input(e.to_string().replace("--out", "--dump")))?
            .sparing(args.inputs());
        dump = Some(Dump::new(folder, args.format, args.every));
    }
    let mut runner = Runner::counting(scene, HeapProbe::new(counted)).map_err(AppError::input)?;
    play(&mut runner, &words, dump.as_mut())?;
    let dumped = dump.as_ref().map_or(0, Dump::frames);
    dump.map_or(Ok(()), Dump::finish)?;
    let yardstick_us = if args.json { Some(yardstick::measure().map_err(AppError::internal)?) } else { None };
    let report = report(&runner, args, dumped, yardstick_us);
    if args.json {
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

fn play(runner: &mut Runner, words: &Words, mut dump: Option<&mut Dump>) -> Result<(), AppError> {
    let steps = runner.scene().steps();
    let bar = words.bar(steps, "running");
    for step in 0..=steps {
        if step > 0 {
            runner.step();
            bar.inc(1);
        }
        if let Some(dump) = dump.as_deref_mut() {
            dump.add(runner)?;
        }
    }
    bar.finish_and_clear();
    Ok(())
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
    let times = figures.step_us;
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
        step_us: report::StepMicros { p50: times.p50, p99: times.p99, p999: times.p999, max: times.max },
        stages_us: STAGES.into_iter().zip(figures.stages_us).collect(),
        yardstick_us,
        allocations_per_step: figures.allocations_per_step,
        memory_bytes: figures.memory_bytes.map(|bytes| bytes.iter().sum()),
        strain: report::Strain { mean: figures.strain_mean, p99: figures.strain_p99, max: figures.strain_max },
        penetration_mm: report::RunPenetration { max: figures.penetration_mm, fraction: figures.penetration_fraction },
        kinetic_energy_j: report::KineticEnergy { end: figures.kinetic_j, max: figures.kinetic_max_j },
        nonfinite: figures.nonfinite,
        events: runner.cloths().iter().map(|cloth| Events::from(cloth.events)).sum(),
        state_hash: report::hash_text(runner.state_hash()),
        dump: args.dump.clone(),
        dumped_frames: dumped,
    }
}
