//! `toile bench filters`: jitter, lag and overshoot of the filters of joints.

use std::path::PathBuf;

use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal::{self, Words};
use toile_perf::filters::{self, FiltersError};

/// Measure jitter, lag and overshoot of the filters of joints, and the slide of feet.
///
/// Shows each filter the same motions, whose truth is known, under a sensor's noise, and reports how much a resting joint
/// trembles, how late a moving one comes, and how far it passes its goal. With a folder of recordings it does the same with
/// recorded waves, and reports how far planted feet slide and whether jumps leave the floor.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args)]
#[command(after_help = "Example: compare all filters\n  toile bench filters --table --data recordings")]
pub struct FiltersArgs {
    /// Folder of recordings (default: the environment's TOILE_DATA, if set)
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Measure every filter; takes a minute
    #[arg(long)]
    table: bool,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

/// Runs `toile bench filters`.
///
/// # Errors
/// Where a recording cannot be read, and where stdout cannot be written.
pub fn run(args: &FiltersArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let data = args.data.clone().or_else(|| std::env::var_os("TOILE_DATA").map(PathBuf::from));
    let table = filters::table::run(data.as_deref(), args.table, &mut |case| words.print_line(case));
    let table = table.map_err(|error| match error {
        FiltersError::Source(error) => AppError::input(error),
        FiltersError::Body(error) => AppError::internal(error),
    })?;
    if args.json {
        return terminal::print_json(&Document::new("bench-filters", table));
    }
    terminal::print(&table.markdown())
}
