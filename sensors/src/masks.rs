//! Silhouettes of a person in the pictures of several cameras: masks as they are given, or a picture less its background.
//!
//! A folder holds one picture a camera, PNG or JPEG, in the order of the cameras' names. A picture with transparent pixels is a mask by
//! its alpha, any other by its brightness: white is the person. With backgrounds (the same pictures without the person), a pixel is
//! the person as far as it differs.

mod sequence;

use std::path::{Path, PathBuf};

use image::DynamicImage;
use toile_assets::file;

use crate::calibration::CalibratedCamera;
use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::pictures::{PICTURE, decode_any};

/// Differences from the background (of 255, the largest of three channels) at which a pixel is background, and wholly the person.
const DIFFERS: [f32; 2] = [14.0, 42.0];

/// Least and most of a picture that a person covers.
const COVERED: [f64; 2] = [0.002, 0.9];

pub use sequence::MaskSequence;

const CURE: &str = "give one PNG or JPEG for each camera, in the order of the cameras' names";

/// How much of each pixel a person covers.
#[derive(Debug, Clone, PartialEq)]
pub struct Mask {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Share of the pixel that is the person, 0 to 1 `[height x width]`.
    pub coverage: Vec<f32>,
}

impl Mask {
    /// The coverage of a pixel; 0 outside of the picture.
    pub fn at(&self, x: isize, y: isize) -> f32 {
        let inside = x >= 0 && y >= 0 && (x as usize) < self.width && (y as usize) < self.height;
        if inside { self.coverage[y as usize * self.width + x as usize] } else { 0.0 }
    }
}

/// Reads the masks of a folder for these cameras.
///
/// # Errors
/// One sentence if there is not one picture a camera, a picture is not of its camera's size, or it shows no person or nothing else.
pub fn read_masks(
    folder: &Path,
    backgrounds: Option<&Path>,
    cameras: &[CalibratedCamera],
) -> Result<Vec<Mask>, SourceError> {
    let files = pictures(folder, cameras.len())?;
    let behind = backgrounds.map(|b| pictures(b, cameras.len())).transpose()?;
    let mut masks = Vec::with_capacity(files.len());
    for (k, (path, camera)) in files.iter().zip(cameras).enumerate() {
        let seen = read(path, camera)?;
        let mask = match &behind {
            Some(all) => less_background(&seen, &read(&all[k], camera)?),
            None => by_itself(&seen),
        };
        check(&mask).map_err(|fault| fault.at(&path.display().to_string()))?;
        masks.push(mask);
    }
    Ok(masks)
}

fn pictures(folder: &Path, cameras: usize) -> Result<Vec<PathBuf>, SourceError> {
    let shown = folder.display().to_string();
    let refused = |error| SourceError::Io { path: shown.clone(), action: "read", error };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refused)? {
        let path = entry.map_err(refused)?.path();
        let known = ["png", "jpg", "jpeg"];
        if path.extension().is_some_and(|e| known.iter().any(|k| e.eq_ignore_ascii_case(k))) {
            files.push(path);
        }
    }
    files.sort();
    if files.len() != cameras {
        return Err(ReaderFault::new(
            FilePlace::Whole,
            format!("{} pictures for {cameras} cameras", files.len()),
            CURE,
        )
        .at(&shown));
    }
    Ok(files)
}

fn read(path: &Path, camera: &CalibratedCamera) -> Result<DynamicImage, SourceError> {
    let shown = path.display().to_string();
    let picture = decode_any(&file::read(path, &PICTURE)?).map_err(|fault| fault.at(&shown))?;
    let [w, h] = camera.size;
    if (picture.width(), picture.height()) != (w, h) {
        let (width, height) = (picture.width(), picture.height());
        let problem = format!("it has {width} x {height} pixels and its camera {w} x {h}");
        return Err(
            ReaderFault::new(FilePlace::Whole, problem, "calibrate the camera at the size of its pictures").at(&shown)
        );
    }
    Ok(picture)
}

