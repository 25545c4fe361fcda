//! The bones that carry skin: one a joint, and along each limb segment the ones between which its twist is divided.
//!
//! A limb segment is split as Gultepe 2013 splits the forearm (section 4.4.3): its first bone takes pitch and roll, and
//! what turns it about itself (yaw) goes to bones that follow it. There is one of them there; here there are as many as
//! keep the volume. Linear blending over a stretch that twists by t loses (1 - cos t)/3 of the volume, so a stretch may
//! twist by 18 degrees where 98 % are to be kept.

use super::joint::{JOINTS, Joint};

/// A limb segment that is split for twist.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Twist {
    /// The joint at its root, whose bone does not twist.
    pub from: Joint,
    /// The joint at its far end, whose bone twists with all of it.
    pub to: Joint,
    /// The joint whose own rotation holds the twist: the ball joint at the root of an upper arm or a thigh, and for a
    /// forearm or a shin the wrist or the ankle that it turns.
    pub carrier: Joint,
    /// Index of its first twist bone; the others follow, from the root on.
    pub first: usize,
    /// How many there are.
    pub count: usize,
}

/// Twist bones of an upper arm: 120 degrees, in seven stretches of 17.
const ARM: usize = 6;
/// Twist bones of a forearm: 120 degrees, in twelve stretches of 10. It is the limb that people do turn so far, and its
/// triangles alone lose some 1.5 % of the volume as they are twisted; blending adds 0.5 % to that.
const FOREARM: usize = 11;
/// Twist bones of a thigh: 60 degrees, in four stretches of 15.
const THIGH: usize = 3;
/// Twist bones of a shin: 30 degrees, in two stretches of 15.
const SHIN: usize = 1;
/// Twist bones of one side.
const SIDE: usize = ARM + FOREARM + THIGH + SHIN;

/// Number of bones that carry skin: one a joint, then the twist bones of the left side and of the right.
pub const BONES: usize = JOINTS + 2 * SIDE;

/// The limb segments that are split: upper arm, forearm, thigh, shin of the left side, then of the right.
pub const TWISTS: [Twist; 8] = {
    use Joint::*;
    const fn of(from: Joint, to: Joint, carrier: Joint, first: usize, count: usize) -> Twist {
        Twist { from, to, carrier, first, count }
    }
    [
        of(LeftShoulder, LeftElbow, LeftShoulder, JOINTS, ARM),
        of(LeftElbow, LeftWrist, LeftWrist, JOINTS + ARM, FOREARM),
        of(LeftHip, LeftKnee, LeftHip, JOINTS + ARM + FOREARM, THIGH),
        of(LeftKnee, LeftAnkle, LeftAnkle, JOINTS + ARM + FOREARM + THIGH, SHIN),
        of(RightShoulder, RightElbow, RightShoulder, JOINTS + SIDE, ARM),
        of(RightElbow, RightWrist, RightWrist, JOINTS + SIDE + ARM, FOREARM),
        of(RightHip, RightKnee, RightHip, JOINTS + SIDE + ARM + FOREARM, THIGH),
        of(RightKnee, RightAnkle, RightAnkle, JOINTS + SIDE + ARM + FOREARM + THIGH, SHIN),
    ]
};

impl Twist {
    /// Its twist bones, from the root on.
    pub fn bones(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.count
    }

    /// Share of the twist that the `k`th of its bones takes, the root's counted as 0; also the share of the way from
    /// root to end at which it stands.
    pub fn share(&self, k: usize) -> f32 {
        k as f32 / (self.count + 1) as f32
    }

    /// The segment between two joints, if it is split.
    pub fn towards(to: Joint) -> Option<&'static Self> {
        TWISTS.iter().find(|t| t.to == to)
    }
}

/// Every bone with its parent, parents first: a split limb is a chain from its root over its twist
/// bones to its far joint.
pub const BONE_CHAIN: [(usize, Option<usize>); BONES] = {
    let mut chain = [(0, None); BONES];
    let (mut at, mut i) = (0, 0);
    while i < JOINTS {
        let mut parent = match Joint::ALL[i].parent() {
            Some(p) => Some(p.index()),
            None => None,
        };
        let mut t = 0;
        while t < TWISTS.len() {
            let mut bone = TWISTS[t].first;
            while TWISTS[t].to.index() == i && bone < TWISTS[t].first + TWISTS[t].count {
                chain[at] = (bone, parent);
                parent = Some(bone);
                (at, bone) = (at + 1, bone + 1);
            }
            t += 1;
        }
        chain[at] = (i, parent);
        (at, i) = (at + 1, i + 1);
    }
    chain
};

/// The joint that a bone belongs to: a twist bone to the one at the root of its limb. Nothing for what is no bone.
pub fn bone_joint(bone: usize) -> Option<Joint> {
    let twist = TWISTS.iter().find(|t| t.bones().contains(&bone)).map(|t| t.from);
    twist.or_else(|| Joint::ALL.get(bone).copied())
}

/// The name of a bone in files: a joint's is that of H-Anim, and twist bones, for which H-Anim has no name, are numbered
/// from the root of their limb: `l_elbow_twist_1`.
pub fn bone_name(bone: usize) -> Option<String> {
    let joint = bone_joint(bone)?;
    let number = TWISTS.iter().find(|t| t.bones().contains(&bone)).map(|t| bone - t.first + 1);
    Some(number.map_or_else(|| joint.hanim().to_owned(), |n| format!("{}_twist_{n}", joint.hanim())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_names_every_bone_once_parents_first() {
        let mut seen = [false; BONES];
        for (bone, parent) in BONE_CHAIN {
            assert!(!seen[bone], "bone {bone} comes twice");
            assert!(parent.is_none_or(|p| seen[p]), "bone {bone} comes before its parent");
            assert_eq!(parent.is_none(), bone == Joint::Pelvis.index());
            seen[bone] = true;
        }
        let of = |bone: usize| BONE_CHAIN.into_iter().find(|(b, _)| *b == bone).and_then(|(_, p)| p);
        assert_eq!(of(Joint::LeftWrist.index()), Some(TWISTS[1].first + TWISTS[1].count - 1));
        assert_eq!(of(TWISTS[1].first), Some(Joint::LeftElbow.index()));
        assert_eq!(of(Joint::LeftHand.index()), Some(Joint::LeftWrist.index()));
    }

    #[test]
    fn bones_know_their_joint() {
        assert_eq!(bone_joint(TWISTS[4].first + 2), Some(Joint::RightShoulder));
        assert_eq!(bone_joint(BONES), None);
        assert_eq!(TWISTS[7].first + TWISTS[7].count, BONES);
    }

    #[test]
    fn every_bone_has_a_name_of_its_own() {
        let names: std::collections::BTreeSet<String> = (0..BONES).filter_map(bone_name).collect();
        assert_eq!(names.len(), BONES);
        assert!(names.contains("l_radiocarpal") && names.contains("r_knee_twist_1"));
        assert_eq!(bone_name(BONES), None);
    }
}
