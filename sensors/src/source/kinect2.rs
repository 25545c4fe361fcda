//! From the camera space of a Kinect, v1 or v2, to world coordinates.
//!
//! Camera space: x to the sensor's left, y up, z away from the sensor. A half turn about y makes the shopper, who
//! faces the sensor, face +z; right-handed both.

use glam::Vec3;

/// Joints of a Kinect v2 body.
pub(super) const KINECT_JOINTS: usize = super::joint_map::Format::Kinect25.points();

/// Camera space to world axes: a half turn about y.
pub(super) fn turned(camera: Vec3) -> Vec3 {
    Vec3::new(-camera.x, camera.y, -camera.z)
}
