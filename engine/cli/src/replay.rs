//! Replays a recorded run, bit for bit: the part common to all kinds of recordings.

use std::fmt::Display;
use std::path::PathBuf;

use serde::Serialize;
use serde::de::DeserializeOwned;
use toile_assets::file::{self, FileKind};
use toile_engine::clock::SimClock;
use toile_engine::frame_loop::physics_thread::{SceneStepper, WorldScene};
use toile_engine::frame_loop::recording::{self, Entry, LoopRecording};
use toile_engine::frame_loop::replay::{Replayed, replay};
use toile_engine::workers::WorkerPool;
use toile_engine::world::World;
use toile_fitting::dress::try_on::TryOn;

use crate::arguments::WorkersArg;
use crate::document::{Document, hash_text};
use crate::exit::AppError;
use crate::terminal;

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
    /// Workers of a step.
    #[command(flatten)]
    pub workers: WorkersArg,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    pub json: bool,
}

/// A recorded run: a day at 15 kB a second.
const RUN: FileKind =
    FileKind { name: "a file made by `toile latency --record`", max_bytes: 2 << 30, cure: "record a shorter run" };

/// The body of the JSON.
#[derive(Debug, Serialize)]
struct ReplayReport<'a, R> {
    /// The scene that was recorded.
    scene: &'a R,
    /// Workers of a step, now.
    workers: usize,
    /// Steps that were replayed.
    ticks: u64,
    /// Hash of the last state.
    state_hash: String,
    /// The first step that ended in other bits than the recorded one.
    diverged_at: Option<u64>,
}

impl ReplayArgs {
    /// Bad input in the file of the recording.
    pub fn bad(&self, problem: impl Display) -> AppError {
        AppError::Input(format!("{}: {problem}", self.file.display()))
    }

    /// The recording.
    ///
    /// # Errors
    /// A file that is no recording.
    pub fn read(&self) -> Result<LoopRecording, AppError> {
        recording::read(&file::read(&self.file, &RUN).map_err(AppError::input)?).map_err(|e| self.bad(e))
    }

    /// The recipe of the scene that a recording is of.
    ///
    /// # Errors
    /// A recipe that another program wrote.
    pub fn recipe<R: DeserializeOwned>(&self, recording: &LoopRecording) -> Result<R, AppError> {
        serde_json::from_str(&recording.text)
            .map_err(|e| self.bad(format!("what it says of its scene is not understood ({e}); record the run again")))
    }

    /// Prints what came out of a replay.
    ///
    /// # Errors
    /// A recording with steps missing, and [`AppError::Diverged`] where the bits are others than those that this version recorded.
    pub fn report<R: Serialize>(
        &self,
        scene: &R,
        version: &str,
        (frame, out): &(World, Replayed),
    ) -> Result<(), AppError> {
        let report = ReplayReport {
            scene,
            workers: self.workers.count(),
            ticks: out.ticks,
            state_hash: hash_text(frame.state_hash()),
            diverged_at: out.diverged_at,
        };
        let (ticks, hash) = (report.ticks, report.state_hash.clone());
        if self.json {
            terminal::print_json(&Document::new("replay", report))?;
        } else {
            terminal::print(&format!("{ticks} steps, state {hash}\n"))?;
        }
        if let Some(tick) = out.gap_at {
            return Err(
                self.bad(format!("the step before step {tick} was not recorded; record it again on a quieter machine"))
            );
        }
        let file = self.file.display();
        out.diverged_at.map_or(Ok(()), |tick| {
            Err(AppError::Diverged(format!(
                "{file}: step {tick} ends in other bits than recorded by version {version}; replay it with that version \
                 on a processor of the same kind"
            )))
        })
    }
}

/// Takes a recording of `toile latency` again.
///
/// # Errors
/// A recording that does not begin with a dressed shopper, and a scene that cannot be made.
pub fn session(request: TryOn, entries: &[Entry], workers: usize) -> Result<(World, Replayed), AppError> {
    let Some(Entry::Dressed(first)) = entries.first() else {
        let what = "it does not begin with how the shopper was dressed; record the run again";
        return Err(AppError::Input(what.to_owned()));
    };
    let frame = request.build(first)?.world;
    let crew = WorkerPool::new(workers).map_err(AppError::input)?;
    let mut stepper = SceneStepper::new(WorldScene::new(frame.with_workers(crew)));
    let out = replay(&mut stepper, entries, &SimClock::default());
    Ok((stepper.scene.world, out))
}
