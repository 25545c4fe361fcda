//! The grammar of `toile soak`.

use std::path::PathBuf;

use clap::{ArgMatches, value_parser};
use toile_engine::crew::SHARES;
use toile_perf::soak::{LEAST_APART_S, Options, Plan, Weight};

use super::latency::crash_after;
use super::{flag, json, path, quiet, required, text};
use crate::exit::AppError;

/// Longest run (h): five weeks.
const MOST_HOURS: f64 = 840.0;

/// Longest uptime (h): a hundred years.
const MOST_UPTIME: i64 = 876_000;

/// Time between two faults where their number is not told (s).
const USUALLY_APART_S: u64 = 30;

/// Arguments of `toile soak`.
#[derive(Debug, Clone, PartialEq)]
pub struct SoakArgs {
    /// What is soaked, and how.
    pub options: Options,
    /// Whether no second run is made to compare.
    pub once: bool,
    /// Where the run is recorded.
    pub record: Option<PathBuf>,
    /// The physics thread panics after so long (s).
    pub crash_after: Option<u64>,
    /// Where the page and the record go.
    pub out: PathBuf,
    /// One JSON object on stdout in place of the table.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// The grammar.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("soak")
        .about("Run the whole loop for hours, with shoppers, garments and faults, and check it while it runs")
        .long_about(
            "Runs the whole loop without a screen: shoppers of many sizes come and go, garments are changed, and with \
             --faults everything goes wrong that can: the camera, the threads, the clocks, the disk, memory. Checks while it \
             runs that nothing published is no number, that the loop allocates nothing, that memory, files and threads stay as \
             they are, that every fault is recovered and how fast, and that a second run ends in the same bits. Writes a record \
             as a page and as JSON.",
        )
        .args([
            text("minutes", "M", "Length of the run on the loop's clock").value_parser(value_parser!(f64)),
            text("hours", "H", "The same in hours").value_parser(value_parser!(f64)).conflicts_with("minutes"),
            flag("real-time", "On threads and the system's clock [default: as fast as possible on a simulated one]"),
            text("seed", "N", "Everything that happens follows from it")
                .value_parser(value_parser!(u64))
                .default_value("1"),
            text("faults", "N", "Inject so many faults, or one every half minute if N is left out")
                .num_args(0..=1)
                .default_missing_value("0")
                .value_parser(value_parser!(u64)),
            text("uptime-hours", "H", "What the clock shows at the begin")
                .value_parser(value_parser!(u64).range(0..=MOST_UPTIME as u64))
                .default_value("0"),
            text("scene", "S", "light: coarse garments, hours in minutes; full: the wardrobe as it is worn \
                 [default: full in real time, else light]")
                .value_parser(Weight::ALL.map(Weight::name)),
            text("workers", "N", "Workers of a step in real time, 1 or 2 [default: as many as there are cores]")
                .value_parser(value_parser!(u8).range(1..=SHARES as i64)),
            flag("once", "Make no second run to compare the bits with"),
            path("record", "F", "Record the run, without images, for `toile replay`"),
            crash_after(),
            path("out", "DIR", "Folder for the record; it is made if missing").default_value("soak"),
            json(),
            quiet(),
        ])
        .after_help(
            "Example: eight hours and a thousand faults in some minutes, then an hour in real time\n  \
             toile soak --hours 8 --faults 1000 && toile soak --hours 1 --real-time --faults",
        )
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<SoakArgs, AppError> {
    let hours = match (matches.get_one::<f64>("minutes"), matches.get_one::<f64>("hours")) {
        (Some(minutes), _) => minutes / 60.0,
        (None, Some(hours)) => *hours,
        (None, None) => 1.0 / 6.0,
    };
    if !(hours > 0.0 && hours <= MOST_HOURS) {
        return Err(AppError::Usage(format!("a run lasts up to {MOST_HOURS} hours, not {hours}; choose less")));
    }
    let seconds = (hours * 3_600.0).ceil() as u64;
    let faults = match matches.get_one::<u64>("faults") {
        None => 0,
        Some(0) => seconds / USUALLY_APART_S,
        Some(faults) => *faults,
    };
    if faults > seconds / LEAST_APART_S {
        let most = seconds / LEAST_APART_S;
        return Err(AppError::Usage(format!("{faults} faults do not fit into {seconds} s; ask for {most} at most")));
    }
    let real_time = matches.get_flag("real-time");
    let named = matches.get_one::<String>("scene");
    let scene = named.and_then(|name| Weight::ALL.into_iter().find(|w| w.name() == name));
    let scene = scene.unwrap_or(if real_time { Weight::Full } else { Weight::Light });
    let cores = std::thread::available_parallelism().map_or(1, usize::from).min(SHARES);
    let workers = matches.get_one::<u8>("workers").map_or(cores, |n| usize::from(*n));
    let plan = Plan { seed: required(matches, "seed")?, seconds, faults: faults as usize, scene };
    let options = Options {
        plan,
        uptime_hours: required(matches, "uptime-hours")?,
        real_time,
        workers: if real_time { workers } else { 1 },
    };
    Ok(SoakArgs {
        options,
        once: matches.get_flag("once"),
        record: matches.get_one("record").cloned(),
        crash_after: matches.get_one("crash-after").copied(),
        out: required(matches, "out")?,
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<SoakArgs, AppError> {
        args(&grammar().try_get_matches_from(line.split_whitespace()).map_err(AppError::input)?)
    }

    #[test]
    fn ten_simulated_minutes_without_faults_are_the_default() {
        let Options { plan, uptime_hours, real_time, workers } = parsed("soak").unwrap().options;
        assert_eq!(plan, Plan { seed: 1, seconds: 600, faults: 0, scene: Weight::Light });
        assert_eq!((uptime_hours, real_time, workers), (0, false, 1));
    }

    #[test]
    fn faults_have_a_number_or_come_every_half_minute() {
        assert_eq!(parsed("soak --hours 8 --faults 1000").unwrap().options.plan.faults, 1_000);
        assert_eq!(parsed("soak --minutes 5 --faults").unwrap().options.plan.faults, 10);
        let real = parsed("soak --hours 1 --real-time --uptime-hours 9936").unwrap().options;
        assert_eq!((real.plan.scene, real.uptime_hours), (Weight::Full, 9_936));
        for wrong in
            ["soak --minutes 1 --faults 11", "soak --minutes 0", "soak --hours nan", "soak --minutes 1 --hours 1"]
        {
            assert!(parsed(wrong).is_err(), "{wrong}");
        }
    }
}
