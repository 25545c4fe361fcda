//! Folds of a garment: the contacts that keep its particles apart.
//!
//! Particles of one garment that are not joined keep as far apart as the edges of their triangles ask for: then no two of its
//! triangles can cross (Wu et al. 2020, "A safe and fast repulsion method for GPU-based cloth self collisions", theorem 1), and no
//! side has to be remembered. The direction of a contact is that at the start of the step, so that within the step neither passes
//! the plane between the two. Only where the parts of the body tell that two pieces meet front to front, one leg and the other
//! for example, the side is known: there the two are brought apart from wherever they are.
//!
//! Cloth that crosses all the same, because the body or the pins have left no room, is drawn out by [`Uncross`]. Its particles
//! keep apart from no other meanwhile, since that would hold them in place.

use glam::Vec3A;
use toile_base::garment::Part;

use super::contact::LayerContact;
use super::contact_list::ContactList;
use super::find_folds::{FASTER, FindFolds, FoldPair, MARGIN_M, PARTS};
use super::fold_motion::FoldMotion;
use super::fold_surface::FoldSurface;
use super::pair::{PairScene, opposite};
use super::uncross::{Tangle, Uncross};
use crate::bounded::BoundedVec;
use crate::cloth::state::get;

/// Capacity of one worker for pairs of a garment's particles, per particle. If there are more pairs, it keeps the nearest, relative
/// to the distance that they are to keep, then those of the lowest index; the others are counted. The capacity is enough: at most
/// twelve particles around another keep apart from it, each pair is one share's, and few garments are folded everywhere. Wide
/// skirts and trouser legs come to more than six while they fall.
pub const PAIRS_A_PARTICLE: usize = 8;

/// Which pairs are taken, by how far apart they are as a part of what they keep apart (1): all, and where there is no room those
/// nearer than the next of these. What comes near fast is looked for from far away, so it begins well above 1.
const NEARER: [f32; 10] = [1e9, 4.0, 2.8, 2.0, 1.5, 1.2, 1.0, 0.8, 0.6, 0.4];

/// Farther apart than such a part of what they keep apart (1) no edges of two particles cross.
const MAY_CROSS: f32 = 0.9;

/// Particles of different parts nearer to each other than this where the garment starts (m) lie beside the seam between these.
const SEAM_M: f32 = 0.05;

/// Cosine of normals from which on two pieces look at each other.
const FACING: f32 = -0.3;

/// What folds of one garment are found from.
#[derive(Clone, Copy)]
pub struct FoldScene<'a> {
    /// Distances that the particles keep from each other.
    pub surface: &'a FoldSurface,
    /// Where the clusters are and how they move.
    pub motion: &'a FoldMotion,
}

/// What one worker's half of the clusters has to do with the garment that they are of.
#[derive(Debug, Clone)]
pub struct FoldShare {
    share: usize,
    /// Of each part of its clusters the pairs that were found when that was last looked at.
    pairs: [BoundedVec<FoldPair>; PARTS],
    /// Whether the pairs of all parts have to be found, because nothing is known of them.
    unknown: bool,
    /// Most pairs that were kept at once.
    most: usize,
    /// Pairs that there was no room for, summed over the steps.
    crowded: u64,
    uncross: Uncross,
}

/// Pairs and crossings that did not fit, counted since the garment was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FoldCounts {
    /// Most pairs that one worker kept at once.
    pub pairs_most: u64,
    /// Room for pairs that one worker has.
    pub pairs_room: u64,
    /// Pairs that there was no room for, summed over the steps.
    pub crowded: u64,
    /// Most crossings that were kept at once.
    pub crossings_most: u64,
    /// Crossings that there was no room for, summed over the steps.
    pub left_out: u64,
}

impl FoldShare {
    /// Room for a garment of so many particles. At load.
    pub fn new(particles: usize, share: usize) -> Self {
        Self {
            share,
            pairs: [(); PARTS].map(|()| BoundedVec::new(PAIRS_A_PARTICLE * particles / PARTS)),
            unknown: true,
            most: 0,
            crowded: 0,
            uncross: Uncross::new(particles),
        }
    }

    /// Most contacts that it makes in a step of a garment of so many particles.
    pub fn most_contacts(particles: usize) -> usize {
        PAIRS_A_PARTICLE * particles + Uncross::most_contacts()
    }

