//! The 25 joints of the Kinect v2, and the way from its camera space to our world.
//!
//! Camera space: x to the sensor's left, y up, z away from the sensor. A half turn about y makes the shopper, who
//! faces the sensor, face +z; right-handed both.

use glam::Vec3;
use toile_assets::skeleton::Joint;

/// Joints of a Kinect v2 body.
pub(super) const KINECT_JOINTS: usize = 25;

/// Kinect joint number of each of ours. Spine shoulder, from which both shoulders hang, is our chest. The Kinect has no
/// clavicles; hand tips and thumbs (21..24) have no counterpart.
pub(super) const FROM_KINECT: [(usize, Joint); 21] = {
    use Joint::*;
    [
        (0, Pelvis),
        (1, Spine),
        (20, Chest),
        (2, Neck),
        (3, Head),
        (4, LeftShoulder),
        (5, LeftElbow),
        (6, LeftWrist),
        (7, LeftHand),
        (8, RightShoulder),
        (9, RightElbow),
        (10, RightWrist),
        (11, RightHand),
        (12, LeftHip),
        (13, LeftKnee),
        (14, LeftAnkle),
        (15, LeftToe),
        (16, RightHip),
        (17, RightKnee),
        (18, RightAnkle),
        (19, RightToe),
    ]
};

/// Camera space to world axes: a half turn about y.
pub(super) fn turned(camera: Vec3) -> Vec3 {
    Vec3::new(-camera.x, camera.y, -camera.z)
}
