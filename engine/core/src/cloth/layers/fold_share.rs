//! Folds of a garment: what is remembered of them, and the contacts that they make.
//!
//! A particle keeps up to two pieces of its own garment in mind, one on either side, each with the side of it on which the
//! particle was when they met. As long as both stay near the particle belongs on that side, also where it has been
//! squeezed through: so folds that were crushed open again.

use glam::Vec3A;

use super::contact::LayerContact;
use super::find_folds::{FindFolds, FoldSeed};
use super::fold_motion::FoldMotion;
use super::fold_surface::FoldSurface;
use super::pair::{LayerPair, PairScene, opposite};
use super::uncross::{Tangle, Uncross};
use crate::cloth::state::get;
use crate::lanes::Readable;
use crate::surface::{FindNearest, NearestPoint, SurfaceMesh};

/// Farther from a piece than this (m) a particle forgets it.
const FORGET_M: f32 = 0.015;

/// How much nearer than the gap a contact is made (m).
const MARGIN_M: f32 = 0.001;

/// Farther on the wrong side of a piece than this (m) a particle forgets it too: it would be dragged along by it.
const WRONG_M: f32 = 0.006;

/// So much before it touches a piece a particle keeps it in mind (m): the side on which it is then is still the right one.
const EARLY_M: f32 = 0.012;

/// How much faster than at its start a particle may be within a step (1).
const FASTER: f32 = 1.5;

/// How far beyond a border (m) a particle is still over the face.
const BEYOND_M: f32 = 0.001;

/// So many times farther to the side than up, a particle is beside a piece and not over it.
const BESIDE: f32 = 0.7;

/// Pieces of its own garment that a particle keeps in mind: one on either side. Of more it keeps the nearest, and of those that
/// are equally near the ones of the lowest index; the others are counted.
pub const PIECES: usize = 2;

/// Instead of a triangle: no piece.
const NONE: u32 = u32::MAX;

/// No piece.
const NO_PIECE: Piece = Piece { triangle: NONE, side: 0.0, distance: 0.0, contact: NONE };

/// A piece of its own garment that a particle keeps in mind.
#[derive(Debug, Clone, Copy)]
struct Piece {
    /// Where it is nearest.
    triangle: u32,
    /// On which side of it the particle belongs: 1 in front, -1 behind.
    side: f32,
    /// How far it was when it was last looked at (m).
    distance: f32,
    /// Which contact of the step it has made; [`NONE`] for none yet.
    contact: u32,
}

impl Piece {
    /// What is lower is kept rather: no distance is below 0, so that its bits are in its order.
    fn order(&self) -> (u32, u32) {
        (self.distance.to_bits(), self.triangle)
    }

    /// Whether it is one, and around that vertex.
    fn is_at(&self, mesh: &SurfaceMesh, surface: &FoldSurface, vertex: u32) -> bool {
        self.triangle != NONE && mesh.corners(self.triangle).iter().any(|&c| surface.one_piece(c, vertex))
    }
}

/// What folds of one garment are found from.
#[derive(Clone, Copy)]
pub struct FoldScene<'a> {
    /// Who is whose neighbour.
    pub surface: &'a FoldSurface,
    /// How the clusters lie and move.
    pub motion: &'a FoldMotion,
}

/// What one worker's half of the clusters has to do with the garment that they are of.
#[derive(Debug, Clone)]
pub struct FoldShare {
    share: usize,
    pieces: Box<[[Piece; PIECES]]>,
    /// Particles of this share that keep anything in mind, each once.
    minding: Vec<u32>,
    /// Whether each particle is among them.
    minds: Box<[bool]>,
    seeds: Vec<FoldSeed>,
    list: Vec<u32>,
    /// Which piece of its particle each in the list is; [`PIECES`] for a new one.
    which: Vec<u8>,
    found: Vec<NearestPoint>,
    /// Pieces that were not kept in mind because a particle had [`PIECES`] nearer ones, summed over the steps.
    crowded: u64,
    /// Most pieces that a particle kept in mind at once.
    pieces_most: usize,
    uncross: Uncross,
}

