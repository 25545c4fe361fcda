//! How far each joint turns: clinical ranges of motion, approached softly so that a clamp never shows as a stop.
//!
//! Degrees, after the American Academy of Orthopaedic Surgeons, "Joint Motion: Method of Measuring and Recording"
//! (1965), whose neutral is standing with the arms hanging; where a constant is wider than the table the reason stands
//! beside it. A range is left untouched up to [`SOFT_DEG`] before its end.

use glam::{Quat, Vec3};

use super::smooth::{rotation_vector, wrap};

/// Width of the zone before a limit in which angles are compressed (degrees).
pub const SOFT_DEG: f32 = 8.0;

/// A range of one angle (degrees).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Least angle (degrees).
    pub min: f32,
    /// Greatest angle (degrees).
    pub max: f32,
}

/// Elbow: 0 to 150 flexed; 10 beyond straight, which loose joints reach and noise suggests.
pub const ELBOW: Range = Range { min: -10.0, max: 150.0 };

/// Knee: 0 to 135 in the table; 155 in a deep squat, where the body's weight closes it.
pub const KNEE: Range = Range { min: -10.0, max: 155.0 };

/// Sideways play of a hinge (degrees): the elbow's carrying angle and what noise leaves of it.
pub const HINGE_PLAY: f32 = 25.0;

/// Upper arm about its own axis, inwards positive: 70 inwards and 90 outwards, each 30 wider because the neutral that
/// they are counted from depends on the way by which the arm was raised (Codman's paradox).
pub const SHOULDER_TWIST: Range = Range { min: -120.0, max: 100.0 };

/// Thigh about its own axis, inwards positive: 45 each way, outwards 15 wider for a seated or squatting leg.
pub const HIP_TWIST: Range = Range { min: -60.0, max: 45.0 };

/// Where an upper arm reaches: 180 up, 60 back, 45 across the chest: all but a cone behind the back.
pub const SHOULDER_REACH: Reach = Reach { centre: [0.7, -0.15, 0.6], front_back: 125.0, sideways: 125.0 };

/// Where a thigh reaches: 120 forward and 30 back, 45 out and 30 in; the outward side 15 wider, as a squat opens it.
pub const HIP_REACH: Reach = Reach { centre: [0.15, -0.7, 0.7], front_back: 92.0, sideways: 62.0 };

/// Spine and chest share the trunk's 80 forward and 25 back, 45 of turn, 35 sideways: each half, and half as much
/// again because they are seldom shared evenly.
pub const TRUNK: Spread = Spread { flexion: [-20.0, 60.0], turn: [-35.0, 35.0], side: [-28.0, 28.0] };

/// Neck: 45 forward, 45 back, 60 of turn, 45 sideways.
pub const NECK: Spread = Spread { flexion: [-45.0, 50.0], turn: [-60.0, 60.0], side: [-45.0, 45.0] };

/// Collar bone of the left side: lifted 35, lowered 10, 20 forwards and back (Inman, Saunders and Abbott 1944).
pub const CLAVICLE: Spread = Spread { flexion: [-10.0, 10.0], turn: [-25.0, 25.0], side: [-15.0, 40.0] };

/// Foot against the shin: 20 up and 50 down (down positive), 20 of turn, 35 in and 20 out; 10 wider upwards for squats.
pub const ANKLE: Spread = Spread { flexion: [-35.0, 60.0], turn: [-25.0, 25.0], side: [-30.0, 30.0] };

/// Hand against the forearm, every way: 80 down and 70 up.
pub const WRIST_DEG: f32 = 80.0;

/// Directions that a ball joint's limb can take: an elliptic cone about `centre`, given for the left side in rest axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Middle of the cone, not normalised.
    pub centre: [f32; 3],
    /// Half opening forwards and backwards (degrees).
    pub front_back: f32,
    /// Half opening inwards and outwards (degrees).
    pub sideways: f32,
}

/// Ranges of a joint's rotation vector about the body's axes (degrees), given for the left side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// About x: forward, or down, positive.
    pub flexion: [f32; 2],
    /// About y: to the left positive.
    pub turn: [f32; 2],
    /// About z: the left side up positive.
    pub side: [f32; 2],
}

