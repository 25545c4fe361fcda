//! Laying the grid onto a form: vertices slide until they lie evenly, and stand exactly on the surface.

use glam::Vec3;

use crate::form::Form;
use crate::subdivide::Quads;

/// A mesh on its way to a form: the left half is moved, the right one is its mirror image.
pub(super) struct Wrapping<'a> {
    pub form: &'a Form,
    pub quads: &'a Quads,
    pub mirrors: &'a [u32],
    /// How far each vertex may slide, 0 to 1.
    pub slide: &'a [f32],
}

/// The furthest that a vertex moves towards the surface in one round (mm).
const STRIDE: f32 = 8.0;
/// Below this height a vertex of the sole stands on the floor (mm).
const FLOOR: f32 = 0.3;

impl Wrapping<'_> {
    /// Moves `points` (mm) in rounds of evening out and stepping onto the surface, then settles them on it.
    pub(super) fn lay(&self, points: &mut [Vec3], rounds: usize) {
        let neighbours = self.neighbours();
        let left: Vec<usize> = (0..points.len()).filter(|&v| self.is_left(v, points)).collect();
        for round in 0..rounds + 4 {
            let even = round < rounds;
            let moved: Vec<Vec3> = left.iter().map(|&v| self.stepped(points, &neighbours[v], v, even)).collect();
            for (&v, p) in left.iter().zip(moved) {
                self.place(points, v, p);
            }
        }
        for v in left {
            let p = points[v];
            if p.y < FLOOR {
                self.place(points, v, Vec3::new(p.x, 0.0, p.z));
            }
        }
    }

    fn is_left(&self, v: usize, points: &[Vec3]) -> bool {
        self.mirrors[v] as usize == v || points[v].x > 0.0
    }

    fn place(&self, points: &mut [Vec3], v: usize, mut p: Vec3) {
        let mirror = self.mirrors[v] as usize;
        if mirror == v {
            p.x = 0.0;
        }
        points[v] = p;
        points[mirror] = Vec3::new(-p.x, p.y, p.z);
        if mirror == v {
            points[v].x = 0.0;
        }
    }

    fn stepped(&self, points: &[Vec3], around: &[u32], v: usize, even: bool) -> Vec3 {
        let mut p = points[v];
        let (normal, steep) = self.form.slope(p);
        if even {
            let middle: Vec3 = around.iter().map(|&n| points[n as usize]).sum::<Vec3>() / around.len() as f32;
            p += (middle - p).reject_from_normalized(normal) * (0.7 * self.slide[v]);
        }
        p - normal * (self.form.distance(p) / steep.clamp(0.3, 3.0)).clamp(-STRIDE, STRIDE)
    }

    fn neighbours(&self) -> Vec<Vec<u32>> {
        let mut around = vec![Vec::new(); self.mirrors.len()];
        for [a, b] in self.quads.edges() {
            around[a as usize].push(b);
            around[b as usize].push(a);
        }
        around
    }
}
