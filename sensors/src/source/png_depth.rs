//! Depth in 16-bit grey PNG images.

use std::io::Cursor;

use super::camera::DepthCamera;
use super::raw_depth::assumed_camera;
use super::sequence::{Sequence, assumed_time};
use crate::error::{FilePlace, ReaderFault};
use crate::session::Session;
use toile_base::frame::Intrinsics;

/// First bytes of a PNG.
pub(super) const MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";

const CURE: &str = "export depth as 16-bit grey PNG, one channel, in millimetres";

/// Reads one image.
pub(super) fn read(bytes: &[u8], camera: Option<DepthCamera>) -> Result<Session, ReaderFault> {
    let mut notes = Vec::new();
    let camera = camera.unwrap_or_else(|| assumed_camera(&mut notes));
    let mut sequence = Sequence::new(camera, notes)?;
    let samples = decode(bytes, &sequence.sensor())?;
    sequence.push(assumed_time(0), samples.into_iter())?;
    sequence.finish()
}

/// The samples of an image of the camera's size, which is checked before memory is taken.
pub(super) fn decode(bytes: &[u8], camera: &Intrinsics) -> Result<Vec<u16>, ReaderFault> {
    let whole = |problem| ReaderFault::new(FilePlace::Whole, problem, CURE);
    let broken = |e: png::DecodingError| whole(format!("the PNG is broken ({e})"));
    let size = camera.pixels() * 2;
    let limits = png::Limits { bytes: 2 * size + (1 << 20) };
    let mut reader = png::Decoder::new_with_limits(Cursor::new(bytes), limits).read_info().map_err(broken)?;
    if reader.output_color_type() != (png::ColorType::Grayscale, png::BitDepth::Sixteen) {
        return Err(whole("the PNG is not 16-bit grey: colour and 8 bits hold no depth".to_owned()));
    }
    let (w, h) = (reader.info().width, reader.info().height);
    if (w, h) != (camera.width, camera.height) {
        let problem = format!("the PNG has {w} x {h} pixels where the camera has {} x {}", camera.width, camera.height);
        return Err(ReaderFault::new(FilePlace::Whole, problem, "give the camera JSON that fits"));
    }
    let mut samples = vec![0; size];
    reader.next_frame(&mut samples).map_err(broken)?;
    Ok(samples.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect())
}
