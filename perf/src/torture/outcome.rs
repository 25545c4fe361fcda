//! What a trial found, and whether that is good enough.

use glam::Vec3;
use serde::Serialize;

use super::crossed::CrossedEdges;
use super::error::TortureError;
use super::piece;
use super::trial::{self, BACK_M, RECOVER_S, Trial, TrialFigures, TrialRecovery};
use crate::backend::SteppedBy;

/// What the rounding of a speed may add to its limit (1).
const SPEED_SLACK: f32 = 1e-3;

/// What a trial found.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TrialFindings {
    /// What was seen of the cloth.
    pub seen: TrialFigures,
    /// The speed that no free particle may exceed (m/s); none where there was no cloth.
    pub limit: Option<f32>,
    /// How it came back, where there is one place to come back to.
    pub recovery: Option<TrialRecovery>,
    /// Edges that pass through faces at the end, where they are counted.
    pub crossings: Option<u64>,
    /// What else was to be met and was not.
    pub miss: Option<String>,
    /// Whether it is at rest in a fold that stays, a minimum of the energy.
    pub folded: bool,
    /// Figures of the case's own.
    pub note: String,
}

impl TrialFindings {
    /// What a trial saw that has no one place to come back to.
    pub fn of(trial: &Trial<'_>) -> Self {
        Self { seen: trial.seen, limit: Some(trial.settings.max_speed), ..Self::default() }
    }

    /// Lets a trial come to rest and compares.
    pub fn back(mut trial: Trial<'_>, rest: &[Vec3]) -> Self {
        let recovery = trial.recover(rest);
        let mut found = Self { recovery: Some(recovery), crossings: trial.crossings(), ..Self::of(&trial) };
        if recovery.after_s.is_none() && trial.crossings().is_none() {
            found.note = match off_equilibrium(&trial) {
                Ok(off) if off <= BACK_M => {
                    found.folded = true;
                    "in a fold that stays".into()
                }
                Ok(off) => format!("in a fold {:.1} mm from one that stays", off * 1e3),
                Err(error) => error.to_string(),
            };
        }
        found
    }

    /// The same for what may have other places of rest: one that the oracle finds downhill from where the cloth ended,
    /// and stable, is as good.
    pub fn back_anywhere(mut trial: Trial<'_>, rest: &[Vec3]) -> Self {
        let recovery = trial.recover(rest);
        let mut found = Self { recovery: Some(recovery), crossings: trial.crossings(), ..Self::of(&trial) };
        if recovery.after_s.is_none() {
            match off_equilibrium(&trial) {
                Ok(off) => {
                    let after_s = (off <= BACK_M).then_some(RECOVER_S);
                    found.recovery = Some(TrialRecovery { after_s, hausdorff_m: off });
                    found.note = format!("folds; {:.1} mm from lying flat", recovery.hausdorff_m * 1e3);
                }
                Err(error) => found.note = error.to_string(),
            }
        }
        found
    }

    /// The same with what was seen of crossings, of which there must be none after so long (s).
    pub fn uncrossed(self, crossed: &CrossedEdges, within_s: f32, step_seconds: f32) -> Self {
        let free_s = crossed.free_after_s(step_seconds);
        let late = free_s.filter(|s| *s > within_s);
        Self {
            crossings: Some(crossed.now),
            note: format!(
                "at most {} edges through faces{}",
                crossed.most,
                match free_s {
                    Some(s) => format!(", none after {s:.2} s"),
                    None => String::new(),
                }
            ),
            miss: late.map(|s| format!("edges passed through faces for {s:.2} s")).or(self.miss),
            ..self
        }
    }

    /// The first thing that is not as it has to be.
    fn cause(&self) -> Option<String> {
        let TrialFigures { nonfinite, max_speed, .. } = self.seen;
        if nonfinite > 0 {
            return Some(format!("{nonfinite} positions or velocities that are not finite"));
        }
        if self.limit.is_some_and(|limit| max_speed > limit * (1.0 + SPEED_SLACK)) {
            return Some(format!("{max_speed:.1} m/s, over the limit"));
        }
        if let Some(crossings) = self.crossings.filter(|&count| count > 0) {
            return Some(format!("{crossings} edges pass through faces at the end"));
        }
        if let Some(recovery) = self.recovery.filter(|r| r.after_s.is_none()) {
            let mm = recovery.hausdorff_m * 1e3;
            return Some(if recovery.hausdorff_m > BACK_M {
                format!("{mm:.2} mm from its place after {RECOVER_S} s")
            } else {
                format!("it does not stay within {} mm, {mm:.2} mm at the end", BACK_M * 1e3)
            });
        }
        self.miss.clone()
    }
}

/// How far a cloth is from the equilibrium that the oracle finds downhill from where it is (m).
fn off_equilibrium(trial: &Trial<'_>) -> Result<f64, TortureError> {
    let end: Vec<Vec3> = trial.cloth.positions.iter().map(|p| Vec3::from(*p)).collect();
    let near = piece::equilibrium(trial.garment, &trial.settings, &end)?;
    Ok(trial::hausdorff(&trial.cloth.positions, &near))
}

