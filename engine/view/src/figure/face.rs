//! The face of a shop mannequin in the place of the drawn one: the same vertices, elsewhere.

use glam::{DVec3, Vec3};
use toile_base::body::{Body, Region};
use toile_base::mesh::vertex_normals;

use super::egg::{self, ease};
use super::fairing::FairedPatch;
use super::head_space::HeadSpace;

/// Pull to the shape while folds are smoothed out, where the drawn face is smooth and where it folds: at ears, lids, lips, nostrils.
const SMOOTH_PULL: f64 = 0.08;
const FOLD_PULL: f64 = 0.0003;

/// Pull to the shape once there are none.
const LAST_PULL: f64 = 0.15;

/// A drawn face folds where its normal is so far off the direction from the middle of the head (cosine), above the jaw (mm).
const FOLDS: f32 = 0.5;
const JAW_MM: f32 = -200.0;

/// Rings of vertices around a fold that count to it.
const FOLD_RINGS: usize = 3;

/// Rings of vertices above the neck in which the shape takes over.
const NECK_RINGS: usize = 5;

/// Passes over the normals, which are as uneven as the faces of ears and lids that now lie flat.
const NORMAL_PASSES: usize = 3;

/// A body at rest whose head is a mannequin's.
pub struct Face {
    /// Places of the body's vertices (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Their unit normals `[vertices]`.
    pub normals: Vec<Vec3>,
}

/// The head with two rings of the neck.
struct HeadPatch {
    /// Vertices of the body, in rising order.
    vertices: Vec<usize>,
    /// Place where they are drawn (mm, in the head's space).
    drawn: Vec<Vec3>,
    /// How far the shape takes over, 0 to 1.
    share: Vec<f32>,
    fairing: FairedPatch,
}

impl Face {
    /// Shapes a head.
    pub fn of(body: &Body, space: &HeadSpace) -> Self {
        let mut positions = body.mesh.positions.clone();
        let rings = neighbours(positions.len(), &body.mesh.triangles);
        let mut patch = HeadPatch::of(body, space, &rings);
        let mut at: Vec<DVec3> = patch.drawn.iter().map(|p| p.as_dvec3()).collect();
        patch.fairing.pull = patch.first_pull(body);
        patch.fair(&mut at);
        // Its folds lie flat now, so that every vertex knows its place on the shape.
        patch.fairing.pull.fill(LAST_PULL);
        patch.fair(&mut at);
        for (v, p) in patch.free().map(|i| (patch.vertices[i], at[i])) {
            positions[v] = space.outwards(p.as_vec3());
        }
        let normals = patch.normals(body, &positions, &rings);
        Self { positions, normals }
    }
}

impl HeadPatch {
    fn of(body: &Body, space: &HeadSpace, rings: &[Vec<u32>]) -> Self {
        let is_head: Vec<bool> = body.regions.iter().map(|r| *r == Region::Head).collect();
        let vertices = with_rings((0..is_head.len()).filter(|v| is_head[*v]), rings);
        let mut place = vec![None; is_head.len()];
        (0..).zip(&vertices).for_each(|(i, v)| place[*v] = Some(i));
        let depth = depth(&is_head, rings);
        let drawn: Vec<Vec3> = vertices.iter().map(|v| space.inwards(body.mesh.positions[*v])).collect();
        let places = || vertices.iter().zip(&drawn);
        let share = |(v, p): (&usize, &Vec3)| ease(depth[*v] as f32, 0.0, NECK_RINGS as f32) * (1.0 - kept(*p));
        // The outermost ring has neighbours outside of the patch, and none here.
        let ring = |v: &usize| rings[*v].iter().map(|n| place[*n as usize]).collect::<Option<Vec<u32>>>();
        let fairing = FairedPatch {
            rings: vertices.iter().map(|v| ring(v).unwrap_or_default()).collect(),
            free: places().map(|(v, p)| is_head[*v] && kept(*p) < 1.0).collect(),
            pull: Vec::new(),
        };
        Self { share: places().map(share).collect(), vertices, drawn, fairing }
    }

