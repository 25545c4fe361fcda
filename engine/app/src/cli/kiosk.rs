//! The grammar of `toile kiosk`.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::{ArgMatches, value_parser};

use super::latency::crash_after;
use super::{flag, json, path, quiet, text};
use crate::exit::AppError;

/// Longest run that is asked for by its length (s): a year.
const MOST_SECONDS: i64 = 366 * 86_400;

/// Arguments of `toile kiosk`.
#[derive(Debug, Clone, PartialEq)]
pub struct KioskArgs {
    /// Whether it runs without a window.
    pub headless: bool,
    /// Pixels of a window, where it is not to cover the display.
    pub windowed: Option<[u32; 2]>,
    /// Length of the run (s); none is until it is told to end.
    pub seconds: Option<u32>,
    /// The configuration; none is the default one.
    pub config: Option<PathBuf>,
    /// A recording to play in place of what the configuration names.
    pub session: Option<PathBuf>,
    /// When it panics (s), to see what a crash leaves.
    pub crash_after: Option<u64>,
    /// Only print the default configuration.
    pub print_config: bool,
    /// One JSON object on stdout at the end.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// Least and most pixels of a window, each way.
const WINDOW: RangeInclusive<u32> = 240..=8192;

/// Reads `540x960`.
fn windowed(said: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|n| WINDOW.contains(n));
    let size = said.split_once('x').and_then(|(w, h)| Some([side(w)?, side(h)?]));
    size.ok_or_else(|| {
        format!("give two numbers of pixels from {} to {}, for example 540x960", WINDOW.start(), WINDOW.end())
    })
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("kiosk")
        .about("Run unattended: wait for shoppers, measure them, dress them, forget them")
        .long_about(
            "Runs the whole loop until it is told to end (SIGTERM, SIGINT): waits for somebody to step in, measures them, \
             dresses a body of their size, and forgets them when they have left. Nothing about a person is written. Speaks \
             to systemd as a service of Type=notify with a watchdog; docs/kiosk.md tells how it is installed.",
        )
        .args([
            flag("headless", "Without a window: pictures are taken and thrown away"),
            text("windowed", "WxH", "In a window of so many pixels [default: it covers the display]")
                .value_parser(windowed)
                .conflicts_with("headless"),
            text("seconds", "S", "End after so many seconds [default: when told to]")
                .value_parser(value_parser!(u32).range(1..=MOST_SECONDS)),
            path("config", "FILE", "Configuration in TOML [default: what --print-config prints]"),
            path("session", "F", "Recording to play as the sensor, again and again, in place of the configured one"),
            flag("print-config", "Print the default configuration with all keys explained, and end"),
            crash_after(),
            json(),
            quiet(),
        ])
        .after_help("Example: two visits of the embedded shopper, and what became of them\n  toile kiosk --headless --seconds 60 --json")
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<KioskArgs, AppError> {
    Ok(KioskArgs {
        headless: matches.get_flag("headless"),
        windowed: matches.get_one("windowed").copied(),
        seconds: matches.get_one("seconds").copied(),
        config: matches.get_one("config").cloned(),
        session: matches.get_one("session").cloned(),
        crash_after: matches.get_one("crash-after").copied(),
        print_config: matches.get_flag("print-config"),
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}
