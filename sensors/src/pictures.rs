//! Pictures of several cameras, frame by frame: folders of PNG and JPEG files.
//!
//! A folder holds one folder a camera, in the order of the cameras' names; a file is a frame, numbered by the last digits of its
//! name. All cameras have the same frames, without a gap. Files are decoded when they are asked for, one at a time.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageReader, Limits, RgbImage};
use toile_assets::file::{self, FileKind};

use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::limits::MAX_CAMERAS;
use toile_base::limits::MAX_SIDE;

/// Largest file of one picture.
pub(crate) const PICTURE: FileKind =
    FileKind { name: "a picture", max_bytes: 128 << 20, cure: "save it as a PNG or JPEG of ordinary size" };

/// Most frames of a sequence: an hour at 30 Hz.
pub const MAX_FRAMES: usize = 108_000;

/// Most bytes that decoding one picture may take.
const MAX_DECODED_BYTES: u64 = 4 * (MAX_SIDE as u64) * (MAX_SIDE as u64);

const CURE: &str = "give a folder of numbered PNG or JPEG files for each camera, in the order of the cameras' names";

/// The files of one camera.
#[derive(Debug, Clone, PartialEq)]
struct CameraFolder {
    /// The folder's name.
    name: String,
    /// One file a frame, in order.
    files: Vec<PathBuf>,
}

/// The pictures of several cameras.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureSequence {
    path: String,
    views: Vec<CameraFolder>,
    first: u64,
}

impl PictureSequence {
    /// Lists the pictures of a folder for so many cameras.
    ///
    /// # Errors
    /// One sentence where there is no folder for each camera, a frame is missing, or cameras have not the same frames.
    pub fn open(folder: &Path, cameras: usize) -> Result<Self, SourceError> {
        let path = folder.display().to_string();
        let mut views = BTreeMap::new();
        for inner in entries(folder)?.into_iter().filter(|p| p.is_dir()) {
            let files = numbered(&inner)?;
            if !files.is_empty() && views.len() <= MAX_CAMERAS {
                views.insert(name_of(&inner), files);
            }
        }
        let whole = |problem: String, cure| ReaderFault::new(FilePlace::Whole, problem, cure).at(&path);
        if views.len() != cameras {
            return Err(whole(format!("{} folders of pictures for {cameras} cameras", views.len()), CURE));
        }
        for (name, files) in &views {
            if let Some(gap) = gap(files) {
                let cure = "copy the missing frame, or leave out what lies before it";
                return Err(whole(format!("camera {name} has no frame {gap}"), cure));
            }
        }
        let span = |files: &BTreeMap<u64, PathBuf>| {
            (files.keys().next().copied().unwrap_or(0), files.keys().next_back().copied().unwrap_or(0))
        };
        let spans: Vec<(&String, (u64, u64))> = views.iter().map(|(name, files)| (name, span(files))).collect();
        let (one, first) = spans[0];
        if let Some((other, (from, to))) = spans.iter().find(|s| s.1 != first) {
            let (a, b) = first;
            let cure = "leave out the frames that not all cameras have";
            return Err(whole(format!("camera {one} has frames {a} to {b} and camera {other} {from} to {to}"), cure));
        }
        let frames = views.values().map(BTreeMap::len).next().unwrap_or(0);
        if frames > MAX_FRAMES {
            return Err(whole(format!("{frames} frames where {MAX_FRAMES} are read"), "give a part of them"));
        }
        let views = views.into_iter().map(|(name, files)| CameraFolder { name, files: files.into_values().collect() });
        Ok(Self { path, views: views.collect(), first: first.0 })
    }

    /// Frames of each camera.
    pub fn frames(&self) -> usize {
        self.views.first().map_or(0, |v| v.files.len())
    }

    /// Number of the first frame in the files' names.
    pub const fn first(&self) -> u64 {
        self.first
    }

    /// The camera's folder.
    pub fn name(&self, camera: usize) -> &str {
        &self.views[camera].name
    }

    /// The file of a frame.
    pub(crate) fn file(&self, camera: usize, frame: usize) -> &Path {
        &self.views[camera].files[frame]
    }

    /// Decodes one picture.
    ///
    /// # Errors
    /// One sentence where the file is no picture, or not of the camera's size.
    pub fn read(&self, camera: usize, frame: usize, size: [u32; 2]) -> Result<RgbImage, SourceError> {
        let path = &self.views[camera].files[frame];
        let bytes = file::read(path, &PICTURE)?;
        let picture = decode(&bytes).map_err(|fault| fault.at(&path.display().to_string()))?;
        if picture.dimensions() != (size[0], size[1]) {
            let (w, h) = picture.dimensions();
            let problem = format!("it has {w} x {h} pixels and its camera {} x {}", size[0], size[1]);
            let cure = "calibrate the camera at the size of its pictures";
            return Err(ReaderFault::new(FilePlace::Whole, problem, cure).at(&path.display().to_string()));
        }
        Ok(picture)
    }

    /// The folder that they came from.
    pub fn path(&self) -> &str {
        &self.path
    }
}

