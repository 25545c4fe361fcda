//! Which capsules cloth on a part of the body can touch at all: a sleeve never touches a leg.

use toile_assets::garment::Part;
use toile_assets::skeleton::{Joint, bone_joint};

use crate::colliders::Colliders;

/// The capsules that cloth on a part of the body can touch, a bit each.
pub fn reach(part: Part, colliders: &Colliders) -> u32 {
    let mut bits = 0;
    for (c, ends) in colliders.capsules().iter().enumerate() {
        let limb = ends.iter().map(|&s| limb(colliders.bone(s))).max_by_key(|l| *l as u8).unwrap_or(Part::Trunk);
        let touches = match part {
            Part::All => true,
            Part::Hollow => false,
            Part::Trunk => !matches!(limb, Part::LeftArm | Part::RightArm),
            Part::LeftArm | Part::RightArm => limb == part,
            Part::LeftLeg | Part::RightLeg => limb == part || limb == Part::Trunk,
        };
        bits |= u32::from(touches) << c;
    }
    bits
}

/// The limb that a bone belongs to; the shoulder girdle and the pelvis are the trunk's.
fn limb(bone: u8) -> Part {
    use Joint::*;
    const SIDES: [(Part, [Joint; 4]); 4] = [
        (Part::LeftArm, [LeftShoulder, LeftElbow, LeftWrist, LeftHand]),
        (Part::RightArm, [RightShoulder, RightElbow, RightWrist, RightHand]),
        (Part::LeftLeg, [LeftHip, LeftKnee, LeftAnkle, LeftToe]),
        (Part::RightLeg, [RightHip, RightKnee, RightAnkle, RightToe]),
    ];
    let joint = bone_joint(bone.into());
    SIDES.into_iter().find(|(_, joints)| joints.iter().any(|j| Some(*j) == joint)).map_or(Part::Trunk, |(part, _)| part)
}
