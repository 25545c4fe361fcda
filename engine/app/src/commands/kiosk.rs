//! `toile kiosk`: runs a shop's fitting room, unattended.

use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::time::Instant;

use clap::value_parser;
use toile_cli::arguments::Printing;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal::{self, Words};
use toile_kiosk::KioskOptions;
use toile_kiosk::service::instance;

use super::doctor;

/// Longest run that is asked for by its length (s): a year.
const MOST_SECONDS: i64 = 366 * 86_400;

/// Least and most pixels of a window, each way.
const WINDOW: RangeInclusive<u32> = 240..=8192;

/// Run unattended: wait for shoppers, measure them, dress them, forget them.
///
/// Runs the whole loop until it is asked to end (SIGTERM, SIGINT): waits for a shopper to step in, measures them, dresses a
/// body of their size, and forgets them when they have left. Nothing about a person is written. Works with systemd as a
/// service of Type=notify with a watchdog; docs/kiosk.md describes how it is installed.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: two visits of the embedded shopper, and what became of them\n  toile kiosk --headless \
                        --seconds 60 --json"
)]
pub struct KioskArgs {
    /// Without a window: pictures are taken and thrown away
    #[arg(long)]
    pub headless: bool,
    /// In a window of so many pixels (default: it covers the display)
    #[arg(long, value_name = "WxH", value_parser = windowed, conflicts_with = "headless")]
    pub windowed: Option<[u32; 2]>,
    /// End after so many seconds (default: when a signal asks for it)
    #[arg(long, value_name = "S", value_parser = value_parser!(u32).range(1..=MOST_SECONDS))]
    pub seconds: Option<u32>,
    /// Configuration in TOML (default: what --print-config prints)
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// Name of this kiosk, where several run on one machine (default: only one may run)
    #[arg(long, value_name = "NAME", value_parser = instance::name)]
    pub instance: Option<String>,
    /// Recording to play as the sensor, again and again, in place of the configured one
    #[arg(long, value_name = "F")]
    pub session: Option<PathBuf>,
    /// Print the default configuration with all keys explained, and end
    #[arg(long)]
    pub print_config: bool,
    /// Panic after so many seconds, to see what a crash leaves
    #[arg(long, value_name = "S")]
    pub crash_after: Option<u64>,
    /// What is printed.
    #[command(flatten)]
    pub printing: Printing,
}

/// Reads the size of a window (pixels) such as `540x960`.
fn windowed(given: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|n| WINDOW.contains(n));
    let size = given.split_once('x').and_then(|(w, h)| Some([side(w)?, side(h)?]));
    size.ok_or_else(|| {
        format!("give two numbers of pixels from {} to {}, for example 540x960", WINDOW.start(), WINDOW.end())
    })
}

/// Runs `toile kiosk`.
///
/// # Errors
/// Those of the kiosk; a report that cannot be printed.
pub fn run(args: &KioskArgs) -> Result<(), AppError> {
    let begun = Instant::now();
    if args.print_config {
        return terminal::print(toile_kiosk::EXAMPLE_CONFIG);
    }
    let words = Words::new(args.printing.quiet);
    let report = toile_kiosk::run(&options(args), begun, &|line| words.print_line(line))?;
    if args.printing.json {
        terminal::print_json(&Document::new("kiosk", report))
    } else {
        terminal::print(&report.summary())
    }
}

fn options(args: &KioskArgs) -> KioskOptions {
    KioskOptions {
        config: args.config.clone(),
        session: args.session.clone(),
        instance: args.instance.clone(),
        headless: args.headless,
        windowed: args.windowed,
        seconds: args.seconds,
        crash_after: args.crash_after,
        may_lock_memory: doctor::may_lock_all(),
    }
}
