//! A case: something with an exact answer, and how it is run at a level; and the rows that come of it.

use serde::Serialize;
use toile_gpu::backend::{Backend, Backends};

use super::specimen::{ParticlePlaces, Specimen, SpecimenError};
use super::{CaseSetup, Level};

/// What one run gave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CaseOutcome {
    /// The figure, in the case's unit.
    pub got: f64,
    /// Median time of a step (us).
    pub step_us: f64,
    /// Substeps of a step.
    pub substeps: u32,
    /// Least share of its bending stiffness that the substep could carry (1).
    pub bend_kept: f32,
    /// Whether what was to come to rest had.
    pub settled: bool,
    /// Steps that the guard rolled back.
    pub rolled_back: u64,
    /// The same figure of the converged f64 solution of the same discretisation, where the oracle has found one.
    pub solved: Option<f64>,
}

impl CaseOutcome {
    /// A figure read off a specimen.
    pub fn of(specimen: &Specimen, got: f64) -> Self {
        Self {
            got,
            step_us: specimen.step_us(),
            substeps: specimen.cloth.substeps(),
            bend_kept: specimen.cloth.bend_pace().least,
            settled: true,
            rolled_back: specimen.cloth.events.rolled_back,
            solved: None,
        }
    }

    /// What is read off a specimen at rest, and off the oracle's equilibrium too in the converged setting.
    pub fn at_rest(specimen: &Specimen, setup: CaseSetup<'_>, read: impl Fn(&ParticlePlaces<'_>) -> f64) -> Self {
        let solved = if setup.level == Level::Converged { specimen.solved().map(|seen| read(&seen)) } else { None };
        Self { solved, ..Self::of(specimen, read(&specimen.seen())) }
    }

    /// A figure that no specimen has given.
    pub fn none(got: f64) -> Self {
        Self { got, step_us: 0.0, substeps: 0, bend_kept: 1.0, settled: true, rolled_back: 0, solved: None }
    }

    /// The same, with whether it had come to rest.
    pub fn settled(self, settled: bool) -> Self {
        Self { settled, ..self }
    }
}

/// How a case is run at a level.
pub type RunCase = Box<dyn Fn(CaseSetup<'_>) -> Result<CaseOutcome, SpecimenError> + Send + Sync>;

/// Something with an exact answer.
pub struct ValidationCase {
    /// Its name; what `toile validate CASE` takes.
    pub name: &'static str,
    /// Which one of the name it is.
    pub parameter: String,
    /// How it is meshed.
    pub mesh: &'static str,
    /// Links along the mesh.
    pub resolution: usize,
    /// Unit of the figures.
    pub unit: &'static str,
    /// The exact value.
    pub expected: f64,
    /// What an error is a part of, where it is not the exact value: of a value of 0 nothing is a part.
    pub scale: Option<f64>,
    /// Largest error (%) at the quality `fine`; none where the row is only reported.
    pub target: Option<f64>,
    /// Runs the case at a level of quality.
    pub run: RunCase,
}

/// One line of the table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ValidationRow {
    /// Name of the case.
    pub name: &'static str,
    /// Which one of it.
    pub parameter: String,
    /// How the engine was set: draft, shop, fine or converged.
    pub quality: &'static str,
    /// How it was meshed.
    pub mesh: &'static str,
    /// Links along the mesh.
    pub resolution: usize,
    /// Substeps of a step.
    pub substeps: u32,
    /// Unit of the next two.
    pub unit: &'static str,
    /// The exact value.
    pub expected: f64,
    /// What the engine gave.
    pub got: f64,
    /// Difference of the two (% of the exact value).
    pub error_percent: f64,
    /// Of that the solver's part: distance from the converged solution of the same mesh (% of the exact value).
    pub solver_error: Option<f64>,
    /// And the mesh's part: distance of that solution from the exact value (%).
    pub model_error: Option<f64>,
    /// Median time of a step (us).
    pub step_us: f64,
    /// Largest error that is accepted (%), where one is.
    pub target: Option<f64>,
    /// Whether it was kept to.
    pub pass: Option<bool>,
    /// Why it was not.
    pub cause: Option<String>,
}

