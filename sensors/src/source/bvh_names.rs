//! Maps the joints of a BVH file to ours: the dialects of the field, known by the names they use.
//!
//! The classic error is off by one along the arm: `LeftShoulder` is the clavicle where there is a `LeftArm`, and the
//! shoulder joint where there is a `LeftElbow`; `LeftHip` and `LeftUpLeg` are the same joint.

use toile_base::skeleton::{JOINTS, Joint};

use super::bvh_file::Node;
use crate::error::{FilePlace, ReaderFault};

/// A dialect: names that it alone has, then the names of each joint, the first that the file has counts. `@` stands for the
/// side. Names are compared without case, prefix (`mixamorig:`) and separators.
struct Dialect {
    marks: &'static [&'static str],
    middle: [(Joint, &'static [&'static str]); 5],
    side: [(Joint, &'static [&'static str]); 9],
    left_right: [&'static str; 2],
}

/// Names of Maya, MotionBuilder, Mixamo and the FAIR files: arm, fore arm, up leg, leg.
const ARM_AND_UP_LEG: Dialect = Dialect {
    marks: &["LeftArm", "LeftForeArm", "LeftUpLeg", "LeftLeg"],
    middle: [
        (Joint::Pelvis, &["Hips", "Hip", "Pelvis"]),
        (Joint::Spine, &["LowerBack", "Spine"]),
        (Joint::Chest, &["Spine3", "Spine2", "Spine1", "Chest"]),
        (Joint::Neck, &["Neck", "Neck1"]),
        (Joint::Head, &["Head"]),
    ],
    side: [
        (Joint::LeftClavicle, &["@Shoulder", "@Collar"]),
        (Joint::LeftShoulder, &["@Arm"]),
        (Joint::LeftElbow, &["@ForeArm"]),
        (Joint::LeftWrist, &["@Hand"]),
        (Joint::LeftHand, &["@HandEnd", "@HandMiddle1", "@HandIndex1", "@FingerBase"]),
        (Joint::LeftHip, &["@UpLeg"]),
        (Joint::LeftKnee, &["@Leg"]),
        (Joint::LeftAnkle, &["@Foot"]),
        (Joint::LeftToe, &["@ToeBase", "@Toe"]),
    ],
    left_right: ["Left", "Right"],
};

/// Names of the joints themselves, as in B. Hahne's CMU files: hip, knee, shoulder, elbow. Their `lowerback` stands at
/// the pelvis itself, so that `Chest` is the first joint of the spine.
const HIP_AND_KNEE: Dialect = Dialect {
    marks: &["LeftHip", "LeftKnee", "LeftShoulder", "LeftElbow"],
    middle: [
        (Joint::Pelvis, &["Hips", "Pelvis"]),
        (Joint::Spine, &["Chest", "Spine", "lowerback"]),
        (Joint::Chest, &["Chest4", "Chest3", "Chest2", "UpperChest", "Spine1"]),
        (Joint::Neck, &["Neck"]),
        (Joint::Head, &["Head"]),
    ],
    side: [
        (Joint::LeftClavicle, &["@Collar", "@Clavicle"]),
        (Joint::LeftShoulder, &["@Shoulder"]),
        (Joint::LeftElbow, &["@Elbow"]),
        (Joint::LeftWrist, &["@Wrist"]),
        (Joint::LeftHand, &["$Fingers", "@Fingers", "@Hand"]),
        (Joint::LeftHip, &["@Hip"]),
        (Joint::LeftKnee, &["@Knee"]),
        (Joint::LeftAnkle, &["@Ankle"]),
        (Joint::LeftToe, &["@Toe"]),
    ],
    left_right: ["Left", "Right"],
};

/// VRM and VMC: upper arm, lower arm, upper leg, lower leg.
const UPPER_AND_LOWER: Dialect = Dialect {
    marks: &["LeftUpperArm", "LeftLowerArm", "LeftUpperLeg", "LeftLowerLeg"],
    middle: [
        (Joint::Pelvis, &["Hips"]),
        (Joint::Spine, &["Spine"]),
        (Joint::Chest, &["UpperChest", "Chest"]),
        (Joint::Neck, &["Neck"]),
        (Joint::Head, &["Head"]),
    ],
    side: [
        (Joint::LeftClavicle, &["@Shoulder"]),
        (Joint::LeftShoulder, &["@UpperArm"]),
        (Joint::LeftElbow, &["@LowerArm"]),
        (Joint::LeftWrist, &["@Hand"]),
        (Joint::LeftHand, &["@MiddleProximal", "@IndexProximal"]),
        (Joint::LeftHip, &["@UpperLeg"]),
        (Joint::LeftKnee, &["@LowerLeg"]),
        (Joint::LeftAnkle, &["@Foot"]),
        (Joint::LeftToe, &["@Toes", "@ToeBase"]),
    ],
    left_right: ["Left", "Right"],
};

