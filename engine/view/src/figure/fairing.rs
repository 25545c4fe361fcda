//! Fairing: the smoothest surface that keeps its border and comes near to where it is wanted.
//!
//! It minimises the sum of |x - mean of x's neighbours|^2, which is discrete bending (Kobbelt, Campagna, Vorsatz, Seidel 1998,
//! "Interactive multi-resolution modeling on arbitrary meshes"), and of pull times the squared distance to the wanted places, by
//! conjugate gradients.

use glam::DVec3;

/// Iterations at most, and the share of the first residual at which it ends.
const ITERATIONS: usize = 400;
const ENOUGH: f64 = 1e-7;

/// A patch of a mesh: all its vertices, each with its neighbours.
pub struct FairedPatch {
    /// Neighbours of each vertex, among all vertices `[vertices]`.
    pub rings: Vec<Vec<u32>>,
    /// Whether a vertex may move `[vertices]`.
    pub free: Vec<bool>,
    /// How hard each is pulled to where it is wanted `[vertices]`.
    pub pull: Vec<f64>,
}

impl FairedPatch {
    /// Moves the free vertices of `at`, towards `wanted` and into the smoothest surface.
    pub fn fair(&self, at: &mut [DVec3], wanted: &[DVec3]) {
        // Unknown is how far each moves, which is nothing at the border.
        let mut residual = self.bent(at);
        for (v, r) in residual.iter_mut().enumerate() {
            *r = if self.free[v] { (wanted[v] - at[v]) * self.pull[v] - *r } else { DVec3::ZERO };
        }
        let mut moved = vec![DVec3::ZERO; at.len()];
        let mut along = residual.clone();
        let mut energy = dot(&residual, &residual);
        let end = energy * ENOUGH * ENOUGH;
        for _ in 0..ITERATIONS {
            if energy.max_element() <= end.max_element() {
                break;
            }
            let pushed = self.applied(&along);
            let step = ratio(energy, dot(&along, &pushed));
            for v in 0..at.len() {
                moved[v] += along[v] * step;
                residual[v] -= pushed[v] * step;
            }
            let next = dot(&residual, &residual);
            let keep = ratio(next, energy);
            along.iter_mut().zip(&residual).for_each(|(a, r)| *a = *r + *a * keep);
            energy = next;
        }
        at.iter_mut().zip(moved).for_each(|(p, d)| *p += d);
    }

    /// What the system makes of a move of the free vertices.
    fn applied(&self, moves: &[DVec3]) -> Vec<DVec3> {
        let mut out = self.bent(moves);
        for (v, o) in out.iter_mut().enumerate() {
            *o = if self.free[v] { *o + moves[v] * self.pull[v] } else { DVec3::ZERO };
        }
        out
    }

    /// The transposed difference from the mean of the neighbours, of the difference from that mean.
    fn bent(&self, x: &[DVec3]) -> Vec<DVec3> {
        let once: Vec<DVec3> = self
            .rings
            .iter()
            .enumerate()
            .map(|(v, ring)| if ring.is_empty() { DVec3::ZERO } else { x[v] - mean(ring, x) })
            .collect();
        let mut twice = once.clone();
        for (ring, d) in self.rings.iter().zip(&once) {
            let share = *d / ring.len().max(1) as f64;
            ring.iter().for_each(|n| twice[*n as usize] -= share);
        }
        twice
    }
}

fn mean(ring: &[u32], x: &[DVec3]) -> DVec3 {
    ring.iter().map(|n| x[*n as usize]).sum::<DVec3>() / ring.len().max(1) as f64
}

/// By coordinate: the three systems are solved beside each other.
fn dot(a: &[DVec3], b: &[DVec3]) -> DVec3 {
    a.iter().zip(b).map(|(a, b)| *a * *b).sum()
}

fn ratio(a: DVec3, b: DVec3) -> DVec3 {
    let one = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
    DVec3::new(one(a.x, b.x), one(a.y, b.y), one(a.z, b.z))
}
