//! A row of the table, and the errors on the way to it.

use serde::Serialize;
use thiserror::Error;
use toile_assets::scene_file::SceneError;
use toile_engine::workers::WorkerPoolError;
use toile_fitting::scene::RunError;

use crate::skirt::SkirtError;
use crate::validate::specimen::SpecimenError;
use crate::worn::WornError;

/// Why a case cannot be measured.
#[derive(Debug, Error)]
pub enum ContactError {
    /// A scene of the benchmark's own that cannot be read.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// One that cannot be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Garments that cannot be worn.
    #[error(transparent)]
    Worn(#[from] WornError),
    /// A case with an exact answer that cannot be run.
    #[error(transparent)]
    Exact(#[from] SpecimenError),
    /// A skirt that cannot be made.
    #[error(transparent)]
    Skirt(#[from] SkirtError),
    /// A garment without faces, which has no contact to be had.
    #[error("the skirt has no faces, so that nothing of it could touch; bake it from a mesh with faces")]
    NoFaces,
    /// Workers that cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
}

/// A target and what was got.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContactRow {
    /// What was measured, and of what.
    pub name: String,
    /// At most so much; none where the figure is only reported.
    pub target: Option<f64>,
    /// What was got.
    pub got: f64,
    /// The unit of both.
    pub unit: &'static str,
    /// Whether it is within the target, where there is one.
    pub pass: Option<bool>,
}

impl ContactRow {
    /// A figure that is to be at most so much.
    pub fn at_most(name: impl Into<String>, target: f64, got: f64, unit: &'static str) -> Self {
        Self { name: name.into(), target: Some(target), got, unit, pass: Some(got <= target) }
    }

    /// A figure that is only reported.
    pub fn reported(name: impl Into<String>, got: f64, unit: &'static str) -> Self {
        Self { name: name.into(), target: None, got, unit, pass: None }
    }

    /// The row of a table in Markdown.
    pub fn markdown(&self) -> String {
        let Self { name, target, got, unit, pass } = self;
        let figure = |x: f64| if x != 0.0 && x.abs() < 10.0 { format!("{x:.3}") } else { format!("{x:.0}") };
        let verdict = pass.map_or("", |pass| if pass { "met" } else { "missed" });
        format!("| {name} | {} | {} | {unit} | {verdict} |", target.map_or_else(String::new, figure), figure(*got))
    }
}