/// What there was no room for, counted since the garment was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FoldCounts {
    /// Most pieces that a particle kept in mind at once.
    pub pieces_most: u64,
    /// Pieces that were not kept in mind because a particle had [`PIECES`] nearer ones, summed over the steps.
    pub crowded: u64,
    /// Most crossings that were kept at once.
    pub crossings_most: u64,
    /// Crossings that there was no room for, summed over the steps.
    pub left_out: u64,
}

impl FoldShare {
    /// Room for a garment of so many particles. At load.
    pub fn new(particles: usize, share: usize) -> Self {
        let most = PIECES * particles;
        Self {
            share,
            pieces: vec![[NO_PIECE; PIECES]; particles].into(),
            minding: Vec::with_capacity(particles),
            minds: vec![false; particles].into(),
            seeds: Vec::with_capacity(most),
            list: Vec::with_capacity(2 * most),
            which: Vec::with_capacity(2 * most),
            found: Vec::with_capacity(2 * most),
            crowded: 0,
            pieces_most: 0,
            uncross: Uncross::new(particles),
        }
    }

    /// Most contacts that it makes in a step of a garment of so many particles.
    pub fn most_contacts(particles: usize) -> usize {
        PIECES * particles + Uncross::most_contacts()
    }

    /// Finds the contacts of a step; gives how many particles were looked at.
    pub fn find(
        &mut self,
        pair: &LayerPair,
        scene: &PairScene<'_>,
        folds: FoldScene<'_>,
        contacts: &mut Vec<LayerContact>,
    ) -> u64 {
        let surface = scene.surfaces[0];
        let half = surface.clusters.len().div_ceil(2);
        let clusters = if self.share == 0 { 0..half } else { half..surface.clusters.len() };
        self.seeds.clear();
        scene.width.run(FindFolds {
            v: scene.columns[0].v,
            surface,
            folds: folds.surface,
            boxes: &scene.motions[0].boxes,
            motion: folds.motion,
            normals: &scene.motions[0].normals,
            clusters,
            near: pair.thickness + EARLY_M,
            farthest: FORGET_M,
            step_seconds: scene.step_seconds,
            seeds: &mut self.seeds,
        });
        self.ask(&surface.mesh, folds.surface);
        scene.width.run(FindNearest {
            mesh: &surface.mesh,
            surface: scene.columns[0].x.each_ref().map(Readable::reader),
            points: scene.columns[0].x.each_ref().map(Readable::reader),
            list: &self.list,
            found: &mut self.found,
        });
        let crowded = self.crowded;
        for k in 0..self.list.len() {
            let (i, which, found) = (self.list[k], usize::from(self.which[k]), self.found[k]);
            let at = scene.at(i, &found, folds.surface);
            let kept = match &at {
                None => {
                    self.lose(i, which);
                    None
                }
                Some(at) if which < PIECES && self.lost(i, which, at) => {
                    self.lose(i, which);
                    None
                }
                Some(at) if which < PIECES => self.keep((&surface.mesh, folds.surface), i, which, found.triangle, at),
                Some(at) => self.meet(scene, folds.surface, i, (&found, at), contacts),
            };
            if let Some((at, kept)) = at.zip(kept)
                && let Some(contact) = touch(pair, scene, i, &found, &at, self.pieces[i as usize][kept].side)
            {
                self.pieces[i as usize][kept].contact = contacts.len() as u32;
                contacts.push(contact);
            }
        }
        if self.crowded > crowded {
            contacts.retain(|c| c.normal != Vec3A::ZERO);
        }
        self.forget();
        let tangle = Tangle { x: scene.columns[0].x, mesh: &surface.mesh, tick: scene.tick };
        let Self { pieces, uncross, list, found, .. } = self;
        let minds = |i: u32, triangle: u32| {
            let corner = surface.mesh.corners(triangle)[0];
            pieces[i as usize].iter().any(|p| p.is_at(&surface.mesh, folds.surface, corner))
        };
        uncross.find(tangle, (list, found), minds, contacts);
        self.list.len() as u64
    }

