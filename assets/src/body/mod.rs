//! The parametric body: two drawn bodies, and morphs that fit them to whatever measures are given.
//!
//! Reads: the drawings in `data/body/`, the measures wanted. Writes: one immutable [`Body`].
//! Budget: at load only, under 20 ms a body; the mesh has the same vertices and triangles whatever the size.
//! Thread: the loading thread.

pub mod base;
mod calibrate;
mod fields;
mod fitted;
mod gauge;
pub mod landmarks;
mod morph;
mod people;
mod proportions;
mod reading;
mod segments;
pub mod shape;
mod shares;
mod skin;
mod slider;
pub mod sound;
pub mod stored;
pub mod tape;
#[cfg(test)]
mod tests;

use glam::Vec3;

use crate::mesh::{Mesh, SkinWeights};
use crate::skeleton::Skeleton;
pub use fitted::{Fitted, TOLERANCE};
pub use reading::{Ansur, En, Readings, Vocabulary, Wanted};

/// Which drawing a body is stretched from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sex {
    /// The body drawn of a woman.
    Female,
    /// The body drawn of a man.
    Male,
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

    /// Checks that every measure lies in the range that a body can be built to.
    ///
    /// # Errors
    /// [`BodyError::OutOfRange`].
    pub fn check(&self) -> Result<(), BodyError> {
        self.wanted().check()
    }
}

/// Why no body could be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A measure is not a number, or beyond the sizes that the mannequin is drawn for.
    #[error("the {measure} is {value} m, but a body is built for {least} to {most} m: {}", cure(*value, [*least, *most]))]
    OutOfRange {
        /// Name of the measure.
        measure: &'static str,
        /// The value asked for (m).
        value: f32,
        /// The least accepted (m).
        least: f32,
        /// The most accepted (m).
        most: f32,
    },
    /// Each measure is in its range, but no body of this kind has them together.
    #[error(
        "no body has a {measure} of {value} m together with {}, the nearest has {reached:.3} m: check them against each \
         other, or leave one out",
        beside(against.as_ref())
    )]
    Unreachable {
        /// The name of the measure that is furthest off.
        measure: &'static str,
        /// The value asked for (m).
        value: f32,
        /// The value of the nearest body (m).
        reached: f32,
        /// The one other measure without which the first can be met, if there is one, and the value asked for (m).
        against: Option<(&'static str, f32)>,
        /// The nearest body that can be built.
        nearest: Box<Fitted>,
    },
}

/// What to do about a measure that is out of its range: in another unit it may be in it.
fn cure(value: f32, [least, most]: [f32; 2]) -> String {
    let units = [("millimetres", 1e-3), ("centimetres", 1e-2), ("inches", 0.0254)];
    match units.into_iter().find(|(_, metres)| (least..=most).contains(&(value * metres))) {
        Some((unit, metres)) => format!("taken as {unit} it would be {:.3} m, so give metres", value * metres),
        None => "check the measure and its unit".to_owned(),
    }
}

/// What a measure cannot be had together with.
fn beside(other: Option<&(&'static str, f32)>) -> String {
    other.map_or_else(|| "the other measures".to_owned(), |(name, value)| format!("a {name} of {value} m"))
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
    /// Tips of the shoulder blades (acromions).
    pub shoulder: f32,
    /// Most forward points of the breasts.
    pub chest: f32,
    /// Just below the breasts.
    pub underbust: f32,
    /// Natural waistline, midway between the lowest rib and the hip bone.
    pub waist: f32,
    /// Greatest protrusion of the buttocks.
    pub hip: f32,
    /// Lowest point between the legs.
    pub crotch: f32,
    /// Middle of the kneecap.
    pub knee: f32,
    /// Centre of the ankle joint.
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
