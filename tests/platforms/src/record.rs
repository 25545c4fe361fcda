//! Writes the recording that every platform steps: the shopper of the embedded session in the default dress.
//!
//! Usage: toile-platforms-record FILE

use std::process::ExitCode;

use toile_assets::{body, drafting, rig, scene};
use toile_base::limits::STEP_SECONDS;
use toile_base::skeleton::Pose;
use toile_engine::colliders::RestSphere;
use toile_platforms::STEPS;
use toile_platforms::dress_recording::DressRecording;

/// Garment and size.
const DRESS: [&str; 2] = ["strap-dress", "38"];

/// Steps in which the body moves from its rest pose into the session's first one.
const DRESS_STEPS: usize = 120;

fn main() -> ExitCode {
    let Some(path) = std::env::args().nth(1) else {
        eprintln!("give the file to write: toile-platforms-record FILE");
        return ExitCode::from(2);
    };
    let body = body::build(scene::SHOPPER.0, &scene::SHOPPER.1).expect("the session's shopper can be built");
    let fitted = rig::fit(&body);
    let spheres = fitted.spheres.iter().map(|s| RestSphere::on_bone(&body.skeleton, s.bone, s.offset, s.radius));
    let style = drafting::style(DRESS[0]).expect("a garment that is drafted");
    let package = style.package().expect("the sizes of its table");
    let garment = package.dress(DRESS[1], &body).expect("a garment that can be worn");
    let rest = Pose::rest(&body.skeleton);
    let first = scene::shopper(&body.skeleton, 0.0);
    let begin = (1..=DRESS_STEPS).map(|step| {
        let t = step as f32 / DRESS_STEPS as f32;
        let local = std::array::from_fn(|i| rest.local[i].slerp(first.local[i], t));
        Pose { root: rest.root.lerp(first.root, t), local }
    });
    let session = (1..=STEPS).map(|step| scene::shopper(&body.skeleton, step as f32 * STEP_SECONDS));
    let poses = begin.chain(session).collect();
    let recording =
        DressRecording { spheres: spheres.collect(), capsules: fitted.capsules.to_vec(), garment, poses, body };
    if let Err(error) = std::fs::write(&path, recording.to_bytes()) {
        eprintln!("{path} cannot be written: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
