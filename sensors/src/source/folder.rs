//! A folder of depth images as a recording: 16-bit PNG or raw images, one a file, in the order of the numbers in their
//! names. Other files are passed over.

use std::fs;
use std::path::{Path, PathBuf};

use toile_assets::file;

use super::camera;
use super::files::{OpenOptions, count_bytes, shown};
use super::raw_depth::{assumed_camera, samples};
use super::sequence::{Sequence, assumed_time, untimed};
use super::{fakenect, png_depth};
use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::limits::{CAMERA, MAX_FOLDER_FILES, RECORDING};
use crate::session::Session;
use toile_base::clock::SECOND_NS;

/// Endings of raw 16-bit images.
const RAW: [&str; 5] = ["u16le", "raw", "bin", "depth", "z16"];

/// The camera of a folder, where none is given.
const CAMERA_FILE: &str = "camera.json";

/// From this on, a number in a name is a time in seconds (September 2001), as in the recordings of the TUM benchmark.
const FIRST_CLOCK_S: f64 = 1e9;

const CURE: &str = "give a folder of 16-bit PNG images (.png) or raw ones (.u16le, .raw, .bin, .depth, .z16)";

/// Reads all depth images of a folder.
pub(super) fn read(folder: &Path, options: &OpenOptions) -> Result<Session, SourceError> {
    if folder.join(fakenect::INDEX).is_file() {
        return fakenect::read(folder, options);
    }
    let path = shown(folder);
    let (images, beside) = list(folder)?;
    let mut notes = Vec::new();
    let camera = match options.camera.clone().or(beside) {
        Some(json) => camera::read(&file::read(&json, &CAMERA)?).map_err(|fault| fault.at(&shown(&json)))?,
        None => assumed_camera(&mut notes),
    };
    let clock = clock(&images);
    if clock.is_none() && images.len() > 1 {
        notes.push(untimed(images.len()));
    }
    let mut sequence = Sequence::new(camera, notes).map_err(|fault| fault.at(&path))?;
    let mut total = 0;
    for (i, image) in images.iter().enumerate() {
        let bytes = file::read(image, &RECORDING)?;
        count_bytes(&mut total, &bytes).map_err(|fault| fault.at(&path))?;
        let time = clock.as_ref().map_or_else(|| assumed_time(i), |clock| clock[i]);
        push(&bytes, time, &mut sequence).map_err(|fault| fault.at(&shown(image)))?;
    }
    let mut session = sequence.finish().map_err(|fault| fault.at(&path))?;
    session.name = folder.file_name().map_or_else(|| "session".to_owned(), |n| n.to_string_lossy().into_owned());
    session.check().map_err(|fault| fault.at(&path))?;
    Ok(session)
}

fn push(bytes: &[u8], time_ns: u64, sequence: &mut Sequence) -> Result<(), ReaderFault> {
    if bytes.starts_with(png_depth::MAGIC) {
        let image = png_depth::decode(bytes, &sequence.sensor())?;
        return sequence.push(time_ns, image.into_iter());
    }
    if !bytes.len().is_multiple_of(2) {
        return Err(ReaderFault::new(
            FilePlace::Whole,
            "an odd number of bytes, which is no image of 16 bits a pixel",
            CURE,
        ));
    }
    sequence.push(time_ns, samples(bytes))
}

/// The images of a folder in order, and its camera. One kind alone: that of which there are more.
fn list(folder: &Path) -> Result<(Vec<PathBuf>, Option<PathBuf>), SourceError> {
    let refused = |error| SourceError::Io { path: shown(folder), action: "read", error };
    let (mut png, mut raw, mut camera) = (Vec::new(), Vec::new(), None);
    for (i, entry) in fs::read_dir(folder).map_err(refused)?.enumerate() {
        let path = entry.map_err(refused)?.path();
        if i >= MAX_FOLDER_FILES {
            let problem = format!("more than {MAX_FOLDER_FILES} files in the folder");
            return Err(
                ReaderFault::new(FilePlace::Whole, problem, "cut the recording into shorter pieces").at(&shown(folder))
            );
        }
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        if path.file_name().is_some_and(|n| n == CAMERA_FILE) {
            camera = Some(path);
        } else if ending == "png" {
            png.push(path);
        } else if RAW.contains(&ending.as_str()) {
            raw.push(path);
        }
    }
    let mut images = if png.len() >= raw.len() { png } else { raw };
    if images.is_empty() {
        return Err(ReaderFault::new(FilePlace::Whole, "no depth image in the folder", CURE).at(&shown(folder)));
    }
    images.sort_by_cached_key(|path| natural(&path.file_name().unwrap_or_default().to_string_lossy()));
    Ok((images, camera))
}

/// The order of names in which frame 9 comes before frame 10: words, and numbers by length and then by digits.
fn natural(name: &str) -> Vec<(usize, String)> {
    let mut parts: Vec<(usize, String)> = Vec::new();
    let mut in_number = false;
    for c in name.chars() {
        let digit = c.is_ascii_digit();
        match parts.last_mut() {
            Some((length, part)) if digit == in_number => {
                part.push(c);
                *length += usize::from(digit);
            }
            _ => parts.push((usize::from(digit), c.to_string())),
        }
        in_number = digit;
    }
    for (length, part) in &mut parts {
        if *length > 0 {
            let digits = part.trim_start_matches('0');
            *length = 1 + digits.len();
            *part = digits.to_owned();
        }
    }
    parts
}

/// Times in the names (ns), where every name is a number of seconds since 1970.
fn clock(images: &[PathBuf]) -> Option<Vec<u64>> {
    let time = |path: &PathBuf| {
        let seconds: f64 = path.file_stem()?.to_str()?.parse().ok()?;
        let plausible = seconds.is_finite() && (FIRST_CLOCK_S..FIRST_CLOCK_S * 10.0).contains(&seconds);
        plausible.then_some((seconds * SECOND_NS as f64) as u64)
    };
    images.iter().map(time).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_ordered_by_their_numbers() {
        let mut names = ["f10.png", "f9.png", "f010a.png", "f1.png", "f100000000000000000000000.png", "e2.png"];
        names.sort_by_cached_key(|n| natural(n));
        assert_eq!(names, ["e2.png", "f1.png", "f9.png", "f10.png", "f010a.png", "f100000000000000000000000.png"]);
    }

    #[test]
    fn times_are_taken_from_names_that_are_clocks_and_from_no_others() {
        let paths = |names: &[&str]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
        let times = clock(&paths(&["1305031102.160407.png", "1305031102.226738.png"])).unwrap();
        assert!((times[1] - times[0]).abs_diff(66_331_000) < 1000, "{times:?}");
        assert_eq!(clock(&paths(&["1305031102.1.png", "x.png"])), None);
        assert_eq!(clock(&paths(&["0001.png", "0002.png"])), None);
        assert_eq!(clock(&paths(&["inf.png"])), None);
    }
}
