//! Which capsules cloth on a part of the body can touch at all: a sleeve never touches a leg.

use toile_base::garment::Part;

use crate::body_surface::BodyPart;
use crate::colliders::Colliders;

/// The capsules that cloth on a part of the body can touch, a bit each.
pub fn reach(part: Part, colliders: &Colliders) -> u32 {
    let touches = |c: usize| u32::from(limb(c, colliders).touches(part));
    (0..colliders.capsules().len()).fold(0, |bits, c| bits | touches(c) << c)
}

/// The limb that a capsule belongs to: that of its end farther out.
pub fn limb(capsule: usize, colliders: &Colliders) -> BodyPart {
    let ends = colliders.capsules()[capsule].iter();
    ends.map(|&s| BodyPart::of_bone(colliders.bone(s))).max_by_key(|l| *l as u8).unwrap_or(BodyPart::Trunk)
}