/// Left and right: what mirrors a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The person's left, +x.
    Left,
    /// The person's right.
    Right,
}

impl Side {
    /// Left, then right.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// +1 on the left, -1 on the right.
    pub fn sign(self) -> f32 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }
}

impl Range {
    /// The range of a left joint's angle about an axis that does not mirror, for either side.
    pub fn on(self, side: Side) -> Self {
        match side {
            Side::Left => self,
            Side::Right => Self { min: -self.max, max: -self.min },
        }
    }

    /// An angle (rad) brought into the range softly.
    pub fn clamp(self, angle: f32) -> f32 {
        soft_clamp(angle, self.min.to_radians(), self.max.to_radians())
    }

    /// Middle of the range (rad).
    pub fn middle(self) -> f32 {
        (0.5 * (self.min + self.max)).to_radians()
    }

    /// The same angle (rad), whole turns added so that it lies as near to the range as it can.
    pub fn near(self, angle: f32) -> f32 {
        self.middle() + wrap(angle - self.middle())
    }

    /// How far an angle (rad) lies outside the range (rad), 0 inside.
    pub fn excess(self, angle: f32) -> f32 {
        (self.min.to_radians() - angle).max(angle - self.max.to_radians()).max(0.0)
    }
}

impl Reach {
    /// A direction (unit, in the parent's frame) brought into the cone softly.
    pub fn clamp(self, direction: Vec3, side: Side) -> Vec3 {
        let mut centre = Vec3::from_array(self.centre).normalize();
        centre.x *= side.sign();
        let bend = rotation_vector(Quat::from_rotation_arc(centre, direction));
        let flexion = (Vec3::X - centre * centre.x).normalize_or(Vec3::Z);
        let abduction = centre.cross(flexion);
        let f = bend.dot(flexion) / self.front_back.to_radians();
        let s = bend.dot(abduction) / self.sideways.to_radians();
        let used = (f * f + s * s).sqrt();
        let soft = SOFT_DEG / self.front_back.min(self.sideways);
        let kept = soft_above(used, 1.0, soft);
        if used <= kept {
            return direction;
        }
        Quat::from_scaled_axis(bend * (kept / used)) * centre
    }
}

impl Spread {
    /// A rotation brought into the ranges softly.
    pub fn clamp(self, turn: Quat, side: Side) -> Quat {
        let mut v = rotation_vector(turn);
        v.y *= side.sign();
        v.z *= side.sign();
        for (angle, [min, max]) in [(&mut v.x, self.flexion), (&mut v.y, self.turn), (&mut v.z, self.side)] {
            *angle = soft_clamp(*angle, min.to_radians(), max.to_radians());
        }
        v.y *= side.sign();
        v.z *= side.sign();
        Quat::from_scaled_axis(v)
    }
}

/// A rotation with its angle brought below `max_deg` softly.
pub fn clamp_angle(turn: Quat, max_deg: f32) -> Quat {
    let v = rotation_vector(turn);
    let angle = v.length();
    let kept = soft_above(angle, max_deg.to_radians(), SOFT_DEG.to_radians());
    if angle > kept { Quat::from_scaled_axis(v * (kept / angle)) } else { turn }
}

/// `angle` within `min..max` (rad): unchanged up to [`SOFT_DEG`] before either end, then compressed so that value and
/// slope are continuous and the end is never passed.
pub fn soft_clamp(angle: f32, min: f32, max: f32) -> f32 {
    let soft = SOFT_DEG.to_radians().min(0.5 * (max - min));
    if angle > 0.5 * (min + max) { soft_above(angle, max, soft) } else { -soft_above(-angle, -min, soft) }
}

/// The upper half of [`soft_clamp`]: `max - soft e^-x`, x the distance past `max - soft`
/// in units of `soft`.
fn soft_above(value: f32, max: f32, soft: f32) -> f32 {
    let knee = max - soft;
    if value <= knee { value } else { max - soft * (-(value - knee) / soft).exp() }
}
