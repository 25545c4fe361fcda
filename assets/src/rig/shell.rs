//! The capsules as surfaces to look at.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::plan::CAPSULES;
use super::union::RestSpheres;

/// Vertices around a capsule, and rings on it from one pole to the other (even: half of them on each end).
const AROUND: usize = 32;
const RINGS: usize = 20;

/// The surfaces of all capsules, whole even where they overlap.
#[derive(Debug, Clone, Default)]
pub struct CapsuleSurface {
    /// Points (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Unit normals `[vertices]`.
    pub normals: Vec<Vec3>,
    /// Vertex indices, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The capsule that each vertex belongs to `[vertices]`.
    pub capsules: Vec<u8>,
}

impl CapsuleSurface {
    pub(super) fn new(placed: &RestSpheres) -> Self {
        let mut shell = Self::default();
        for (c, ends) in CAPSULES.iter().enumerate() {
            shell.add(c as u8, ends.map(|s| placed[usize::from(s)]));
        }
        shell
    }

    /// A capsule's rings: by the angle between normal and axis, where the slope of the side parts one end from the other.
    fn add(&mut self, capsule: u8, [(a, ra), (b, rb)]: [(Vec3, f32); 2]) {
        let length = a.distance(b);
        let axis = (b - a).try_normalize().unwrap_or(Vec3::Y);
        let sine = if length > 0.0 { ((ra - rb) / length).clamp(-1.0, 1.0) } else { 0.0 };
        let (u, v) = axis.any_orthonormal_pair();
        // Angle from the pole of `a` to where the slanted side begins.
        let slope = PI * 0.5 + sine.asin();
        let first = self.positions.len() as u32;
        for ring in 0..RINGS {
            let half = RINGS / 2;
            let (centre, radius, angle) = if ring < half {
                (a, ra, slope * ring as f32 / (half - 1) as f32)
            } else {
                (b, rb, slope + (PI - slope) * (ring - half) as f32 / (half - 1) as f32)
            };
            for k in 0..AROUND {
                let (s, c) = (TAU * k as f32 / AROUND as f32).sin_cos();
                let normal = (u * c + v * s) * angle.sin() - axis * angle.cos();
                self.positions.push(centre + normal * radius);
                self.normals.push(normal);
                self.capsules.push(capsule);
            }
        }
        let at = |ring: usize, k: usize| first + (ring * AROUND + k % AROUND) as u32;
        for (ring, k) in (0..RINGS - 1).flat_map(|ring| (0..AROUND).map(move |k| (ring, k))) {
            let [p, q, r, s] = [at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)];
            self.triangles.extend([[p, q, r], [p, r, s]]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::union::nearest;
    use super::*;
    use toile_base::body::{Measures, Sex};
    use toile_base::cone::round_cone;

    #[test]
    fn shells_lie_on_their_capsules_and_face_outwards() {
        let body = crate::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
        let rig = crate::rig::fit(&body);
        let (shell, placed) = (crate::rig::shell(&rig, &body), rig.placed(&body));
        assert_eq!(shell.positions.len(), CAPSULES.len() * RINGS * AROUND);
        for ((p, n), c) in shell.positions.iter().zip(&shell.normals).zip(&shell.capsules) {
            let [a, b] = CAPSULES[usize::from(*c)].map(|s| placed[usize::from(s)]);
            assert!(round_cone(*p, a, b).0.abs() < 1e-5, "{p}");
            assert!(round_cone(*p + *n * 0.01, a, b).0 > 0.0 && nearest(&placed, *p).0 < 1e-5);
        }
        for t in &shell.triangles {
            let [a, b, c] = t.map(|v| shell.positions[v as usize]);
            let face = (b - a).cross(c - a);
            assert!(face.dot(shell.normals[t[0] as usize] + shell.normals[t[1] as usize]) >= -1e-9);
        }
    }
}