/// Game engines: upperarm_l, lowerarm_l, thigh_l, calf_l.
const THIGH_AND_CALF: Dialect = Dialect {
    marks: &["upperarm_l", "lowerarm_l", "thigh_l", "calf_l"],
    middle: [
        (Joint::Pelvis, &["pelvis"]),
        (Joint::Spine, &["spine_01"]),
        (Joint::Chest, &["spine_03", "spine_02"]),
        (Joint::Neck, &["neck_01", "neck"]),
        (Joint::Head, &["head"]),
    ],
    side: [
        (Joint::LeftClavicle, &["clavicle_@"]),
        (Joint::LeftShoulder, &["upperarm_@"]),
        (Joint::LeftElbow, &["lowerarm_@"]),
        (Joint::LeftWrist, &["hand_@"]),
        (Joint::LeftHand, &["middle_01_@", "index_01_@"]),
        (Joint::LeftHip, &["thigh_@"]),
        (Joint::LeftKnee, &["calf_@"]),
        (Joint::LeftAnkle, &["foot_@"]),
        (Joint::LeftToe, &["ball_@"]),
    ],
    left_right: ["l", "r"],
};

const DIALECTS: [&Dialect; 4] = [&ARM_AND_UP_LEG, &HIP_AND_KNEE, &UPPER_AND_LOWER, &THIGH_AND_CALF];

/// Joints without which a recording cannot be levelled, scaled or dressed.
const NEEDED: [Joint; 9] = [
    Joint::Pelvis,
    Joint::Head,
    Joint::LeftHip,
    Joint::LeftKnee,
    Joint::LeftAnkle,
    Joint::RightHip,
    Joint::RightKnee,
    Joint::RightAnkle,
    Joint::LeftShoulder,
];

/// Node index of each of our joints, `None` where the file has none.
pub(super) type Names = [Option<usize>; JOINTS];

/// Maps a file's joints to ours.
pub(super) fn map(nodes: &[Node]) -> Result<Names, ReaderFault> {
    const CURE: &str = "rename its joints as in VRM, Mixamo or the CMU files";
    let plain: Vec<String> = nodes.iter().map(|n| plain(&n.name)).collect();
    let find = |name: &str| plain.iter().position(|p| !p.is_empty() && *p == self::plain(name));
    let Some(dialect) = DIALECTS.iter().find(|d| d.marks.iter().all(|t| find(t).is_some())) else {
        return Err(ReaderFault::new(FilePlace::Whole, "the skeleton's joint names are of no known dialect", CURE));
    };
    let mut names: Names = [None; JOINTS];
    for (joint, candidates) in dialect.middle {
        names[joint.index()] = candidates.iter().find_map(|c| find(c));
    }
    for (left, candidates) in dialect.side {
        for (joint, side) in [left, left.mirror()].into_iter().zip(dialect.left_right) {
            let initial = &side[..1];
            names[joint.index()] = candidates.iter().find_map(|c| find(&c.replace('@', side).replace('$', initial)));
        }
    }
    match NEEDED.into_iter().find(|j| names[j.index()].is_none()) {
        Some(joint) => {
            Err(ReaderFault::new(FilePlace::Whole, format!("the skeleton has no joint for {joint:?}"), CURE))
        }
        None => Ok(names),
    }
}

/// A name without prefix, case and separators.
fn plain(name: &str) -> String {
    let name = name.rsplit(':').next().unwrap_or(name);
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn skeleton(names: &[&str]) -> Vec<Node> {
        let node = |n: &&str| Node { name: (*n).into(), parent: None, offset: DVec3::ZERO, channels: Vec::new() };
        names.iter().map(node).collect()
    }

    #[test]
    fn left_shoulder_is_the_clavicle_only_beside_a_left_arm() {
        let mut fair = vec!["Hips", "Spine", "Head"];
        let mut cmu = vec!["Hips", "Chest", "Head"];
        for side in ["Left", "Right"] {
            for part in ["Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot"] {
                fair.push(format!("mixamorig:{side}{part}").leak());
            }
            for part in ["Collar", "Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle"] {
                cmu.push(format!("{side}{part}").leak());
            }
        }
        let names = map(&skeleton(&fair)).unwrap();
        assert_eq!(names[Joint::LeftClavicle.index()], Some(3));
        assert_eq!(names[Joint::LeftShoulder.index()], Some(4));
        assert_eq!(names[Joint::RightAnkle.index()], Some(16));
        let names = map(&skeleton(&cmu)).unwrap();
        assert_eq!(names[Joint::LeftClavicle.index()], Some(3));
        assert_eq!(names[Joint::LeftShoulder.index()], Some(4));
        assert_eq!(names[Joint::LeftHip.index()], Some(7));
    }

    #[test]
    fn unknown_names_are_refused() {
        assert!(map(&skeleton(&["a", "b"])).is_err());
        assert!(map(&skeleton(&["LeftArm", "LeftForeArm", "LeftUpLeg", "LeftLeg"])).is_err());
    }
}
