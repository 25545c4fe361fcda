//! The arguments of `toile measure`.

use std::path::PathBuf;

/// Measure the person in a recording or a depth frame.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: get the measures as JSON\n  toile measure shopper.mcap --json")]
pub struct MeasureArgs {
    /// Recording or depth frame
    #[arg(value_name = "F")]
    pub file: PathBuf,
    /// Camera of a raw depth frame, as JSON (default: the recording's own)
    #[arg(long, value_name = "J")]
    pub camera: Option<PathBuf>,
    /// The shopper wears nothing that stands off the skin: the body fit is not one-sided
    #[arg(long)]
    pub tight: bool,
    /// Folder for a picture of the fitted body over the depth
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    pub json: bool,
    /// Print nothing on stderr but errors
    #[arg(long, short)]
    pub quiet: bool,
}
