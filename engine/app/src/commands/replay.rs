//! `toile replay`: a recorded run taken again, bit for bit.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use toile_assets::file::{self, FileKind};
use toile_engine::clock::SimClock;
use toile_engine::frame::Frame;
use toile_engine::frame_loop::physics_thread::{FrameScene, SceneStepper};
use toile_engine::frame_loop::recording::{self, Entry, Recording};
use toile_engine::frame_loop::replay::{Replayed, replay};
use toile_engine::workers::WorkerPool;
use toile_fitting::dress::try_on::TryOn;

use crate::arguments::WorkersArg;
use crate::commands::soak::{self, SoakRecipe};
use crate::exit::AppError;
use crate::report::{Document, hash_text};
use crate::terminal;
use toile_fitting::live::recording as kiosk_recording;
use toile_fitting::live::recording::KioskRecipe;

/// Replay a recorded run and compare every step bit for bit.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: record a run, and replay it with one worker in place of two\n  toile latency --seconds 10 \
                        --record run.tape && toile replay run.tape --workers 1"
)]
pub struct ReplayArgs {
    /// Recording of a run
    #[arg(value_name = "F")]
    pub file: PathBuf,
    #[command(flatten)]
    workers: WorkersArg,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    pub json: bool,
}

/// A recorded run: a day at 15 kB a second.
const RUN: FileKind =
    FileKind { name: "a file made by `toile latency --record`", max_bytes: 2 << 30, cure: "record a shorter run" };

/// How the scene of a recording is made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Recorded {
    /// Recorded by `toile soak`.
    Soak(SoakRecipe),
    /// By `toile kiosk`, which crashed.
    Kiosk(KioskRecipe),
    /// Recorded by `toile latency`.
    Session(TryOn),
}

impl Recorded {
    /// The version of the program that wrote it.
    fn version(&self) -> &str {
        match self {
            Self::Soak(recipe) => &recipe.version,
            Self::Kiosk(recipe) => &recipe.version,
            Self::Session(request) => &request.version,
        }
    }
}

/// The body of the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReplayReport {
    /// The scene that was recorded.
    pub scene: Recorded,
    /// Workers of a step, now.
    pub workers: usize,
    /// Steps that were replayed.
    pub ticks: u64,
    /// Hash of the last state.
    pub state_hash: String,
    /// The first step that ended in other bits than the recorded one.
    pub diverged_at: Option<u64>,
}

/// Runs `toile replay`.
///
/// # Errors
/// A file that is no recording, one with steps missing, and [`AppError::Diverged`] where the bits are others.
pub fn run(args: &ReplayArgs) -> Result<(), AppError> {
    let workers = args.workers.count();
    let file = args.file.display();
    let bad = |what: &dyn std::fmt::Display| AppError::Input(format!("{file}: {what}"));
    let Recording { text, notes, entries } =
        recording::read(&file::read(&args.file, &RUN).map_err(AppError::input)?).map_err(|e| bad(&e))?;
    let recorded: Recorded = serde_json::from_str(&text)
        .map_err(|e| bad(&format!("what it says of its scene is not understood ({e}); record the run again")))?;
    let (frame, out) = match &recorded {
        Recorded::Soak(recipe) => soak::again(recipe.soak, &entries, workers)?,
        Recorded::Kiosk(_) => kiosk_recording::again(&notes, &entries, workers).map_err(|e| bad(&e))?,
        Recorded::Session(request) => session(request.clone(), &entries, workers).map_err(|e| bad(&e))?,
    };
    let report = ReplayReport {
        workers,
        ticks: out.ticks,
        state_hash: hash_text(frame.state_hash()),
        diverged_at: out.diverged_at,
        scene: recorded,
    };
    if args.json {
        terminal::print_json(&Document::new("replay", report.clone()))?;
    } else {
        terminal::print(&format!("{} steps, state {}\n", report.ticks, report.state_hash))?;
    }
    if let Some(tick) = out.gap_at {
        return Err(bad(&format!(
            "the step before step {tick} was not recorded; record it again on a quieter machine"
        )));
    }
    let made_by = report.scene.version();
    report.diverged_at.map_or(Ok(()), |tick| {
        Err(AppError::Diverged(format!(
            "{file}: step {tick} ends in other bits than recorded by version {made_by}; replay it with that version on \
             a processor of the same kind"
        )))
    })
}

/// Takes a recording of `toile latency` again.
fn session(request: TryOn, entries: &[Entry], workers: usize) -> Result<(Frame, Replayed), AppError> {
    let Some(Entry::Dressed(first)) = entries.first() else {
        let what = "it does not begin with how the shopper was dressed; record the run again";
        return Err(AppError::Input(what.to_owned()));
    };
    let frame = request.build(first)?.frame;
    let crew = WorkerPool::new(workers).map_err(AppError::input)?;
    let mut stepper = SceneStepper::new(FrameScene::new(frame.with_workers(crew)));
    let out = replay(&mut stepper, entries, &SimClock::default());
    Ok((stepper.scene.frame, out))
}
