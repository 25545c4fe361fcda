//! The plan of the collision body: its spheres, the bones that carry them, the start of the fit, and the pairs of spheres
//! that span a capsule.
//!
//! Chosen by a search: from 129 capsules over the same spheres, one after the other was dropped whose loss cost the fit
//! least, and then exchanged while that helped, on bodies of both sexes and all sizes. Contact pays by the capsule and
//! hardly by the sphere, so that 28 capsules with ends of their own follow a trunk far closer than 28 that share 16. Head,
//! hands and feet were then given theirs, in place of one across the shoulder blades.
//! The start of the fit is the mean of its results on twelve bodies.

use toile_base::limits::MAX_CAPSULES;
use toile_base::skeleton::Joint;

/// Spheres beside the middle, each followed by its mirror image.
pub(super) const PAIRS: usize = 24;
/// Spheres of the middle, after them.
pub(super) const MIDDLE: usize = 3;
const _: () = assert!(toile_base::rig::SPHERES == 2 * PAIRS + MIDDLE);

/// Place of a sphere before the fit.
pub(super) enum SpherePlace {
    /// In the trunk: its height between the levels (0 crotch, 1 hip, 2 waist, 3 underbust, 4 chest, 5 shoulder), its
    /// place across as a share of the section's half breadth, ahead of the section's middle and its radius as shares of
    /// its half depth.
    Trunk { level: f32, across: f32, ahead: f32, radius: f32 },
    /// On the way from one joint to the next: the share of that way, and beside it (x outwards) as well as its radius as
    /// shares of the stature.
    Limb { from: Joint, to: Joint, along: f32, beside: [f32; 3], radius: f32 },
}

/// One sphere of the left side or of the middle.
pub(super) struct SpherePlan {
    /// The joint that carries it.
    pub carrier: Joint,
    /// Place from which the fit starts.
    pub start: SpherePlace,
    /// How strongly it is held there, times [`super::fit::HOLD`].
    pub held: f64,
}

const fn trunk(carrier: Joint, [level, across, ahead, radius]: [f32; 4]) -> SpherePlan {
    SpherePlan { carrier, start: SpherePlace::Trunk { level, across, ahead, radius }, held: 1.0 }
}

const fn limb(carrier: Joint, [from, to]: [Joint; 2], along: f32, beside: [f32; 3], radius: f32) -> SpherePlan {
    SpherePlan { carrier, start: SpherePlace::Limb { from, to, along, beside, radius }, held: 1.0 }
}

/// The left spheres, then those of the middle.
pub(super) const PLAN: [SpherePlan; PAIRS + MIDDLE] = {
    use Joint::*;
    const CLAVICLE: [Joint; 2] = [LeftClavicle, LeftShoulder];
    const UPPER_ARM: [Joint; 2] = [LeftShoulder, LeftElbow];
    const FOREARM: [Joint; 2] = [LeftElbow, LeftWrist];
    const THIGH: [Joint; 2] = [LeftHip, LeftKnee];
    const SHIN: [Joint; 2] = [LeftKnee, LeftAnkle];
    const HAND: [Joint; 2] = [LeftWrist, LeftHand];
    const FOOT: [Joint; 2] = [LeftAnkle, LeftToe];
    const NECK: [Joint; 2] = [Neck, Head];
    [
        trunk(Pelvis, [1.126, 0.358, 0.149, 0.91]),
        trunk(Pelvis, [1.029, 0.454, -0.273, 0.733]),
        trunk(Pelvis, [1.566, 0.338, -0.049, 0.979]),
        trunk(Spine, [1.962, 0.339, -0.048, 0.981]),
        trunk(Pelvis, [1.67, 0.173, 0.082, 0.959]),
        trunk(Chest, [3.331, 0.323, 0.08, 0.844]),
        trunk(Spine, [3.003, 0.341, -0.018, 0.929]),
        trunk(Chest, [3.863, 0.288, -0.076, 0.948]),
        trunk(Chest, [3.987, 0.503, 0.474, 0.523]),
        trunk(Chest, [4.477, 0.1, -0.181, 0.832]),
        trunk(Chest, [4.441, 0.491, -0.151, 0.715]),
        limb(Chest, CLAVICLE, 0.089, [-0.007, 0.0055, -0.0356], 0.0337),
        // The arm turns about this one: it stays where the joint is, so that the clavicle can carry it.
        SpherePlan { held: 200.0, ..limb(LeftClavicle, UPPER_ARM, 0.0, [0.0; 3], 0.0345) },
        limb(LeftElbow, UPPER_ARM, 1.052, [0.0016, 0.0019, 0.0], 0.0237),
        limb(LeftElbow, FOREARM, 0.185, [0.0004, 0.0005, 0.0004], 0.0269),
        limb(LeftWrist, FOREARM, 0.854, [-0.0002, 0.0, 0.0006], 0.0162),
        limb(LeftHip, THIGH, 0.312, [0.0047, 0.0001, 0.0112], 0.0496),
        limb(LeftHip, THIGH, 0.364, [0.0012, 0.0, 0.0062], 0.0547),
        limb(LeftKnee, THIGH, 1.065, [-0.0011, 0.0, -0.0005], 0.0335),
        limb(LeftKnee, SHIN, 0.209, [0.0004, 0.0007, -0.0111], 0.0371),
        limb(LeftAnkle, SHIN, 1.005, [0.0006, 0.0002, -0.0023], 0.0183),
        limb(LeftHand, HAND, 1.421, [-0.0047, -0.002, 0.0095], 0.021),
        limb(LeftAnkle, FOOT, -0.046, [-0.001, -0.0223, -0.0117], 0.0234),
        limb(LeftToe, FOOT, 1.38, [0.0073, 0.0085, 0.0043], 0.015),
        limb(Neck, NECK, 0.544, [0.0, -0.002, 0.0071], 0.0331),
        limb(Head, NECK, 1.282, [0.0, -0.0072, 0.0246], 0.0367),
        limb(Head, NECK, 1.779, [0.0, 0.0023, -0.0079], 0.051),
    ]
};