    /// The vertices that move.
    fn free(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.vertices.len()).filter(|i| self.fairing.free[*i])
    }

    fn fair(&self, at: &mut [DVec3]) {
        let wanted = self.wanted(at);
        self.fairing.fair(at, &wanted);
    }

    /// The shape for vertices as they lie, and the drawn head where that is kept.
    fn wanted(&self, at: &[DVec3]) -> Vec<DVec3> {
        let drawn = self.drawn.iter().zip(&self.share);
        at.iter().zip(drawn).map(|(p, (drawn, share))| drawn.lerp(egg::onto(p.as_vec3()), *share).as_dvec3()).collect()
    }

    /// Hardly any at a fold and near it.
    fn first_pull(&self, body: &Body) -> Vec<f64> {
        let folds = |(p, v): (&Vec3, &usize)| {
            let outwards = (*p - egg::MIDDLE_MM).normalize_or_zero();
            outwards.dot(body.normals[*v]) < FOLDS && p.y > JAW_MM
        };
        let mut folds: Vec<bool> = self.drawn.iter().zip(&self.vertices).map(folds).collect();
        for _ in 0..FOLD_RINGS {
            let before = folds.clone();
            for (fold, ring) in folds.iter_mut().zip(&self.fairing.rings) {
                *fold |= ring.iter().any(|n| before[*n as usize]);
            }
        }
        folds.into_iter().map(|fold| if fold { FOLD_PULL } else { SMOOTH_PULL }).collect()
    }

    /// Normals of the body, evened out where the shape has taken over; those of the body farther down.
    fn normals(&self, body: &Body, positions: &[Vec3], rings: &[Vec<u32>]) -> Vec<Vec3> {
        let mut all = vec![Vec3::ZERO; positions.len()];
        vertex_normals(positions, &body.mesh.triangles, &mut all);
        for _ in 0..NORMAL_PASSES {
            let before = all.clone();
            for (i, v) in self.free().map(|i| (i, self.vertices[i])) {
                let mean = rings[v].iter().map(|n| before[*n as usize]).sum::<Vec3>().normalize_or(before[v]);
                all[v] = before[v].lerp(mean, self.share[i]).normalize_or(before[v]);
            }
        }
        let mut normals = body.normals.clone();
        self.vertices.iter().for_each(|v| normals[*v] = all[*v]);
        normals
    }
}

/// How far the drawn head is kept: not on the face, wholly on the crown and behind.
fn kept(p: Vec3) -> f32 {
    ease(p.y, -52.0, -18.0).max(ease(-p.z, 28.0, 52.0))
}

/// Some vertices with two rings around them, in rising order.
fn with_rings(some: impl Iterator<Item = usize>, rings: &[Vec<u32>]) -> Vec<usize> {
    let mut all: Vec<usize> = some.collect();
    for _ in 0..2 {
        let around: Vec<usize> = all.iter().flat_map(|v| &rings[*v]).map(|n| *n as usize).collect();
        all.extend(around);
        all.sort_unstable();
        all.dedup();
    }
    all
}

/// Neighbours of each vertex, in rising order.
fn neighbours(vertices: usize, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut rings = vec![Vec::new(); vertices];
    // A closed mesh has each edge twice, once each way.
    for [a, b, c] in triangles {
        [(a, b), (b, c), (c, a)].into_iter().for_each(|(from, to)| rings[*from as usize].push(*to));
    }
    rings.iter_mut().for_each(|ring: &mut Vec<u32>| ring.sort_unstable());
    rings
}

/// Edges from each vertex of the head to the neck, up to the rings above it.
fn depth(is_head: &[bool], rings: &[Vec<u32>]) -> Vec<usize> {
    let mut depth: Vec<usize> = is_head.iter().map(|head| if *head { NECK_RINGS } else { 0 }).collect();
    for _ in 0..NECK_RINGS {
        let before = depth.clone();
        for (d, ring) in depth.iter_mut().zip(rings) {
            let next = ring.iter().map(|n| before[*n as usize] + 1).min().unwrap_or(0);
            *d = (*d).min(next);
        }
    }
    depth
}
