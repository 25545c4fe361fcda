//! Speed against error: what a step costs under many settings, and how far from x* it ends.
//!
//! Reads: the scenes (skirt, wardrobe, cantilever, tablecloth), the oracle. Writes: points, the front, charts, a report.
//! Budget: six minutes for everything on two cores, twenty seconds with `quick`; nothing but the step itself is timed.
//! Thread: one, and the helper of runs that are asked for two.
//!
//! x* of the cantilever is the oracle's equilibrium. Cloth that moves or folds has no equilibrium to be held against, and
//! within a second the folds of any two runs differ. Its x* is what moments of one run become in 50 ms with 128 substeps
//! of the quality `fine`; every setting goes on from the same moments. How far half as many substeps end from it is reported
//! beside it and bounds what the errors mean.

mod charts;
mod drape;
mod front;
mod html;
mod meshed_scene;
mod play;
mod reference;
mod report;
mod scenes;
mod survival;
mod sweep;

use thiserror::Error;
use toile_assets::body::BodyError;
use toile_assets::fabric::FabricError;
use toile_assets::garment::MeshError;
use toile_assets::sizes::SizeError;
use toile_assets::wardrobe::WardrobeError;
use toile_engine::colliders::ColliderError;
use toile_engine::workers::WorkerPoolError;

use crate::oracle::OracleError;
use crate::skirt::SkirtError;
pub use report::{Drape, ParetoReport, Point, ReportFile, Sampling, SceneReport, Survival};

/// Why the figures cannot be taken.
#[derive(Debug, Error)]
pub enum ParetoError {
    /// A scene's mesh.
    #[error("a scene's mesh cannot be baked: {0}")]
    Mesh(#[from] MeshError),
    /// A scene's fabric.
    #[error(transparent)]
    Fabric(#[from] FabricError),
    /// The mannequin.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// A garment of the wardrobe.
    #[error(transparent)]
    Wardrobe(#[from] WardrobeError),
    /// Its sizes.
    #[error(transparent)]
    Sizes(#[from] SizeError),
    /// A scene's solids.
    #[error("a scene's colliders are refused: {0}")]
    Colliders(#[from] ColliderError),
    /// The engine's workers.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
    /// x*.
    #[error("x* was not found: {0}")]
    Oracle(#[from] OracleError),
    /// The survival map's skirt.
    #[error(transparent)]
    Skirt(#[from] SkirtError),
    /// A plot.
    #[error(transparent)]
    Picture(#[from] toile_view::image::Error),
    /// A scene that is not one.
    #[error("there is no scene {0} to plot; give one of those that `toile pareto --help` names")]
    Unknown(String),
}

/// What is to be measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ParetoOptions {
    /// The one scene; all of them if not given.
    pub scene: Option<String>,
    /// Few settings of small meshes: whether the command works, not what the engine can do.
    pub quick: bool,
}

/// Names of all scenes, in the order in which they are run.
pub const SCENES: [&str; 6] = ["cantilever", "skirt", "sun-dress", "t-shirt", "wide-trousers", "drape"];

/// Takes all figures that are asked for; `progress` is given the part of the work that is done (0..1).
///
/// # Errors
/// Where a scene cannot be set up, or the oracle finds no x*.
pub fn run(options: &ParetoOptions, progress: &dyn Fn(f64)) -> Result<ParetoReport, ParetoError> {
    let names: Vec<&str> = match &options.scene {
        Some(name) => vec![*SCENES.iter().find(|s| *s == name).ok_or_else(|| ParetoError::Unknown(name.clone()))?],
        None => SCENES.to_vec(),
    };
    let mut report = ParetoReport { quick: options.quick, ..ParetoReport::default() };
    for (k, name) in names.iter().enumerate() {
        let part = |share: f64| progress((k as f64 + share) / names.len() as f64);
        if *name == "drape" {
            report.drape = Some(drape::study(options.quick, &part)?);
            continue;
        }
        for subject in scenes::subjects(name, options.quick)? {
            let (points, scene) = sweep::sweep(&subject, options.quick, &part)?;
            report.points.extend(points);
            report.scenes.push(scene);
        }
        if *name == "skirt" {
            report.survival = Some(survival::map(options.quick)?);
        }
    }
    front::mark(&mut report.points);
    Ok(report)
}

/// The report's files: CSV, plots as PNG, and an HTML page that needs no other.
///
/// # Errors
/// Where a plot cannot be encoded.
pub fn files(report: &ParetoReport) -> Result<Vec<ReportFile>, ParetoError> {
    let figures = charts::figures(report);
    let mut files = vec![ReportFile { name: "points.csv".into(), bytes: report::csv(&report.points).into_bytes() }];
    for figure in &figures {
        let mut png = Vec::new();
        crate::plot::raster::image(&figure.drawing).write_png(&mut png)?;
        files.push(ReportFile { name: format!("{}.png", figure.name), bytes: png });
    }
    files.push(ReportFile { name: "pareto.html".into(), bytes: html::page(report, &figures).into_bytes() });
    Ok(files)
}

#[cfg(test)]
mod tests;
