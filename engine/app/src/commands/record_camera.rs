//! `toile record --camera`: a session of the people before a camera, with their consent.

use std::io::{self, BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Serialize;
use toile_cli::arguments::Printing;
use toile_cli::camera::{self, MountArgs};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFile};
use toile_cli::terminal;
use toile_sensors::source::live::{self, Arrival, CameraFrame, CameraName, CameraRecorder};

use crate::report::{self, SessionReport};

/// Longest that a frame is waited for at once.
const PATIENCE: Duration = Duration::from_millis(50);

/// The body of the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CameraRecordReport {
    /// The camera's own name.
    pub device: String,
    /// The session that was made.
    pub session: SessionReport,
    /// Frames that came, and those that were of no use or did not come.
    pub frames: u64,
    /// Frames that did not come, or were of no use.
    pub dropped: u64,
    /// What the file holds of the person, in words.
    pub holds: &'static str,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// What a session of a camera holds.
const HOLDS: &str = "depth images of the whole view, from which shape, stature and movement of all people in it can be taken; no colour, \
                     no sound, no name";

/// What is recorded, and how.
pub(super) struct CameraRequest<'a> {
    /// The camera.
    pub name: &'a CameraName,
    /// How it is mounted.
    pub mount: &'a MountArgs,
    /// The file.
    pub out: &'a Path,
    /// Length (s).
    pub seconds: u32,
    /// Whether every person in view has agreed already.
    pub consent: bool,
    /// What is printed.
    pub printing: Printing,
}

/// Records, once consent is given.
///
/// # Errors
/// No consent; a camera that cannot be opened or shows nothing; a file that cannot be written.
pub(super) fn run(args: &CameraRequest<'_>) -> Result<(), AppError> {
    if args.name.kind.is_colour() {
        let why = format!("a session holds depth, and {} gives none; record with a depth camera", args.name);
        return Err(AppError::Input(why));
    }
    ask(args.consent)?;
    let out = OutputFile::prepare(args.out, Inputs::default())?;
    let options = args.mount.options(false);
    let mut camera = live::open(args.name, &options).map_err(|e| camera::error(&e))?;
    let device = camera.info().device.clone();
    let mut recorder = CameraRecorder::new(camera.info()).map_err(|e| camera::error(&e))?;
    let words = args.printing.words();
    words.print_line(&format!("recording {device} for {} s", args.seconds));
    let bar = words.bar(u64::from(args.seconds), "recording");
    let (mut frame, begun) = (CameraFrame::default(), Instant::now());
    let length = Duration::from_secs(args.seconds.into());
    while begun.elapsed() < length {
        match camera.read(&mut frame, PATIENCE) {
            // What came before the camera was gone is kept.
            Err(gone) if recorder.frames() > 0 => {
                words.print_line(&format!("the camera was lost; what came before is kept ({gone})"));
                break;
            }
            Err(gone) => return Err(camera::error(&gone)),
            Ok(Arrival::Frame) => {
                let arrived_ns = begun.elapsed().as_nanos() as u64;
                recorder.take(&frame, arrived_ns).map_err(|e| camera::error(&e))?;
                bar.set_position(begun.elapsed().as_secs());
            }
            Ok(Arrival::Nothing) => {}
            Ok(Arrival::Ended) => break,
        }
    }
    bar.finish_and_clear();
    let counts = recorder.counts();
    let session = recorder.finish(&format!("recorded from {device}")).map_err(|e| camera::error(&e))?;
    let files = out.write(&session.to_bytes().map_err(AppError::internal)?)?;
    let dropped = counts.missing + counts.half + counts.repeated + counts.empty;
    let session = report::measures::session(&session, &[]);
    let report = CameraRecordReport { device, session, frames: counts.frames, dropped, holds: HOLDS, files };
    if args.printing.json {
        return terminal::print_json(&Document::new("record", report));
    }
    let path = &report.files[0];
    terminal::print(&format!(
        "{}: {} frames, {dropped} dropped\n  it holds {HOLDS}\n  delete it when it has served\n",
        path.display(),
        report.frames
    ))
}

/// Asks for the consent of the people in view, through the person at the keyboard.
fn ask(given: bool) -> Result<(), AppError> {
    if given {
        return Ok(());
    }
    let refused = || {
        AppError::Usage(
            "recording a person needs their consent; ask all people in view, and add --consent once they agree"
                .to_owned(),
        )
    };
    if !io::stdin().is_terminal() || !io::stderr().is_terminal() {
        return Err(refused());
    }
    let question = format!("The file will hold {HOLDS}.\nDo all people in view agree to be recorded? Type yes: ");
    let mut stderr = io::stderr();
    stderr.write_all(question.as_bytes()).and_then(|()| stderr.flush()).map_err(AppError::internal)?;
    let mut reply = String::new();
    io::stdin().lock().read_line(&mut reply).map_err(AppError::internal)?;
    if reply.trim() == "yes" { Ok(()) } else { Err(refused()) }
}