fn by_itself(picture: &DynamicImage) -> Mask {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let alpha = picture.color().has_alpha().then(|| picture.to_rgba8());
    let transparent = alpha.filter(|p| p.pixels().any(|p| p.0[3] < 255));
    let coverage = match transparent {
        Some(rgba) => rgba.pixels().map(|p| f32::from(p.0[3]) / 255.0).collect(),
        None => picture.to_luma8().pixels().map(|p| f32::from(p.0[0]) / 255.0).collect(),
    };
    Mask { width, height, coverage }
}

fn less_background(picture: &DynamicImage, background: &DynamicImage) -> Mask {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let (seen, behind) = (picture.to_rgb8(), background.to_rgb8());
    let differs = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| {
        let most = a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
        ((f32::from(most) - DIFFERS[0]) / (DIFFERS[1] - DIFFERS[0])).clamp(0.0, 1.0)
    };
    let raw = Mask { width, height, coverage: seen.pixels().zip(behind.pixels()).map(differs).collect() };
    Mask { coverage: without_speckles(&raw), width, height }
}

/// Each pixel becomes the median of the nine around it, which leaves straight edges and takes single pixels.
fn without_speckles(mask: &Mask) -> Vec<f32> {
    let mut out = Vec::with_capacity(mask.coverage.len());
    for y in 0..mask.height as isize {
        for x in 0..mask.width as isize {
            let mut around: [f32; 9] = std::array::from_fn(|k| mask.at(x + k as isize % 3 - 1, y + k as isize / 3 - 1));
            around.sort_unstable_by(f32::total_cmp);
            out.push(around[4]);
        }
    }
    out
}

/// How much of a picture a mask covers, 0 to 1.
struct Covered(f64);

fn covered(mask: &Mask) -> Covered {
    Covered(mask.coverage.iter().filter(|c| **c >= 0.5).count() as f64 / mask.coverage.len().max(1) as f64)
}

impl Covered {
    /// Whether that is a person before something else.
    fn is_person(&self) -> bool {
        (COVERED[0]..=COVERED[1]).contains(&self.0)
    }
}

fn check(mask: &Mask) -> Result<(), ReaderFault> {
    let fault = |problem: String, cure| Err(ReaderFault::new(FilePlace::Whole, problem, cure));
    match covered(mask).0 {
        c if c < COVERED[0] => fault(
            format!("{:.2} % of it is a person's", 100.0 * c),
            "give a mask that is white where the person is, or the pictures without the person as backgrounds",
        ),
        c if c > COVERED[1] => {
            fault(format!("{:.0} % of it is a person's", 100.0 * c), "turn black and white round, or give backgrounds")
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{GrayImage, Luma, Rgb, RgbImage, Rgba, RgbaImage};

    fn square(x: u32, y: u32) -> bool {
        (10..30).contains(&x) && (5..35).contains(&y)
    }

    #[test]
    fn white_alpha_and_a_difference_are_one_mask() {
        let white = GrayImage::from_fn(40, 40, |x, y| Luma([if square(x, y) { 255 } else { 0 }]));
        let alpha = RgbaImage::from_fn(40, 40, |x, y| Rgba([90, 90, 90, if square(x, y) { 255 } else { 0 }]));
        let room = |x: u32, y: u32| Rgb([(x * 3) as u8, (y * 4) as u8, 100]);
        let behind = RgbImage::from_fn(40, 40, room);
        let before = RgbImage::from_fn(40, 40, |x, y| if square(x, y) { Rgb([200, 30, 220]) } else { room(x, y) });
        let one = by_itself(&white.into());
        assert_eq!(one, by_itself(&alpha.into()));
        let other = less_background(&before.into(), &behind.into());
        let off = one.coverage.iter().zip(&other.coverage).filter(|(a, b)| (*a - *b).abs() > 0.5).count();
        assert!(off <= 4, "only corners are rounded: {off}");
    }

    #[test]
    fn empty_and_full_masks_are_refused() {
        let of = |c: f32| check(&Mask { width: 10, height: 10, coverage: vec![c; 100] });
        assert!(of(0.0).unwrap_err().at("m.png").to_string().contains("0.00 % of it is a person's"));
        assert!(of(1.0).unwrap_err().at("m.png").to_string().contains("turn black and white round"));
    }
}
