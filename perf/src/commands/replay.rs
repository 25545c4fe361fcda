//! `toile-perf replay`: what `toile soak` and `toile latency` recorded, taken again bit for bit.

use serde::{Deserialize, Serialize};
use toile_cli::exit::AppError;
use toile_cli::replay::{self, ReplayArgs};
use toile_fitting::dress::try_on::TryOn;

use super::soak::{self, SoakRecipe};

/// How the scene of a recording is made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum PerfRecorded {
    /// Recorded by `toile soak`.
    Soak(SoakRecipe),
    /// Recorded by `toile latency`.
    Session(TryOn),
}

/// Runs `toile-perf replay`.
///
/// # Errors
/// A file that is no recording, one with steps missing, and [`AppError::Diverged`] where the bits are others.
pub fn run(args: &ReplayArgs) -> Result<(), AppError> {
    let recording = args.read()?;
    let recorded: PerfRecorded = args.recipe(&recording)?;
    let workers = args.workers.count();
    let (version, again) = match &recorded {
        PerfRecorded::Soak(recipe) => (&recipe.version, soak::again(recipe.soak, &recording.entries, workers)?),
        PerfRecorded::Session(recipe) => {
            (&recipe.version, replay::session(recipe.clone(), &recording.entries, workers).map_err(|e| args.bad(e))?)
        }
    };
    args.report(&recorded, version, &again)
}
