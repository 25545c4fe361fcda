//! `toile bench`: what one part of the frame costs, with the error at that speed.

use clap::Subcommand;

use crate::exit::AppError;

mod body;
mod depth;
mod filters;
mod gestures;
mod measure;
mod skinning;
mod skirt;

/// Time one part of the frame, with the error at that speed.
#[derive(Debug, Clone, PartialEq, Subcommand)]
#[command(after_help = "Example: the cost of a step of cloth, with its strain\n  toile bench skirt --motion walk")]
pub enum BenchCommand {
    /// `toile bench skinning`.
    Skinning(skinning::SkinningArgs),
    /// `toile bench skirt`.
    Skirt(skirt::SkirtArgs),
    /// `toile bench body`.
    Body(body::BodyBenchArgs),
    /// `toile bench measure`.
    Measure(measure::MeasureBenchArgs),
    /// `toile bench filters`.
    Filters(filters::FiltersArgs),
    /// `toile bench gestures`.
    Gestures(gestures::GesturesArgs),
    /// `toile bench depth`.
    Depth(depth::DepthArgs),
}

/// Runs `toile bench`.
///
/// # Errors
/// As each benchmark says.
pub fn run(command: &BenchCommand) -> Result<(), AppError> {
    match command {
        BenchCommand::Skinning(args) => skinning::run(args),
        BenchCommand::Skirt(args) => skirt::run(args),
        BenchCommand::Body(args) => body::run(args),
        BenchCommand::Measure(args) => measure::run(args),
        BenchCommand::Filters(args) => filters::run(args),
        BenchCommand::Gestures(args) => gestures::run(args),
        BenchCommand::Depth(args) => depth::run(args),
    }
}
