//! Recordings of a Kinect v1 by libfreenect's `fakenect-record`: a folder with INDEX.txt, which names colour, depth and
//! motion in the order of their coming; depth is read, the rest is passed over.
//!
//! Read here and not through libfreenect's own player, because that ends the process at the first broken file, takes the
//! folder from the environment, and plays no faster than it was recorded.

use std::path::Path;

use toile_assets::file;

use super::camera::{self, DepthCamera};
use super::files::{OpenOptions, count_bytes, shown};
use super::sequence::Sequence;
use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::limits::{CAMERA, MAX_FOLDER_FILES, RECORDING};
use crate::session::Session;
use toile_base::clock::SECOND_NS;
use toile_base::frame::Intrinsics;

/// The list of a recording's files.
pub(super) const INDEX: &str = "INDEX.txt";

/// Raw values from this on are no reading (2047), or nearer than infinity by less than the sensor can tell.
const NO_READING: u16 = 1_084;

const CURE: &str = "record it again with fakenect-record";

/// Reads all depth images of a recording.
pub(super) fn read(folder: &Path, options: &OpenOptions) -> Result<Session, SourceError> {
    let index = folder.join(INDEX);
    let text = file::read(&index, &RECORDING)?;
    let names = names(&text).map_err(|fault| fault.at(&shown(&index)))?;
    let mut notes =
        vec!["raw 11-bit readings were turned into millimetres by the Kinect v1's usual formula".to_owned()];
    let camera = match &options.camera {
        Some(json) => camera::read(&file::read(json, &CAMERA)?).map_err(|fault| fault.at(&shown(json)))?,
        None => {
            notes.push("no camera was given: a Kinect v1 is assumed (f = 575.8 px, centred)".to_owned());
            DepthCamera::pinhole(Intrinsics::KINECT_V1)
        }
    };
    let mut sequence = Sequence::new(camera, notes).map_err(|fault| fault.at(&shown(folder)))?;
    let mut total = 0;
    for (time_ns, name) in names {
        let image = folder.join(name);
        let bytes = file::read(&image, &RECORDING)?;
        count_bytes(&mut total, &bytes).map_err(|fault| fault.at(&shown(folder)))?;
        let at = |fault: ReaderFault| fault.at(&shown(&image));
        let samples = samples(&bytes, &sequence.sensor()).map_err(at)?;
        let millimetres = samples.chunks_exact(2).map(|b| millimetres(u16::from_le_bytes([b[0], b[1]])));
        sequence.push(time_ns, millimetres).map_err(at)?;
    }
    let mut session = sequence.finish().map_err(|fault| fault.at(&shown(folder)))?;
    session.name = folder.file_name().map_or_else(|| "session".to_owned(), |n| n.to_string_lossy().into_owned());
    session.check().map_err(|fault| fault.at(&shown(folder)))?;
    Ok(session)
}

/// Depth images of an index and their times, the seconds in their names: `d-SECONDS-TICKS.pgm`.
fn names(text: &[u8]) -> Result<Vec<(u64, &str)>, ReaderFault> {
    let text =
        std::str::from_utf8(text).map_err(|_| ReaderFault::new(FilePlace::Whole, "the index is no text", CURE))?;
    let mut names = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        let Some(rest) = line.strip_prefix("d-") else { continue };
        let seconds = rest.split('-').next().and_then(|s| s.parse::<f64>().ok());
        let seconds = seconds.filter(|s| (0.0..1e11).contains(s));
        // A name leads to a file beside the index, and nowhere else.
        let (Some(seconds), false) = (seconds, line.contains(['/', '\\'])) else {
            return Err(ReaderFault::new(FilePlace::Line(i + 1), "no name of a depth image with its time", CURE));
        };
        if names.len() >= MAX_FOLDER_FILES {
            let problem = format!("more than {MAX_FOLDER_FILES} depth images");
            return Err(ReaderFault::new(FilePlace::Line(i + 1), problem, "cut the recording into shorter pieces"));
        }
        names.push(((seconds * SECOND_NS as f64) as u64, line));
    }
    Ok(names)
}

/// The samples of a PGM as the recorder writes it: a header of one line, then little-endian words, which a PGM's should not
/// be.
fn samples<'a>(bytes: &'a [u8], camera: &Intrinsics) -> Result<&'a [u8], ReaderFault> {
    let head = &bytes[..bytes.len().min(64)];
    let end = head.iter().position(|b| *b == b'\n').filter(|_| head.starts_with(b"P5"));
    let end = end.ok_or_else(|| ReaderFault::new(FilePlace::Byte(0), "no PGM header of one line", CURE))?;
    let samples = &bytes[end + 1..];
    if samples.len() != camera.pixels() * 2 {
        let (w, h) = (camera.width, camera.height);
        let problem = format!("{} bytes are no image of {w} x {h} pixels", samples.len());
        return Err(ReaderFault::new(FilePlace::Byte(end as u64 + 1), problem, CURE));
    }
    Ok(samples)
}

/// Depth of a raw reading (mm), linear in its inverse, with the constants that the Kinect's users calibrated (OpenKinect);
/// 0 where there is no reading.
pub(super) fn millimetres(raw: u16) -> u16 {
    if raw >= NO_READING {
        return 0;
    }
    (1000.0 / (3.330_949_5 - 0.003_071_101_6 * f32::from(raw))).round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_become_millimetres() {
        assert_eq!([millimetres(2047), millimetres(1084)], [0, 0]);
        // 1 m and 2 m lie at about 759 and 922, where a step is 3 and 12 mm.
        assert!(millimetres(759).abs_diff(1000) < 4 && millimetres(922).abs_diff(2000) < 20);
        assert!((1..1084).all(|raw| millimetres(raw) >= millimetres(raw - 1)));
    }

    #[test]
    fn an_index_names_depth_images_beside_it_and_no_other_files() {
        let index =
            b"r-1300399331.4-123.ppm\nd-1300399331.5-124.pgm\na-1300399331.5-124.dump\nd-1300399331.6-125.pgm\n";
        let names = names(index).unwrap();
        assert_eq!(names.iter().map(|n| n.1).collect::<Vec<_>>(), ["d-1300399331.5-124.pgm", "d-1300399331.6-125.pgm"]);
        assert!((names[1].0 - names[0].0).abs_diff(100_000_000) < 1_000);
        for bad in [&b"d-1-/etc/passwd"[..], b"d-x-1.pgm", b"d-nan-1.pgm", b"d--1.pgm", b"\xff"] {
            assert!(super::names(bad).is_err(), "{bad:?}");
        }
    }
}
