//! Skin before cones: which particles a limb's cones leave to its skin.

use toile_base::limits::MAX_CAPSULES;

use super::cones::{CapsuleCones, CapsuleEnds};
use super::near::{ContactPair, ParticleBlock};
use super::reach::limb;
use super::skin_asking::DISAGREE_M;
use super::skin_contact::SkinContacts;
use super::touch::close;
use crate::body_surface::BodyPart;
use crate::cloth::state::ParticleColumns;
use crate::colliders::Colliders;
use crate::lanes::{Kernel, Lanes, Mask};

/// Cones this little thicker than [`DISAGREE_M`] at their thin end (m) have nothing in them that is deeper than that.
const THIN_M: f32 = 0.001;

/// The limb of each capsule; the trunk's past their count.
pub fn capsule_limbs(colliders: &Colliders) -> [BodyPart; MAX_CAPSULES] {
    let count = colliders.capsules().len();
    std::array::from_fn(|c| if c < count { limb(c, colliders) } else { BodyPart::Trunk })
}

/// Takes out of the pairs the particles that lie by the skin of the capsule's limb, unless they are deep inside the capsule.
pub struct SkinFirst<'a> {
    /// The garment's columns.
    pub cols: ParticleColumns<'a>,
    /// The ends of the capsules.
    pub ends: &'a CapsuleEnds,
    /// The capsules at the start of the step.
    pub cones: &'a CapsuleCones,
    /// The owner's blocks.
    pub blocks: &'a [ParticleBlock],
    /// Their pairs.
    pub pairs: &'a mut [ContactPair],
    /// The limb of each capsule.
    pub limbs: &'a [BodyPart; MAX_CAPSULES],
    /// By whose skin each particle lies.
    pub skin: &'a SkinContacts,
}

impl Kernel for SkinFirst<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { cols, ends, cones, blocks, pairs, limbs, skin } = self;
        for block in blocks.iter().filter(|b| b.pairs != 0) {
            let mut by = [None; crate::lanes::MOST];
            for (lane, by) in by.iter_mut().enumerate().take(block.len()) {
                *by = skin.by(block.particle(lane));
            }
            let range = block.from as usize..block.from as usize + usize::from(block.pairs);
            for pair in &mut pairs[range] {
                let of = limbs[pair.capsule.place()];
                let mut lies = 0;
                for (lane, by) in by.iter().enumerate() {
                    lies |= u16::from(by.is_some_and(|by: BodyPart| by.joins(of))) << lane;
                }
                if lies & pair.lanes != 0 {
                    let thick = ends.start.iter().all(|e| e.radius.0[pair.capsule.place()] > DISAGREE_M + THIN_M);
                    pair.lanes &= !lies | if thick { deep::<L>(cols, cones, block, pair) } else { 0 };
                }
            }
        }
    }
}

/// Which particles of a block are deeper than [`DISAGREE_M`] in a pair's capsule.
#[inline(always)]
fn deep<L: Lanes>(cols: ParticleColumns<'_>, cones: &CapsuleCones, block: &ParticleBlock, pair: &ContactPair) -> u16 {
    let (mut bits, mut from) = (0, 0);
    while from < block.len() {
        let x = block.load::<L>(cols.x, from);
        bits |= close(cones, pair.capsule, x, L::splat(-DISAGREE_M)).bits() << from;
        from += L::N;
    }
    bits as u16
}
