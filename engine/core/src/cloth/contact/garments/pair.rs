//! A pair of garments, or one and itself: what one is to the other, and what is known of both at the start of a step.

use glam::Vec3A;
use toile_base::garment::{Garment, Part, Tuck};

use super::contact::{CONTACTS_AN_EDGE, PairConstants};
use super::garment_surface::{GarmentMotion, GarmentSurface};
use super::thickness::thickness;
use crate::cloth::ContactRates;
use crate::cloth::state::{ParticleColumns, get};
use crate::lanes::Width;

/// Fastest that cloth is pushed apart that is found in other cloth (m/s): garments, 10 mm in a hundredth of a second, and a
/// garment and itself, whose particles keep farther apart.
const PUSH_M_S: [f32; 2] = [1.0, 2.0];

/// Particles farther from a face than this (m) have lost nothing there: about half of the least distance between opposite
/// walls of a garment, a sleeve at the wrist.
pub const REACH_M: f32 = 0.03;

/// How much nearer than the gap of two garments a contact is made (m).
const MARGIN_M: f32 = 0.001;

/// How much faster than at its start a particle may be within a step (1).
pub const FASTER: f32 = 1.5;

/// How deep behind a face that looks towards it (m) a particle may be and still belong in front: two garments' fronts,
/// a sleeve and a trouser leg for example, are no layers.
const FACING_M: f32 = 0.006;

/// Cosine of normals from which on two fronts look at each other.
const FACING: f32 = -0.7;

/// Cosine of the skin's normals from which on two places lie by two limbs, and not beside each other on one.
const TWO_WALLS: f32 = -0.3;

/// Cosine between the skin's normal and where two layers look from which on that is not told by the layers: they are crumpled.
const CRUMPLED: f32 = 0.3;

/// What a particle of a pair is to the face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wearing {
    /// Worn over it.
    Outer,
    /// Worn under it.
    Inner,
    /// A part of the same garment.
    Folded,
}

/// Particles of one garment against faces of another.
#[derive(Debug, Clone)]
pub struct GarmentPair {
    /// The garment whose particles they are.
    pub particles: usize,
    /// The garment whose faces they are.
    pub faces: usize,
    /// Which is worn over which.
    pub wearing: Wearing,
    /// Distance that is kept (m): half of both thicknesses.
    pub thickness: f32,
    /// Coulomb coefficient of the two fabrics on each other: their mean (1).
    pub friction: f32,
    /// How many particles there are.
    pub count: usize,
    /// How high it lies, from 1: what is lower is solved first.
    pub level: usize,
    /// What of the one is tucked into the other.
    tuck: PairTuck,
}

/// What of a pair is tucked in.
#[derive(Debug, Clone)]
enum PairTuck {
    /// Nothing.
    None,
    /// The particles so marked, into the garment of the faces.
    Particles(Tuck),
    /// Faces with a corner so marked, into the garment of the particles.
    Faces(Tuck),
}

impl PairTuck {
    fn new(garments: &[Garment], particles: usize, faces: usize) -> Self {
        match (&garments[particles].tuck, &garments[faces].tuck) {
            (Some(tuck), _) if tuck.into == faces => Self::Particles(tuck.clone()),
            (_, Some(tuck)) if tuck.into == particles => Self::Faces(tuck.clone()),
            _ => Self::None,
        }
    }
}

impl GarmentPair {
    /// Of two of some garments. At load.
    pub fn new(garments: &[Garment], particles: usize, faces: usize, wearing: Wearing, level: usize) -> Self {
        let fabrics = [&garments[particles].fabric, &garments[faces].fabric];
        Self {
            particles,
            faces,
            wearing,
            thickness: thickness(fabrics[0], fabrics[1]),
            friction: 0.5 * fabrics.iter().map(|f| f.friction).sum::<f32>(),
            count: garments[particles].particles(),
            level,
            tuck: PairTuck::new(garments, particles, faces),
        }
    }

    /// What a particle is to a face with these corners: as the garments are worn, the other way round where it or the face is
    /// tucked in.
    #[inline]
    pub fn wearing_at(&self, particle: u32, corners: [u32; 3]) -> Wearing {
        let tucked = match &self.tuck {
            PairTuck::None => false,
            PairTuck::Particles(tuck) => tuck.particles[particle as usize],
            PairTuck::Faces(tuck) => tuck.holds(corners),
        };
        match self.wearing {
            Wearing::Outer if tucked => Wearing::Inner,
            Wearing::Inner if tucked => Wearing::Outer,
            worn => worn,
        }
    }

