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
    list: u16,
    /// Level at which it is solved.
    level: u8,
    /// Whether what is touched lies above in it, and whether it is no fold.
    flags: u8,
    /// Which of its contacts.
    contact: u32,
    /// 1 for the contact's particle, minus the share for a corner of its face.
    share: f32,
}

/// The touched particle's garment lies on the other one.
const ABOVE: u8 = 1;

/// The contact is between two garments.
const BETWEEN: u8 = 2;

/// What is moved less than this (m) only by rounding is not held.
const MOVED_M: f32 = 1e-6;

/// What slides less than this in a substep (m) sticks: 50 mm/s at a thousand substeps a second.
const STICKS_M: f32 = 5e-5;

/// The farthest that the body gives way (m): less than what makes cones win over the skin.
const GIVES_MOST_M: f32 = 0.012;

/// How fast it gives way (m/s), and how fast it comes back.
const GIVES_M_S: f32 = 0.5;
const COMES_BACK_M_S: f32 = 0.05;

/// With less room than this to spare (m) it stays where it is.
const SETTLED_M: f32 = 0.001;

/// The lists of one garment.
#[derive(Debug, Clone)]
pub struct TouchLists {
    garment: usize,
    /// Where each particle's touches begin, and the end of the last `[particles + 1]`.
    start: Box<[u32]>,
    touches: Vec<Touch>,
    /// Particles that anything touches, in their order.
    touched: Vec<u32>,
    /// Sum of the shares of the contacts on each particle that are solved at once: at its own level, and above
    /// `[particles]` each.
    load: [Box<[f32]>; 2],
    /// Where to the body, or cloth that lies on it, moves each particle: a unit vector, or 0 `[particles]`.
    support: Box<[Vec3A]>,
    /// Where to the body has moved each in the last substep: a unit vector, or 0 `[particles]`.
    body: Box<[Vec3A]>,
    /// How far that has moved it, from where it was without what it then bore (m) `[particles]`.
    lift: Box<[Vec3A]>,
    /// What particles that do not give way are still to get (kg m) `[particles]`.
    owed: Box<[Vec3A]>,
    /// Where each particle that anything touches was put without what it bears (m) `[particles]`.
    left: Box<[Vec3A]>,
    /// Where the contacts have put each particle that anything touches (m) `[particles]`.
    placed: Box<[Vec3A]>,
    /// The levels of the contacts that the garment has in this step, one bit each.
    levels: u32,
    /// How high it lies; 0 is on nothing but the body.
    height: usize,
    /// How strongly what it lies on holds each particle (kg m) `[particles]`.
    held_by: Box<[f32]>,
}

/// The level at which a garment at some height is put on what it lies on: what lies on the body only is put back by it last,
/// and shares the first with what lies on it.
fn own_level(height: usize) -> usize {
    height.max(1)
}

