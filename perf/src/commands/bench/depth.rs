//! `toile bench depth`: from a depth frame to the shopper's clean points.

use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal::{self, Words};
use toile_perf::depth;

/// Time every stage from a depth frame to the shopper's clean points, with the errors of the same run.
///
/// Renders people in a room as depth cameras of three sizes see them, with a Kinect's noise, and reports the time of each
/// stage (shopper found, holes filled, noise smoothed, points and normals), and the noise before and after, the blur of an
/// edge, pixels of others that leak in, and pixels of the shopper that are missed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::Args)]
#[command(after_help = "Example: the table of docs/depth.md\n  toile bench depth --table")]
pub struct DepthArgs {
    /// As a table, which is the default
    #[arg(long)]
    table: bool,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

/// Runs `toile bench depth`.
///
/// # Errors
/// Where the scene's people cannot be made, and where stdout cannot be written.
pub fn run(args: &DepthArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let table = depth::run(&mut |case| words.print_line(case)).map_err(AppError::internal)?;
    if args.json {
        return terminal::print_json(&Document::new("bench-depth", table));
    }
    terminal::print(&table.markdown())
}