    /// Whether a particle is so far on the wrong side of a piece that it only holds on to it.
    fn lost(&self, i: u32, which: usize, at: &OnPiece) -> bool {
        at.height * self.pieces[i as usize][which].side < -WRONG_M
    }

    /// A piece is none any more.
    fn lose(&mut self, i: u32, which: usize) {
        if let Some(piece) = self.pieces[i as usize].get_mut(which) {
            piece.triangle = NONE;
        }
    }

    /// A piece that was in mind has moved along; gives which it is, unless the other one has become the same.
    fn keep(
        &mut self,
        (mesh, surface): (&SurfaceMesh, &FoldSurface),
        i: u32,
        which: usize,
        triangle: u32,
        at: &OnPiece,
    ) -> Option<usize> {
        let pieces = &mut self.pieces[i as usize];
        let corner = mesh.corners(triangle)[0];
        let doubled = pieces[..which].iter().any(|p| p.is_at(mesh, surface, corner));
        let triangle = if doubled { NONE } else { triangle };
        pieces[which] = Piece { triangle, side: pieces[which].side, distance: at.distance, contact: NONE };
        (!doubled).then_some(which)
    }

    /// Lists who asks for what: pieces in mind, then new ones.
    fn ask(&mut self, mesh: &SurfaceMesh, surface: &FoldSurface) {
        let Self { list, which, found, minding, pieces, seeds, .. } = self;
        list.clear();
        which.clear();
        found.clear();
        let mut add = |i: u32, piece: usize, triangle: u32| {
            list.push(i);
            which.push(piece as u8);
            found.push(NearestPoint { triangle, ..NearestPoint::default() });
        };
        for &i in minding.iter() {
            for (k, piece) in pieces[i as usize].iter().enumerate().filter(|(_, p)| p.triangle != NONE) {
                add(i, k, piece.triangle);
            }
        }
        for seed in seeds.iter() {
            let known = pieces[seed.particle as usize].iter().any(|p| p.is_at(mesh, surface, seed.vertex));
            if let Some(&triangle) = mesh.fan(seed.vertex).first().filter(|_| !known) {
                add(seed.particle, PIECES, triangle);
            }
        }
    }

    /// Keeps a piece in mind that was not, if need be in place of the farthest, whose contact is then none any more; gives
    /// which it is.
    fn meet(
        &mut self,
        scene: &PairScene<'_>,
        surface: &FoldSurface,
        i: u32,
        (found, at): (&NearestPoint, &OnPiece),
        contacts: &mut [LayerContact],
    ) -> Option<usize> {
        let mesh = &scene.surfaces[0].mesh;
        let pieces = &mut self.pieces[i as usize];
        let corner = mesh.corners(found.triangle)[0];
        let known = pieces.iter().any(|p| p.is_at(mesh, surface, corner));
        if known || at.beside || !self.uncross.sure(i) || at.distance > FORGET_M {
            return None;
        }
        let parts = &scene.surfaces[0].parts;
        // Where the parts of the body tell, history is not asked.
        let front_to_front = opposite(parts[i as usize], parts[corner as usize]) == Some(true);
        let side = if front_to_front || at.height >= 0.0 { 1.0 } else { -1.0 };
        let new = Piece { triangle: found.triangle, side, distance: at.distance, contact: NONE };
        let place = match pieces.iter().position(|p| p.triangle == NONE) {
            Some(free) => free,
            None => {
                self.crowded += 1;
                let farthest = (0..PIECES).max_by_key(|&k| pieces[k].order())?;
                if new.order() >= pieces[farthest].order() {
                    return None;
                }
                if let Some(contact) = contacts.get_mut(pieces[farthest].contact as usize) {
                    contact.normal = Vec3A::ZERO;
                }
                farthest
            }
        };
        pieces[place] = new;
        self.pieces_most = self.pieces_most.max(pieces.iter().filter(|p| p.triangle != NONE).count());
        if !std::mem::replace(&mut self.minds[i as usize], true) {
            self.minding.push(i);
        }
        Some(place)
    }

