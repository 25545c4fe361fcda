//! The pose of a camera from the floor that it sees, if the pose is unknown. A recording and a live camera are placed by the same
//! frames in the same way.

use glam::{Affine3A, Mat3, Vec3};
use toile_base::numeric::statistics::quantile_of;

use crate::segment::floor::{Floor, FloorFinder};
use toile_base::frame::DepthFrame;

/// Height of a camera of unknown pose above the floor (m): the middle of the 0.6 .. 1.8 m that Kinect's makers advise.
const ASSUMED_CAMERA_HEIGHT: f32 = 1.2;

/// Images in which the floor is sought.
const TRIED: usize = 5;

/// A level camera that the shopper faces: image right is the shopper's left (+x), down is -y, forward is -z.
pub(super) fn level_camera() -> Affine3A {
    let rotation = Mat3::from_cols(Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z);
    Affine3A::from_mat3_translation(rotation, Vec3::Y * ASSUMED_CAMERA_HEIGHT)
}

/// A pose that was found or assumed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlacedCamera {
    /// Camera to world (m): the floor at y = 0, its origin under the middle of what the first image shows.
    pub pose: Affine3A,
    /// How it was found, in a sentence.
    pub note: String,
}

/// Finds the pose from frame to frame.
#[derive(Debug, Default)]
pub(super) struct CameraPlacement {
    tried: usize,
    /// The first image that shows anything.
    first: Option<DepthFrame>,
}

impl CameraPlacement {
    /// Looks at the next frame; gives the pose once the floor is seen, or once it was sought in vain.
    pub fn push(&mut self, frame: &DepthFrame) -> Option<PlacedCamera> {
        if !shows_anything(frame) {
            return None;
        }
        self.first.get_or_insert_with(|| frame.clone());
        self.tried += 1;
        match floor_of(frame) {
            Some(floor) => self.centred(
                floor.pose(),
                format!(
                    "the camera's pose is unknown: from the floor that it sees, it stands {:.2} m high and is tilted by {:.0} degrees",
                    floor.height,
                    floor.up.angle_between(Vec3::NEG_Y).to_degrees()
                ),
            ),
            None if self.tried >= TRIED => self.assumed(),
            None => None,
        }
    }

    /// The pose that is assumed where no floor was seen; none where nothing was.
    pub fn assumed(&mut self) -> Option<PlacedCamera> {
        let note = format!(
            "the camera's pose is unknown and no floor is seen: level, {ASSUMED_CAMERA_HEIGHT} m above the floor is assumed, and heights depend on it"
        );
        self.centred(level_camera(), note)
    }

    fn centred(&mut self, pose: Affine3A, note: String) -> Option<PlacedCamera> {
        let first = self.first.as_mut()?;
        first.camera_to_world = pose;
        let [x, _, z] = middle(first)?;
        Some(PlacedCamera { pose: Affine3A::from_translation(-Vec3::new(x, 0.0, z)) * pose, note })
    }
}

/// Whether anything was measured.
pub(super) fn shows_anything(frame: &DepthFrame) -> bool {
    frame.depth_mm.iter().any(|d| *d != 0)
}

/// The median of what a frame shows along x and z, and its lowest points along y (m).
pub(super) fn middle(frame: &DepthFrame) -> Option<[f32; 3]> {
    let points: Vec<Vec3> = frame.points().collect();
    let axis = |k: usize, fraction| quantile_of(points.iter().map(|p| p[k]), fraction);
    Some([axis(0, 0.5)?, axis(1, 0.002)?, axis(2, 0.5)?])
}

/// The floor that a frame of unknown pose shows.
fn floor_of(frame: &DepthFrame) -> Option<Floor> {
    let mut finder = FloorFinder::default();
    finder.push(frame, Vec3::NEG_Y);
    finder.floor().copied()
}