impl ValidationCase {
    /// Runs the case at some levels by some means, and at the converged one, which the others are held against, by the processor;
    /// a row of each that is asked for.
    ///
    /// # Errors
    /// Where the case's own mesh or colliders are refused.
    pub fn rows(&self, levels: &[Level], by: &Backends) -> Result<Vec<ValidationRow>, SpecimenError> {
        let converged = (self.run)(CaseSetup { level: Level::Converged, backends: &Backends::cpu() })?;
        let on_cpu = by.asked() == Backend::Cpu;
        let run = |level: &Level| {
            let known = on_cpu && *level == Level::Converged;
            let found = if known { converged } else { (self.run)(CaseSetup { level: *level, backends: by })? };
            Ok(self.row(*level, &found, &converged))
        };
        levels.iter().map(run).collect()
    }

    fn percent(&self, from: f64, to: f64) -> f64 {
        (from - to) / self.scale.unwrap_or(self.expected).abs() * 100.0
    }

    fn row(&self, level: Level, found: &CaseOutcome, converged: &CaseOutcome) -> ValidationRow {
        let error = self.percent(found.got, self.expected);
        // Without the oracle the converged setting stands for the truth; it cannot be held against itself.
        let stands_in = (level != Level::Converged).then_some(converged.got);
        let truth = converged.solved.or(stands_in);
        let target = self.target.filter(|_| level == Level::GATED);
        let pass = target.map(|most| error.abs() <= most && found.rolled_back == 0);
        let mut row = ValidationRow {
            name: self.name,
            parameter: self.parameter.clone(),
            quality: level.name(),
            mesh: self.mesh,
            resolution: self.resolution,
            substeps: found.substeps,
            unit: self.unit,
            expected: self.expected,
            got: found.got,
            error_percent: error,
            solver_error: truth.map(|t| self.percent(found.got, t)),
            model_error: truth.map(|t| self.percent(t, self.expected)),
            step_us: found.step_us,
            target,
            pass,
            cause: None,
        };
        if pass == Some(false) {
            let known = known(&row).map_or(String::new(), |why| format!("; {why}"));
            row.cause = Some(cause(found, &row) + &known);
        }
        row
    }
}

/// Why a row fails, from what its run has left behind.
fn cause(found: &CaseOutcome, row: &ValidationRow) -> String {
    if found.rolled_back > 0 {
        return format!("{} steps were rolled back by the guard", found.rolled_back);
    }
    if found.bend_kept < 0.999 {
        let kept = f64::from(found.bend_kept) * 100.0;
        return format!("bending: {} substeps of all stages carry {kept:.2} % of it on this mesh", found.substeps);
    }
    if !found.settled {
        return "it has not come to rest".into();
    }
    match (row.solver_error, row.model_error) {
        (Some(solver), Some(model)) if solver.abs() > model.abs() => {
            format!("solver: {solver:+.1} % from what the same mesh converges to at {} substeps", found.substeps)
        }
        (Some(_), Some(model)) => format!("mesh: it converges to {model:+.1} % of what is exact"),
        _ => "of unknown cause".into(),
    }
}

/// What is known to lie behind a miss, whatever its figures.
fn known(row: &ValidationRow) -> Option<&'static str> {
    match (row.name, row.mesh) {
        ("capstan", _) => Some("contact and fibers are solved in turn: a heavy load on a light rope slips early"),
        ("layer-capstan", _) => Some(
            "pairs of cloths that are near and do not touch take a share of what holds those that do: what sticks creeps",
        ),
        ("bias", _) => Some(
            "threads that know nothing of each other let a strip along the bias curl across for next to nothing: a fabric's \
             file may have its rigidity there",
        ),
        ("shear-sag", _) => Some(
            "within some links of the free sides there is no shear, and the sheet sags more: the mesh's, not the solver's",
        ),
        ("strip" | "catenary" | "wave", _) => Some(
            "positions are f32, a metre from the origin: the forces of many short substeps are lost in their rounding",
        ),
        ("pendulum", _) => Some("the velocity of a substep is a chord of the arc: what turns loses angle"),
        _ => None,
    }
}