impl TouchLists {
    /// Room for the touches of a garment. At load.
    pub fn new(garment: usize, height: usize, garments: &[Garment], pairs: &[LayerPair]) -> Self {
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
            load: [(); 2].map(|()| vec![0.0; particles].into()),
            support: vec![Vec3A::ZERO; particles].into(),
            body: vec![Vec3A::ZERO; particles].into(),
            lift: vec![Vec3A::ZERO; particles].into(),
            left: vec![Vec3A::ZERO; particles].into(),
            owed: vec![Vec3A::ZERO; particles].into(),
            placed: vec![Vec3A::ZERO; particles].into(),
            levels: 0,
            height,
            held_by: vec![0.0; particles].into(),
        }
    }

    /// Lists the contacts of a step; `lists` are those of the first share of every pair, then of the second.
    pub fn fill<'c>(&mut self, pairs: &[LayerPair], lists: impl Fn(usize) -> &'c [LayerContact]) {
        let Self { garment, start, touches, touched, load, support, body, height, levels, .. } = self;
        start.fill(0);
        load.iter_mut().for_each(|load| load.fill(0.0));
        let each = |act: &mut dyn FnMut(u32, Touch)| {
            for list in 0..2 * pairs.len() {
                let pair = &pairs[list % pairs.len()];
                let level = pair.level as u8;
                let above = if pair.has_above(*garment) { ABOVE } else { 0 };
                let flags = above | if pair.is_fold() { 0 } else { BETWEEN };
                for (c, contact) in lists(list).iter().enumerate() {
                    let touch = |share| Touch { list: list as u16, level, flags, contact: c as u32, share };
                    if pair.particles == *garment {
                        act(contact.particle, touch(1.0));
                    }
                    if pair.faces == *garment {
                        let corners = (0..3).filter(|&k| contact.shares[k] != 0.0);
                        corners.for_each(|k| act(contact.corners[k], touch(-contact.shares[k])));
                    }
                }
            }
        };
        let mut count = 0;
        *levels = 0;
        each(&mut |i, touch| {
            start[i as usize + 1] += 1;
            *levels |= 1 << touch.level;
            let above = usize::from(touch.level) != own_level(*height);
            load[usize::from(above)][i as usize] += touch.share.abs();
            count += 1;
        });
        touched.clear();
        for i in 0..support.len() {
            if start[i + 1] > 0 {
                touched.push(i as u32);
            } else {
                (support[i], body[i]) = (Vec3A::ZERO, Vec3A::ZERO);
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

    /// Gives the particles what the contacts of one level do to them. What does not give way bears it until the end of
    /// the substep's turns, or passes it on: what holds it puts it back, and no solve sees a gap that is none.
    pub fn gather<'c>(
        &mut self,
        columns: ParticleColumns<'_>,
        level: usize,
        lists: impl Fn(usize) -> &'c [LayerContact],
    ) {
        // At its own level it learns what holds it, which may be nothing any more.
        let is_own = level == own_level(self.height);
        if self.levels >> level & 1 == 0 && !(is_own && self.levels != 0) {
            return;
        }
        for &i in &self.touched {
            let i = i as usize;
            let (mut push, mut carry, mut support) = (Vec3A::ZERO, Vec3A::ZERO, Vec3A::ZERO);
            let (mut owed, mut held_by) = (self.owed[i], 0.0);
            for touch in &self.touches[self.start[i] as usize..self.start[i + 1] as usize] {
                if usize::from(touch.level) != level {
                    continue;
                }
                let contact = &lists(touch.list as usize)[touch.contact as usize];
                let part = contact.push * touch.share;
                if contact.holds(self.support[i], touch.share) {
                    // Being moved apart is no load.
                    owed += part - contact.carry * touch.share;
                } else {
                    push += part;
                    carry += contact.carry * touch.share;
                }
                // What lies on the other side and is held holds this one.
                let held = contact.held[usize::from(touch.share > 0.0)];
                support += part * held;
                held_by += if touch.flags & ABOVE != 0 && held > 0.0 { part.length() * held } else { 0.0 };
            }
            if is_own {
                let by_cloth = support.normalize_or_zero();
                self.support[i] = if by_cloth == Vec3A::ZERO { self.body[i] } else { by_cloth };
                self.held_by[i] = held_by;
            }
            let w = columns.w.get(i);
            self.owed[i] = owed;
            set(columns.x, i, get(columns.x, i) + push * w);
            set(columns.previous, i, get(columns.previous, i) + carry * w);
        }
    }

    /// Takes over what those that lie on it pass on, and lets go of what it has passed on itself.
    pub fn take_over<'c>(&mut self, level: usize, lists: impl Fn(usize) -> &'c [LayerContact]) {
        if self.levels >> level & 1 == 0 || self.height > level {
            return;
        }
        for &i in &self.touched {
            let i = i as usize;
            if self.height == level {
                self.owed[i] = if self.held_by[i] > 0.0 { Vec3A::ZERO } else { self.owed[i] };
                continue;
            }
            for touch in &self.touches[self.start[i] as usize..self.start[i + 1] as usize] {
                if usize::from(touch.level) == level && touch.flags & BETWEEN != 0 {
                    self.owed[i] += lists(touch.list as usize)[touch.contact as usize].passed * touch.share.abs();
                }
            }
        }
    }

    /// Gives the particles what they bear, for the body to put them back.
    pub fn bear(&mut self, columns: ParticleColumns<'_>) {
        for &i in &self.touched {
            let i = i as usize;
            self.left[i] = get(columns.x, i);
            self.placed[i] = self.left[i] + self.owed[i] * columns.w.get(i);
            set(columns.x, i, self.placed[i]);
            self.owed[i] = Vec3A::ZERO;
        }
    }

    /// What its particles bear (kg m), and how strongly what they lie on holds them (kg m).
    pub fn borne(&self) -> (&[Vec3A], &[f32]) {
        (&self.owed, &self.held_by)
    }

    /// What the body had to bear for what lies on a garment in the last substep (kg m); `w` are its inverse masses (1/kg).
    #[cfg(test)]
    pub fn bore(&self, w: &[f32]) -> Vec3A {
        let moved = |i: usize| if w[i] > 0.0 { (self.placed[i] - self.left[i]) / w[i] } else { Vec3A::ZERO };
        self.touched.iter().map(|&i| moved(i as usize)).sum()
    }

    /// Notes which of the particles the body has moved since: it holds them.
    pub fn note_support(&mut self, columns: ParticleColumns<'_>) {
        for &i in &self.touched {
            let i = i as usize;
            let x = get(columns.x, i);
            let moved = x - self.placed[i];
            let by_body = moved.length_squared() > MOVED_M * MOVED_M;
            let body = if by_body { moved.normalize_or_zero() } else { Vec3A::ZERO };
            if by_body {
                self.support[i] = body;
            }
            let back = x - self.left[i];
            // What sticks is put back altogether, what slides along only away from the body.
            let slid = (x - get(columns.previous, i)).reject_from_normalized(body);
            let sticks = by_body && slid.length_squared() < STICKS_M * STICKS_M;
            self.lift[i] = if sticks { back } else { body * back.dot(body) };
            self.body[i] = body;
        }
    }

    /// Lets the body give way under particles that the last step's contacts have left pinched between two limbs, half of what is
    /// missing on either side, and takes that back where there is room again. Once a step, before contacts are looked for;
    /// `seconds` is its length.
    pub fn give_way<'c>(
        &self,
        columns: ParticleColumns<'_>,
        seconds: f32,
        lists: impl Fn(usize) -> &'c [LayerContact],
    ) {
        let [faster, back] = [GIVES_M_S, COMES_BACK_M_S].map(|speed| speed * seconds);
        for i in 0..columns.given.len() {
            let before = columns.given.get(i);
            let touches = &self.touches[self.start[i] as usize..self.start[i + 1] as usize];
            if touches.is_empty() && before == 0.0 {
                continue;
            }
            let each = touches.iter().map(|t| lists(t.list as usize)[t.contact as usize].pinched);
            let missing = each.fold(f32::NEG_INFINITY, f32::max);
            let more = if missing > -SETTLED_M { (0.5 * missing).clamp(0.0, faster) } else { -back };
            columns.given.set(i, (before + more).clamp(0.0, GIVES_MOST_M));
        }
    }

    /// Sum of the shares of the contacts of a level on each particle `[particles]`.
    pub fn load(&self, level: usize) -> &[f32] {
        &self.load[usize::from(level != own_level(self.height))]
    }

    /// What holds the particles from below.
    pub fn resting(&self) -> RestingOn<'_> {
        RestingOn { support: &self.support, lift: &self.lift }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.start)
            + self.load.iter().map(|load| size_of_val(&**load)).sum::<usize>()
            + size_of_val(&*self.support)
            + size_of_val(&*self.lift)
            + size_of_val(&*self.body)
            + size_of_val(&*self.left)
            + size_of_val(&*self.owed)
            + size_of_val(&*self.held_by)
            + size_of_val(&*self.placed)
            + size_of::<Touch>() * self.touches.capacity()
            + size_of::<u32>() * self.touched.capacity()
    }
}
