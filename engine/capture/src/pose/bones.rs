//! The bones between the keypoints of BODY_25B, as a tree that hangs from the neck, and their lengths.

use toile_base::numeric::statistics::median_of;
use toile_sensors::source::openpose::{KeypointRecording, POINTS};

/// A bone: from a keypoint to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bone {
    /// Keypoint that it hangs from.
    pub from: usize,
    /// Keypoint at its end.
    pub to: usize,
}

const fn bone(from: usize, to: usize) -> Bone {
    Bone { from, to }
}

/// The keypoint that all hangs from: the neck.
pub(super) const ROOT: usize = 17;

/// Number of bones.
pub const BONES: usize = 20;

/// The tree, a bone after the one that it hangs from.
pub(super) const TREE: [Bone; BONES] = [
    bone(17, 18),
    bone(17, 0),
    bone(17, 5),
    bone(17, 6),
    bone(17, 11),
    bone(17, 12),
    bone(5, 7),
    bone(7, 9),
    bone(6, 8),
    bone(8, 10),
    bone(11, 13),
    bone(13, 15),
    bone(12, 14),
    bone(14, 16),
    bone(15, 19),
    bone(15, 20),
    bone(15, 21),
    bone(16, 22),
    bone(16, 23),
    bone(16, 24),
];

/// Pairs that keep their distance besides, within some millimetres: a pelvis' breadth, feet.
pub(super) const BRACES: [Bone; 8] =
    [bone(11, 12), bone(19, 20), bone(19, 21), bone(20, 21), bone(22, 23), bone(22, 24), bone(23, 24), bone(18, 0)];

/// Confidence from which a point counts for a bone's length.
const BELIEVED: f32 = 0.3;

/// Fewest frames that give a length.
const FEWEST: usize = 5;

/// Names of the keypoints, as Pose2Sim writes them; empty where it writes none.
pub fn marker_name(keypoint: usize) -> &'static str {
    const NAMES: [&str; POINTS] = [
        "Nose",
        "",
        "",
        "",
        "",
        "LShoulder",
        "RShoulder",
        "LElbow",
        "RElbow",
        "LWrist",
        "RWrist",
        "LHip",
        "RHip",
        "LKnee",
        "RKnee",
        "LAnkle",
        "RAnkle",
        "Neck",
        "Head",
        "LBigToe",
        "LSmallToe",
        "LHeel",
        "RBigToe",
        "RSmallToe",
        "RHeel",
    ];
    NAMES.get(keypoint).copied().unwrap_or_default()
}

/// The length of a bone over all frames: the median of where both ends are seen (m).
pub(super) fn length(recording: &KeypointRecording, bone: Bone) -> Option<f64> {
    let seen = recording.frames.iter().flatten().filter_map(|f| {
        let (a, b) = (f.points[bone.from], f.points[bone.to]);
        (a.confidence.min(b.confidence) > BELIEVED).then(|| a.position.distance(b.position) as f32)
    });
    let all: Vec<f32> = seen.collect();
    (all.len() >= FEWEST).then(|| median_of(all).map(f64::from)).flatten()
}
