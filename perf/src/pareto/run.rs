//! Takes all figures, and makes the report's files of them.

use super::error::ParetoError;
use super::report::{self, ParetoReport, ReportFile};
use super::{charts, front, html, scenes, sweep};

/// What is to be measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ParetoOptions {
    /// The one scene; all of them if not given.
    pub scene: Option<String>,
    /// Few settings of small meshes: whether the command works, not what the engine can do.
    pub quick: bool,
}

/// Takes all figures that are asked for; `progress` is given the part of the work that is done (0..1).
///
/// # Errors
/// Where a scene cannot be set up, or the oracle finds no x*.
pub fn run(options: &ParetoOptions, progress: &dyn Fn(f64)) -> Result<ParetoReport, ParetoError> {
    let names: Vec<&str> = match &options.scene {
        Some(name) => {
            vec![*scenes::SCENES.iter().find(|s| *s == name).ok_or_else(|| ParetoError::Unknown(name.clone()))?]
        }
        None => scenes::SCENES.to_vec(),
    };
    let mut report = ParetoReport { quick: options.quick, ..ParetoReport::default() };
    for (k, name) in names.iter().enumerate() {
        let part = |share: f64| progress((k as f64 + share) / names.len() as f64);
        for subject in scenes::subjects(name, options.quick)? {
            let (points, scene) = sweep::sweep(&subject, options.quick, &part)?;
            report.points.extend(points);
            report.scenes.push(scene);
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
        toile_view::plot::raster::image(&figure.drawing).write_png(&mut png)?;
        files.push(ReportFile { name: format!("{}.png", figure.name), bytes: png });
    }
    files.push(ReportFile { name: "pareto.html".into(), bytes: html::page(report, &figures).into_bytes() });
    Ok(files)
}