    /// The normal of a contact of a particle and a face with these corners, towards the side on which the particle belongs; none
    /// where that cannot be told. `front` is the normal of the face, `height` how far in front of it the particle is (m).
    ///
    /// Layers look the same way, and their contact is square to the mean of both: where one of them is crumpled, its faces look
    /// anywhere, and the smooth one shows the way out.
    pub fn normal(&self, scene: &PairScene<'_>, i: u32, corners: [u32; 3], front: Vec3A, height: f32) -> Option<Vec3A> {
        let [of, faces] = scene.surfaces;
        let own = scene.motions[0].normals[i as usize];
        let opposite = opposite(of.parts[i as usize], faces.parts[corners[0] as usize]);
        let turned = own.dot(front) < FACING;
        let wearing = self.wearing_at(i, corners);
        if opposite != Some(true)
            && let Some(out) = scene.off_the_skin(i, corners)
            && out.dot(if turned { front } else { front + own }) < CRUMPLED
        {
            return Some(if wearing == Wearing::Inner { -out } else { out });
        }
        match (wearing, opposite) {
            (_, Some(true)) => Some(front),
            (Wearing::Outer | Wearing::Folded, _) => {
                Some(if turned { front } else { (front + own).normalize_or_zero() })
            }
            (Wearing::Inner, _) if !turned => Some(-(front + own).normalize_or_zero()),
            // Rolled up cloth does not tell, nor does cloth of unknown parts.
            (Wearing::Inner, Some(false)) => None,
            (Wearing::Inner, None) => (height > -FACING_M).then_some(front),
        }
    }

    /// Most contacts of both shares together, of a pair that is no fold; `surface` is that of the particles' garment.
    pub fn most_contacts(&self, surface: &GarmentSurface) -> usize {
        self.count + CONTACTS_AN_EDGE * surface.border_edges.len()
    }

    /// Whether a garment lies on the other one of the two.
    pub fn has_above(&self, garment: usize) -> bool {
        match self.wearing {
            Wearing::Outer => self.particles == garment,
            Wearing::Inner => self.faces == garment,
            Wearing::Folded => false,
        }
    }

    /// Whether it is a garment and itself.
    pub fn is_fold(&self) -> bool {
        self.wearing == Wearing::Folded
    }

    /// Every how many steps it is searched at these rates; 0 is never.
    pub fn every(&self, rates: ContactRates) -> u8 {
        if self.is_fold() { rates.folds } else { rates.layers }
    }

    /// Constants of its contacts in a substep of `dt` (s); `static_friction` is the coefficient of sticking contacts over that of
    /// sliding ones.
    pub fn constants(&self, dt: f32, static_friction: f32) -> PairConstants {
        let friction = [self.friction * static_friction, self.friction];
        let push = PUSH_M_S[usize::from(self.is_fold())];
        PairConstants { friction, sticks: !self.is_fold(), push, dt }
    }

    /// The particles of a share: the first half and the second.
    pub fn range(&self, share: usize) -> std::ops::Range<usize> {
        let half = self.count.div_ceil(2);
        if share == 0 { 0..half } else { half..self.count }
    }
}

/// What a pair is found from: its two garments at the start of a step.
#[derive(Clone, Copy)]
pub struct PairScene<'a> {
    /// Particles of the particles' garment, then of the faces'.
    pub columns: [ParticleColumns<'a>; 2],
    /// Their surfaces.
    pub surfaces: [&'a GarmentSurface; 2],
    /// How they move.
    pub motions: [&'a GarmentMotion; 2],
    /// Time until the next search (s): a step, or several.
    pub step_seconds: f32,
    /// Number of the search.
    pub tick: u64,
    /// Lanes of the kernels.
    pub width: Width,
}

impl PairScene<'_> {
    /// Away from the skin by which a particle and a face with these corners lie, a unit vector; none where one of them lies by none, or
    /// the two by skins that look at each other.
    fn off_the_skin(&self, i: u32, corners: [u32; 3]) -> Option<Vec3A> {
        let [of, faces] = self.columns;
        let (own, under) = (get(of.skin, i as usize), get(faces.skin, corners[0] as usize));
        let known = own != Vec3A::ZERO && under != Vec3A::ZERO && own.dot(under) > TWO_WALLS;
        if known { (own + under).try_normalize() } else { None }
    }

    /// How far apart (m) two things are looked at that approach each other so fast (m/s).
    #[inline(always)]
    pub fn near(&self, approach: f32) -> f32 {
        MARGIN_M + FASTER * self.step_seconds * approach.max(0.0)
    }
}

/// Whether cloth on two parts of the body meets front to front, a sleeve and a trouser leg for example, and not as
/// layers; none where the parts do not tell.
pub fn opposite(one: Part, other: Part) -> Option<bool> {
    use Part::{All, Hollow, LeftArm, LeftLeg, RightArm, RightLeg};
    Some(match (one, other) {
        (All, _) | (_, All) => return None,
        (Hollow, _) | (_, Hollow) => false,
        (LeftLeg, RightLeg) | (RightLeg, LeftLeg) => true,
        (LeftArm | RightArm, _) | (_, LeftArm | RightArm) => one != other,
        _ => false,
    })
}
