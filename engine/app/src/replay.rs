//! `toile replay`: a recorded run taken again, bit for bit.

use std::fs;
use std::path::Path;

use serde::Serialize;
use toile_engine::clock::SimClock;
use toile_engine::crew::Crew;
use toile_engine::pace::physics::{Staged, Stepper};
use toile_engine::pace::replay::replay;
use toile_engine::pace::tape::{self, Entry};

use crate::cli::ReplayArgs;
use crate::exit::AppError;
use crate::outfit::Recipe;
use crate::report::{Document, hash_text};
use crate::terminal;

/// Largest recording that is read (bytes): a day at 15 kB a second.
const MOST_BYTES: u64 = 2 << 30;

/// The body of the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReplayReport {
    /// What was on stage.
    pub scene: Recipe,
    /// Workers of a step, now.
    pub workers: usize,
    /// Steps taken.
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
    let file = args.file.display();
    let bad = |what: &dyn std::fmt::Display| AppError::Input(format!("{file}: {what}"));
    let (text, entries) = tape::read(&read(&args.file)?).map_err(|e| bad(&e))?;
    let recipe: Recipe = serde_json::from_str(&text)
        .map_err(|e| bad(&format!("what it says of its scene is not understood ({e}); record the run again")))?;
    let Some(Entry::Dressed(first)) = entries.first() else {
        return Err(bad(&"it does not begin with how the shopper was dressed; record the run again"));
    };
    let (frame, _reader) = recipe.make(first)?;
    let crew = Crew::new(args.workers).map_err(AppError::input)?;
    let mut stepper = Stepper::new(Staged::new(frame.with_crew(crew)));
    let out = replay(&mut stepper, &entries, &SimClock::default());
    let report = ReplayReport {
        workers: args.workers,
        ticks: out.ticks,
        state_hash: hash_text(stepper.scene.frame.state_hash()),
        diverged_at: out.diverged_at,
        scene: recipe,
    };
    if args.json {
        terminal::print_json(&Document::new("replay", report.clone()))?;
    } else {
        terminal::print(&format!("{} steps, state {}\n", report.ticks, report.state_hash))?;
    }
    if let Some(tick) = out.gap_at {
        return Err(bad(&format!("the step before step {tick} was not recorded; raise {}", tape::ENTRIES_NAME)));
    }
    let made_by = &report.scene.version;
    report.diverged_at.map_or(Ok(()), |tick| {
        Err(AppError::Diverged(format!(
            "{file}: step {tick} ends in other bits than recorded by version {made_by}; replay it with that version on \
             a processor of the same kind"
        )))
    })
}

fn read(path: &Path) -> Result<Vec<u8>, AppError> {
    let refused = |e: std::io::Error| {
        AppError::Input(format!(
            "{} cannot be read ({e}); name a file made by `toile latency --record`",
            path.display()
        ))
    };
    let bytes = fs::metadata(path).map_err(refused)?.len();
    if bytes > MOST_BYTES {
        let name = path.display();
        return Err(AppError::Input(format!("{name} has {bytes} bytes, more than {MOST_BYTES}; record a shorter run")));
    }
    fs::read(path).map_err(refused)
}
