//! Chooses the held vertices of each piece: those on the skin and those that carry it, as tailors' garments hang. The rest moves.

use std::collections::VecDeque;

use glam::Vec3;

use super::lay::LaidMesh;
use super::made_for::arm_share;
use super::mesh::ForeignMesh;
use super::surface::loops;
use toile_bake::check::corners;
use toile_base::body::Body;
use toile_base::garment::Part;

/// Cloth that starts nearer to the skin than this (m) lies on it and follows it.
const TIGHT_M: f32 = 0.010;

/// Cloth above the shoulders' height less this (m), flat enough and near enough, is carried by them.
const YOKE_BELOW_M: f32 = 0.06;
const YOKE_UP: f32 = 0.35;
const YOKE_NEAR_M: f32 = 0.03;

/// Height of a waistband (m): what hangs from no shoulder is held so far below its upper edge.
const BAND_M: f32 = 0.04;

/// Cloth whose skin an arm carries by a share between these bends with the shoulder: it is stretched as skin is, and what moved
/// between arm and trunk would be torn by them.
const SHOULDER_SHARE: [f32; 2] = [0.04, 0.96];

/// A patch of cloth moves only if it has room: an area of so much (m^2), a share of which is farther from the skin than so much (m).
const LEAST_AREA_M2: f32 = 0.015;
const LEAST_LOOSE: f32 = 0.2;
const LOOSE_M: f32 = 0.018;

/// Patches that are held where nothing carries are no smaller than this (vertices), nor is a yoke.
const LEAST_HELD: usize = 12;

/// Holds the pieces of a mesh, one after the other.
pub struct Holding<'a> {
    mesh: &'a ForeignMesh,
    laid: &'a LaidMesh,
    shopper: &'a Body,
    neighbours: &'a [Vec<u32>],
    /// Normals of the cloth as laid `[vertices]`.
    normals: Vec<Vec3>,
    /// Area of the cloth around each vertex (m^2) `[vertices]`.
    areas: Vec<f32>,
    /// Borders, each with the mean height of its vertices (m).
    borders: Vec<(f32, Vec<u32>)>,
    /// Distance from the upper edge, along the cloth (m) `[vertices]`.
    far: Vec<f32>,
    /// True where a vertex is held; only the entries of pieces that were held are written `[vertices]`.
    pub held: Vec<bool>,
    /// True where a vertex carries its piece `[vertices]`.
    carries: Vec<bool>,
}

impl<'a> Holding<'a> {
    /// Of a mesh on a shopper; nothing is held yet.
    pub fn new(mesh: &'a ForeignMesh, laid: &'a LaidMesh, shopper: &'a Body, neighbours: &'a [Vec<u32>]) -> Self {
        let height = |ring: &Vec<u32>| ring.iter().map(|v| laid.worn[*v as usize].y).sum::<f32>() / ring.len() as f32;
        let count = mesh.positions.len();
        let mut areas = vec![0.0; count];
        for (f, ring) in mesh.faces.iter().map(corners).enumerate() {
            let share = 0.5 * mesh.area_normal(f).length() / ring.len() as f32;
            ring.iter().for_each(|v| areas[*v as usize] += share);
        }
        Self {
            areas,
            mesh,
            laid,
            shopper,
            neighbours,
            normals: normals(mesh, &laid.worn),
            borders: loops(mesh).into_iter().map(|ring| (height(&ring), ring)).collect(),
            far: vec![f32::INFINITY; count],
            held: vec![false; count],
            carries: vec![false; count],
        }
    }

