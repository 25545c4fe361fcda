//! The parametric body: a mannequin of our own, swept from drawn cross-sections and fitted to five measures.
//!
//! Reads: the drawings in `data/body/`, the measures wanted. Writes: one immutable [`Body`].
//! Budget: at load only, under 60 ms a body; the mesh has the same vertices and triangles whatever the size.
//! Thread: the loading thread.

pub mod base;
mod cage;
mod calibrate;
mod fields;
mod fitted;
mod gauge;
pub mod landmarks;
mod morph;
mod people;
mod reading;
mod segments;
mod skin;
pub mod sound;
mod subdivide;
mod table;
pub mod tape;
#[cfg(test)]
mod tests;

use glam::Vec3;

use crate::mesh::{Mesh, SkinWeights};
use crate::skeleton::Skeleton;
use cage::{Cage, Shape};
pub use fitted::{Fitted, TOLERANCE};
use landmarks::Landmarks;
pub use reading::{Ansur, En, Readings, Vocabulary, Wanted};
use subdivide::Quads;
use table::Table;

/// Which drawing a body is stretched from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Sex {
    Female,
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
    #[error("the {measure} is {value} m, but a body is built for {least} to {most} m: check the measure and its unit")]
    OutOfRange {
        /// Its name.
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
        "no body has a {measure} of {value} m together with the other measures, the nearest has {reached} m: \
         check them against each other"
    )]
    Unreachable {
        /// The name of the measure that is furthest off.
        measure: &'static str,
        /// The value asked for (m).
        value: f32,
        /// The value of the nearest body (m).
        reached: f32,
        /// The nearest body.
        nearest: Box<Fitted>,
    },
}

/// Parts of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Region {
    Torso,
    Head,
    LeftArm,
    RightArm,
    LeftLeg,
    RightLeg,
}

/// Heights of the measuring levels above the floor, in the rest pose (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// Base of the neck at the 7th cervical vertebra.
    pub neck: f32,
    /// Acromions.
    pub shoulder: f32,
    /// Bust points.
    pub chest: f32,
    /// Just below the breasts.
    pub underbust: f32,
    /// Natural waistline.
    pub waist: f32,
    /// Greatest protrusion of the buttocks.
    pub hip: f32,
    /// Lowest point between the legs.
    pub crotch: f32,
    /// Middle of the kneecap.
    pub knee: f32,
    /// Ankle joint.
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
    /// Joint centres.
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

/// Rounds of interpolation: enough to pass through the points within half a millimetre.
const INTERPOLATION: usize = 16;

impl base::Base {
    /// The mean body of a sex.
    pub fn new(sex: Sex) -> Self {
        let sweep = Sweep::new(sex);
        let shape = Shape::drawn();
        let cage = Cage::new(sweep.table, &shape);
        let positions = sweep.surface(&cage);
        let skeleton = shape.skeleton(sweep.table);
        let shares = [skin::left_shares(&cage), skin::right_shares(&cage)].map(|s| sweep.subdivided(&s));
        let skinning = skin::Skinning::new(&skeleton, sweep.table.stature * 1e-3);
        let sides = shares[0].iter().zip(&shares[1]);
        let weights = positions.iter().zip(sides).map(|(&p, (&l, &r))| skinning.weights(p, l, r)).collect();
        let drawn = Landmarks::drawn(sex);
        let landmarks = Landmarks::place(&positions, &sweep.triangles, &sweep.regions, &drawn);
        Self { sex, positions, triangles: sweep.triangles, regions: sweep.regions, skeleton, weights, landmarks }
    }
}

/// A sex's drawing with the connectivity of its surface, at each level of subdivision.
struct Sweep {
    table: &'static Table,
    levels: [Quads; 3],
    triangles: Vec<[u32; 3]>,
    regions: Vec<Region>,
}

impl Sweep {
    fn new(sex: Sex) -> Self {
        let table = Table::of(sex);
        let cage = Cage::new(table, &Shape::drawn());
        let coarse = Quads::new(cage.points.len(), cage.faces.clone());
        let middle = coarse.refined();
        let fine = middle.refined();
        let triangles = fine.triangles();
        let levels = [coarse, middle, fine];
        let mut sweep = Self { table, levels, triangles, regions: Vec::new() };
        let positions = sweep.surface(&cage);
        let parts = sweep.subdivided(&skin::part_shares(&cage));
        sweep.regions = parts.iter().zip(&positions).map(|(&part, &p)| skin::region(part, p)).collect();
        sweep
    }

    fn subdivided(&self, values: &[Vec3]) -> Vec<Vec3> {
        self.levels[2].limit(&self.levels[1].refine(&self.levels[0].refine(values)))
    }

    fn surface(&self, cage: &Cage) -> Vec<Vec3> {
        let mut positions = self.subdivided(&self.levels[0].interpolate(&cage.points, INTERPOLATION));
        // The soles are flat on the floor.
        positions.iter_mut().for_each(|p| p.y = p.y.max(0.0));
        positions
    }
}
