//! Recordings of real sensors: one file a format, recognised by content.
//!
//! | kind | recognised by |
//! |---|---|
//! | Toile session (MCAP) | the MCAP magic |
//! | Kinect v1 or v2 joints | text whose lines are 81 or 101 numbers |
//! | Kinectron recording, JSON | text that begins with `[` |
//! | Azure Kinect bodies, JSON | a JSON object, or lines of them, that names `timestamp_usec` or its bones |
//! | MediaPipe landmarks, JSON | JSON that names `...andmarks` |
//! | OpenPose keypoints, JSON | a folder with a calibration (`.toml`) and a folder of JSON files for each camera |
//! | BVH motion capture | text that begins with `HIERARCHY` |
//! | Azure Kinect recording (MKV) | the EBML magic; its depth alone is read |
//! | 16-bit grey PNG | the PNG magic; a folder of them is a sequence |
//! | OpenNI 2 recording (ONI) | its magic; read through libOpenNI2 where that is installed |
//! | fakenect recording | a folder with INDEX.txt |
//! | raw 16-bit depth | none of these, and a camera is given or the size is that of 640x480 images |

mod align;
mod azure;
mod azure_calibration;
mod azure_mkv;
mod bvh;
mod bvh_file;
mod bvh_names;
mod bvh_pose;
mod camera;
mod depth_converter;
mod ebml;
mod fakenect;
mod files;
mod folder;
pub mod joint_map;
mod kinect2;
mod kinect_csv;
mod kinectron;
pub mod live;
mod mediapipe;
mod mediapipe_landmarks;
mod mediapipe_place;
mod openni2;
mod openni_library;
pub mod openpose;
mod placement;
mod png_depth;
mod raw_depth;
mod sequence;
mod straighten;
pub mod synthetic;
mod tidy;
pub mod vmc;

use std::path::Path;

use toile_assets::file;

use crate::limits::{CAMERA, RECORDING};
use files::shown;

pub use crate::error::{FilePlace, SourceError};
pub use crate::session::Session;
pub use files::OpenOptions;

/// Opens a recording of any known kind: a file, or the folder of a multi-view recording.
///
/// # Errors
/// One sentence with the path, the place and the cure where the file cannot be read, is of an unknown kind, or is wrong.
pub fn open(path: &Path, options: &OpenOptions) -> Result<Session, SourceError> {
    if path.is_dir() {
        if openpose::recognises(path)? {
            return openpose::open(path);
        }
        return folder::read(path, options);
    }
    let bytes = file::read(path, &RECORDING)?;
    if bytes.starts_with(ONI_MAGIC) {
        return openni2::read(path, options);
    }
    let camera = match &options.camera {
        Some(json) => Some((shown(json), file::read(json, &CAMERA)?)),
        None => None,
    };
    let name = path.file_stem().map_or_else(|| "session".to_owned(), |s| s.to_string_lossy().into_owned());
    read_bytes(&shown(path), &name, &bytes, camera.as_ref().map(|(path, bytes)| (path.as_str(), bytes.as_slice())))
}

/// Reads a recording of any known kind from memory; `path` appears in errors, `camera` is a camera JSON with its path.
///
/// # Errors
/// As [`open`].
pub fn read_bytes(path: &str, name: &str, bytes: &[u8], camera: Option<(&str, &[u8])>) -> Result<Session, SourceError> {
    let unknown = |what| SourceError::UnknownKind { path: path.to_owned(), what };
    let result = match recognise(bytes, camera.is_some()).map_err(unknown)? {
        RecordingKind::Session => return crate::session::read(path, bytes),
        RecordingKind::KinectCsv => kinect_csv::read(bytes),
        RecordingKind::Kinectron => kinectron::read(bytes),
        RecordingKind::Azure => azure::read(bytes),
        RecordingKind::MediaPipe => mediapipe::read(bytes),
        RecordingKind::Bvh => bvh::read(bytes),
        depth => {
            let camera = match camera {
                Some((json, bytes)) => Some(camera::read(bytes).map_err(|fault| fault.at(json))?),
                None => None,
            };
            match depth {
                RecordingKind::AzureMkv => azure_mkv::read(bytes, camera),
                RecordingKind::Png => png_depth::read(bytes, camera),
                _ => raw_depth::read(bytes, camera),
            }
        }
    };
    let mut session = result.map_err(|fault| fault.at(path))?;
    name.clone_into(&mut session.name);
    session.check().map_err(|fault| fault.at(path))?;
    Ok(session)
}

