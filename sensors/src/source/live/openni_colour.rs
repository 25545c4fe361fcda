//! The colour stream of an OpenNI camera: its lens and place from what the driver says of single pixels, its images kept until their depth
//! comes.
//!
//! OpenNI has no call for a lens. Its driver says where the colour stream shows what the depth stream measured at a pixel, by the
//! calibration of the device. With p = (X, Y, Z) the place of such a measurement, a camera that stands parallel sees it at
//!
//! ```text
//! u = fx X / Z + cx + fx tx / Z,   v = fy Y / Z + cy + fy ty / Z
//! ```
//!
//! which is linear in fx, cx and fx tx: least squares over a grid of pixels and four distances.

use glam::{DMat3, DVec3, Mat3, Vec3};

use super::live_camera::{ColourImage, is_of_moment};
use crate::colour_camera::ColourCamera;
use crate::source::openni_library::OpenNiStream;
use toile_base::frame::Intrinsics;

/// Pixels between two that are asked for, and the distances (mm).
const APART: usize = 40;
const DISTANCES_MM: [f32; 4] = [800.0, 1_200.0, 2_000.0, 3_500.0];

/// Fewest answers that say how a camera sees, and the most that they may be off a parallel camera (px, root of the mean square):
/// answers are whole pixels, and lenses bend a little.
const FEWEST: usize = 100;
const MOST_OFF: f64 = 3.0;

/// How long an image of the same moment is waited for (ms).
const PATIENCE_MS: u32 = 5;

/// Nearest that a stamp is to being as old as its depth (ns).
const OLDER_NS: u64 = 1_000_000;

/// The stream, and the image that came last.
pub(super) struct OpenNiColour {
    stream: OpenNiStream,
    image: ColourImage,
    taken_ns: Option<u64>,
}

impl OpenNiColour {
    pub fn new(stream: OpenNiStream) -> Self {
        Self { stream, image: ColourImage::default(), taken_ns: None }
    }

    /// Its camera in the axes of the depth stream's, by what the driver says; none where it says nothing.
    pub fn camera(&self, depth: &OpenNiStream, k: &Intrinsics, mm_per_unit: f32) -> Option<ColourCamera> {
        let size = self.stream.size()?;
        fitted(k, size, &|pixel, mm| {
            let units = (mm / mm_per_unit).round();
            (units <= f32::from(u16::MAX)).then(|| depth.seen_in_colour(&self.stream, pixel, units as u16))?
        })
    }

    /// Writes the image of a depth image's moment, if there is one by now.
    pub fn take(&mut self, depth_ns: u64, rate_hz: f32, to: &mut ColourImage) {
        let is_old = |taken: Option<u64>| {
            taken.is_none_or(|ns| ns + OLDER_NS < depth_ns && !is_of_moment(depth_ns, ns, rate_hz))
        };
        while is_old(self.taken_ns) {
            let Some(image) = self.stream.next(PATIENCE_MS) else { return };
            self.image.rgb.clear();
            let size = image.colour(&mut self.image.rgb);
            self.taken_ns = size.map(|_| image.time_ns());
            let Some((width, height)) = size else { return };
            (self.image.width, self.image.height) = (width, height);
        }
        if self.taken_ns.is_some_and(|ns| is_of_moment(depth_ns, ns, rate_hz)) {
            (to.width, to.height) = (self.image.width, self.image.height);
            to.rgb.extend_from_slice(&self.image.rgb);
        }
    }
}

/// The camera that shows a measurement at a pixel of the depth image (px, mm) where `ask` says (px).
fn fitted(
    depth: &Intrinsics,
    [width, height]: [u32; 2],
    ask: &dyn Fn([u32; 2], f32) -> Option<[i32; 2]>,
) -> Option<ColourCamera> {
    let mut answers = Vec::new();
    for mm in DISTANCES_MM {
        for y in (0..depth.height).step_by(APART) {
            for x in (0..depth.width).step_by(APART) {
                let Some([u, v]) = ask([x, y], mm) else { continue };
                let inside = (0..width as i32).contains(&u) && (0..height as i32).contains(&v);
                if !inside {
                    continue;
                }
                let p = depth.unproject(x as f32, y as f32, mm * 1e-3).as_dvec3();
                answers.push((p, [f64::from(u), f64::from(v)]));
            }
        }
    }
    if answers.len() < FEWEST {
        return None;
    }
    let (mut square, mut right) = ([DMat3::ZERO; 2], [DVec3::ZERO; 2]);
    let row = |p: &DVec3, axis: usize| DVec3::new(p[axis] / p.z, 1.0, 1.0 / p.z);
    for (p, seen) in &answers {
        for axis in 0..2 {
            let row = row(p, axis);
            square[axis] += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
            right[axis] += row * seen[axis];
        }
    }
    let [across, along] = std::array::from_fn(|axis| square[axis].inverse() * right[axis]);
    let found = [across, along];
    let off =
        answers.iter().flat_map(|(p, seen)| [0, 1].map(|axis| (row(p, axis).dot(found[axis]) - seen[axis]).powi(2)));
    let off = (off.sum::<f64>() / answers.len() as f64).sqrt();
    let (fx, fy) = (across.x as f32, along.x as f32);
    let intrinsics = Intrinsics { width, height, fx, fy, cx: across.y as f32, cy: along.y as f32 };
    let translation = Vec3::new(across.z as f32 / fx, along.z as f32 / fy, 0.0);
    let sound = off <= MOST_OFF && translation.is_finite() && intrinsics.fault().is_none();
    sound.then(|| ColourCamera::beside(intrinsics, None, Mat3::IDENTITY, translation))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_is_found_by_where_it_shows_things() {
        let depth = Intrinsics { width: 640, height: 480, fx: 575.0, fy: 575.0, cx: 319.5, cy: 239.5 };
        let colour = Intrinsics { width: 1_280, height: 1_024, fx: 1_050.0, fy: 1_048.0, cx: 642.0, cy: 509.0 };
        let real = ColourCamera::beside(colour, None, Mat3::IDENTITY, Vec3::new(-0.025, 0.001, 0.0));
        let into = real.camera_to_world.inverse();
        let seen = |[x, y]: [u32; 2], mm: f32| {
            let p = into.transform_point3(depth.unproject(x as f32, y as f32, mm * 1e-3));
            real.project(p).map(|at| at.round().to_array().map(|x| x as i32))
        };
        let found = fitted(&depth, [1_280, 1_024], &seen).unwrap();
        let point = Vec3::new(0.3, -0.4, 2.2);
        let at =
            |camera: &ColourCamera| camera.project(camera.camera_to_world.inverse().transform_point3(point)).unwrap();
        assert!(at(&found).distance(at(&real)) < 0.2, "{found:?}");
        let place = Vec3::from(found.camera_to_world.translation);
        assert!(place.distance(Vec3::new(0.025, -0.001, 0.0)) < 5e-4, "{place}");
        // A driver that says nothing, and one that says nonsense, have none.
        assert_eq!(fitted(&depth, [1_280, 1_024], &|_, _| None), None);
        assert_eq!(
            fitted(&depth, [1_280, 1_024], &|[x, y], _| Some([(x * 37 % 1_280) as i32, (y * 91 % 1_024) as i32])),
            None
        );
    }
}
