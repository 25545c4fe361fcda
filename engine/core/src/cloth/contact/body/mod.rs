//! Contact: the cloth against the body's capsules and its skin, the floor and other planes, along the whole of each substep.
//!
//! For 4,096 particles and 28 capsules (32 at most) the broad phase may take 30 us a step, and the pushes 15 us a substep. Each
//! worker calls its own [`OwnerContacts`].

pub mod cones;
mod contact_settings;
mod near;
mod patch;
mod reach;
mod skin_asking;
mod skin_contact;
mod skin_first;
mod solve;
mod sweep;
mod touch;

use glam::Vec3;
use toile_base::garment::Part;
use toile_base::limits::MAX_CAPSULES;

use crate::body_surface::{BodyPart, BodySurface};
use crate::bounded::Fill;
use crate::cloth::state::ParticleColumns;
use crate::colliders::Colliders;
use crate::lanes::Width;
use cones::{CapsuleCones, CapsuleEnds, PrepareCones};
use near::{CapsuleBoxes, ContactPair, FindPairs, PLANES, ParticleBlock};
use skin_contact::SkinContacts;
use skin_first::{SkinFirst, capsule_limbs};
use solve::{BusyBlock, SolveContacts};
use sweep::{QUICK, Sweep};

pub use contact_settings::ContactSettings;
pub use reach::reach;

/// What contact did, counted since the garment was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ContactCounts {
    /// Pairs of particle and capsule that were near, summed over the steps.
    pub near: u64,
    /// Pairs whose way was followed, summed over the substeps.
    pub swept: u64,
    /// Capsules that could not be believed, summed over the steps.
    pub ignored: u64,
    /// Most pairs of a block of particles and a capsule in one step, and their capacity, which is all possible pairs.
    pub most_pairs: [u64; 2],
}

/// The contact of one garment, split among the workers that own its particles.
#[derive(Debug, Clone)]
pub struct Contacts {
    owners: [OwnerContacts; 2],
}

impl Contacts {
    /// All storage. `spans` are the ranges of particles (first, how many) of each worker, together each particle once;
    /// `parts` says which limb each particle belongs to, `start` where it starts (m): what is close shares a block.
    pub fn new(spans: &[Vec<(u32, u32)>; 2], parts: &[Part], start: &[Vec3], colliders: &Colliders) -> Self {
        Self { owners: [0, 1].map(|w| OwnerContacts::new(&spans[w], parts, start, colliders)) }
    }

    /// The workers' parts, to be used at the same time.
    pub fn owners(&mut self) -> &mut [OwnerContacts; 2] {
        &mut self.owners
    }

    /// What contact did so far, all workers together.
    pub fn tally(&self) -> ContactCounts {
        let [a, b] = [self.owners[0].tally, self.owners[1].tally];
        let most_pairs = [0, 1].map(|k| a.most_pairs[k] + b.most_pairs[k]);
        ContactCounts { near: a.near + b.near, swept: a.swept + b.swept, ignored: a.ignored.max(b.ignored), most_pairs }
    }

    /// How full the lists of both workers were so far.
    pub fn usage(&self) -> Fill {
        self.owners[0].skin.usage().and(self.owners[1].skin.usage())
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        let owned = |o: &OwnerContacts| {
            size_of_val(&*o.blocks)
                + size_of_val(&*o.pairs)
                + size_of_val(&*o.turns)
                + size_of_val(&*o.reach)
                + o.skin.bytes()
        };
        self.owners.iter().map(owned).sum()
    }
}

/// The contact of the particles that one worker owns.
#[derive(Debug, Clone)]
pub struct OwnerContacts {
    blocks: Box<[ParticleBlock]>,
    pairs: Box<[ContactPair]>,
    turns: Box<[BusyBlock]>,
    reach: Box<[[u16; MAX_CAPSULES]]>,
    ends: CapsuleEnds,
    cones: CapsuleCones,
    boxes: CapsuleBoxes,
    planes: heapless::Vec<[f32; 4], PLANES>,
    skin: SkinContacts,
    /// The limb of each capsule.
    limbs: [BodyPart; MAX_CAPSULES],
    tally: ContactCounts,
}

impl OwnerContacts {
    fn new(spans: &[(u32, u32)], parts: &[Part], start: &[Vec3], colliders: &Colliders) -> Self {
        let blocks = patch::blocks(spans, start);
        let pairs = vec![ContactPair::default(); blocks.len() * colliders.capsules().len()].into();
        Self {
            reach: reaches(&blocks, parts, colliders),
            turns: vec![BusyBlock::default(); blocks.len()].into(),
            skin: SkinContacts::new(&blocks, parts),
            blocks,
            pairs,
            ends: CapsuleEnds::NONE,
            cones: CapsuleCones::NONE,
            boxes: CapsuleBoxes::NONE,
            planes: heapless::Vec::new(),
            limbs: capsule_limbs(colliders),
            tally: ContactCounts::default(),
        }
    }

