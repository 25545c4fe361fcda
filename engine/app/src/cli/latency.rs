//! The grammar of `toile latency` and `toile replay`.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use toile_engine::cloth::Quality;
use toile_engine::crew::SHARES;
use toile_engine::pace::governor::LADDER;

use super::{flag, json, path, quiet, required, text};
use crate::exit::AppError;
use crate::outfit::Wish;

/// Longest run (s): a day.
const MOST_SECONDS: i64 = 86_400;

/// Most threads of load.
const MOST_LOAD: i64 = 256;

/// Arguments of `toile latency`.
#[derive(Debug, Clone, PartialEq)]
pub struct LatencyArgs {
    /// A recording; `None` is the embedded session.
    pub session: Option<PathBuf>,
    /// What is worn.
    pub wish: Wish,
    /// Length of the run (s).
    pub seconds: u32,
    /// Workers of a step.
    pub workers: usize,
    /// Threads of load.
    pub load: usize,
    /// Rung of the governor's ladder to be held on.
    pub rung: Option<u8>,
    /// Where the run is recorded.
    pub record: Option<PathBuf>,
    /// When it panics (s), to see what a crash leaves.
    pub crash_after: Option<u64>,
    /// Whether a missed goal fails the command.
    pub gate: bool,
    /// Where the page goes.
    pub out: PathBuf,
    /// One JSON object on stdout in place of the table.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// Arguments of `toile replay`.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayArgs {
    /// The recording.
    pub file: PathBuf,
    /// Workers of a step.
    pub workers: usize,
    /// One JSON object on stdout in place of a line.
    pub json: bool,
}

/// The grammar of `toile latency`.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("latency")
        .about("Time the way from the sensor to the picture on this machine, with the error at that speed")
        .long_about(
            "Runs the whole loop in real time (sensor, physics with its worker, render) and tells how long each stage \
             takes, from what the sensor saw until a picture is taken, corrected for coordinated omission; what was late \
             and why; the machine's own jitter; the quality and the error that it ran at. Writes a page with histograms.",
        )
        .args([
            path("session", "F", "Recording to play, forth and back [default: embedded]"),
            text("garment", "G", "Garment of the wardrobe; repeat it to dress in layers, inner first")
                .action(ArgAction::Append),
            text("size", "S", "Size to wear [default: the one that fits]"),
            text("quality", "Q", "Tested settings of the cloth: draft, shop or fine")
                .value_parser(Quality::ALL.map(Quality::name))
                .default_value(Quality::default().name()),
            text("seconds", "S", "Length of the run, after a first second that is not metered")
                .value_parser(value_parser!(u32).range(1..=MOST_SECONDS))
                .default_value("30"),
            workers(),
            text("load", "N", "Threads of load beside the loop; as many as there are cores if N is left out")
                .num_args(0..=1)
                .default_missing_value("0")
                .value_parser(value_parser!(u32).range(0..=MOST_LOAD)),
            text("rung", "R", "Hold the quality on a rung of the governor's ladder: 0 is all of it [default: governed]")
                .value_parser(value_parser!(u8).range(0..LADDER.len() as i64)),
            path("record", "F", "Record the run, without images, for `toile replay`"),
            crash_after(),
            flag("gate", "Exit with 3 where a goal is missed"),
            path("out", "DIR", "Folder for the page; it is made if missing").default_value("latency"),
            json(),
            quiet(),
        ])
        .after_help("Example: see how late a kiosk may be while something else wants its cores\n  toile latency --seconds 60 --load")
}

/// The grammar of `toile replay`.
pub(super) fn replay_grammar() -> clap::Command {
    clap::Command::new("replay")
        .about("Take a recorded run again and compare every step bit for bit")
        .args([
            Arg::new("file")
                .value_name("F")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("Recording of a run"),
            workers(),
            json(),
        ])
        .after_help("Example: record a run, and take it again with one worker in place of two\n  toile latency --seconds 10 --record run.tape && toile replay run.tape --workers 1")
}

pub(super) fn workers() -> Arg {
    text("workers", "N", "Workers of a step, 1 or 2 [default: as many as there are cores]")
        .value_parser(value_parser!(u8).range(1..=SHARES as i64))
}

/// Every command that keeps its last seconds for a crash can be made to.
pub(super) fn crash_after() -> Arg {
    text("crash-after", "S", "Panic after so long, to see what a crash leaves").value_parser(value_parser!(u64))
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

pub(super) fn chosen_workers(matches: &ArgMatches) -> usize {
    matches.get_one::<u8>("workers").map_or_else(|| cores().min(SHARES), |n| usize::from(*n))
}

/// What is to be worn.
pub(super) fn wish(matches: &ArgMatches) -> Wish {
    Wish {
        garments: matches.get_many("garment").into_iter().flatten().cloned().collect(),
        size: matches.get_one("size").cloned(),
        quality: matches.get_one::<String>("quality").and_then(|q| q.parse().ok()).unwrap_or_default(),
    }
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<LatencyArgs, AppError> {
    let load = matches.get_one::<u32>("load").map_or(0, |n| if *n == 0 { cores() } else { *n as usize });
    Ok(LatencyArgs {
        session: matches.get_one("session").cloned(),
        wish: wish(matches),
        seconds: required(matches, "seconds")?,
        workers: chosen_workers(matches),
        load,
        rung: matches.get_one("rung").copied(),
        record: matches.get_one("record").cloned(),
        crash_after: matches.get_one("crash-after").copied(),
        gate: matches.get_flag("gate"),
        out: required(matches, "out")?,
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}

/// What a matched line asks for.
pub(super) fn replay_args(matches: &ArgMatches) -> Result<ReplayArgs, AppError> {
    Ok(ReplayArgs {
        file: required(matches, "file")?,
        workers: chosen_workers(matches),
        json: matches.get_flag("json"),
    })
}