    /// Finds the contacts of a step; gives how many pairs were looked at.
    pub fn find(
        &mut self,
        scene: &PairScene<'_>,
        folds: FoldScene<'_>,
        thickness: f32,
        contacts: &mut ContactList,
    ) -> u64 {
        self.find_pairs(scene, folds);
        let mesh = &scene.surfaces[0].mesh;
        let tangle = Tangle { x: scene.columns[0].x, mesh, tick: scene.tick };
        self.uncross.begin_step(tangle);
        for pair in self.pairs.iter().flatten() {
            let [x, y] = pair.particles.map(|v| get(scene.columns[0].x, v as usize));
            if x.distance_squared(y) < (MAY_CROSS * pair.gap).powi(2) {
                self.uncross.try_pair(tangle, pair.particles);
            }
        }
        for pair in self.pairs.iter().flatten() {
            let [i, j] = pair.particles;
            let Some(away) = touching(scene, pair) else { continue };
            let free = self.uncross.is_sure(i) && self.uncross.is_sure(j) || folds.surface.is_local(i, j);
            let along = || if free { away.try_normalize() } else { None };
            match side(scene, folds.surface, i, j) {
                Some(normal) => _ = contacts.push(LayerContact::with_particle(i, j, pair.gap.min(thickness)), normal),
                None => {
                    if let Some(normal) = along() {
                        contacts.push(LayerContact::with_particle(i, j, pair.gap), normal);
                    }
                }
            }
        }
        let parts = &scene.surfaces[0].parts;
        let told = |i: u32, triangle: u32| are_opposite(parts, folds.surface, i, mesh.corners(triangle)[0]);
        self.uncross.draw_out(tangle, told, contacts);
        self.pairs.iter().map(|p| p.len() as u64).sum()
    }

    /// Finds the pairs of the part whose turn it is; of all where nothing is known yet.
    fn find_pairs(&mut self, scene: &PairScene<'_>, folds: FoldScene<'_>) {
        for part in 0..PARTS {
            if self.unknown || scene.tick % PARTS as u64 == part as u64 {
                self.find_part(scene, folds, part);
            }
        }
        self.unknown = false;
        self.most = self.most.max(self.pairs.iter().map(|p| p.len()).sum());
    }

    /// Forgets what was found, because steps are made without it.
    pub fn forget(&mut self) {
        self.pairs.iter_mut().for_each(BoundedVec::clear);
        self.unknown = true;
    }

    /// Counts of the pairs and crossings that did not fit.
    pub fn counts(&self) -> FoldCounts {
        let Uncross { most, left_out, .. } = self.uncross;
        let pairs_room = self.pairs.iter().map(|p| p.usage().capacity).sum();
        let (pairs_most, crossings_most) = (self.most as u64, most as u64);
        FoldCounts { pairs_most, pairs_room, crowded: self.crowded, crossings_most, left_out }
    }

    /// Finds the pairs of a part: all, or where there is no room the nearest.
    fn find_part(&mut self, scene: &PairScene<'_>, folds: FoldScene<'_>, part: usize) {
        for (time, nearest) in NEARER.into_iter().enumerate() {
            self.pairs[part].clear();
            let left_out = scene.width.run(FindFolds {
                clusters: &scene.surfaces[0].clusters,
                folds: folds.surface,
                boxes: &scene.motions[0].boxes,
                motion: folds.motion,
                share: [self.share, part],
                seconds: scene.step_seconds * PARTS as f32,
                nearest,
                pairs: &mut self.pairs[part],
            });
            self.crowded += if time == 0 { left_out } else { 0 };
            if left_out == 0 {
                break;
            }
        }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.pairs.iter().map(BoundedVec::bytes).sum::<usize>() + self.uncross.bytes()
    }
}

/// From the second particle of a pair to the first (m), if they may come too near within the step.
fn touching(scene: &PairScene<'_>, pair: &FoldPair) -> Option<Vec3A> {
    let (x, v) = (scene.columns[0].x, scene.columns[0].v);
    let [i, j] = pair.particles.map(|p| p as usize);
    let (away, relative) = (get(x, i) - get(x, j), get(v, i) - get(v, j));
    let reach = pair.gap + MARGIN_M + relative.length() * (FASTER * scene.step_seconds);
    (away.length_squared() < reach * reach).then_some(away)
}

/// Whether two particles meet front to front if they meet at all, because they lie on parts that do. Not so beside the seam between
/// the two: that folds either way.
fn are_opposite(parts: &[Part], surface: &FoldSurface, i: u32, j: u32) -> bool {
    opposite(parts[i as usize], parts[j as usize]) == Some(true) && surface.start_distance(i, j) > SEAM_M
}

/// Where the parts of the body tell on which side of `j` the particle `i` belongs, and it is not there: towards that side.
fn side(scene: &PairScene<'_>, surface: &FoldSurface, i: u32, j: u32) -> Option<Vec3A> {
    if !are_opposite(&scene.surfaces[0].parts, surface, i, j) {
        return None;
    }
    let x = scene.columns[0].x;
    let [own, other] = [i, j].map(|v| scene.surfaces[0].mesh.vertex_normal(v, |k| get(x, k as usize)));
    let front = (other - own).normalize_or_zero();
    (own.dot(other) < FACING).then_some(front)
}