    /// Finds what each particle may touch in this step. Once a step, before the first substep.
    pub fn find(&mut self, width: Width, cols: ParticleColumns<'_>, colliders: &Colliders, how: &ContactSettings) {
        self.ends.read(colliders);
        self.boxes.set(&self.ends, how.offset_m);
        self.planes.clear();
        let floor = colliders.floor.then_some([0.0, 1.0, 0.0, 0.0]);
        for [x, y, z, w] in floor.into_iter().chain(colliders.planes().iter().map(|p| p.to_array())).take(PLANES) {
            // As many as there is room for are taken.
            let _ = self.planes.push([x, y, z, w + how.offset_m]);
        }
        let prepare = PrepareCones {
            ends: &self.ends,
            at: 0.5,
            share: 1.0,
            swell: 0.5,
            offset: how.offset_m,
            quick: QUICK,
            to: &mut self.cones,
        };
        width.run(prepare);
        let Self { blocks, pairs, reach, ends, cones, boxes, planes, tally, .. } = self;
        let count = width.run(FindPairs {
            cols,
            swept: cones,
            boxes,
            planes,
            blocks,
            pairs,
            reach,
            step_seconds: how.step_seconds,
        });
        let body = colliders.skin().filter(|_| how.skin_every > 0);
        self.skin.find(width, cols, body, how);
        if self.skin.any() {
            let still =
                PrepareCones { ends, at: 0.0, share: 0.0, swell: 0.0, offset: how.offset_m, quick: QUICK, to: cones };
            width.run(still);
            width.run(SkinFirst {
                cols,
                ends,
                cones,
                blocks,
                pairs: &mut pairs[..count],
                limbs: &self.limbs,
                skin: &self.skin,
            });
        }
        tally.most_pairs = [tally.most_pairs[0].max(count as u64), pairs.len() as u64];
        tally.near += pairs[..count].iter().map(|p| u64::from(p.lanes.count_ones())).sum::<u64>();
        tally.ignored += colliders.capsules().len() as u64 - u64::from(self.ends.sound.count_ones());
    }

    /// Pushes what touches out of the capsules as they stand at the end of the substep, and holds what would have gone
    /// through them. `span` is the substep's part of the step, 0..1. Last of the constraints of a substep.
    pub fn solve(&mut self, width: Width, cols: ParticleColumns<'_>, span: [f32; 2], how: &ContactSettings) {
        let Self { blocks, pairs, turns, ends, cones, planes, tally, .. } = self;
        let prepare = PrepareCones {
            ends,
            at: span[1],
            share: span[1] - span[0],
            swell: 0.0,
            offset: how.offset_m,
            quick: how.quick(),
            to: cones,
        };
        width.run(prepare);
        let sweep = Sweep { ends, cones, span, offset: how.offset_m };
        tally.swept += width.run(SolveContacts { cols, sweep, planes, blocks, pairs, turns, how });
        self.skin.solve(width, cols, span, how);
    }
}

impl Contacts {
    /// By which limb's skin a particle lies, where it does.
    pub fn by_skin(&self, particle: u32) -> Option<BodyPart> {
        self.owners[0].skin.by(particle).or(self.owners[1].skin.by(particle))
    }

    /// How deep each particle that lies by the skin is behind it at the end of the step (m). For measuring.
    pub(crate) fn skin_depths(
        &mut self,
        width: Width,
        cols: ParticleColumns<'_>,
        body: &BodySurface,
        mut depth: impl FnMut(u32, f32),
    ) {
        self.owners.iter_mut().for_each(|own| own.skin.depths(width, cols, body, &mut depth));
    }
}

/// Which particles of each block may touch each capsule at all; nothing where all may touch all.
fn reaches(blocks: &[ParticleBlock], parts: &[Part], colliders: &Colliders) -> Box<[[u16; MAX_CAPSULES]]> {
    let all = reach(Part::All, colliders);
    let bits: Vec<u32> = parts.iter().map(|&part| reach(part, colliders)).collect();
    if bits.iter().all(|b| *b == all) {
        return Box::default();
    }
    let of = |block: &ParticleBlock, c: usize| {
        let reaches = |lane: usize| bits.get(block.particle(lane) as usize).unwrap_or(&all) >> c & 1;
        (0..block.len()).fold(0, |lanes, lane| lanes | (reaches(lane) as u16) << lane)
    };
    blocks.iter().map(|block| std::array::from_fn(|c| of(block, c))).collect()
}

#[cfg(test)]
mod tests;
