//! Layers: garments over one another, stepped together so that the outer one stays outside.
//!
//! A step of 10,000 particles that lie on each other may take 1 ms, shared by two workers. Nothing is allocated after load.
//!
//! The side of a contact comes from the wearing order alone: a particle of an outer garment belongs in front of an inner
//! garment's face, one of an inner garment behind an outer garment's. So an order that was lost comes back. Within a substep each
//! garment is put on what lies under it, from below; what it bears is then passed on downwards, so all weight arrives at the body.

mod bearing;
mod border_edges;
mod contact;
mod contact_list;
mod find_folds;
mod flatness;
mod fold_motion;
mod fold_share;
mod fold_surface;
mod garment_surface;
mod lay;
mod order;
mod pace;
mod pair;
mod pair_share;
mod phases;
mod step;
#[cfg(test)]
mod tests;
mod thickness;
mod touch;
mod tuck;
mod turns;
mod uncross;
#[expect(unsafe_code, reason = "the workers of a step share the contacts")]
mod work;

use std::sync::Arc;

use glam::Vec3;
use toile_base::garment::{Garment, Layout};
use toile_base::limits::MAX_GARMENTS;

use crate::bounded::Fill;
use bearing::GarmentBearing;
use garment_surface::{GarmentMotion, GarmentSurface};
use order::heights;
use pace::PairPace;
use pair::{GarmentPair, Wearing};
use pair_share::PairShare;
use touch::TouchLists;
use turns::Turns;

pub use fold_share::PAIRS_A_PARTICLE;
pub use lay::lay_outside;
pub use order::wearing_order;
pub use tuck::{TuckError, tuck_in};
pub use uncross::MOST_CROSSINGS;

/// Garments that lie farther apart than this where they start (m) never touch.
const NEAR_M: f32 = 0.15;

/// What layer contact did, counted since the garments were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GarmentContactCounts {
    /// Particles that were looked at, summed over the steps.
    pub asked: u64,
    /// Contacts that were solved, summed over the steps.
    pub contacts: u64,
    /// Most contacts of one step.
    pub contacts_most: u64,
    /// Most pairs of its own particles that one worker kept of a garment at once.
    pub pairs_most: u64,
    /// Room for such pairs: [`PAIRS_A_PARTICLE`] times the particles, of the garment that has most.
    pub pairs_room: u64,
    /// Pairs of its own particles that there was no room for, summed over the steps: the nearest were kept.
    pub crowded: u64,
    /// Most crossings that one worker kept of one garment at once, of [`MOST_CROSSINGS`].
    pub crossings_most: u64,
    /// Crossings that there was no room for, summed over the steps.
    pub left_out: u64,
    /// Steps that were refused because they were asked for with other garments than the layers' own, or with states of others.
    pub refused: u64,
}

impl GarmentContactCounts {
    /// Adds what a step did, whose shares are these.
    fn add(&mut self, shares: &[PairShare]) {
        let contacts = shares.iter().map(|s| s.contacts.len() as u64).sum();
        self.asked += shares.iter().map(|s| s.asked).sum::<u64>();
        self.contacts += contacts;
        self.contacts_most = self.contacts_most.max(contacts);
        // These are counted since the start.
        let folds = || shares.iter().map(PairShare::fold_counts);
        self.pairs_most = folds().map(|f| f.pairs_most).max().unwrap_or(0);
        self.pairs_room = folds().map(|f| f.pairs_room).max().unwrap_or(0);
        self.crowded = folds().map(|f| f.crowded).sum();
        self.crossings_most = folds().map(|f| f.crossings_most).max().unwrap_or(0);
        self.left_out = folds().map(|f| f.left_out).sum();
    }
}

/// The contact between the garments of an outfit. All storage is made once.
#[derive(Debug, Clone)]
pub struct GarmentContact {
    /// The constraints of the garments that all of this was made for.
    layouts: Box<[Arc<Layout>]>,
    surfaces: Box<[GarmentSurface]>,
    motions: Box<[GarmentMotion]>,
    pairs: Box<[GarmentPair]>,
    /// In which steps each is searched.
    paces: Box<[PairPace]>,
    /// First share of every pair, then the second.
    shares: Box<[PairShare]>,
    touching: Box<[TouchLists]>,
    bearing: Box<[GarmentBearing]>,
    /// Which worker takes and lists what is known of each garment.
    worker: Box<[usize]>,
    turns: Turns,
    tick: u64,
    counts: GarmentContactCounts,
}

