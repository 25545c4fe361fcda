//! From the samples of a depth camera to millimetres of a pinhole: unit, lens, and the side on which the camera lies.

use super::camera::DepthCamera;
use super::straighten::Straighten;
use crate::error::{FilePlace, ReaderFault};
use toile_base::frame::Intrinsics;

/// Converts the images of one camera, one after the other.
pub(super) struct DepthConverter {
    camera: DepthCamera,
    straighten: Option<Straighten>,
    /// The image in millimetres, before it is straightened and turned `[sensor pixels]`.
    millimetres: Vec<u16>,
    /// The same when straightened `[straight pixels]`.
    straight: Vec<u16>,
}

impl DepthConverter {
    /// Of a camera; what is done to its images is noted.
    pub fn new(camera: DepthCamera, notes: &mut Vec<String>) -> Result<Self, ReaderFault> {
        let bent = camera.distortion.as_ref();
        let straighten = match bent.map(|lens| Straighten::new(camera.intrinsics, lens)) {
            None => None,
            Some(Some(table)) => {
                let (from, to) = (camera.intrinsics, table.straight);
                notes.push(format!(
                    "the lens bends straight lines: images of {} x {} pixels were straightened to {} x {}",
                    from.width, from.height, to.width, to.height
                ));
                Some(table)
            }
            Some(None) => {
                let cure = "give the coefficients k1 .. k6, p1, p2 of a calibrated lens, or leave them out";
                return Err(ReaderFault::new(FilePlace::Whole, "the distortion folds the image over itself", cure));
            }
        };
        if camera.quarter_turns != 0 {
            notes.push(format!("images were turned by {} degrees", 90 * u32::from(camera.quarter_turns)));
        }
        Ok(Self { camera, straighten, millimetres: Vec::new(), straight: Vec::new() })
    }

    /// The straight camera, before it is turned.
    fn upright(&self) -> Intrinsics {
        self.straighten.as_ref().map_or(self.camera.intrinsics, |s| s.straight)
    }

    /// The camera of the images that come out.
    pub fn kept(&self) -> Intrinsics {
        turned(self.upright(), self.camera.quarter_turns)
    }

    /// One image in the camera's units (0 = nothing) as millimetres of [`Self::kept`].
    pub fn convert(&mut self, samples: impl Iterator<Item = u16>) -> Box<[u16]> {
        let mut out = vec![0; self.kept().pixels()];
        self.convert_into(samples, &mut out);
        out.into_boxed_slice()
    }

    /// The same into an image of the size of [`Self::kept`]; allocates nothing after the first.
    pub fn convert_into(&mut self, samples: impl Iterator<Item = u16>, out: &mut [u16]) {
        let scale = self.camera.mm_per_unit;
        self.millimetres.clear();
        if scale == 1.0 {
            self.millimetres.extend(samples);
        } else {
            // What is too far for 16 bits of millimetres was not measured: the conversion saturates.
            let scaled = samples.map(|d| (f32::from(d) * scale).round() as u16);
            self.millimetres.extend(scaled.map(|d| if d == u16::MAX { 0 } else { d }));
        }
        let image = match &self.straighten {
            Some(table) => {
                table.apply_into(&self.millimetres, &mut self.straight);
                &self.straight
            }
            None => &self.millimetres,
        };
        turn(image, self.upright(), self.camera.quarter_turns, out);
    }
}

/// A camera whose images are turned clockwise by so many quarters.
fn turned(k: Intrinsics, quarters: u8) -> Intrinsics {
    (0..quarters % 4).fold(k, |k, _| Intrinsics {
        width: k.height,
        height: k.width,
        fx: k.fy,
        fy: k.fx,
        cx: k.height as f32 - 1.0 - k.cy,
        cy: k.cx,
    })
}

/// Turns an image clockwise by so many quarters.
fn turn(image: &[u16], k: Intrinsics, quarters: u8, out: &mut [u16]) {
    let (w, h) = (k.width as usize, k.height as usize);
    match quarters % 4 {
        0 => out.copy_from_slice(image),
        1 => out.iter_mut().enumerate().for_each(|(i, d)| *d = image[(h - 1 - i % h) * w + i / h]),
        2 => out.iter_mut().zip(image.iter().rev()).for_each(|(to, from)| *to = *from),
        _ => out.iter_mut().enumerate().for_each(|(i, d)| *d = image[(i % h) * w + w - 1 - i / h]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_image_shows_the_same_points_to_a_turned_camera() {
        let k = Intrinsics { width: 4, height: 3, fx: 5.0, fy: 6.0, cx: 1.25, cy: 0.75 };
        for quarters in 0..4 {
            let camera = DepthCamera { quarter_turns: quarters, ..DepthCamera::pinhole(k) };
            let mut converter = DepthConverter::new(camera, &mut Vec::new()).unwrap();
            let out = converter.convert((0..12).map(|i| 1_000 + i));
            let to = converter.kept();
            for (i, depth) in out.iter().enumerate() {
                let at = usize::from(*depth - 1_000);
                let before = k.unproject((at % 4) as f32, (at / 4) as f32, 1.0);
                let after = to.unproject((i % to.width as usize) as f32, (i / to.width as usize) as f32, 1.0);
                // A quarter clockwise takes right (x) to down (y), and down to the left.
                let turned = (0..quarters).fold(before, |p, _| glam::Vec3::new(-p.y, p.x, p.z));
                assert!((turned - after).length() < 1e-5, "{quarters}: {turned} {after}");
            }
        }
    }
}
