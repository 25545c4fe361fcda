//! The plan of a scene, as the JSON has it.

use std::collections::BTreeMap;

use serde::Serialize;
use toile_engine::meter;

use super::cost::Costs;
use super::reach::Reach;
use super::verdict::PlanVerdict;
use super::weigh::Played;
use super::work::{STAGES, UNITS};

/// What a unit of work takes on this machine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UnitCost {
    /// Name of the stage of the cloth.
    pub stage: &'static str,
    /// Unit of the work that is counted.
    pub unit: &'static str,
    /// Time of one (ns).
    pub ns: f64,
}

/// The costs by name; units that the machine showed no time for are left out.
pub fn units(costs: &Costs) -> Vec<UnitCost> {
    let named = STAGES.iter().zip(&UNITS).zip(&costs.unit_us);
    let all = named.flat_map(|((stage, units), us)| units.iter().zip(us).map(|(unit, us)| (*stage, *unit, us * 1e3)));
    let mut all: Vec<_> = all.filter(|u| u.2 > 0.0).map(|(stage, unit, ns)| UnitCost { stage, unit, ns }).collect();
    all.push(UnitCost { stage: "all", unit: "barriers of two workers", ns: costs.barrier_us * 1e3 });
    all.push(UnitCost { stage: "publish", unit: "particles", ns: costs.copy_us * 1e3 });
    all
}

/// One garment of the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GarmentPlan {
    /// Name of the garment.
    pub name: String,
    /// Code of the size.
    pub size: String,
    /// Name of the fabric.
    pub fabric: String,
    /// Particles of the garment.
    pub particles: usize,
    /// Of these, the ones that move on their own.
    pub free: usize,
    /// Mean distance of neighbours (mm).
    pub spacing_mm: f64,
    /// Substeps of a step.
    pub substeps: u32,
    /// Pairs of particle and capsule that are near as it is laid on.
    pub near: u64,
    /// Time of a step on one core, and shared by two workers (us).
    pub us: [f64; 2],
    /// Time of each stage on one core (us).
    pub stages_us: BTreeMap<&'static str, f64>,
}

/// A stage of a step against its budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StagePlan {
    /// Name of the stage.
    pub stage: &'static str,
    /// Budget of the stage (us).
    pub budget_us: f64,
    /// What it is predicted to take, half of the time more (us).
    pub predicted_us: f64,
    /// Whether that is within the budget.
    pub within: bool,
}

/// The stages of a step (us) against the budgets of the engine. Where a scene has another period, its cloth has the share
/// of that.
pub fn stages(predicted: &[f64; meter::STAGES.len()], period_us: f64) -> Vec<StagePlan> {
    let longer = period_us / (meter::PERIOD_NS as f64 * 1e-3);
    let row = |(stage, us): (&meter::StageBudget, &f64)| {
        let budget_us = stage.budget_us as f64 * longer;
        StagePlan { stage: stage.name, budget_us, predicted_us: *us, within: *us <= budget_us }
    };
    meter::STAGES.iter().zip(predicted).skip(1).map(row).collect()
}

/// Memory of a part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Memory {
    /// Name of the part.
    pub part: String,
    /// Memory of the part (bytes).
    pub bytes: u64,
}

/// How the prediction held.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Held {
    /// Predicted time of the cloth in a step (us).
    pub predicted_us: f64,
    /// Measured median and 99 % (us).
    pub measured_us: [f64; 2],
    /// Predicted over measured median, less one (%).
    pub error_percent: f64,
    /// The same on one core, the sum of the stages: predicted, measured (us), and the error (%).
    pub one_core: [f64; 3],
}

impl Held {
    /// Of a prediction and what was played.
    pub fn of(predicted_us: f64, one_core_us: f64, played: &Played) -> Self {
        let off = |predicted: f64, measured: f64| 100.0 * (predicted / measured.max(1e-9) - 1.0);
        let one = played.stages_us.iter().sum();
        Self {
            predicted_us,
            measured_us: played.cloth_us,
            error_percent: off(predicted_us, played.cloth_us[0]),
            one_core: [one_core_us, one, off(one_core_us, one)],
        }
    }
}

/// What a scene needs: garments, contact, memory, time of each stage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    /// The scene's name.
    pub scene: String,
    /// How the cloth is stepped.
    pub quality: &'static str,
    /// Workers of a step.
    pub workers: usize,
    /// Lanes that the kernels run on.
    pub lanes: usize,
    /// Time between two steps (us).
    pub period_us: f64,
    /// Garments of the scene, inner first.
    pub garments: Vec<GarmentPlan>,
    /// Colliders that each part of a garment can touch.
    pub reach: Vec<Reach>,
    /// Memory of each part.
    pub memory: Vec<Memory>,
    /// Predicted time of each stage.
    pub stages: Vec<StagePlan>,
    /// Whether it fits, and what would help.
    pub verdict: PlanVerdict,
    /// What the machine takes for a unit of work.
    pub units: Vec<UnitCost>,
    /// How the prediction held in a run; none where nothing was run.
    pub held: Option<Held>,
    /// What was played; none where nothing was.
    pub played: Option<Played>,
}
