//! The commands of `toile-capture`: they turn the pictures of several calibrated cameras into a surface that moves, a pose or a body.

use clap::{Parser, Subcommand};
use toile_cli::exit::AppError;

mod body;
mod body_frames;
mod compare;
mod fabric_scene;
mod face;
mod face_frames;
mod face_picture;
mod flow;
mod found_face;
mod pose;

/// Turn the pictures of several calibrated cameras into motion, a pose, a body or a face.
#[derive(Debug, Parser)]
#[command(
    name = "toile-capture",
    version,
    after_help = "Example: a cloth that was filmed by four cameras, followed from its mesh in the first frame\n  toile capture flow \
                  pictures --calibration cameras.toml --mesh cloth.obj --out captured"
)]
pub struct CommandLine {
    #[command(subcommand)]
    pub command: CaptureCommand,
}

/// What the user asked for. The help of a command is the doc of its arguments, which a doc here would replace.
#[derive(Debug, Clone, PartialEq, Subcommand)]
pub enum CaptureCommand {
    Flow(flow::FlowArgs),
    Pose(pose::PoseArgs),
    Compare(compare::CompareArgs),
    Body(body::BodyCaptureArgs),
    Face(face::FaceArgs),
}

/// Runs a command.
///
/// # Errors
/// As each command says.
pub fn run(command: &CaptureCommand) -> Result<(), AppError> {
    match command {
        CaptureCommand::Flow(args) => flow::run(args),
        CaptureCommand::Pose(args) => pose::run(args),
        CaptureCommand::Compare(args) => compare::run(args),
        CaptureCommand::Body(args) => body::run(args),
        CaptureCommand::Face(args) => face::run(args),
    }
}
