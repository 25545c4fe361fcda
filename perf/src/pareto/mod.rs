//! Speed against error: what a step costs under many settings, and how far from x* it ends.
//!
//! x* of the cantilever is the oracle's equilibrium. Cloth that moves or folds has no equilibrium to be held against, and
//! within a second the folds of any two runs differ. Its x* is what moments of one run become in 50 ms with 128 substeps
//! of the quality `fine`; every setting goes on from the same moments. How far half as many substeps end from it is reported
//! beside it and bounds what the errors mean.

mod charts;
mod error;
mod front;
mod html;
mod meshed_scene;
mod play;
mod reference;
mod report;
mod run;
mod scenes;
mod sweep;

pub use error::ParetoError;
pub use report::{ParetoReport, Point, ReportFile, SceneReport};
pub use run::{ParetoOptions, files, run};
pub use scenes::SCENES;

#[cfg(test)]
mod tests;
