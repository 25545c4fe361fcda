//! Bearing: what contacts do to each particle of a garment, what holds it from below, and what it bears meanwhile.

use glam::Vec3A;

use super::contact::{ContactPush, LayerContact, Resting};
use super::touch::Touch;
use crate::cloth::state::{ParticleColumns, get, set};
use crate::lanes::WriteColumn;

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

/// What one particle bears.
#[derive(Debug, Clone, Copy)]
pub struct Bearing {
    /// Where to the body has moved it in the last substep: a unit vector, or 0.
    body: Vec3A,
    /// What it is still to get because it does not give way (kg m).
    pub owed: Vec3A,
    /// Where it was put without what it bears (m).
    left: Vec3A,
    /// Where the contacts have put it (m).
    placed: Vec3A,
    /// How strongly what it lies on holds it (kg m).
    pub held_by: f32,
    /// How much too near the body holds it against other cloth (m); minus infinity where it does not.
    missing: f32,
}

impl Default for Bearing {
    fn default() -> Self {
        let [body, owed, left, placed] = [Vec3A::ZERO; 4];
        Self { body, owed, left, placed, held_by: 0.0, missing: f32::NEG_INFINITY }
    }
}

/// What the particles of one garment bear. All storage is made once.
#[derive(Debug, Clone)]
pub struct GarmentBearing {
    /// What holds each `[particles]`.
    pub resting: Box<[Resting]>,
    /// What each bears `[particles]`.
    pub bearing: Box<[Bearing]>,
}

impl GarmentBearing {
    /// Of so many particles that nothing touches. At load.
    pub fn new(particles: usize) -> Self {
        Self {
            resting: vec![Resting::default(); particles].into(),
            bearing: vec![Bearing::default(); particles].into(),
        }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.resting) + size_of_val(&*self.bearing)
    }
}

impl Bearing {
    /// Forgets what held it, because no contact touches it.
    pub fn rest(&mut self, resting: &mut Resting) {
        (resting.support, self.body, self.missing) = (Vec3A::ZERO, Vec3A::ZERO, f32::NEG_INFINITY);
    }

    /// Gives the particle `i` what the contacts of one level do to it; `pushes` are those of a list. What does not give way bears it until the end of
    /// the substep's turns, or passes it on: what holds it puts it back, and no solve sees a gap that is none. At its own level it
    /// learns what holds it, which may be nothing any more.
    #[inline(always)]
    pub fn gather<'c>(
        &mut self,
        resting: &mut Resting,
        i: usize,
        touches: &[Touch],
        is_own: bool,
        columns: ParticleColumns<'_>,
        pushes: impl Fn(u16) -> &'c [ContactPush],
    ) {
        let (mut push, mut carry, mut support) = (Vec3A::ZERO, Vec3A::ZERO, Vec3A::ZERO);
        let (mut owed, mut held_by) = (self.owed, 0.0);
        let mut missing = if is_own { f32::NEG_INFINITY } else { self.missing };
        for touch in touches {
            let contact = &pushes(touch.list)[touch.contact as usize];
            let part = contact.push * touch.share;
            let carried = contact.normal * (contact.carry * touch.share);
            if contact.holds(resting.support, touch.share) {
                // Being moved apart is no load.
                owed += part - carried;
            } else {
                push += part;
                carry += carried;
            }
            // What lies on the other side and is held holds this one.
            let held = contact.held[usize::from(touch.share > 0.0)];
            support += part * held;
            held_by += if touch.above && held > 0.0 { part.length() * held } else { 0.0 };
            missing = missing.max(contact.pinched);
        }
        if is_own {
            let by_cloth = support.normalize_or_zero();
            resting.support = if by_cloth == Vec3A::ZERO { self.body } else { by_cloth };
            self.held_by = held_by;
        }
        (self.owed, self.missing) = (owed, missing);
        let w = columns.w.get(i);
        set(columns.x, i, get(columns.x, i) + push * w);
        set(columns.previous, i, get(columns.previous, i) + carry * w);
    }

    /// Lets go of what it has passed on.
    pub fn let_go(&mut self) {
        self.owed = if self.held_by > 0.0 { Vec3A::ZERO } else { self.owed };
    }

    /// Takes over what those that lie on it pass on by one of its contacts.
    pub fn take_over(&mut self, touch: &Touch, contact: &LayerContact) {
        if touch.between {
            self.owed += contact.passed * touch.share.abs();
        }
    }

    /// Gives the particle `i` what it bears, for the body to put it back.
    pub fn bear(&mut self, i: usize, columns: ParticleColumns<'_>) {
        self.left = get(columns.x, i);
        self.placed = self.left + self.owed * columns.w.get(i);
        set(columns.x, i, self.placed);
        self.owed = Vec3A::ZERO;
    }

    /// How far it was moved by what it bears (m).
    #[cfg(test)]
    pub fn moved(&self) -> Vec3A {
        self.placed - self.left
    }

    /// Notes whether the body has moved the particle `i` since: then it holds it.
    pub fn note_support(&mut self, resting: &mut Resting, i: usize, columns: ParticleColumns<'_>) {
        let x = get(columns.x, i);
        let moved = x - self.placed;
        let by_body = moved.length_squared() > MOVED_M * MOVED_M;
        let body = if by_body { moved.normalize_or_zero() } else { Vec3A::ZERO };
        if by_body {
            resting.support = body;
        }
        let back = x - self.left;
        // What sticks is put back altogether, what slides along only away from the body.
        let slid = (x - get(columns.previous, i)).reject_from_normalized(body);
        let sticks = by_body && slid.length_squared() < STICKS_M * STICKS_M;
        resting.lift = if sticks { back } else { body * back.dot(body) };
        self.body = body;
    }
}

/// Lets the body give way under particles that the last step's contacts have left pinched between two limbs, half of what is
/// missing on either side, and takes that back where there is room again. Once a step, before contacts are looked for;
/// `given` is how far it gives way under each (m), `seconds` the step's length. Says whether it gives way anywhere.
pub fn give_way(given: WriteColumn<'_>, bearings: &[Bearing], seconds: f32) -> bool {
    let [faster, back] = [GIVES_M_S, COMES_BACK_M_S].map(|speed| speed * seconds);
    let mut any = false;
    for (i, bearing) in bearings.iter().enumerate() {
        let before = given.get(i);
        let missing = bearing.missing;
        if missing == f32::NEG_INFINITY && before == 0.0 {
            continue;
        }
        let more = if missing > -SETTLED_M { (0.5 * missing).clamp(0.0, faster) } else { -back };
        let now = (before + more).clamp(0.0, GIVES_MOST_M);
        given.set(i, now);
        any |= now > 0.0;
    }
    any
}
