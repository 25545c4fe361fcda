//! `toile bench`: what one part of the frame costs, with the error at that speed.

use clap::Subcommand;
use toile_cli::exit::AppError;

pub(super) mod backend;
mod contact;
mod depth;
mod drape;
mod measure;
mod skinning;
mod skinning_report;
mod skirt;
mod skirt_summary;
mod tablecloth;
mod worn_summary;

/// Time one part of the frame, with the error at that speed.
#[derive(Debug, Clone, PartialEq, Subcommand)]
#[command(after_help = "Example: the cost of a step of cloth, with its strain\n  toile bench skirt --motion walk")]
pub enum BenchCommand {
    Skinning(skinning::SkinningArgs),
    Skirt(skirt::SkirtArgs),
    Measure(measure::MeasureBenchArgs),
    Depth(depth::DepthArgs),
    Contact(contact::ContactArgs),
    Drape(drape::DrapeArgs),
    Tablecloth(tablecloth::TableclothArgs),
}

/// Runs `toile bench`.
///
/// # Errors
/// As each benchmark says.
pub fn run(command: &BenchCommand) -> Result<(), AppError> {
    match command {
        BenchCommand::Skinning(args) => skinning::run(args),
        BenchCommand::Skirt(args) => skirt::run(args),
        BenchCommand::Measure(args) => measure::run(args),
        BenchCommand::Depth(args) => depth::run(args),
        BenchCommand::Contact(args) => contact::run(args),
        BenchCommand::Drape(args) => drape::run(args),
        BenchCommand::Tablecloth(args) => tablecloth::run(args),
    }
}