    /// Holds a piece and says in a few words what carries it. `piece` is sorted.
    pub fn hold(&mut self, piece: &[u32]) -> &'static str {
        let yoke: Vec<u32> = piece.iter().copied().filter(|v| self.is_on_shoulders(*v)).collect();
        let (carried, by) = match yoke.len() {
            0..LEAST_HELD => (self.band(piece), "hangs from its upper edge"),
            _ => (yoke, "hangs from the shoulders"),
        };
        carried.iter().for_each(|v| self.carries[*v as usize] = true);
        for &v in piece {
            self.held[v as usize] = self.carries[v as usize] || self.bends(v) || self.is_tight(v);
        }
        for patch in patches(piece, self.neighbours, |v| self.held[v as usize]) {
            if patch.len() < LEAST_HELD && !patch.iter().any(|v| self.carries[*v as usize]) {
                patch.iter().for_each(|v| self.held[*v as usize] = false);
            }
        }
        for patch in patches(piece, self.neighbours, |v| !self.held[v as usize]) {
            if !self.has_room(&patch) {
                patch.iter().for_each(|v| self.held[*v as usize] = true);
            }
        }
        by
    }

    /// Whether a vertex lies where an arm meets the trunk.
    fn bends(&self, v: u32) -> bool {
        let weights = &self.laid.weights[v as usize];
        let [least, most] = SHOULDER_SHARE;
        let between = |side: f32| (least..most).contains(&arm_share(weights, side));
        self.laid.parts[v as usize] == Part::Hollow || between(1.0) || between(-1.0)
    }

    /// Whether a patch is large and loose enough to move.
    fn has_room(&self, patch: &[u32]) -> bool {
        let area: f32 = patch.iter().map(|v| self.areas[*v as usize]).sum();
        let loose = patch.iter().filter(|v| self.laid.clearance[**v as usize] > LOOSE_M).count();
        area >= LEAST_AREA_M2 && loose as f32 >= LEAST_LOOSE * patch.len() as f32
    }

    fn is_on_shoulders(&self, v: u32) -> bool {
        let (p, i) = (self.laid.worn[v as usize], v as usize);
        let near = self.laid.clearance[i] < YOKE_NEAR_M && self.normals[i].y > YOKE_UP;
        p.y > self.shopper.levels.shoulder - YOKE_BELOW_M && near || p.y > self.shopper.levels.neck
    }

    /// Whether a vertex and its neighbours lie on the skin in the mean.
    fn is_tight(&self, v: u32) -> bool {
        let clearance = |v: u32| self.laid.clearance[v as usize].min(2.0 * TIGHT_M);
        let beside = &self.neighbours[v as usize];
        let mean = beside.iter().map(|u| clearance(*u)).sum::<f32>() / beside.len().max(1) as f32;
        0.5 * (clearance(v) + mean) < TIGHT_M
    }

    /// What lies within a waistband's height of a piece's uppermost border, along the cloth; of a piece without any, its top.
    fn band(&mut self, piece: &[u32]) -> Vec<u32> {
        let own = self.borders.iter().filter(|(_, ring)| piece.binary_search(&ring[0]).is_ok());
        let top = own.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, ring)| ring.clone());
        let height = |v: &u32| self.laid.worn[*v as usize].y;
        let highest = piece.iter().map(height).fold(f32::NEG_INFINITY, f32::max);
        let start =
            top.unwrap_or_else(|| piece.iter().copied().filter(|v| height(v) > highest - 0.5 * BAND_M).collect());
        let mut queue: VecDeque<u32> = start.into();
        queue.iter().for_each(|v| self.far[*v as usize] = 0.0);
        while let Some(v) = queue.pop_front() {
            for &u in &self.neighbours[v as usize] {
                let step = self.mesh.positions[v as usize].distance(self.mesh.positions[u as usize]);
                let d = self.far[v as usize] + step;
                if d < self.far[u as usize] && d <= BAND_M {
                    self.far[u as usize] = d;
                    queue.push_back(u);
                }
            }
        }
        piece.iter().copied().filter(|v| self.far[*v as usize].is_finite()).collect()
    }
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

fn normals(mesh: &ForeignMesh, worn: &[Vec3]) -> Vec<Vec3> {
    let mut laid = mesh.clone();
    laid.positions = worn.to_vec();
    let mut out = vec![Vec3::ZERO; worn.len()];
    for f in 0..laid.faces.len() {
        let n = laid.area_normal(f);
        corners(&laid.faces[f]).iter().for_each(|v| out[*v as usize] += n);
    }
    out.iter().map(|n| n.normalize_or_zero()).collect()
}
