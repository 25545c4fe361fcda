//! Cloth taken along: from a level to the next finer one, each vertex where its panel's cloth was by its place in the panel's
//! drawing; and from one body to another, with the skin.

use glam::{DVec2, Vec3};

use crate::tailor::{PanelMesh, SewnMesh};
use toile_bake::check::corners;
use toile_base::body::Body;

/// Places of the vertices of `fine`, from those of `coarse` (m) `[vertices]`.
pub fn carry(coarse: &SewnMesh, at: &[Vec3], fine: &SewnMesh) -> Vec<Vec3> {
    let mut out = vec![Vec3::ZERO; fine.members.len()];
    for (panel, mesh) in fine.panels.iter().enumerate() {
        let from = &coarse.panels[panel];
        let triangles = triangles(from);
        let number = &coarse.number[panel];
        for (v, p) in mesh.points.iter().enumerate() {
            let (t, shares) = containing(from, &triangles, *p);
            let place = (0..3).map(|k| at[number[t[k] as usize] as usize] * shares[k] as f32).sum::<Vec3>();
            let id = fine.number[panel][v] as usize;
            out[id] += place / fine.members[id].len() as f32;
        }
    }
    out
}

/// How far the pull of a vertex of the skin reaches beside cloth that lies on it (m): what is nearer than that counts alike.
const REACH_M: f32 = 0.02;

/// Every so manieth vertex of the skin tells how it moves: neighbours move alike.
const SKIN_EVERY: usize = 3;

/// Places of cloth that hangs on one body, taken along to another of the same mesh: each moves as the skin around it does, nearer
/// skin counting by the inverse sixth power of its distance (m) `[vertices]`.
pub fn carry_over(from: &Body, to: &Body, at: &[Vec3]) -> Vec<Vec3> {
    let skin: Vec<[Vec3; 2]> =
        from.mesh.positions.iter().zip(&to.mesh.positions).step_by(SKIN_EVERY).map(|(a, b)| [*a, *b - *a]).collect();
    let moved = |p: &Vec3| {
        let mut sum = (Vec3::ZERO, 0.0);
        for [place, motion] in &skin {
            let near = (p.distance_squared(*place) + REACH_M * REACH_M).recip();
            let weight = near * near * near;
            sum = (sum.0 + *motion * weight, sum.1 + weight);
        }
        *p + sum.0 / sum.1
    };
    at.iter().map(moved).collect()
}

fn triangles(mesh: &PanelMesh) -> Vec<[u32; 3]> {
    let fan = |face| {
        let ring = corners(face);
        (2..ring.len()).map(move |k| [ring[0], ring[k - 1], ring[k]])
    };
    mesh.faces.iter().flat_map(fan).collect()
}

/// The triangle that a point lies in, or least outside of, and the shares of its corners there; beyond the outline they go on
/// as they are within.
fn containing(mesh: &PanelMesh, triangles: &[[u32; 3]], p: DVec2) -> ([u32; 3], [f64; 3]) {
    let mut best = ([0; 3], [1.0, 0.0, 0.0], f64::MIN);
    for t in triangles {
        let [a, b, c] = t.map(|v| mesh.points[v as usize]);
        let whole = (b - a).perp_dot(c - a);
        let shares =
            [(b - p).perp_dot(c - p) / whole, (c - p).perp_dot(a - p) / whole, (a - p).perp_dot(b - p) / whole];
        let least = shares.into_iter().fold(f64::MAX, f64::min) * whole.abs().sqrt();
        if least > best.2 {
            best = (*t, shares, least);
            if least >= 0.0 {
                break;
            }
        }
    }
    (best.0, best.1)
}
