//! Joints that were found in the same pictures as the silhouettes.

use glam::DVec3;
use toile_base::skeleton::Joint;
use toile_sensors::source::openpose::Point;

/// A joint that was found in pictures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointPoint {
    /// Which.
    pub joint: Joint,
    /// Where (m): in the cameras' world as it is given, in the upright one while it is fitted.
    pub place: DVec3,
    /// How sure it is, 0 to 1.
    pub confidence: f32,
}

/// The keypoints of BODY_25B that are joints of the body.
const KEYPOINTS: [(usize, Joint); 12] = [
    (5, Joint::LeftShoulder),
    (6, Joint::RightShoulder),
    (7, Joint::LeftElbow),
    (8, Joint::RightElbow),
    (9, Joint::LeftWrist),
    (10, Joint::RightWrist),
    (11, Joint::LeftHip),
    (12, Joint::RightHip),
    (13, Joint::LeftKnee),
    (14, Joint::RightKnee),
    (15, Joint::LeftAnkle),
    (16, Joint::RightAnkle),
];

/// The joints among the triangulated keypoints of BODY_25B.
pub fn joint_points(points: &[Point]) -> Vec<JointPoint> {
    let point = |(k, joint): &(usize, Joint)| {
        let p = points.get(*k).filter(|p| p.confidence > 0.0)?;
        Some(JointPoint { joint: *joint, place: p.position, confidence: p.confidence })
    };
    KEYPOINTS.iter().filter_map(point).collect()
}