/// Reads one picture, PNG or JPEG.
///
/// # Errors
/// One sentence where it cannot be read or is no picture.
pub fn read_picture(path: &Path) -> Result<RgbImage, SourceError> {
    let bytes = file::read(path, &PICTURE)?;
    decode(&bytes).map_err(|fault| fault.at(&path.display().to_string()))
}

fn decode(bytes: &[u8]) -> Result<RgbImage, ReaderFault> {
    Ok(decode_any(bytes)?.into_rgb8())
}

/// Decodes a PNG or JPEG of any kind of pixels.
pub(crate) fn decode_any(bytes: &[u8]) -> Result<DynamicImage, ReaderFault> {
    let fault = |e: &dyn std::fmt::Display| {
        ReaderFault::new(FilePlace::Whole, format!("it is no picture in PNG or JPEG ({e})"), "save it again")
    };
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| fault(&e))?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MAX_SIDE), Some(MAX_SIDE));
    limits.max_alloc = Some(MAX_DECODED_BYTES);
    reader.limits(limits);
    reader.decode().map_err(|e| fault(&e))
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, SourceError> {
    let refused = |error| SourceError::Io { path: folder.display().to_string(), action: "read", error };
    std::fs::read_dir(folder).map_err(refused)?.map(|e| e.map(|e| e.path()).map_err(refused)).collect()
}

fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned())
}

/// The pictures of a folder by their numbers.
fn numbered(folder: &Path) -> Result<BTreeMap<u64, PathBuf>, SourceError> {
    let mut found = BTreeMap::new();
    for path in entries(folder)? {
        let is_picture =
            path.extension().is_some_and(|e| ["png", "jpg", "jpeg"].iter().any(|known| e.eq_ignore_ascii_case(known)));
        let stem = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        if let (true, Some(number)) = (is_picture, last_number(&stem)) {
            found.insert(number, path);
        }
    }
    Ok(found)
}

/// The number that a name ends in, or its last one.
fn last_number(stem: &str) -> Option<u64> {
    let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
    let begin = stem[..end].rfind(|c: char| !c.is_ascii_digit()).map_or(0, |at| at + 1);
    stem[begin..end].parse().ok()
}

/// The first number that is missing between the first and the last.
fn gap(files: &BTreeMap<u64, PathBuf>) -> Option<u64> {
    files.keys().zip(files.keys().skip(1)).find(|(a, b)| *a + 1 != **b).map(|(a, _)| a + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder that is removed when it is dropped.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str, frames: &[(&str, &[u32])]) -> Self {
            let path = std::env::temp_dir().join(format!("toile-pictures-{name}-{}", std::process::id()));
            let _ = std::fs::remove_dir_all(&path);
            for (camera, numbers) in frames {
                std::fs::create_dir_all(path.join(camera)).unwrap();
                for n in *numbers {
                    let extension = if n % 2 == 0 { "png" } else { "jpg" };
                    let picture = RgbImage::from_pixel(8, 6, image::Rgb([*n as u8, 100, 200]));
                    picture.save(path.join(camera).join(format!("cam1_{n:04}.{extension}"))).unwrap();
                }
            }
            Self(path)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn frames_of_both_formats_come_in_order() {
        let folder = Folder::new("order", &[("a", &[9, 10, 11]), ("b", &[9, 10, 11])]);
        let sequence = PictureSequence::open(&folder.0, 2).unwrap();
        assert_eq!((sequence.frames(), sequence.first(), sequence.name(1)), (3, 9, "b"));
        for (frame, n) in [9u8, 10, 11].into_iter().enumerate() {
            let picture = sequence.read(1, frame, [8, 6]).unwrap();
            assert!(picture.get_pixel(3, 3).0[0].abs_diff(n) < 4);
        }
        assert!(sequence.read(0, 0, [6, 8]).unwrap_err().to_string().contains("8 x 6 pixels and its camera 6 x 8"));
    }

    #[test]
    fn missing_frames_and_cameras_are_named() {
        let said = |name: &str, frames: &[(&str, &[u32])]| {
            let folder = Folder::new(name, frames);
            PictureSequence::open(&folder.0, 2).unwrap_err().to_string()
        };
        assert!(said("gap", &[("a", &[1, 2, 3]), ("b", &[1, 3])]).contains("camera b has no frame 2"));
        let ends = said("ends", &[("a", &[1, 2, 3]), ("b", &[1, 2])]);
        assert!(ends.contains("camera a has frames 1 to 3 and camera b 1 to 2"));
        assert!(said("one", &[("a", &[1])]).contains("1 folders of pictures for 2 cameras"));
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let folder = Folder::new("broken", &[("a", &[1]), ("b", &[1])]);
        std::fs::write(folder.0.join("a/cam1_0001.jpg"), b"no picture").unwrap();
        let sequence = PictureSequence::open(&folder.0, 2).unwrap();
        assert!(sequence.read(0, 0, [8, 6]).unwrap_err().to_string().contains("save it again"));
    }
}
