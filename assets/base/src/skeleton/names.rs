//! Names of the joints in other skeletons: H-Anim (ISO/IEC 19774), version 2 and version 1, and VRM's humanoid bones.

use super::joint::{JOINTS, Joint};

/// A joint's own name in each convention.
struct Names {
    joint: Joint,
    hanim: &'static str,
    hanim_1: &'static str,
    vrm: &'static str,
}

const fn named(joint: Joint, hanim: &'static str, hanim_1: &'static str, vrm: &'static str) -> Names {
    Names { joint, hanim, hanim_1, vrm }
}

/// In the order of the joints. Our hand begins at the knuckle of the middle finger.
const OWN: [Names; JOINTS] = {
    use Joint::*;
    [
        named(Pelvis, "sacroiliac", "sacroiliac", "hips"),
        named(Spine, "vl5", "vl5", "spine"),
        named(Chest, "vl1", "vl1", "chest"),
        named(Neck, "vc4", "vc4", "neck"),
        named(Head, "skullbase", "skullbase", "head"),
        named(LeftClavicle, "l_sternoclavicular", "l_sternoclavicular", "leftShoulder"),
        named(LeftShoulder, "l_shoulder", "l_shoulder", "leftUpperArm"),
        named(LeftElbow, "l_elbow", "l_elbow", "leftLowerArm"),
        named(LeftWrist, "l_radiocarpal", "l_wrist", "leftHand"),
        named(LeftHand, "l_metacarpophalangeal_3", "l_middle1", "leftMiddleProximal"),
        named(LeftHip, "l_hip", "l_hip", "leftUpperLeg"),
        named(LeftKnee, "l_knee", "l_knee", "leftLowerLeg"),
        named(LeftAnkle, "l_talocrural", "l_ankle", "leftFoot"),
        named(LeftToe, "l_metatarsophalangeal", "l_midtarsal", "leftToes"),
        named(RightClavicle, "r_sternoclavicular", "r_sternoclavicular", "rightShoulder"),
        named(RightShoulder, "r_shoulder", "r_shoulder", "rightUpperArm"),
        named(RightElbow, "r_elbow", "r_elbow", "rightLowerArm"),
        named(RightWrist, "r_radiocarpal", "r_wrist", "rightHand"),
        named(RightHand, "r_metacarpophalangeal_3", "r_middle1", "rightMiddleProximal"),
        named(RightHip, "r_hip", "r_hip", "rightUpperLeg"),
        named(RightKnee, "r_knee", "r_knee", "rightLowerLeg"),
        named(RightAnkle, "r_talocrural", "r_ankle", "rightFoot"),
        named(RightToe, "r_metatarsophalangeal", "r_midtarsal", "rightToes"),
    ]
};

/// Joints of finer skeletons that move with one of ours: the root that only places the body, and the second joint of
/// the chest, where H-Anim and VRM have two and we have one.
const SHARED: [(&str, Joint); 4] = [
    ("humanoid_root", Joint::Pelvis),
    ("HumanoidRoot", Joint::Pelvis),
    ("vt6", Joint::Chest),
    ("upperChest", Joint::Chest),
];

impl Joint {
    /// The joint that H-Anim, version 2 or 1, or VRM calls so; case does not count. Both joints of a chest that has two
    /// lead to ours; [`Self::hanim`] and [`Self::vrm`] name the one that is ours by place.
    pub fn named(name: &str) -> Option<Self> {
        let own = OWN.iter().find(|n| [n.hanim, n.hanim_1, n.vrm].iter().any(|own| own.eq_ignore_ascii_case(name)));
        let shared = || SHARED.iter().find(|(shared, _)| shared.eq_ignore_ascii_case(name)).map(|(_, joint)| *joint);
        own.map(|n| n.joint).or_else(shared)
    }

    /// Its name in H-Anim, version 2.
    pub fn hanim(self) -> &'static str {
        OWN[self.index()].hanim
    }

    /// Its name in H-Anim, version 1.
    pub fn hanim_1(self) -> &'static str {
        OWN[self.index()].hanim_1
    }

    /// Its humanoid bone in VRM.
    pub fn vrm(self) -> &'static str {
        OWN[self.index()].vrm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_back_to_its_joint() {
        for joint in Joint::ALL {
            assert_eq!(OWN[joint.index()].joint, joint, "the table is in the order of the joints");
            for name in [joint.hanim(), joint.hanim_1(), joint.vrm()] {
                assert_eq!(Joint::named(name), Some(joint), "{name}");
                for (left, right) in [("l_", "r_"), ("left", "right")] {
                    let other = name.strip_prefix(left).map(|rest| format!("{right}{rest}"));
                    assert!(other.is_none_or(|o| Joint::named(&o) == Some(joint.mirror())), "{name}");
                }
            }
        }
        assert_eq!(Joint::named("LeftUpperArm"), Some(Joint::LeftShoulder));
        assert_eq!(Joint::named("tail"), None);
    }

    /// The rows of the joint map: H-Anim 2, H-Anim 1, VRM. Not there: nothing, but a failure in continuous integration.
    fn joint_map() -> Option<Vec<[String; 3]>> {
        let folder = crate::recordings::folder()?;
        let text = std::fs::read_to_string(folder.join("protocols/joint_map.csv")).expect("the joint map is there");
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let head = lines.next().expect("a head line");
        let columns = ["hanim_v2", "hanim_v1", "vrm_bone"].map(|c| head.iter().position(|h| h == c).expect(c));
        Some(lines.map(|row| columns.map(|c| row[c].clone())).collect())
    }

    #[test]
    fn names_are_those_of_the_joint_map() {
        let Some(rows) = joint_map() else { return };
        assert!(rows.len() >= JOINTS, "{} rows", rows.len());
        for [hanim, hanim_1, vrm] in &rows {
            let joint = Joint::named(hanim);
            assert!(joint.is_some(), "{hanim} leads to no joint");
            assert_eq!(Joint::named(hanim_1), joint, "{hanim_1}");
            assert!(vrm.starts_with('(') || Joint::named(vrm) == joint, "{vrm}");
        }
        // Each joint but the hands, which the map has not, is in the row of its own names.
        let hands = [Joint::LeftHand, Joint::RightHand];
        for joint in Joint::ALL.into_iter().filter(|j| !hands.contains(j)) {
            let own = [joint.hanim(), joint.hanim_1(), joint.vrm()].map(str::to_owned);
            assert!(rows.contains(&own), "{own:?}");
        }
    }
}
