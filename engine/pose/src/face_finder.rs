//! The face in a picture: found by the detector, its points by the mesh, whose square is laid around its own points again.

use std::path::Path;

use glam::Vec2;
use toile_sensors::source::live::ColourImage;

use crate::face_detector::FaceDetector;
use crate::face_mesh::{FaceMesh, MeshPoints};
use crate::files::{PoseError, PoseFile};
use crate::region::Region;
use crate::tflite::NetworkFault;
use crate::tracker;

/// Where the mesh lies in the networks' file (bytes), which packs what the package's program loads.
pub const MESH: std::ops::Range<usize> = 2_495_952..3_737_848;
/// Where the detector lies in it (bytes).
pub const DETECTOR: std::ops::Range<usize> = 3_757_224..3_986_256;

/// Least presence of a face (MediaPipe's `min_tracking_confidence`).
const LEAST_PRESENCE: f32 = 0.5;

/// Fewest pixels across a face: with fewer the network sees one that was enlarged three times, and a texture of it is blurred.
pub const FEWEST_PIXELS: f32 = 48.0;

/// Rounds of the mesh: the detector's square is a rough one, and each of the next is laid around the points of the one before.
const ROUNDS: usize = 3;

/// How far off the middle between the temples the bridge of the nose may lie, in shares of the way between them: it lies so far off where a head is
/// turned by some 33 degrees, beyond which the farther cheek is hardly seen.
const TURNED: f32 = 0.42;

/// Points of the mesh: temples, the wearer's right one first, and the bridge of the nose.
const TEMPLES: [usize; 2] = [127, 356];
const BRIDGE: usize = 6;

/// Why no face is taken from a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FaceFault {
    /// None is seen.
    #[error("no face is seen")]
    Unseen,
    /// It is too few pixels wide.
    #[error("the face is too few pixels wide")]
    TooFar,
    /// It looks aside.
    #[error("the face is turned away")]
    Turned,
}

/// Finds a face and its points.
#[derive(Debug)]
pub struct FaceFinder {
    detector: FaceDetector,
    mesh: FaceMesh,
}

impl FaceFinder {
    /// With the network's file of a folder. Called at load: it allocates.
    ///
    /// # Errors
    /// A file that is missing or another than the one that is known.
    pub fn load(folder: &Path) -> Result<Self, PoseError> {
        let bytes = PoseFile::Face.read(folder)?;
        let part = |range: std::ops::Range<usize>| bytes.get(range).unwrap_or_default();
        let unfit = |fault: NetworkFault| PoseFile::Face.another(folder, fault.to_string());
        Ok(Self {
            detector: FaceDetector::load(part(DETECTOR)).map_err(unfit)?,
            mesh: FaceMesh::load(part(MESH)).map_err(unfit)?,
        })
    }

    /// The points of the largest face of a picture; sought about a place of the head first (middle and side of a square, px), where that
    /// is known, and then in all of the picture.
    ///
    /// # Errors
    /// Why no face is taken.
    pub fn find(&mut self, picture: &ColourImage, head: Option<(Vec2, f32)>) -> Result<MeshPoints, FaceFault> {
        tracker::check(picture).map_err(|_| FaceFault::Unseen)?;
        let about = head.map(|(centre, side)| Region { centre, side, turned: 0.0 });
        let about = about.filter(|square| square.is_within(picture.width, picture.height));
        let found = about.and_then(|square| self.detector.find(picture, &square));
        let found = found.or_else(|| self.detector.find(picture, &Region::around(picture)));
        let mut region = found.ok_or(FaceFault::Unseen)?;
        let mut seen: Option<MeshPoints> = None;
        for _ in 0..ROUNDS {
            if !region.is_within(picture.width, picture.height) {
                return Err(if region.side < FEWEST_PIXELS { FaceFault::TooFar } else { FaceFault::Unseen });
            }
            let next = self.mesh.find(picture, &region).filter(|mesh| mesh.presence >= LEAST_PRESENCE);
            let next = next.ok_or(FaceFault::Unseen)?;
            region = next.region();
            if let Some(mut before) = seen.replace(next) {
                before.wipe();
            }
        }
        let seen = seen.ok_or(FaceFault::Unseen)?;
        judge(&seen).map(|()| seen)
    }

    /// Overwrites what it has of the last picture.
    pub fn wipe(&mut self) {
        self.detector.wipe();
        self.mesh.wipe();
    }
}

/// Whether a face is large enough and looks this way.
fn judge(mesh: &MeshPoints) -> Result<(), FaceFault> {
    let [right, left] = TEMPLES.map(|temple| mesh.points[temple]);
    let (_, size) = mesh.bounds();
    if size.max_element() < FEWEST_PIXELS {
        return Err(FaceFault::TooFar);
    }
    let along = left - right;
    let share = (mesh.points[BRIDGE] - right).dot(along) / along.length_squared().max(1e-9);
    if (share - 0.5).abs() > TURNED { Err(FaceFault::Turned) } else { Ok(()) }
}