/// One seed of one case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SeedOutcome {
    /// Name of the case.
    pub name: &'static str,
    /// Seed of the trial.
    pub seed: u64,
    /// Positions and velocities published that were not finite, summed over the steps.
    pub nonfinite: u64,
    /// Greatest speed of a free particle (m/s).
    pub max_speed: f32,
    /// Longest way of a free particle in a step, over the step (m/s): contact pushes without giving speed.
    pub max_way: f32,
    /// The speed limit that the engine was given (m/s), where there was a cloth.
    pub speed_limit: Option<f32>,
    /// Time after which it stayed within 1 mm of its place of rest (s); none where it did not, or has more than one.
    pub recovered_s: Option<f32>,
    /// Hausdorff distance to its place of rest after 5 s (mm); none where there is more than one such place.
    pub hausdorff_mm: Option<f64>,
    /// Edges that pass through faces at the end, where they are counted.
    pub crossings: Option<u64>,
    /// Substeps that the oracle did not solve as exactly as asked for, where it stepped.
    pub unsolved: u64,
    /// Whether it is at rest in a fold that stays: a minimum of the energy, from which no exact solver leads away.
    pub folded: bool,
    /// Whether all was as it has to be.
    pub pass: bool,
    /// What was not as it has to be; none where all was.
    pub cause: Option<String>,
    /// Figures of the case's own.
    pub note: String,
}

impl SeedOutcome {
    /// The verdict on what a trial found.
    pub(super) fn of(name: &'static str, seed: u64, found: TrialFindings) -> Self {
        let cause = found.cause();
        Self {
            name,
            seed,
            nonfinite: found.seen.nonfinite,
            max_speed: found.seen.max_speed,
            max_way: found.seen.max_way,
            speed_limit: found.limit,
            recovered_s: found.recovery.and_then(|r| r.after_s),
            hausdorff_mm: found.recovery.map(|r| r.hausdorff_m * 1e3),
            crossings: found.crossings,
            unsolved: found.seen.unsolved,
            folded: found.folded,
            pass: cause.is_none(),
            cause,
            note: found.note,
        }
    }
}

impl SeedOutcome {
    /// What was wrong and what was done, or the case's own figures.
    fn text(&self) -> String {
        match &self.cause {
            Some(cause) if self.note.is_empty() || *cause == self.note => cause.clone(),
            Some(cause) => format!("{cause} ({})", self.note),
            None => self.note.clone(),
        }
    }
}

/// All seeds of one case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseSummary {
    /// Name of the case.
    pub name: &'static str,
    /// What is done to the cloth.
    pub about: &'static str,
    /// Number of seeds that were run.
    pub seeds: usize,
    /// Seeds in which all was as it has to be.
    pub passed: usize,
    /// Seeds that ended in a fold that stays.
    pub folded: usize,
    /// Positions and velocities published that were not finite.
    pub nonfinite: u64,
    /// Greatest speed of a free particle (m/s).
    pub max_speed: f32,
    /// Longest time until it was back (s), of the seeds that came back.
    pub recovered_s: Option<f32>,
    /// Greatest distance to the place of rest (mm).
    pub hausdorff_mm: Option<f64>,
    /// The seed that is worst: one that failed if any has, and of these the farthest from its place.
    pub worst_seed: u64,
    /// What was wrong with it, or what its own figures are.
    pub cause: String,
}

impl CaseSummary {
    /// What the seeds of a case have in common.
    pub(super) fn of(name: &'static str, about: &'static str, outcomes: &[SeedOutcome]) -> Self {
        let far = |o: &&SeedOutcome| (!o.pass, o.hausdorff_mm.unwrap_or(0.0).max(o.crossings.unwrap_or(0) as f64));
        let worst = outcomes.iter().max_by(|a, b| {
            let (a, b) = (far(a), far(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        Self {
            name,
            about,
            seeds: outcomes.len(),
            passed: outcomes.iter().filter(|o| o.pass).count(),
            folded: outcomes.iter().filter(|o| o.folded).count(),
            nonfinite: outcomes.iter().map(|o| o.nonfinite).sum(),
            max_speed: outcomes.iter().map(|o| o.max_speed).fold(0.0, f32::max),
            recovered_s: outcomes.iter().filter_map(|o| o.recovered_s).reduce(f32::max),
            hausdorff_mm: outcomes.iter().filter_map(|o| o.hausdorff_mm).reduce(f64::max),
            worst_seed: worst.map_or(0, |o| o.seed),
            cause: worst.map_or_else(String::new, SeedOutcome::text),
        }
    }
}

/// The body of `toile torture`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct TortureReport {
    /// Name of the quality.
    pub quality: &'static str,
    /// What stepped the cloth.
    pub stepped_by: SteppedBy,
    /// Whether the oracle stepped it, in place of that.
    pub oracle: bool,
    /// How far curtain, lawn, patch and tube are from the oracle's equilibrium when nothing is done to them (mm).
    pub undisturbed_mm: [f64; 4],
    /// One row a case.
    pub summary: Vec<CaseSummary>,
    /// One entry a case and seed, in their order.
    pub cases: Vec<SeedOutcome>,
}

impl TortureReport {
    /// Cases of which any seed failed.
    pub fn failed(&self) -> impl Iterator<Item = &CaseSummary> {
        self.summary.iter().filter(|s| s.passed < s.seeds)
    }
}
