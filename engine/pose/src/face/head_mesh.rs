//! The mannequin's head as a mesh that a field of displacements moves.

use glam::DVec3;
use toile_assets::body::shape::Shapes;
use toile_base::body::{Region, Sex};
use toile_base::skeleton::Joint;

use super::prior::OffsetField;

/// Distance from the head's border with the body over which the neck takes over (m); the chin is farther.
const NECK: f64 = 0.018;

/// The mannequin's body with its head marked, places counted from the middle of the head.
#[derive(Debug, Clone)]
pub(super) struct HeadMesh {
    /// The body's vertices (m) `[vertices]`.
    pub positions: Vec<DVec3>,
    /// How far each follows the field, 0 to 1: not below the head, wholly above the neck `[vertices]`.
    pub share: Vec<f64>,
    /// Triangles of the head.
    pub triangles: Vec<[u32; 3]>,
    /// The middle of the head on the body (m).
    pub middle: DVec3,
}

impl HeadMesh {
    /// Of a sex.
    pub(super) fn of(sex: Sex) -> Self {
        let base = Shapes::of(sex).base();
        let middle = middle(sex);
        let positions: Vec<DVec3> = base.positions.iter().map(|p| p.as_dvec3() - middle).collect();
        let head = |v: u32| base.regions[v as usize] == Region::Head;
        let mut border: Vec<u32> =
            base.triangles.iter().filter(|t| !t.iter().all(|v| head(*v))).flatten().copied().collect();
        border.retain(|v| head(*v));
        border.sort_unstable();
        border.dedup();
        let share = |(v, p): (u32, &DVec3)| {
            let apart = border.iter().map(|b| positions[*b as usize].distance(*p)).fold(f64::MAX, f64::min);
            if head(v) { (apart / NECK).min(1.0) } else { 0.0 }
        };
        Self {
            share: (0..).zip(&positions).map(share).collect(),
            triangles: base.triangles.iter().filter(|t| t.iter().all(|v| head(*v))).copied().collect(),
            positions,
            middle,
        }
    }

    /// Its vertices where a field has brought them (m) `[vertices]`.
    pub(super) fn moved(&self, field: &OffsetField) -> Vec<DVec3> {
        let one = |(p, share): (&DVec3, &f64)| if *share > 0.0 { *p + field.at(*p) * *share } else { *p };
        self.positions.iter().zip(&self.share).map(one).collect()
    }
}

/// Unit normals of vertices that lie here (m), of the triangles around each by their areas; zero where there is none `[vertices]`.
pub(super) fn normals(places: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; places.len()];
    for t in triangles {
        let [a, b, c] = t.map(|v| places[v as usize]);
        t.iter().for_each(|v| normals[*v as usize] += (b - a).cross(c - a));
    }
    normals.iter_mut().for_each(|n| *n = n.normalize_or_zero());
    normals
}

/// The middle of a head: what places are counted from (m).
pub(super) fn middle(sex: Sex) -> DVec3 {
    let joint = Shapes::of(sex).base().skeleton.at(Joint::Head).as_dvec3();
    joint + DVec3::new(0.0, 0.06, 0.03)
}