/// Places of the left spheres, the right one being the next, and of those in the middle.
mod at {
    pub const GROIN: u8 = 0;
    pub const BUTTOCK: u8 = 2;
    pub const HIP: u8 = 4;
    pub const WAIST: u8 = 6;
    pub const BELLY: u8 = 8;
    pub const UNDERBUST: u8 = 10;
    pub const RIB: u8 = 12;
    pub const CHEST: u8 = 14;
    pub const BREAST: u8 = 16;
    pub const BACK: u8 = 18;
    pub const ARMPIT: u8 = 20;
    pub const TRAPEZIUS: u8 = 22;
    pub const SHOULDER: u8 = 24;
    pub const ELBOW: u8 = 26;
    pub const FOREARM: u8 = 28;
    pub const WRIST: u8 = 30;
    pub const THIGH: u8 = 32;
    pub const MID_THIGH: u8 = 34;
    pub const KNEE: u8 = 36;
    pub const CALF: u8 = 38;
    pub const ANKLE: u8 = 40;
    pub const FINGERS: u8 = 42;
    pub const HEEL: u8 = 44;
    pub const TOES: u8 = 46;
    pub const NECK: u8 = 48;
    pub const JAW: u8 = 49;
    pub const SKULL: u8 = 50;
}

/// The capsules: neck and head, then left and right.
pub(super) const CAPSULES: [[u8; 2]; MAX_CAPSULES] = {
    use at::*;
    [
        [NECK, JAW],
        [JAW, SKULL],
        [BREAST, ARMPIT],
        [BREAST + 1, ARMPIT + 1],
        [TRAPEZIUS, NECK],
        [TRAPEZIUS + 1, NECK],
        [TRAPEZIUS, SHOULDER],
        [TRAPEZIUS + 1, SHOULDER + 1],
        [SHOULDER, ELBOW],
        [SHOULDER + 1, ELBOW + 1],
        [FOREARM, WRIST],
        [FOREARM + 1, WRIST + 1],
        [HIP, THIGH],
        [HIP + 1, THIGH + 1],
        [BUTTOCK, MID_THIGH],
        [BUTTOCK + 1, MID_THIGH + 1],
        [MID_THIGH, KNEE],
        [MID_THIGH + 1, KNEE + 1],
        [CALF, ANKLE],
        [CALF + 1, ANKLE + 1],
        [WAIST, UNDERBUST + 1],
        [WAIST + 1, UNDERBUST],
        [CHEST, BACK],
        [CHEST + 1, BACK + 1],
        [GROIN, HIP + 1],
        [GROIN + 1, HIP],
        [BELLY, RIB],
        [BELLY + 1, RIB + 1],
        [WRIST, FINGERS],
        [WRIST + 1, FINGERS + 1],
        [HEEL, TOES],
        [HEEL + 1, TOES + 1],
    ]
};
