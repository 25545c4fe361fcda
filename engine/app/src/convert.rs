//! `toile convert`: any supported recording as a session, without pictures of anybody unless they are asked for.

use std::path::{Path, PathBuf};

use toile_assets::sizes::Population;
use toile_sensors::segment::Segmenter;
use toile_sensors::session::Session;
use toile_sensors::source::{self, OpenOptions};

use crate::cli::{ConvertArgs, KeptDepth};
use crate::exit::AppError;
use crate::output::OutputFolder;
use crate::report::{ConvertReport, Document};
use crate::shopper::session_report;
use crate::terminal;
use crate::tracking;

/// Runs `toile convert`.
///
/// # Errors
/// A recording that cannot be read or of which nothing would be left, a file that cannot be written, a closed stdout.
pub fn run(args: &ConvertArgs) -> Result<(), AppError> {
    let (folder, name) = place(&args.out)?;
    let mut session =
        source::open(&args.input, &OpenOptions { camera: args.camera.clone() }).map_err(AppError::input)?;
    let dropped = session.depth.len();
    if args.fit && session.joints.is_empty() && !session.depth.is_empty() {
        session.joints = tracking::joints(&session, Population::Mixed)?.1;
        session.notes.push("the joints are those of the body fitted to the depth".to_owned());
    }
    keep(&mut session, args.depth);
    if session.joints.is_empty() && session.depth.is_empty() {
        return Err(AppError::input(format!(
            "{}: holds depth images alone, which show a person; give --fit to keep the joints that they show, or --depth \
             shopper or --depth all to keep the images",
            args.input.display()
        )));
    }
    let bytes = session.to_bytes().map_err(AppError::input)?;
    let mut out = OutputFolder::prepare(&folder)?;
    out.write(&name, &bytes)?;
    let report = ConvertReport {
        session: session_report(&session, &[]),
        joint_frames: session.joints.len() as u64,
        depth_frames: session.depth.len() as u64,
        depth_frames_left_out: (dropped - session.depth.len()) as u64,
        files: out.commit()?,
    };
    if args.json {
        return terminal::print_json(&Document::new("convert", report));
    }
    terminal::print(&told(&report, bytes.len()))
}

/// Leaves of a session's depth what is asked for.
fn keep(session: &mut Session, depth: KeptDepth) {
    match depth {
        KeptDepth::All => {}
        KeptDepth::None => session.depth.clear(),
        KeptDepth::Shopper => {
            let mut segmenter = Segmenter::default();
            for frame in &mut session.depth {
                let mask = segmenter.push(frame).mask.to_vec();
                frame.depth_mm.iter_mut().zip(mask).for_each(|(d, m)| *d *= u16::from(m));
            }
            session.notes.push("only the shopper's depth was kept".to_owned());
        }
    }
}

fn place(out: &Path) -> Result<(PathBuf, String), AppError> {
    let name = out.file_name().and_then(|n| n.to_str());
    let name = name.ok_or_else(|| {
        AppError::Usage(format!("`--out {}` names no file; give one such as shopper.mcap", out.display()))
    })?;
    let folder = out.parent().filter(|p| !p.as_os_str().is_empty());
    Ok((folder.map_or_else(|| ".".into(), Path::to_path_buf), name.to_owned()))
}

fn told(report: &ConvertReport, bytes: usize) -> String {
    let mut text = format!(
        "{}: {} joint frames, {} depth frames, {} KiB\n",
        report.files[0].display(),
        report.joint_frames,
        report.depth_frames,
        bytes / 1024
    );
    if report.depth_frames_left_out > 0 {
        text += &format!("  {} depth frames were left out; --depth keeps them\n", report.depth_frames_left_out);
    }
    for note in &report.session.notes {
        text += &format!("  {note}\n");
    }
    text
}