/// First bytes of an OpenNI recording.
const ONI_MAGIC: &[u8] = b"NI10";

/// Message for an OpenNI recording that cannot be read.
const OPENNI: &str = "an OpenNI recording, which is read from a file and not from memory";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RecordingKind {
    Session,
    KinectCsv,
    Kinectron,
    Azure,
    MediaPipe,
    Bvh,
    AzureMkv,
    Png,
    RawDepth,
}

/// What a file is, by its first bytes; else what it looks like. `has_camera` says that a camera was given for it.
fn recognise(bytes: &[u8], has_camera: bool) -> Result<RecordingKind, &'static str> {
    if bytes.is_empty() {
        return Err("the file is empty");
    }
    if bytes.starts_with(b"\x89MCAP") {
        return Ok(RecordingKind::Session);
    }
    if bytes.starts_with(b"\x1a\x45\xdf\xa3") {
        return Ok(RecordingKind::AzureMkv);
    }
    if bytes.starts_with(png_depth::MAGIC) {
        return Ok(RecordingKind::Png);
    }
    if bytes.starts_with(ONI_MAGIC) {
        return Err(OPENNI);
    }
    let head = &bytes[..bytes.len().min(4096)];
    let text =
        if is_text(head) { recognise_text(head) } else { Err("binary of no known kind, and no camera is given") };
    match text {
        // A file of no other kind is depth if the caller says which camera took it.
        Err(_) if has_camera => Ok(RecordingKind::RawDepth),
        Err(_) if !is_text(head) && (bytes.len() as u64).is_multiple_of(raw_depth::KINECT_V1_BYTES) => {
            Ok(RecordingKind::RawDepth)
        }
        other => other,
    }
}

fn recognise_text(head: &[u8]) -> Result<RecordingKind, &'static str> {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    match text.first() {
        None => Err("the file holds only white space"),
        Some(b'[' | b'{') if mediapipe::recognises(text) => Ok(RecordingKind::MediaPipe),
        Some(b'[') => Ok(RecordingKind::Kinectron),
        Some(b'{') if azure::recognises(text) => Ok(RecordingKind::Azure),
        Some(b'{') if text.windows(9).any(|w| w == b"keypoints") => Err(ONE_VIEW),
        Some(b'{') => Err("a JSON object, perhaps a camera: give it beside its raw depth file, not instead"),
        Some(_) if text.starts_with(b"HIERARCHY") => Ok(RecordingKind::Bvh),
        Some(c) if (c.is_ascii_digit() || b"+-.".contains(c)) && text.iter().any(|c| b", ".contains(c)) => {
            Ok(RecordingKind::KinectCsv)
        }
        Some(_) => Err("text of no known kind"),
    }
}

const ONE_VIEW: &str = "these are the keypoints of one view, which have no depth: give the folder of all cameras with \
                        their calibration";

fn is_text(head: &[u8]) -> bool {
    head.iter().all(|b| *b >= 0x20 || b"\t\n\r".contains(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_recognised_by_content() {
        assert_eq!(recognise(b"\x89MCAP0\r\n", false), Ok(RecordingKind::Session));
        assert_eq!(recognise(b"HIERARCHY\nROOT", false), Ok(RecordingKind::Bvh));
        assert_eq!(recognise(b"\xef\xbb\xbf [{}]", false), Ok(RecordingKind::Kinectron));
        assert_eq!(recognise(b"123,0.5,", false), Ok(RecordingKind::KinectCsv));
        assert_eq!(recognise(b"\x1a\x45\xdf\xa3", true), Ok(RecordingKind::AzureMkv));
        assert_eq!(recognise(png_depth::MAGIC, true), Ok(RecordingKind::Png));
        assert_eq!(recognise(&[0; 614_400], false), Ok(RecordingKind::RawDepth));
        assert_eq!(recognise(&[0; 8], true), Ok(RecordingKind::RawDepth));
        assert_eq!(recognise(b"123,0.5,", true), Ok(RecordingKind::KinectCsv));
        for other in [&b""[..], b"  \n", b"{}", b"hello", b"NI10\x01\0\0\0", &[0; 614_401]] {
            assert!(recognise(other, false).is_err(), "{other:?}");
        }
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = open(Path::new("no/such.csv"), &OpenOptions::default()).unwrap_err();
        assert!(error.to_string().starts_with("no/such.csv: cannot be read"));
    }
}
