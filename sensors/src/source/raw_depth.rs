//! Raw depth: images of 16-bit little-endian millimetres, one after the other, 0 = nothing measured.

use super::camera::DepthCamera;
use super::sequence::{Sequence, assumed_time, untimed};
use crate::error::{FilePlace, ReaderFault};
use crate::limits::MAX_DEPTH_FRAMES;
use crate::session::{Session, too_many};
use toile_base::frame::Intrinsics;

/// Bytes of an image of the Kinect v1, by which a file without a camera is recognised.
pub(super) const KINECT_V1_BYTES: u64 = 640 * 480 * 2;

/// The camera that is assumed where none is given, and what is said of that.
pub(super) fn assumed_camera(notes: &mut Vec<String>) -> DepthCamera {
    let note = "no camera was given: a Kinect v1 is assumed (640 x 480, f = 575.8 px, centred); sizes depend on it";
    notes.push(note.to_owned());
    DepthCamera::pinhole(Intrinsics::KINECT_V1)
}

pub(super) fn read(bytes: &[u8], camera: Option<DepthCamera>) -> Result<Session, ReaderFault> {
    let mut notes = Vec::new();
    let camera = camera.unwrap_or_else(|| assumed_camera(&mut notes));
    let image = camera.intrinsics.pixels() * 2;
    if bytes.is_empty() || !bytes.len().is_multiple_of(image) {
        let (w, h) = (camera.intrinsics.width, camera.intrinsics.height);
        let problem = format!("{} bytes are not a number of images of {w} x {h} x 2 bytes", bytes.len());
        let cure = "give the camera JSON that fits, or the complete file";
        return Err(ReaderFault::new(FilePlace::Byte(bytes.len() as u64), problem, cure));
    }
    if bytes.len() / image > MAX_DEPTH_FRAMES {
        return Err(too_many(bytes.len() / image));
    }
    if bytes.len() > image {
        notes.push(untimed(bytes.len() / image));
    }
    let mut sequence = Sequence::new(camera, notes)?;
    for (i, image) in bytes.chunks_exact(image).enumerate() {
        sequence.push(assumed_time(i), samples(image))?;
    }
    sequence.finish()
}

/// Samples of a raw image.
pub(super) fn samples(bytes: &[u8]) -> impl ExactSizeIterator<Item = u16> {
    bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]]))
}
