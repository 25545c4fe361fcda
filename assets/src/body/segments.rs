//! Anthropometric segments: shares of the surface that decay over mesh neighbourhoods (Ugur 2008, chapters 3 and 4).
//!
//! A segment's core is the ring in which a level cuts the surface. From there the distance runs along the mesh, and
//! the share decays as a Gaussian of it (section 4.3); where segments overlap, the shares are divided by their sum
//! (equation 4.6), so that neighbours blend without a step. Distances are in metres, not in edges: the boundary does not
//! depend on how the mesh is cut.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::Vec3;

/// Rounds of averaging that take the grain of the mesh out of the shares.
const ROUNDS: usize = 12;

/// The ways over a mesh: each vertex's neighbours along edges, and across each edge to the corner opposite.
pub(super) struct Neighbourhood {
    /// Start of each vertex's list, and the end `[vertices + 1]`.
    start: Vec<u32>,
    /// Neighbours and the way to them (m).
    near: Vec<(u32, f32)>,
    /// Number of each vertex's neighbours along edges: they come first in its list.
    ring: Vec<u32>,
    /// Mirror image `[vertices]`.
    pub mirror: Vec<u32>,
}

impl Neighbourhood {
    /// Joins a closed surface that is symmetric about x = 0.
    pub(super) fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut sides: Vec<[u32; 3]> = Vec::with_capacity(triangles.len() * 3);
        for t in triangles {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                sides.push([a.min(b), a.max(b), t[(k + 2) % 3]]);
            }
        }
        sides.sort_unstable();
        let mut along: Vec<Vec<u32>> = vec![Vec::new(); positions.len()];
        let mut across = along.clone();
        for pair in sides.chunks_exact(2) {
            let ([a, b, c], d) = (pair[0], pair[1][2]);
            for (lists, p, q) in [(&mut along, a, b), (&mut across, c, d)] {
                lists[p as usize].push(q);
                lists[q as usize].push(p);
            }
        }
        let mut all = Self { start: vec![0], near: Vec::new(), ring: Vec::new(), mirror: mirrors(positions) };
        for (v, (ring, beyond)) in along.iter().zip(&across).enumerate() {
            let way = |&w: &u32| (w, positions[v].distance(positions[w as usize]));
            all.near.extend(ring.iter().map(way));
            all.near.extend(beyond.iter().map(way));
            all.ring.push(ring.len() as u32);
            all.start.push(all.near.len() as u32);
        }
        all
    }

    /// The vertices that share an edge with one.
    pub(super) fn ring(&self, vertex: usize) -> impl Iterator<Item = usize> + '_ {
        let from = self.start[vertex] as usize;
        self.near[from..from + self.ring[vertex] as usize].iter().map(|(w, _)| *w as usize)
    }

    /// The way along the mesh from a core to every vertex (m): Dijkstra from vertices that start with a lead.
    pub(super) fn distances(&self, core: &[(u32, f32)]) -> Vec<f32> {
        let mut distance = vec![f32::MAX; self.mirror.len()];
        // Lengths are positive, so their bits sort as they do; equal ones in the order of the vertices.
        let mut queue: BinaryHeap<Reverse<(u32, u32)>> = BinaryHeap::new();
        for &(v, lead) in core {
            if lead < distance[v as usize] {
                distance[v as usize] = lead;
                queue.push(Reverse((lead.to_bits(), v)));
            }
        }
        while let Some(Reverse((bits, v))) = queue.pop() {
            let so_far = f32::from_bits(bits);
            if so_far > distance[v as usize] {
                continue;
            }
            let list = self.start[v as usize] as usize..self.start[v as usize + 1] as usize;
            for &(w, way) in &self.near[list] {
                let there = so_far + way;
                if there < distance[w as usize] {
                    distance[w as usize] = there;
                    queue.push(Reverse((there.to_bits(), w)));
                }
            }
        }
        distance
    }

    /// Averages values over neighbours and makes them the same on both sides.
    pub(super) fn smooth(&self, values: &mut [f32]) {
        let mut next = values.to_vec();
        for _ in 0..ROUNDS {
            for (v, n) in next.iter_mut().enumerate() {
                let sum: f32 = self.ring(v).map(|w| values[w]).sum();
                *n = 0.5 * values[v] + 0.5 * sum / self.ring[v] as f32;
            }
            values.copy_from_slice(&next);
        }
        for (v, &mirror) in self.mirror.iter().enumerate() {
            values[v] = 0.5 * (next[v] + next[mirror as usize]);
        }
    }

    /// Shares of a chain of segments, given each one's distances and how far it reaches (the Gaussian's sigma, m):
    /// `[segments][vertices]`, summing to 1 at each vertex.
    pub(super) fn shares(&self, chain: &[(Vec<f32>, f32)]) -> Vec<Vec<f32>> {
        let mut shares: Vec<Vec<f32>> = chain.iter().map(|(d, _)| vec![0.0; d.len()]).collect();
        for v in 0..self.mirror.len() {
            let power = |(d, sigma): &(Vec<f32>, f32)| -0.5 * (f64::from(d[v]) / f64::from(*sigma)).powi(2);
            // Far from every core all of them underflow: only their ratios count.
            let most = chain.iter().map(power).fold(f64::MIN, f64::max);
            let sum: f64 = chain.iter().map(|c| (power(c) - most).exp()).sum();
            for (share, c) in shares.iter_mut().zip(chain) {
                share[v] = ((power(c) - most).exp() / sum) as f32;
            }
        }
        shares.iter_mut().for_each(|s| self.smooth(s));
        shares
    }
}

