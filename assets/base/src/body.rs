//! What a body is: its surface, its skeleton, its parts, its measures.

use glam::Vec3;

use crate::mesh::{Mesh, SkinWeights};
use crate::skeleton::Skeleton;

/// Which drawing a body is stretched from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sex {
    /// The woman's drawing.
    Female,
    /// The man's drawing.
    Male,
}

impl Sex {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Female, Self::Male];

    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Female => "female",
            Self::Male => "male",
        }
    }
}

/// The measures that a body is built to, by the definitions of EN 13402-1 (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Height without hair and shoes (m).
    pub stature: f32,
    /// Biacromial: between the tips of the two shoulder blades, not over the deltoids (m).
    pub shoulder_breadth: f32,
    /// Horizontal girth at the bust points, under the armpits (m).
    pub chest_girth: f32,
    /// Girth at the natural waistline, midway between the lowest rib and the top of the hip bone (m).
    pub waist_girth: f32,
    /// Girth at the greatest protrusion of the buttocks (m).
    pub hip_girth: f32,
}

impl Measures {
    /// The means of ANSUR II (US Army Natick TR-15/007, 2014): 1,986 women, 4,082 men; hip is its buttock
    /// circumference. Its waist is taken at the navel, so the natural waist is instead the one that EN 13402-3 pairs
    /// with the chest: 16 cm less for women, 12 cm less for men.
    pub fn average(sex: Sex) -> Self {
        match sex {
            Sex::Female => Self {
                stature: 1.6285,
                shoulder_breadth: 0.3653,
                chest_girth: 0.9469,
                waist_girth: 0.7869,
                hip_girth: 1.0212,
            },
            Sex::Male => Self {
                stature: 1.7562,
                shoulder_breadth: 0.4157,
                chest_girth: 1.0587,
                waist_girth: 0.9387,
                hip_girth: 1.0195,
            },
        }
    }
}

/// Parts of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Region {
    /// Trunk, up to the neck.
    Torso,
    /// Head, from the neck up.
    Head,
    /// Left arm and hand.
    LeftArm,
    /// Right arm and hand.
    RightArm,
    /// Left leg and foot.
    LeftLeg,
    /// Right leg and foot.
    RightLeg,
}

/// Heights of the measuring levels above the floor, in the rest pose (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// Base of the neck at the 7th cervical vertebra.
    pub neck: f32,
    /// Height of the acromions over the floor (m).
    pub shoulder: f32,
    /// Height of the bust points over the floor (m).
    pub chest: f32,
    /// Just below the breasts.
    pub underbust: f32,
    /// Height of the natural waistline over the floor (m).
    pub waist: f32,
    /// Greatest protrusion of the buttocks.
    pub hip: f32,
    /// Lowest point between the legs.
    pub crotch: f32,
    /// Middle of the kneecap.
    pub knee: f32,
    /// Height of the ankle joint over the floor (m).
    pub ankle: f32,
}

/// A body of one size in its rest pose: arms half raised, feet under the hips, facing +z, the floor at y = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// The drawing it comes from.
    pub sex: Sex,
    /// Closed surface (m), without texture coordinates.
    pub mesh: Mesh,
    /// Unit normals `[vertices]`.
    pub normals: Vec<Vec3>,
    /// Joint centres in the rest pose (m).
    pub skeleton: Skeleton,
    /// Bones that carry each vertex `[vertices]`.
    pub weights: Vec<SkinWeights>,
    /// Part of the body `[vertices]`.
    pub regions: Vec<Region>,
    /// Heights of the measuring levels.
    pub levels: Levels,
    /// As measured on this mesh by the tape.
    pub measures: Measures,
}
