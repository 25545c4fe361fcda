//! The points of a face within a region of a picture: MediaPipe's face mesh.

use glam::{DVec2, Vec2};
use toile_sensors::face_points::{self, FACE_POINTS, MESH_POINTS};
use toile_sensors::source::live::ColourImage;

use crate::network::{Network, logistic};
use crate::region::{Border, Region};
use crate::tflite::NetworkFault;

/// Side of the network's image (px).
const SIDE: usize = 192;

/// Outer corners of the eyes, the wearer's right one first.
const EYES: [usize; 2] = [33, 263];

/// Share of the longer side of the points' box that the next square has (MediaPipe's `face_landmarks_to_roi`).
const AROUND: f32 = 1.5;

/// Standard deviation of a point, in shares of the face's longer side: twice what points are off their true places on drawn faces
/// (docs/capture.md), since neighbours are off the same way.
const SIGMA: f32 = 0.03;

/// Sides of the jaw among the 68 points, which are not taken over: there the mesh is a guess wherever hair covers them, and off by three times as
/// much as elsewhere. The chin is.
const JAW_SIDES: [std::ops::Range<usize>; 2] = [0..7, 10..17];

/// Least standard deviation of a point (px): no network's points are surer.
const LEAST_SIGMA_PX: f32 = 0.5;

/// What the network says of a region.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshPoints {
    /// How likely a face is there, 0 to 1.
    pub presence: f32,
    /// Its points, in MediaPipe's order (px) `[MESH_POINTS]`.
    pub points: Vec<Vec2>,
}

impl MeshPoints {
    /// The box around the points: its middle and its size (px).
    pub fn bounds(&self) -> (Vec2, Vec2) {
        let low = self.points.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let high = self.points.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        ((low + high) * 0.5, high - low)
    }

    /// The 68 points of a marked photograph (px, whole numbers at the middles of pixels), without the sides of the jaw.
    pub fn marked(&self) -> [Option<DVec2>; FACE_POINTS] {
        let mut all = face_points::of_mesh(&self.points).map(|p| Some(p.as_dvec2() - 0.5));
        JAW_SIDES.into_iter().flatten().for_each(|k| all[k] = None);
        all
    }

    /// Standard deviation of a point (px).
    pub fn sigma_px(&self) -> f64 {
        f64::from((SIGMA * self.bounds().1.max_element()).max(LEAST_SIGMA_PX))
    }

    /// The square in which the same face is seen best.
    pub fn region(&self) -> Region {
        let (middle, size) = self.bounds();
        Region::of_eyes(middle, size, EYES.map(|eye| self.points[eye]), AROUND)
    }

    /// Overwrites them.
    pub fn wipe(&mut self) {
        self.points.fill(Vec2::ZERO);
        self.presence = 0.0;
    }
}

/// Finds the points of a face in regions.
#[derive(Debug)]
pub struct FaceMesh {
    network: Network,
}

impl FaceMesh {
    /// Of the network's bytes. Called at load: it allocates.
    ///
    /// # Errors
    /// A file of another network.
    pub fn load(bytes: &[u8]) -> Result<Self, NetworkFault> {
        let network = Network::load(bytes, &[&[1, 1, 1, 3 * MESH_POINTS], &[1, 1, 1, 1]])?;
        network.takes_square(SIDE)?;
        Ok(Self { network })
    }

    /// The points in a region; none where the network gives what is no number.
    pub fn find(&mut self, picture: &ColourImage, region: &Region) -> Option<MeshPoints> {
        region.sample(picture, Border::Nearest, [1.0, 0.0], self.network.input(), SIDE);
        self.network.run();
        let pixel = |[x, y, _]: &[f32; 3]| region.pixel(Vec2::new(*x, *y) / SIDE as f32);
        let points: Vec<Vec2> = self.network.output(0).as_chunks::<3>().0.iter().map(pixel).collect();
        let presence = logistic(self.network.output(1)[0]);
        (presence.is_finite() && points.iter().all(|p| p.is_finite())).then_some(MeshPoints { presence, points })
    }

    /// Overwrites what it has of the last picture.
    pub fn wipe(&mut self) {
        self.network.wipe();
    }
}
