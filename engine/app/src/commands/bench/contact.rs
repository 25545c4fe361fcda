//! `toile bench contact`: cloth against itself, other cloth and the skin, with its targets.

use toile_perf::contact;

use crate::exit::AppError;
use crate::report::Document;
use crate::terminal::{self, Words};

/// Measure contact of cloth with itself, with other cloth and with the skin, against its targets.
///
/// Stacks sheets, drops ten over a cylinder, twists a square metre, lets one sheet slide on another, starts garments in the
/// wrong order, walks the skirt of `bench skirt` against itself, and dresses a mannequin in three layers. Crossings of edges
/// with faces are counted in f64 by a test that shares no code with the engine.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args)]
#[command(after_help = "Example: the sheets alone\n  toile bench contact --case sheet")]
pub struct ContactArgs {
    /// Only the cases whose names contain this
    #[arg(long, value_name = "NAME", conflicts_with = "table")]
    case: Option<String>,
    /// Every case, which is also the default; takes some minutes
    #[arg(long)]
    table: bool,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

/// Runs `toile bench contact`.
///
/// # Errors
/// A name that no case has, and where stdout cannot be written.
pub fn run(args: &ContactArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let table = contact::run(args.case.as_deref(), &mut |case| words.print_line(case)).map_err(AppError::internal)?;
    if table.rows.is_empty() {
        let name = args.case.as_deref().unwrap_or_default();
        return Err(AppError::Usage(format!("no case's name contains {name:?}; leave out --case to run them all")));
    }
    if args.json {
        return terminal::print_json(&Document::new("bench-contact", table));
    }
    terminal::print(&table.markdown())
}