impl GarmentContact {
    /// The layers of some garments and the folds of each; none where none has faces, and of more than [`MAX_GARMENTS`]. At
    /// load.
    pub fn new(garments: &[Garment]) -> Option<Self> {
        let order = wearing_order(garments);
        let boxes: Vec<[Vec3; 2]> = garments.iter().map(bounds).collect();
        let meet = |a: usize, b: usize| {
            let ([low, high], [other_low, other_high]) = (boxes[a], boxes[b]);
            low.cmple(other_high + NEAR_M).all() && other_low.cmple(high + NEAR_M).all()
        };
        let surfaces: Box<[GarmentSurface]> = garments.iter().map(|g| GarmentSurface::new(g).with_folds(g)).collect();
        let folded = (0..garments.len()).filter(|&g| surfaces[g].folds.is_some());
        let heights = heights(&order, meet);
        let level = |garment: usize| heights[garment].max(1);
        let mut pairs: Vec<_> = folded.map(|g| GarmentPair::new(garments, g, g, Wearing::Folded, level(g))).collect();
        for (k, &outer) in order.iter().enumerate() {
            for &inner in order[..k].iter().filter(|&&inner| meet(inner, outer)) {
                for (particles, faces, wearing) in [(outer, inner, Wearing::Outer), (inner, outer, Wearing::Inner)] {
                    if !surfaces[faces].mesh.is_empty() {
                        pairs.push(GarmentPair::new(garments, particles, faces, wearing, level(outer)));
                    }
                }
            }
        }
        if pairs.is_empty() || garments.len() > MAX_GARMENTS {
            return None;
        }
        let halves = |share: usize| pairs.iter().map(|p| PairShare::new(p, &surfaces, share)).collect::<Vec<_>>();
        Some(Self {
            layouts: garments.iter().map(|g| Arc::clone(g.shared_layout())).collect(),
            motions: surfaces.iter().map(GarmentMotion::new).collect(),
            shares: halves(0).into_iter().chain(halves(1)).collect(),
            bearing: garments.iter().map(|g| GarmentBearing::new(g.particles())).collect(),
            touching: (0..garments.len())
                .map(|g| TouchLists::new(g, heights[g], garments, &surfaces, &pairs))
                .collect(),
            worker: workers(garments),
            turns: Turns { top: heights.iter().copied().max().unwrap_or(0).max(1) },
            surfaces,
            paces: pairs.iter().map(|_| PairPace::default()).collect(),
            pairs: pairs.into(),
            tick: 0,
            counts: GarmentContactCounts::default(),
        })
    }

    /// What layer contact did so far.
    pub fn counts(&self) -> GarmentContactCounts {
        self.counts
    }

    /// How full the lists were that steps fill: the fullest of them, and what all of them lost. Each can hold all that may come; pairs
    /// and crossings of folds have limits of their own, which [`Self::counts`] reports.
    pub fn lists(&self) -> Fill {
        let shares = self.shares.iter().map(PairShare::usage);
        shares.chain(self.touching.iter().map(TouchLists::usage)).fold(Fill::default(), Fill::and)
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.surfaces.iter().map(GarmentSurface::bytes).sum::<usize>()
            + self.motions.iter().map(GarmentMotion::bytes).sum::<usize>()
            + self.shares.iter().map(PairShare::bytes).sum::<usize>()
            + self.touching.iter().map(TouchLists::bytes).sum::<usize>()
            + self.bearing.iter().map(GarmentBearing::bytes).sum::<usize>()
    }
}

/// Lower and upper end of where a garment starts (m).
fn bounds(garment: &Garment) -> [Vec3; 2] {
    let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    garment.start.iter().fold(none, |[low, high], p| [low.min(*p), high.max(*p)])
}

/// Which worker does what is one worker's of each garment: the dearest first, each to the worker who has less to do.
fn workers(garments: &[Garment]) -> Box<[usize]> {
    let mut order: Vec<usize> = (0..garments.len()).collect();
    order.sort_by_key(|&g| std::cmp::Reverse(garments[g].particles()));
    let (mut load, mut worker) = ([0; 2], vec![0; garments.len()]);
    for g in order {
        worker[g] = usize::from(load[1] < load[0]);
        load[worker[g]] += garments[g].particles();
    }
    worker.into()
}
