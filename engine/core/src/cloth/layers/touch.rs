//! Touch lists: for each particle of a garment the contacts that act on it, in a fixed order.
//!
//! Particles gather what contacts do to them; no contact writes to a particle. So sums have one order, whoever works.

use glam::Vec3A;
use toile_assets::garment::Garment;

use super::contact::{LayerContact, RestingOn};
use super::fold_share::FoldShare;
use super::pair::LayerPair;
use crate::cloth::state::{ParticleColumns, get, set};

/// One contact that acts on a particle.
#[derive(Debug, Clone, Copy, Default)]
struct Touch {
    /// Which list of contacts.
    list: u32,
    /// Which of its contacts.
    contact: u32,
    /// 1 for the contact's particle, minus the share for a corner of its face.
    share: f32,
}

/// What is moved less than this (m) only by rounding is not held.
const MOVED_M: f32 = 1e-6;

/// The lists of one garment.
#[derive(Debug, Clone)]
pub struct TouchLists {
    garment: usize,
    /// Where each particle's touches begin, and the end of the last `[particles + 1]`.
    start: Box<[u32]>,
    touches: Vec<Touch>,
    /// Particles that anything touches, in their order.
    touched: Vec<u32>,
    /// Sum of the shares of the contacts on each particle `[particles]`.
    pub load: Box<[f32]>,
    /// Where to the body, or cloth that lies on it, has moved each particle in the last substep: a unit vector, or 0
    /// `[particles]`.
    support: Box<[Vec3A]>,
    /// How far that has moved it, from where the constraints had left it (m) `[particles]`.
    lift: Box<[Vec3A]>,
    /// What particles that do not give way are still to get (kg m) `[particles]`.
    owed: Box<[Vec3A]>,
    /// Where the constraints of the substep have left each particle that anything touches (m) `[particles]`.
    left: Box<[Vec3A]>,
    /// Where the contacts have put each particle that anything touches (m) `[particles]`.
    placed: Box<[Vec3A]>,
}

impl TouchLists {
    /// Room for the touches of a garment. At load.
    pub fn new(garment: usize, garments: &[Garment], pairs: &[LayerPair]) -> Self {
        let particles = garments[garment].particles();
        let most = |p: &LayerPair| {
            let own = if p.particles == garment { particles } else { 0 };
            // A garment that meets itself has as many contacts of both kinds as particles keep pieces in mind.
            if p.particles == garment && p.faces == garment {
                // Two shares.
                return 4 * 2 * FoldShare::most_contacts(particles);
            }
            own + if p.faces == garment { 3 * garments[p.particles].particles() } else { 0 }
        };
        Self {
            garment,
            start: vec![0; particles + 1].into(),
            touches: Vec::with_capacity(pairs.iter().map(most).sum()),
            touched: Vec::with_capacity(particles),
            load: vec![0.0; particles].into(),
            support: vec![Vec3A::ZERO; particles].into(),
            lift: vec![Vec3A::ZERO; particles].into(),
            left: vec![Vec3A::ZERO; particles].into(),
            owed: vec![Vec3A::ZERO; particles].into(),
            placed: vec![Vec3A::ZERO; particles].into(),
        }
    }

    /// Lists the contacts of a step; `lists` are those of the first share of every pair, then of the second.
    pub fn fill<'c>(&mut self, pairs: &[LayerPair], lists: impl Fn(usize) -> &'c [LayerContact]) {
        let Self { garment, start, touches, touched, load, support, .. } = self;
        start.fill(0);
        load.fill(0.0);
        let each = |act: &mut dyn FnMut(u32, Touch)| {
            for list in 0..2 * pairs.len() {
                let pair = &pairs[list % pairs.len()];
                for (c, contact) in lists(list).iter().enumerate() {
                    let touch = |share| Touch { list: list as u32, contact: c as u32, share };
                    if pair.particles == *garment {
                        act(contact.particle, touch(1.0));
                    }
                    if pair.faces == *garment {
                        (0..3).for_each(|k| act(contact.corners[k], touch(-contact.shares[k])));
                    }
                }
            }
        };
        let mut count = 0;
        each(&mut |i, touch| {
            start[i as usize + 1] += 1;
            load[i as usize] += touch.share.abs();
            count += 1;
        });
        touched.clear();
        for i in 0..load.len() {
            if start[i + 1] > 0 {
                touched.push(i as u32);
            } else {
                support[i] = Vec3A::ZERO;
            }
            start[i + 1] += start[i];
        }
        touches.clear();
        touches.resize(count, Touch::default());
        each(&mut |i, touch| {
            // Filled from behind its start, which is put back below.
            touches[start[i as usize] as usize] = touch;
            start[i as usize] += 1;
        });
        for i in (1..start.len()).rev() {
            start[i] = start[i - 1];
        }
        start[0] = 0;
    }

    /// Gives the particles what their contacts do to them. Those that do not give way get it after the last solve of a
    /// substep only: what holds them then puts them back and bears it, and no solve sees a gap that is none.
    pub fn gather<'c>(
        &mut self,
        columns: ParticleColumns<'_>,
        [first, last]: [bool; 2],
        lists: impl Fn(usize) -> &'c [LayerContact],
    ) {
        for &i in &self.touched {
            let i = i as usize;
            let (mut push, mut carry, mut support) = (Vec3A::ZERO, Vec3A::ZERO, Vec3A::ZERO);
            let mut owed = self.owed[i];
            for touch in &self.touches[self.start[i] as usize..self.start[i + 1] as usize] {
                let contact = &lists(touch.list as usize)[touch.contact as usize];
                let part = contact.push * touch.share;
                if contact.holds(self.support[i], touch.share) {
                    owed += part;
                } else {
                    push += part;
                    carry += contact.carry * touch.share;
                }
                // What lies on the other side and is held holds this one.
                support += part * contact.held[usize::from(touch.share > 0.0)];
            }
            let w = columns.w.get(i);
            if first {
                self.left[i] = get(columns.x, i);
            }
            if last {
                push += owed;
                owed = Vec3A::ZERO;
                self.support[i] = support.normalize_or_zero();
            }
            self.owed[i] = owed;
            self.placed[i] = get(columns.x, i) + push * w;
            set(columns.x, i, self.placed[i]);
            set(columns.previous, i, get(columns.previous, i) + carry * w);
        }
    }

    /// Notes which of the particles the body has moved since: it holds them.
    pub fn note_support(&mut self, columns: ParticleColumns<'_>) {
        for &i in &self.touched {
            let i = i as usize;
            let x = get(columns.x, i);
            let moved = x - self.placed[i];
            if moved.length_squared() > MOVED_M * MOVED_M {
                self.support[i] = moved.normalize_or_zero();
            }
            // Not what slides along.
            self.lift[i] = self.support[i] * (x - self.left[i]).dot(self.support[i]);
        }
    }

    /// What holds the particles from below.
    pub fn resting(&self) -> RestingOn<'_> {
        RestingOn { support: &self.support, lift: &self.lift }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.start)
            + size_of_val(&*self.load)
            + size_of_val(&*self.support)
            + size_of_val(&*self.lift)
            + size_of_val(&*self.left)
            + size_of_val(&*self.owed)
            + size_of_val(&*self.placed)
            + size_of::<Touch>() * self.touches.capacity()
            + size_of::<u32>() * self.touched.capacity()
    }
}
