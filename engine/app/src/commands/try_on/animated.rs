//! A body of a file that moves as an animation of the file says.

use std::path::Path;

use toile_assets::import::avatar::{ImportOptions, MovingBody, read_moving};
use toile_assets::sizes::Population;
use toile_cli::exit::AppError;
use toile_fitting::dress::try_on::TryOn;
use toile_fitting::dress::{measured, motion};

use crate::report::AnimationReport;

/// The body of a file and its motion by the animation of this name.
///
/// # Errors
/// A file that is no such body or lacks the animation, and an animation of no file.
pub fn body(file: Option<&Path>, name: &str, request: &TryOn) -> Result<MovingBody, AppError> {
    let Some(file) = file.filter(|file| !file.is_dir()) else {
        let cure = "name it too, as in --body walker.glb";
        return Err(AppError::Usage(format!("--animation {name} belongs to a .glb, .gltf or .vrm file; {cure}")));
    };
    let sex = measured::sex(Population::Mixed, request.population()?);
    let options = ImportOptions { sex, ..ImportOptions::default() };
    read_moving(file, name, &options).map_err(AppError::input)
}

/// What is said of the motion.
///
/// # Errors
/// A body that cannot be skinned.
pub fn report(moving: &MovingBody) -> Result<AnimationReport, AppError> {
    let apart = motion::skin_distance(moving)?;
    let mm = |m: f64| (m * 1e6).round() * 1e-3;
    Ok(AnimationReport {
        name: moving.animation.clone(),
        seconds: moving.seconds,
        skin_mean_mm: mm(apart.mean),
        skin_p99_mm: mm(apart.p99),
        skin_max_mm: mm(apart.max),
        notes: moving.imported.report.notes.clone(),
    })
}
