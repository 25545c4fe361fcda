//! `toile record`: makes a synthetic session, such as the embedded one: a moving shopper, rendered as a depth camera would see them.

use std::path::PathBuf;

use clap::value_parser;
use glam::{Affine3A, Vec3};
use toile_assets::scene;
use toile_base::body::Body;
use toile_base::clock::SECOND_NS;
use toile_base::frame::{Intrinsics, Joints};
use toile_base::skeleton::{BONES, JOINTS, Pose};
use toile_cli::arguments::Printing;
use toile_cli::camera::{self, MountArgs};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFile};
use toile_cli::terminal;
use toile_engine::body::{JointFrames, palette};
use toile_engine::skin::SkinningJob;
use toile_engine::world::BLEND;
use toile_sensors::session::Session;
use toile_sensors::source::live::CameraName;
use toile_sensors::source::synthetic::{JointNoise, KinectNoise, SyntheticCamera};

use super::record_camera::{self, CameraRequest};
use crate::report::{self, RecordReport};

/// Longest session that `record` makes (s); at 30 frames a second this is some hundred megabytes.
const MAX_SECONDS: i64 = 600;

/// Length of the embedded session (s), [`toile_assets::scene::LENGTH_S`] as the command line wants it.
const DEFAULT_SECONDS: &str = "10";
const _: () = assert!(scene::LENGTH_S == 10.0);

/// Record a session: from a live camera, or a synthetic one such as the embedded one.
///
/// With --camera it records the people before a depth camera, once they have agreed. Without, it renders what a depth camera would see of a moving body, with the camera's noise, and writes it as a session. Without
/// --seed and --seconds it makes the session that is embedded in the program.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: make another session and watch it\n  toile record --out other.mcap --seed 7 && toile \
                        try-on --session other.mcap"
)]
pub struct RecordArgs {
    /// Session file to write
    #[arg(long, value_name = "F.mcap")]
    pub out: PathBuf,
    /// Seed of the noise; the same seed gives the same bits
    #[arg(long, value_name = "N", default_value = "1")]
    pub seed: u64,
    /// Length in seconds
    #[arg(long, value_name = "S", value_parser = value_parser!(u32).range(1..=MAX_SECONDS), default_value = DEFAULT_SECONDS)]
    pub seconds: u32,
    /// Camera to record from, as `toile live` names them (default: the synthetic shopper)
    #[arg(long, value_name = "C", value_parser = camera::name, conflicts_with = "seed")]
    pub camera: Option<CameraName>,
    /// All people in view have agreed to be recorded; without it, it is asked
    #[arg(long, requires = "camera")]
    pub consent: bool,
    /// How the camera is mounted
    #[command(flatten)]
    pub mount: MountArgs,
    #[command(flatten)]
    printing: Printing,
}

/// Frames a second of the synthetic sensor, a Kinect's.
const SENSOR_HZ: u64 = 30;

/// The synthetic camera: a Kinect's field of view at half its resolution, upright so that a whole person fits, which
/// keeps the embedded session small.
const CAMERA: Intrinsics = Intrinsics { width: 480, height: 640, fx: 575.8, fy: 575.8, cx: 239.5, cy: 319.5 };

/// Runs `toile record`.
///
/// # Errors
/// An output file that cannot be written, or a closed stdout.
pub fn run(args: &RecordArgs) -> Result<(), AppError> {
    if let Some(camera) = &args.camera {
        let RecordArgs { out, seconds, consent, mount, printing, .. } = args;
        let (seconds, consent, printing) = (*seconds, *consent, *printing);
        return record_camera::run(&CameraRequest { name: camera, mount, out, seconds, consent, printing });
    }
    let words = args.printing.words();
    let out = OutputFile::prepare(&args.out, Inputs::default())?;
    let frames = u64::from(args.seconds) * SENSOR_HZ;
    let bar = words.bar(frames, "recording");
    let session = perform(args.seed, frames, || bar.inc(1))?;
    bar.finish_and_clear();
    let files = out.write(&session.to_bytes().map_err(AppError::internal)?)?;
    let report = RecordReport { session: report::measures::session(&session, &[]), seed: args.seed, files };
    if args.printing.json {
        return terminal::print_json(&Document::new("record", report));
    }
    let (path, bytes) = (&report.files[0], report.files[0].metadata().map_or(0, |m| m.len()));
    terminal::print(&format!("{}: {} frames, {} KiB\n", path.display(), frames, bytes / 1024))
}

/// Lets the shopper of the scene perform before the synthetic camera. The same seed gives the same bits.
pub fn perform(seed: u64, frames: u64, mut done: impl FnMut()) -> Result<Session, AppError> {
    let (sex, measures) = scene::SHOPPER;
    let body = toile_assets::body::build(sex, &measures).map_err(AppError::internal)?;
    let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights).map_err(AppError::internal)?;
    let camera = SyntheticCamera::looking_at(CAMERA, scene::CAMERA[0], scene::CAMERA[1]);
    let (mut depth_noise, mut joint_noise) = (KinectNoise::new(seed), JointNoise::new(seed ^ 0x5eed));
    let (mut skin, mut normals, mut posed) = (body.mesh.positions.clone(), body.normals.clone(), job.posed());
    let mut z = vec![0.0f32; (CAMERA.width * CAMERA.height) as usize];
    let mut bones = [Affine3A::IDENTITY; BONES];
    let (mut joints, mut depth) = (Vec::new(), Vec::new());
    for frame in 0..frames {
        let time_ns = frame * SECOND_NS / SENSOR_HZ;
        let pose = scene::shopper(&body.skeleton, frame as f32 / SENSOR_HZ as f32);
        palette(&body.skeleton, &pose, &mut bones);
        job.run(BLEND, &bones, &mut posed);
        posed.read(&mut skin, &mut normals);
        camera.render(&skin, &body.mesh.triangles, &mut z);
        depth.push(camera.frame(time_ns, depth_noise.apply(&CAMERA, &z)));
        joints.push(joint_noise.apply(&truth(&body, &pose, time_ns)));
        done();
    }
    Ok(Session { name: "synthetic shopper".into(), joints, depth, notes: Vec::new(), raw_scale_known: true })
}

/// Where the joints really are.
fn truth(body: &Body, pose: &Pose, time_ns: u64) -> Joints {
    let at: [Vec3; JOINTS] = JointFrames::new(&body.skeleton, pose).position;
    Joints::seen(time_ns, at)
}
