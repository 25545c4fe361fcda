//! All settings of a scene, one after the other.

use toile_base::garment::Garment;
use toile_base::numeric::statistics::median_of;
use toile_engine::cloth::Quality;
use toile_fitting::plan::scene::spacing_mm;

use super::error::ParetoError;
use super::meshed_scene::{MeshedScene, SolverChoice};
use super::play::{Setting, Trace, iterations, play};
use super::reference::Reference;
use super::report::{EnergyRun, Point, SceneReport};

/// Substeps that are tried beside a garment's own.
const SUBSTEPS: [u32; 8] = [1, 2, 4, 6, 8, 12, 16, 32];

/// The same for a quick look.
const QUICK_SUBSTEPS: [u32; 3] = [1, 4, 8];

/// Time of a step from which more substeps are not tried (us): three times what 120 Hz leaves.
const FAR_BEYOND_US: f64 = 25_000.0;

/// Times that every setting is timed, one after the other: a machine has faster and slower minutes.
const ROUNDS: usize = 3;

/// Name of the backend that steps the scenes.
const BACKEND: &str = "cpu";

/// Runs every setting of a scene and holds each against x*.
pub fn sweep(
    subject: &MeshedScene,
    quick: bool,
    progress: &dyn Fn(f64),
) -> Result<(Vec<Point>, SceneReport), ParetoError> {
    let reference = Reference::of(subject, quick)?;
    let (mut points, mut played) = (Vec::new(), Vec::new());
    let mut energy: Vec<EnergyRun> = Vec::new();
    if let Some(run) = &reference.run {
        energy.push(EnergyRun { setting: format!("fine, {} substeps", run.substeps), frames: run.energy.clone() });
    }
    let choices: &[SolverChoice] = match (subject.main, quick) {
        (true, false) => &SolverChoice::ALL,
        (true, true) => &[SolverChoice::Mixed, SolverChoice::GaussSeidel],
        (false, _) => &[SolverChoice::Mixed],
    };
    let garments = choices.iter().map(|choice| subject.bake(*choice)).collect::<Result<Vec<Garment>, _>>()?;
    for (k, (&choice, garment)) in choices.iter().zip(&garments).enumerate() {
        let settings = settings(subject, garment, choice, quick);
        let mut beyond = None;
        for (done, setting) in settings.iter().enumerate() {
            progress((k as f64 + done as f64 / settings.len() as f64) / choices.len() as f64);
            if beyond.is_some_and(|limit: Setting| limit.quality == setting.quality && limit.threads == setting.threads)
            {
                continue;
            }
            let run = reference.play(subject, garment, *setting)?;
            let found = point(subject, garment, choice, *setting, &run, &reference);
            if found.default && subject.main && setting.threads == 1 {
                let run = play(subject, garment, *setting)?;
                energy.push(EnergyRun { setting: found.quality.into(), frames: run.energy });
            }
            if found.step_us > FAR_BEYOND_US {
                beyond = Some(*setting);
            }
            played.push((garment, *setting, vec![found.step_us]));
            points.push(found);
        }
    }
    if !quick {
        time_again(subject, &reference, &mut played)?;
        points.iter_mut().zip(played).for_each(|(point, (.., us))| point.step_us = median_of(us).unwrap_or(0.0));
    }
    let garment = subject.bake(SolverChoice::Mixed)?;
    let scene = SceneReport {
        scene: subject.scene.into(),
        mesh: subject.mesh.clone(),
        particles: garment.particles(),
        spacing_mm: spacing_mm(&garment),
        main: subject.main,
        reference: reference.words.clone(),
        reference_gap_mm: reference.gap_mm,
        energy,
    };
    Ok((points, scene))
}

/// Times all settings again, in as many rounds as are left of [`ROUNDS`].
fn time_again(
    subject: &MeshedScene,
    reference: &Reference,
    played: &mut [(&Garment, Setting, Vec<f64>)],
) -> Result<(), ParetoError> {
    for _ in 1..ROUNDS {
        for (garment, setting, us) in &mut *played {
            us.push(reference.play(subject, garment, *setting)?.step_us);
        }
    }
    Ok(())
}

/// What is tried with one choice of solvers: every quality with the bake's own, on one worker and on two; `shop` with the
/// others; on meshes beside the main one the qualities' own substeps alone.
fn settings(subject: &MeshedScene, garment: &Garment, choice: SolverChoice, quick: bool) -> Vec<Setting> {
    let mixed = choice == SolverChoice::Mixed;
    let qualities = if mixed { &Quality::ALL[..] } else { &[Quality::Shop] };
    let threads = if mixed && subject.main && !quick { &[1, 2][..] } else { &[1] };
    let tried = if quick { &QUICK_SUBSTEPS[..] } else { &SUBSTEPS };
    let mut all = Vec::new();
    for &threads in threads {
        for &quality in qualities {
            let own = quality.substeps(garment.substeps);
            let mut substeps: Vec<u32> = if subject.main { tried.to_vec() } else { Vec::new() };
            substeps.push(own);
            substeps.sort_unstable();
            substeps.dedup();
            all.extend(substeps.into_iter().map(|n| Setting { quality, substeps: Some(n), threads }));
        }
    }
    all
}

fn point(
    subject: &MeshedScene,
    garment: &Garment,
    choice: SolverChoice,
    setting: Setting,
    run: &Trace,
    reference: &Reference,
) -> Point {
    let [error_mm, max_mm] = reference.error_mm(run);
    Point {
        scene: subject.scene.into(),
        mesh: subject.mesh.clone(),
        particles: garment.particles(),
        solver: choice.name(),
        quality: setting.quality.name(),
        substeps: run.substeps,
        iterations: iterations(garment, setting.quality),
        default: choice == SolverChoice::Mixed && run.substeps == setting.quality.substeps(garment.substeps),
        backend: BACKEND,
        threads: setting.threads,
        step_us: run.step_us,
        error_mm,
        max_mm,
        strain_mean: run.strain[0],
        strain_p99: run.strain[1],
        energy_j: run.energy.last().map_or(0.0, |e| e[1]),
        rolled_back: run.rolled_back,
        on_front: false,
    }
}
