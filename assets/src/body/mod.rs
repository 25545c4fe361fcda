//! The parametric body: a mannequin of our own, swept from drawn cross-sections and fitted to five measures.
//!
//! Reads: the drawings in `data/body/`, the measures wanted. Writes: one immutable [`Body`].
//! Budget: at load only, under 60 ms a body; the mesh has the same vertices and triangles whatever the size.
//! Thread: the loading thread.

pub mod base;
mod cage;
pub mod draw;
mod form;
pub mod landmarks;
pub mod lattice;
mod shares;
mod skin;
pub mod stored;
mod subdivide;
mod table;
pub mod tape;
#[cfg(test)]
mod tests;
pub mod unwrap;
mod wrap;

use glam::Vec3;

use crate::mesh::{Mesh, SkinWeights, vertex_normals};
use crate::skeleton::Skeleton;
use cage::{Cage, Shape, row};
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

    fn named(&self) -> [(&'static str, f32, [f32; 2]); 5] {
        [
            ("stature", self.stature, [1.2, 2.2]),
            ("shoulder breadth", self.shoulder_breadth, [0.25, 0.55]),
            ("chest girth", self.chest_girth, [0.5, 1.8]),
            ("waist girth", self.waist_girth, [0.5, 1.8]),
            ("hip girth", self.hip_girth, [0.5, 1.8]),
        ]
    }

    /// Checks that every measure lies in the range that a body can be built to.
    pub fn check(&self) -> Result<(), BodyError> {
        for (measure, value, [least, most]) in self.named() {
            if !(least..=most).contains(&value) {
                return Err(BodyError::OutOfRange { measure, value, least, most });
            }
        }
        Ok(())
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

/// Largest error of a calibrated measure at which the fitting stops (m).
const CLOSE_ENOUGH: f32 = 0.2e-3;
/// Largest error that a caller has to accept (m).
const TOLERANCE: f32 = 2e-3;
/// Rounds of fitting at most.
const ROUNDS: usize = 24;
/// Rounds of interpolation: enough to pass through the points within half a millimetre.
const INTERPOLATION: usize = 16;

impl Body {
    /// Builds the body of a sex that has the measures wanted, each within 2 mm.
    pub fn build(sex: Sex, wanted: &Measures) -> Result<Self, BodyError> {
        wanted.check()?;
        let sweep = Sweep::new(sex);
        Ok(sweep.body(&sweep.calibrate(wanted)?))
    }
}

/// A sex's drawing with the connectivity of its surface, at each level of subdivision.
struct Sweep {
    sex: Sex,
    table: &'static Table,
    levels: [Quads; 3],
    triangles: Vec<[u32; 3]>,
    regions: Vec<Region>,
    torso: Vec<[u32; 12]>,
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
        let mut sweep = Self { sex, table, levels, triangles, regions: Vec::new(), torso: cage.torso.clone() };
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

    fn mesh(&self, shape: &Shape) -> Mesh {
        let positions = self.surface(&Cage::new(self.table, shape));
        Mesh { positions, uvs: Vec::new(), triangles: self.triangles.clone() }
    }

    /// Stretches the drawing until the tape reads the measures wanted.
    fn calibrate(&self, wanted: &Measures) -> Result<Shape, BodyError> {
        let mut shape = Shape { scale: wanted.stature / self.table.stature * 1e3, ..Shape::drawn() };
        let mut mesh = self.mesh(&shape);
        for _ in 0..ROUNDS {
            let read = self.measure(&mesh);
            if furthest(wanted, &read).3 <= CLOSE_ENOUGH {
                return Ok(shape);
            }
            let grown = wanted.stature / read.stature;
            shape.scale *= grown;
            let closer = |factor: f32, wanted: f32, read: f32| (factor * wanted / (read * grown)).clamp(0.2, 5.0);
            shape.shoulder = closer(shape.shoulder, wanted.shoulder_breadth, read.shoulder_breadth);
            shape.chest = closer(shape.chest, wanted.chest_girth, read.chest_girth);
            shape.waist = closer(shape.waist, wanted.waist_girth, read.waist_girth);
            shape.hip = closer(shape.hip, wanted.hip_girth, read.hip_girth);
            mesh = self.mesh(&shape);
        }
        let read = self.measure(&mesh);
        let (measure, value, reached, error) = furthest(wanted, &read);
        if error <= TOLERANCE { Ok(shape) } else { Err(BodyError::Unreachable { measure, value, reached }) }
    }

    fn levels(&self, mesh: &Mesh) -> Levels {
        let at = |r: usize, column: usize| mesh.positions[self.torso[r][column] as usize].y;
        // Heights grow with stature alone, so any one row gives the scale from the drawing (mm) to the body (m).
        let (waist, fold, back) = (at(row::WAIST, 3), at(row::CROTCH, 5), at(row::HIGH_HIP, 5));
        let drawn = |mm: f32| mm * waist / self.table.torso[row::WAIST].points[3][1];
        let mut seat = Vec3::new(0.0, at(row::HIP, 5), 0.0);
        for (p, region) in mesh.positions.iter().zip(&self.regions) {
            if *region == Region::Torso && p.y > fold && p.y < back && p.z < seat.z {
                seat = *p;
            }
        }
        Levels {
            neck: at(row::TRAPEZIUS, 6),
            shoulder: at(row::SHOULDER, 3),
            chest: at(row::BUST, 1),
            underbust: at(row::UNDERBUST, 1),
            waist,
            hip: seat.y,
            crotch: drawn(self.table.crotch.point[1]),
            knee: drawn(self.table.leg[cage::KNEE].y),
            ankle: drawn(self.table.joints.ankle[1]),
        }
    }

    /// Reads the five measures off a mesh.
    fn measure(&self, mesh: &Mesh) -> Measures {
        let levels = self.levels(mesh);
        let [left, right] = [3, 9].map(|c| mesh.positions[self.torso[row::SHOULDER][c] as usize]);
        let girth = |height: f32| tape::girth_of(mesh, &self.regions, height);
        Measures {
            stature: mesh.positions.iter().map(|p| p.y).fold(0.0, f32::max),
            shoulder_breadth: left.distance(right),
            chest_girth: girth(levels.chest),
            waist_girth: girth(levels.waist),
            hip_girth: girth(levels.hip),
        }
    }

    fn body(&self, shape: &Shape) -> Body {
        let cage = Cage::new(self.table, shape);
        let mesh = self.mesh(shape);
        let mut normals = vec![Vec3::ZERO; mesh.positions.len()];
        vertex_normals(&mesh.positions, &mesh.triangles, &mut normals);
        let skeleton = shape.skeleton(self.table);
        let measures = self.measure(&mesh);
        let shares = [skin::left_shares(&cage), skin::right_shares(&cage)].map(|s| self.subdivided(&s));
        let skinning = skin::Skinning::new(&skeleton, measures.stature);
        let weights = mesh
            .positions
            .iter()
            .zip(&shares[0])
            .zip(&shares[1])
            .map(|((&p, &l), &r)| skinning.weights(p, l, r))
            .collect();
        let levels = self.levels(&mesh);
        Body { sex: self.sex, mesh, normals, skeleton, weights, regions: self.regions.clone(), levels, measures }
    }
}

/// The measure that is furthest from the one wanted: name, wanted, read, error (m).
fn furthest(wanted: &Measures, read: &Measures) -> (&'static str, f32, f32, f32) {
    let pairs = wanted.named().into_iter().zip(read.named());
    let errors = pairs.map(|((name, w, _), (_, r, _))| (name, w, r, (w - r).abs()));
    errors.max_by(|a, b| a.3.total_cmp(&b.3)).expect("five measures")
}
