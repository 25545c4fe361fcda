//! The order of a mesh's pieces on the body that it is made for: a shirt over trousers.

use super::mesh::ForeignMesh;

/// Vertices of two pieces within this distance (m) lie over each other.
const OVER_M: f32 = 0.035;

/// Pieces of a mesh whose order is looked at: more are no garments over each other.
const MOST_PIECES: usize = 12;

/// Vertices of a mesh whose order is looked at: finer ones are not simulated.
const MOST_VERTICES: usize = 40_000;

/// Layers that one mesh may have, so that an outfit of several stays below what a body wears at once.
const MOST_DEEP: u8 = 2;

/// The order of a mesh's pieces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PieceOrder {
    /// A vertex of an outer piece, and the vertex of an inner one that it lies over.
    pub over: Vec<[u32; 2]>,
    /// How many pieces lie under each piece, one under the other `[pieces]`; those of 0 are innermost.
    pub depth: Vec<u8>,
}

impl PieceOrder {
    /// Of a mesh on the body that it is made for: `piece` is the number of each vertex's piece, `height` how far it is from the
    /// skin there (m). Of two pieces the one that lies farther out where they meet is the outer one.
    pub fn of(mesh: &ForeignMesh, piece: &[u32], height: &[f32]) -> Self {
        let count = piece.iter().max().map_or(0, |m| *m as usize + 1);
        let mut order = Self { over: Vec::new(), depth: vec![0; count] };
        if !(2..=MOST_PIECES).contains(&count) || piece.len() > MOST_VERTICES {
            return order;
        }
        let pairs = near(mesh, piece, count);
        let mut above = vec![0.0f32; count * count];
        for &[a, b] in &pairs {
            let (p, q) = (piece[a as usize] as usize, piece[b as usize] as usize);
            let higher = height[a as usize] - height[b as usize];
            above[p * count + q] += higher;
            above[q * count + p] -= higher;
        }
        let is_outer = |a: u32, b: u32| above[piece[a as usize] as usize * count + piece[b as usize] as usize] > 0.0;
        order.over = pairs.into_iter().map(|[a, b]| if is_outer(a, b) { [a, b] } else { [b, a] }).collect();
        // Pieces may lie over each other in a circle, so that the rounds are counted.
        for _ in 0..MOST_DEEP {
            for [over, under] in &order.over {
                let below = order.depth[piece[*under as usize] as usize];
                let own = &mut order.depth[piece[*over as usize] as usize];
                *own = (*own).max((below + 1).min(MOST_DEEP));
            }
        }
        order
    }
}

/// Each vertex with the nearest one of each other piece, where that is near.
fn near(mesh: &ForeignMesh, piece: &[u32], count: usize) -> Vec<[u32; 2]> {
    let mut order: Vec<u32> = (0..piece.len() as u32).collect();
    let at = |v: u32| mesh.positions[v as usize];
    order.sort_by(|a, b| at(*a).y.total_cmp(&at(*b).y));
    let mut pairs = Vec::new();
    for (k, &a) in order.iter().enumerate() {
        let mut nearest = vec![(OVER_M * OVER_M, None); count];
        let below = order[..k].iter().rev().take_while(|b| at(a).y - at(**b).y < OVER_M);
        let above = order[k + 1..].iter().take_while(|b| at(**b).y - at(a).y < OVER_M);
        for &b in below.chain(above).filter(|b| piece[**b as usize] != piece[a as usize]) {
            let (d, best) = (at(a).distance_squared(at(b)), &mut nearest[piece[b as usize] as usize]);
            if d < best.0 {
                *best = (d, Some(b));
            }
        }
        pairs.extend(nearest.into_iter().filter_map(|(_, b)| b).map(|b| [a, b]));
    }
    pairs
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// A tube over the upper half of a longer and narrower one.
    #[test]
    fn the_outer_of_two_tubes_is_found() {
        let mut mesh = ForeignMesh::default();
        let (mut piece, mut height) = (Vec::new(), Vec::new());
        for (number, (radius, low)) in [(0.21f32, 5), (0.2, 0)].into_iter().enumerate() {
            for (row, k) in (low..10).flat_map(|row| (0..24).map(move |k| (row, k))) {
                let (s, c) = (k as f32 / 24.0 * std::f32::consts::TAU).sin_cos();
                mesh.positions.push(Vec3::new(radius * c, 0.05 * row as f32, radius * s));
                piece.push(number as u32);
                height.push(radius - 0.19);
            }
        }
        let order = PieceOrder::of(&mesh, &piece, &height);
        assert_eq!(order.depth, [1, 0]);
        assert!(order.over.iter().all(|[a, b]| piece[*a as usize] == 0 && piece[*b as usize] == 1));
        assert_eq!(order.over.len(), 2 * 5 * 24);
    }
}