    /// Strikes out who keeps nothing in mind any more.
    fn forget(&mut self) {
        let Self { minding, minds, pieces, .. } = self;
        minding.retain(|&i| {
            minds[i as usize] = pieces[i as usize].iter().any(|p| p.triangle != NONE);
            minds[i as usize]
        });
    }

    /// What there was no room for.
    pub fn counts(&self) -> FoldCounts {
        let Uncross { most, left_out, .. } = self.uncross;
        let pieces_most = self.pieces_most as u64;
        FoldCounts { pieces_most, crowded: self.crowded, crossings_most: most as u64, left_out }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.pieces)
            + size_of_val(&*self.minds)
            + size_of::<u32>() * (self.minding.capacity() + self.list.capacity())
            + size_of::<FoldSeed>() * self.seeds.capacity()
            + self.which.capacity()
            + size_of::<NearestPoint>() * self.found.capacity()
            + self.uncross.bytes()
    }
}

/// Where a particle is from a piece of its own garment.
pub struct OnPiece {
    /// From the piece's nearest point to the particle (m).
    away: Vec3A,
    /// Its length (m).
    distance: f32,
    /// Normal of the piece there.
    front: Vec3A,
    /// How far in front of it the particle is (m).
    height: f32,
    /// Whether it is beside the piece rather than over it, where that is folded itself.
    beside: bool,
}

impl PairScene<'_> {
    /// Where a particle is from a piece; none where that is no fold: the particle's own neighbourhood, or beside a border, or
    /// far away.
    fn at(&self, i: u32, found: &NearestPoint, folds: &FoldSurface) -> Option<OnPiece> {
        let mesh = &self.surfaces[0].mesh;
        let corners = mesh.corners(found.triangle);
        let distance = found.distance2.sqrt();
        if distance.is_nan() || distance >= 2.0 * FORGET_M || corners.iter().any(|&c| folds.one_piece(i, c)) {
            return None;
        }
        let x = self.columns[0].x;
        let point: Vec3A = (0..3).map(|k| get(x, corners[k] as usize) * found.shares[k]).sum();
        let normal = |k: usize| self.motions[0].normals[corners[k] as usize] * found.shares[k];
        let front = (normal(0) + normal(1) + normal(2)).normalize_or_zero();
        let away = get(x, i as usize) - point;
        let height = away.dot(front);
        let beside2 = away.length_squared() - height * height;
        let off = beside2 > BEYOND_M * BEYOND_M && mesh.on_border(found.triangle, SurfaceMesh::feature(found.shares));
        let beside = beside2 > BEYOND_M * BEYOND_M && beside2 > BESIDE * BESIDE * height * height;
        (!off).then_some(OnPiece { away, distance, front, height, beside })
    }
}

/// The contact with a piece, if it may come to one in this step.
fn touch(
    pair: &LayerPair,
    scene: &PairScene<'_>,
    i: u32,
    found: &NearestPoint,
    at: &OnPiece,
    side: f32,
) -> Option<LayerContact> {
    let v = scene.columns[0].v;
    let corners = scene.surfaces[0].mesh.corners(found.triangle);
    if at.beside {
        return None;
    }
    // Square to the mean of both: where one is crumpled, the smooth one shows the way out.
    let own = scene.motions[0].normals[i as usize];
    let along = if own.dot(at.front) < 0.0 { -own } else { own };
    let normal = (at.front + along).normalize_or_zero() * side;
    let gap = at.away.dot(normal) - pair.thickness;
    let moved: Vec3A = (0..3).map(|k| get(v, corners[k] as usize) * found.shares[k]).sum();
    let approach = (moved - get(v, i as usize)).dot(normal).max(0.0);
    let near = gap < MARGIN_M + FASTER * scene.step_seconds * approach;
    near.then(|| LayerContact { particle: i, corners, shares: found.shares, normal, ..LayerContact::default() })
}

#[cfg(test)]
mod tests;
