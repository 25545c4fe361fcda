//! `toile replay`: a recorded run taken again, bit for bit.

use std::convert::Infallible;

use serde::{Deserialize, Serialize};
use toile_cli::exit::AppError;
use toile_cli::replay::{self, ReplayArgs};
use toile_fitting::dress::try_on::TryOn;
use toile_fitting::live::recording::{self, KioskRecipe};

use super::programs;

/// How the scene of a recording is made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum Recorded {
    /// Recorded by `toile soak`, whose scenes `toile-perf` makes.
    Soak(SoakMark),
    /// By `toile kiosk`, which crashed.
    Kiosk(KioskRecipe),
    /// Recorded by `toile latency`.
    Session(TryOn),
}

/// The key by which a soak's recording is known.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SoakMark {
    soak: serde_json::Value,
}

/// Runs `toile replay`; a recording of `toile soak` is handed over to `toile-perf`.
///
/// # Errors
/// A file that is no recording, one with steps missing, and [`AppError::Diverged`] where the bits are others.
pub fn run(args: &ReplayArgs) -> Result<(), AppError> {
    let recording = args.read()?;
    let recorded: Recorded = args.recipe(&recording)?;
    let workers = args.workers.count();
    let (version, again) = match &recorded {
        Recorded::Soak(_) => return soak(args).map(|never| match never {}),
        Recorded::Kiosk(recipe) => {
            (&recipe.version, recording::again(&recording.notes, &recording.entries, workers).map_err(|e| args.bad(e)))
        }
        Recorded::Session(recipe) => {
            (&recipe.version, replay::session(recipe.clone(), &recording.entries, workers).map_err(|e| args.bad(e)))
        }
    };
    args.report(&recorded, version, &again?)
}

/// Lets `toile-perf` take the recording again.
fn soak(args: &ReplayArgs) -> Result<Infallible, AppError> {
    let mut line =
        vec!["replay".into(), args.file.clone().into(), "--workers".into(), args.workers.count().to_string().into()];
    line.extend(args.json.then(|| "--json".into()));
    programs::hand_over("toile-perf", &line)
}
