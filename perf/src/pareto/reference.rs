//! x*: the oracle's equilibrium, or what a moment of a run becomes with very many substeps.

use glam::DVec3;
use toile_base::garment::Garment;
use toile_engine::cloth::Quality;

use super::error::ParetoError;
use super::meshed_scene::{MeshedScene, ReferenceKind, SolverChoice};
use super::play::{Setting, Trace, WINDOW, WindowStart, play, play_through, play_windows};
use crate::oracle::{Oracle, Problem, Solids};

/// Substeps of the reference: beyond them a substep's motion comes near to the resolution of f32 at a metre.
pub const SUBSTEPS: u32 = 128;

/// The same for a quick look.
const QUICK_SUBSTEPS: u32 = 64;

/// x* of one scene in one mesh.
pub struct Reference {
    /// Positions by vertex (m) of the frames that are compared, the last ones of a run `[frames][vertices]`.
    frames: Vec<Vec<DVec3>>,
    /// Vertices that can move.
    free: Vec<usize>,
    /// What the reference solution is, in words for the page.
    pub words: String,
    /// How far it may be off (mm).
    pub gap_mm: f64,
    /// The moments that are gone on from, where it is no equilibrium.
    moments: Vec<WindowStart>,
    /// The run that they are of.
    pub run: Option<Trace>,
}

impl Reference {
    /// Finds the reference solution x*; `quick` takes fewer substeps.
    pub fn of(subject: &MeshedScene, quick: bool) -> Result<Self, ParetoError> {
        match subject.truth {
            ReferenceKind::Equilibrium => equilibrium(subject),
            ReferenceKind::Trajectory => trajectory(subject, if quick { QUICK_SUBSTEPS } else { SUBSTEPS }),
        }
    }

    /// Runs a setting as x* asks for.
    pub fn play(&self, subject: &MeshedScene, garment: &Garment, setting: Setting) -> Result<Trace, ParetoError> {
        match subject.truth {
            ReferenceKind::Equilibrium => play(subject, garment, setting),
            ReferenceKind::Trajectory => play_windows(subject, garment, setting, &self.moments),
        }
    }

    /// Mean and largest distance of a run to it (mm).
    pub fn error_mm(&self, run: &Trace) -> [f64; 2] {
        let last = run.frames.len().saturating_sub(self.frames.len());
        let (mut sum, mut most, mut count) = (0.0, 0.0f64, 0usize);
        for (x, star) in run.frames[last..].iter().zip(&self.frames) {
            for &v in &self.free {
                let d = x[v].distance(star[v]);
                (sum, most, count) = (sum + d, most.max(d), count + 1);
            }
        }
        [1e3 * sum / count.max(1) as f64, 1e3 * most]
    }
}

fn free(subject: &MeshedScene) -> Vec<usize> {
    (0..subject.shape.fixed.len()).filter(|&v| !subject.shape.fixed[v]).collect()
}

fn equilibrium(subject: &MeshedScene) -> Result<Reference, ParetoError> {
    let garment = subject.bake(SolverChoice::Mixed)?;
    let problem = Problem::of(&garment);
    let start = problem.start.clone();
    let solved = Oracle::new(problem)?.equilibrium(&start, &Solids::default())?;
    let words =
        format!("the oracle's equilibrium (Newton in f64, {:.1e} N left on any particle)", solved.report.residual_n);
    let frames = vec![MeshedScene::by_vertex(&garment, |p| solved.state.x[p])];
    let longest = frames[0].iter().map(|x| x.length()).fold(0.0, f64::max);
    let gap_mm = 1e3 * solved.report.violation.strain.abs() * longest;
    Ok(Reference { frames, free: free(subject), words, gap_mm, moments: Vec::new(), run: None })
}

fn trajectory(subject: &MeshedScene, substeps: u32) -> Result<Reference, ParetoError> {
    let garment = subject.bake(SolverChoice::Mixed)?;
    let of = |substeps| Setting { quality: Quality::Fine, substeps: Some(substeps), threads: 1 };
    let (run, moments) = play_through(subject, &garment, of(substeps / 8))?;
    let star = play_windows(subject, &garment, of(substeps), &moments)?;
    let half = play_windows(subject, &garment, of(substeps / 2), &moments)?;
    let words = format!(
        "what {} moments of one run become in {WINDOW} steps of {substeps} substeps of fine, from which each setting \
         goes on as well",
        moments.len()
    );
    let mut reference =
        Reference { frames: star.frames, free: free(subject), words, gap_mm: 0.0, moments, run: Some(run) };
    reference.gap_mm = reference.error_mm(&half)[0];
    Ok(reference)
}
