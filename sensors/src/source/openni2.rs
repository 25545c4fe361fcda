//! OpenNI 2 recordings (.oni) through libOpenNI2, where it is installed: the depth stream alone, played as fast as it is read.

use std::path::Path;

use toile_assets::file;

use super::camera::{self, DepthCamera};
use super::files::{OpenOptions, shown};
use super::live::library;
use super::openni_library::OpenNiLibrary;
use super::sequence::Sequence;
use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::limits::{CAMERA, MAX_DEPTH_FRAMES};
use crate::session::{Session, too_many};

/// Longest that one frame is waited for (ms): frames are in the file, and come at once.
const PATIENCE_MS: u32 = 2_000;

const CURE: &str = "record it again with an OpenNI 2 program such as NiViewer";

/// Reads a recording.
pub(super) fn read(path: &Path, options: &OpenOptions) -> Result<Session, SourceError> {
    let camera = match &options.camera {
        Some(json) => Some(camera::read(&file::read(json, &CAMERA)?).map_err(|fault| fault.at(&shown(json)))?),
        None => None,
    };
    let mut session = play(path, camera).map_err(|fault| fault.at(&shown(path)))?;
    session.name = path.file_stem().map_or_else(|| "session".to_owned(), |s| s.to_string_lossy().into_owned());
    session.check().map_err(|fault| fault.at(&shown(path)))?;
    Ok(session)
}

fn play(path: &Path, camera: Option<DepthCamera>) -> Result<Session, ReaderFault> {
    let library = OpenNiLibrary::start(&library::folders())?;
    let device = library.open(Some(path.as_os_str().as_encoded_bytes()))?;
    device.play_at_once();
    let mut stream = device.depth()?;
    let frames = stream.number_of_frames().unwrap_or(MAX_DEPTH_FRAMES);
    if frames > MAX_DEPTH_FRAMES {
        return Err(too_many(frames));
    }
    let (mut sequence, mut samples): (Option<Sequence>, _) = (None, Vec::new());
    for _ in 0..frames {
        let Some(frame) = stream.next(PATIENCE_MS) else { break };
        let (time, (width, height, mm_per_unit)) = (frame.time_ns(), frame.shape()?);
        samples.clear();
        if !frame.depth(width, height, &mut samples) {
            return Err(ReaderFault::new(FilePlace::Whole, "a depth image shorter than its size", CURE));
        }
        drop(frame);
        if sequence.is_none() {
            let camera = match camera {
                Some(camera) => camera,
                None => DepthCamera { mm_per_unit, ..DepthCamera::pinhole(stream.intrinsics(width, height)?) },
            };
            sequence = Some(Sequence::new(camera, Vec::new())?);
        }
        if let Some(sequence) = &mut sequence {
            sequence.push(time, samples.iter().copied())?;
        }
    }
    let cut = ReaderFault::new(FilePlace::Whole, "no depth frame can be played", CURE);
    sequence.ok_or(cut)?.finish()
}
