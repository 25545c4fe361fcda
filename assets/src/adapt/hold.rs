//! What is held: of each piece, what lies on the skin and what carries it, as tailors' garments hang; the rest moves.

use std::collections::VecDeque;

use glam::Vec3;

use super::lay::LaidMesh;
use super::mesh::ForeignMesh;
use super::surface::loops;
use crate::body::Body;

/// Cloth that starts nearer to the skin than this (m) lies on it and follows it.
const TIGHT_M: f32 = 0.010;

/// Cloth above the shoulders' height less this (m), flat enough and near enough, is carried by them.
const YOKE_BELOW_M: f32 = 0.06;
const YOKE_UP: f32 = 0.35;
const YOKE_NEAR_M: f32 = 0.03;

/// Height of a waistband (m): what hangs from no shoulder is held so far below its upper edge.
const BAND_M: f32 = 0.04;

/// Patches of cloth that move are no smaller than this (vertices), and patches that are held where nothing carries neither.
const LEAST_MOVING: usize = 24;
const LEAST_HELD: usize = 12;

/// What holds a piece, in a few words, and which of its vertices are held.
pub struct HeldVertices {
    /// True where a vertex is held `[vertices]`.
    pub held: Vec<bool>,
    /// What carries the piece.
    pub by: &'static str,
}

/// Which vertices of a piece are held. `held` is filled for all of the mesh; only the piece's vertices are looked at.
pub fn hold(mesh: &ForeignMesh, laid: &LaidMesh, shopper: &Body, piece: &[u32], neighbours: &[Vec<u32>]) -> HeldVertices {
    let mut inside = vec![false; mesh.positions.len()];
    piece.iter().for_each(|v| inside[*v as usize] = true);
    let normals = normals(mesh, &laid.worn);
    let on_shoulders = |v: u32| {
        let (p, i) = (laid.worn[v as usize], v as usize);
        let near = laid.clearance[i] < YOKE_NEAR_M && normals[i].y > YOKE_UP;
        p.y > shopper.levels.shoulder - YOKE_BELOW_M && near || p.y > shopper.levels.neck
    };
    let yoke: Vec<u32> = piece.iter().copied().filter(|v| on_shoulders(*v)).collect();
    let (carried, by) = match yoke.len() {
        0..LEAST_HELD => (band(mesh, laid, piece, neighbours), "hangs from its upper edge"),
        _ => (yoke, "hangs from the shoulders"),
    };
    let mut carries = vec![false; mesh.positions.len()];
    carried.iter().for_each(|v| carries[*v as usize] = true);
    let mut held = carries.clone();
    for &v in piece {
        // A vertex is as tight as it and its neighbours are in the mean.
        let beside = &neighbours[v as usize];
        let sum: f32 = beside.iter().map(|u| laid.clearance[*u as usize].min(2.0 * TIGHT_M)).sum();
        let mean = 0.5 * (laid.clearance[v as usize].min(2.0 * TIGHT_M) + sum / beside.len().max(1) as f32);
        held[v as usize] |= mean < TIGHT_M;
    }
    for (state, least) in [(true, LEAST_HELD), (false, LEAST_MOVING)] {
        for patch in patches(piece, neighbours, |v| held[v as usize] == state) {
            if patch.len() < least && !patch.iter().any(|v| carries[*v as usize]) {
                patch.iter().for_each(|v| held[*v as usize] = !state);
            }
        }
    }
    HeldVertices { held, by }
}

/// Connected patches of the vertices of a piece that `is` names.
pub fn patches(piece: &[u32], neighbours: &[Vec<u32>], is: impl Fn(u32) -> bool) -> Vec<Vec<u32>> {
    let mut seen = std::collections::BTreeSet::new();
    let mut found = Vec::new();
    for &first in piece.iter().filter(|v| is(**v)) {
        if !seen.insert(first) {
            continue;
        }
        let mut patch = vec![first];
        let mut next = 0;
        while next < patch.len() {
            let v = patch[next];
            next += 1;
            patch.extend(neighbours[v as usize].iter().copied().filter(|u| is(*u) && seen.insert(*u)));
        }
        found.push(patch);
    }
    found
}

/// What lies within a waistband's height of a piece's uppermost border, along the cloth; of a piece without any, its top.
fn band(mesh: &ForeignMesh, laid: &LaidMesh, piece: &[u32], neighbours: &[Vec<u32>]) -> Vec<u32> {
    let own = |ring: &Vec<u32>| piece.binary_search(&ring[0]).is_ok();
    let height = |ring: &Vec<u32>| ring.iter().map(|v| laid.worn[*v as usize].y).sum::<f32>() / ring.len() as f32;
    let top = loops(mesh).into_iter().filter(own).max_by(|a, b| height(a).total_cmp(&height(b)));
    let highest = piece.iter().map(|v| laid.worn[*v as usize].y).fold(f32::NEG_INFINITY, f32::max);
    let start = top.unwrap_or_else(|| {
        piece.iter().copied().filter(|v| laid.worn[*v as usize].y > highest - 0.5 * BAND_M).collect()
    });
    let mut far = vec![f32::INFINITY; mesh.positions.len()];
    let mut queue: VecDeque<u32> = start.into();
    queue.iter().for_each(|v| far[*v as usize] = 0.0);
    while let Some(v) = queue.pop_front() {
        for &u in &neighbours[v as usize] {
            let d = far[v as usize] + mesh.positions[v as usize].distance(mesh.positions[u as usize]);
            if d < far[u as usize] && d <= BAND_M {
                far[u as usize] = d;
                queue.push_back(u);
            }
        }
    }
    piece.iter().copied().filter(|v| far[*v as usize].is_finite()).collect()
}

fn normals(mesh: &ForeignMesh, worn: &[Vec3]) -> Vec<Vec3> {
    let mut laid = mesh.clone();
    laid.positions = worn.to_vec();
    let mut out = vec![Vec3::ZERO; worn.len()];
    for f in 0..laid.faces.len() {
        let n = laid.area_normal(f);
        crate::garment::check::corners(&laid.faces[f]).iter().for_each(|v| out[*v as usize] += n);
    }
    out.iter().map(|n| n.normalize_or_zero()).collect()
}
