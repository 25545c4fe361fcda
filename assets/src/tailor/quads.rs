//! Quads beside the seams: two triangles of the ring that together follow warp and weft.

use std::collections::BTreeMap;

use glam::DVec2;

/// Most that a side may lie off its thread, and a corner off a right angle (rad): 25 degrees.
const MOST_OFF: f64 = 0.44;

/// Two triangles that make a quad.
struct Pair {
    off: f64,
    triangles: [usize; 2],
    quad: [u32; 4],
}

/// Joins triangles to quads, the best pairs first. Quads are counter-clockwise in the drawing, their first side along the
/// weft (`axes[0]`); the triangles that are left keep their order.
pub fn pair(at: &[DVec2], triangles: &[[u32; 3]], axes: [DVec2; 2]) -> (Vec<[u32; 4]>, Vec<[u32; 3]>) {
    let mut beside: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    let mut pairs = Vec::new();
    for (i, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            if let Some(&j) = beside.get(&(b, a)) {
                let Some(d) = triangles[j].iter().find(|v| **v != a && **v != b) else { continue };
                pairs.extend(quad(at, [a, *d, b, c], axes).map(|(off, quad)| Pair { off, triangles: [i, j], quad }));
            }
            beside.insert((a, b), i);
        }
    }
    pairs.sort_by(|a, b| a.off.total_cmp(&b.off).then(a.triangles.cmp(&b.triangles)));
    let mut taken = vec![false; triangles.len()];
    let mut quads = Vec::new();
    for pair in pairs {
        if pair.triangles.iter().all(|&t| !taken[t]) {
            pair.triangles.iter().for_each(|&t| taken[t] = true);
            quads.push(pair.quad);
        }
    }
    (quads, (0..triangles.len()).filter(|&t| !taken[t]).map(|t| triangles[t]).collect())
}

/// How far four corners are from a cell of the lattice (rad), and the same corners beginning with a side along the weft;
/// `None` where they are too far.
fn quad(at: &[DVec2], ring: [u32; 4], axes: [DVec2; 2]) -> Option<(f64, [u32; 4])> {
    let turned = |first: usize| [0, 1, 2, 3].map(|k| ring[(first + k) % 4]);
    let off = |ring: &[u32; 4]| {
        let along = [axes[0], axes[1], -axes[0], -axes[1]];
        let sides = [0, 1, 2, 3].map(|k| at[ring[(k + 1) % 4] as usize] - at[ring[k] as usize]);
        let thread = (0..4).map(|k| sides[k].angle_to(along[k]).abs());
        let corner = (0..4).map(|k| (sides[k].angle_to(sides[(k + 1) % 4]) - std::f64::consts::FRAC_PI_2).abs());
        thread.chain(corner).fold(0.0, f64::max)
    };
    let best = (0..4).map(turned).map(|ring| (off(&ring), ring)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(off, _)| *off < MOST_OFF)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_of_a_cell_become_a_quad_that_begins_along_the_weft() {
        let at = [[0.0, 0.0], [1.0, 0.1], [1.0, 1.0], [0.0, 1.0], [1.8, 0.5]].map(DVec2::from);
        let (quads, left) = pair(&at, &[[0, 1, 2], [0, 2, 3], [1, 4, 2]], [DVec2::X, DVec2::Y]);
        assert_eq!((quads, left), (vec![[0, 1, 2, 3]], vec![[1, 4, 2]]));
        // With the warp along x the weft runs down.
        let (quads, _) = pair(&at, &[[0, 1, 2], [0, 2, 3]], [DVec2::NEG_Y, DVec2::X]);
        assert_eq!(quads, [[3, 0, 1, 2]]);
    }
}