/// Each vertex's mirror image. Panics when it has none: the base bodies are our own data.
fn mirrors(positions: &[Vec3]) -> Vec<u32> {
    const NEAR: f32 = 2e-5;
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    let height = |v: u32| positions[v as usize].y;
    order.sort_by(|&a, &b| height(a).total_cmp(&height(b)));
    let find = |p: &Vec3| {
        let wanted = Vec3::new(-p.x, p.y, p.z);
        let from = order.partition_point(|&v| height(v) < p.y - NEAR);
        let near = order[from..].iter().copied().take_while(|&v| height(v) < p.y + NEAR);
        let off = |v: &u32| positions[*v as usize].distance(wanted);
        let mirror = near.min_by(|a, b| off(a).total_cmp(&off(b))).filter(|v| off(v) < NEAR);
        mirror.expect("the base body is symmetric")
    };
    positions.iter().map(find).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A closed box of `n` by `n` by `n` cells, one metre wide.
    fn tube(rows: u32, columns: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let mut positions = Vec::new();
        for r in 0..rows {
            for k in 0..columns {
                let (s, c) = ((k as f32 + 0.5) / columns as f32 * std::f32::consts::TAU).sin_cos();
                positions.push(Vec3::new(0.1 * s, 0.02 * r as f32, 0.1 * c));
            }
        }
        let (low, high) = (positions.len() as u32, positions.len() as u32 + 1);
        positions.extend([Vec3::ZERO, Vec3::new(0.0, 0.02 * (rows - 1) as f32, 0.0)]);
        let mut triangles = Vec::new();
        for k in 0..columns {
            let n = (k + 1) % columns;
            triangles.extend([[low, n, k], [high, (rows - 1) * columns + k, (rows - 1) * columns + n]]);
            for r in 0..rows - 1 {
                let (a, b, c, d) = (r * columns + k, r * columns + n, (r + 1) * columns + n, (r + 1) * columns + k);
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        (positions, triangles)
    }

    #[test]
    fn way_along_a_tube_is_its_length() {
        let (positions, triangles) = tube(30, 24);
        let near = Neighbourhood::new(&positions, &triangles);
        let core: Vec<(u32, f32)> = (0..24).map(|v| (v, 0.0)).collect();
        for (v, d) in near.distances(&core).iter().enumerate().take(30 * 24) {
            assert!((d - positions[v].y).abs() < 1e-5, "{d} {}", positions[v]);
        }
    }

    #[test]
    fn shares_sum_to_one_and_fall_from_their_cores() {
        let (positions, triangles) = tube(30, 24);
        let near = Neighbourhood::new(&positions, &triangles);
        let ring = |r: u32| near.distances(&(24 * r..24 * (r + 1)).map(|v| (v, 0.0)).collect::<Vec<_>>());
        let shares = near.shares(&[(ring(5), 0.1), (ring(20), 0.1)]);
        for v in 0..positions.len() {
            assert!((shares[0][v] + shares[1][v] - 1.0).abs() < 1e-5);
            assert_eq!(shares[0][v].to_bits(), shares[0][near.mirror[v] as usize].to_bits());
        }
        let at = |r: usize| shares[0][24 * r];
        assert!(at(5) > 0.95 && at(20) < 0.05 && (6..20).all(|r| at(r) < at(r - 1)));
    }
}
