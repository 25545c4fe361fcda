//! `toile capture`: what several calibrated cameras saw becomes a surface that moves, a pose or a body.
//!
//! Reads: calibrations, pictures, meshes, keypoints. Writes: meshes, joints, reports into an output folder; figures on stdout.
//! Budget: offline: about a second a frame.
//! Thread: the main thread, and those that a capture starts.

use clap::Subcommand;

use crate::exit::AppError;

pub(crate) mod body;
mod body_frames;
pub(crate) mod compare;
mod fabric_scene;
pub(crate) mod face;
mod face_frames;
mod face_picture;
pub(crate) mod flow;
mod found_face;
pub(crate) mod pose;

/// Turn the pictures of several calibrated cameras into motion, a pose, a body or a face.
#[derive(Debug, Clone, PartialEq, Subcommand)]
#[command(
    after_help = "Example: a cloth that was filmed by four cameras, followed from its mesh in the first frame\n  toile capture flow \
                  pictures --calibration cameras.toml --mesh cloth.obj --out captured"
)]
pub(crate) enum CaptureCommand {
    Flow(flow::FlowArgs),
    Pose(pose::PoseArgs),
    Compare(compare::CompareArgs),
    Body(body::BodyCaptureArgs),
    Face(face::FaceArgs),
}

/// Runs `toile capture`.
///
/// # Errors
/// As each command says.
pub(crate) fn run(command: &CaptureCommand) -> Result<(), AppError> {
    match command {
        CaptureCommand::Flow(args) => flow::run(args),
        CaptureCommand::Pose(args) => pose::run(args),
        CaptureCommand::Compare(args) => compare::run(args),
        CaptureCommand::Body(args) => body::run(args),
        CaptureCommand::Face(args) => face::run(args),
    }
}
