//! One contact between a particle and a face: what a substep makes of it.
//!
//! A contact acts on positions, as contact with the body does ([`push`](crate::cloth::contact)): what came too near in this
//! substep is moved back and loses that speed, what was too near before is moved apart without gaining any, and friction holds
//! what slides up to mu times what pressed (Mueller et al. 2007, "Position based dynamics", section 3.5). All contacts of a level are solved at
//! once from the same state. So that they do not push too far together, each divides by what all of them do to its four
//! particles: the sum of a row of the contacts' matrix in place of its diagonal, which leaves no wave that grows and is exact
//! where all contacts are alike.
//!
//! Many contacts of a particle, of which not all touch, each undo but a part of what it slides, so that under a lasting pull what
//! sticks would creep. So each knows where it sticks, and draws it back there little by little: as a bristle that bends as far as friction
//! holds (Canudas de Wit et al. 1995, "A new model for control of systems with friction").
//!
//! A particle that lies on the body, or on cloth that does, is put back by it in the same substep: it does not give way. So
//! the other side takes the whole way, and the particle still gets the whole reaction, which the body then bears (contact
//! graphs with shock propagation: Guendelman, Bridson, Fedkiw 2003, section 8.3, but without losing the weight).

use glam::Vec3A;

use crate::cloth::state::{ParticleColumns, get};

/// A particle that moves farther than this from a face in one substep (m) is no case for contact.
const FARTHEST_MOVE_M: f32 = 1.0;

/// Cosine between where something holds a particle and where it is pushed against from which on it does not give way.
const SUPPORTED: f32 = 0.5;

/// Share of both sides that something holds (1) from which on nothing but the body can give way.
const PINCHED: f32 = 0.99;

/// How many times its own load presses at most on a contact from above (1): a coat over a shirt, ten sheets of a pile. Crushed
/// cloth presses more, and would be held where it is.
const MOST_ABOVE: f32 = 10.0;

/// Least share of what gives where nothing is held (1) that is reckoned with: a corner that alone can move, and carries next to
/// nothing of the contact, would be thrown far away. Less than what three corners give by themselves.
const LEAST_GIVE: f32 = 0.2;

/// How much of the way to where it sticks a particle is brought back in a substep (1): all of it at once would swing.
const BACK: f32 = 1.0 / 16.0;

/// A particle near a face of another garment, for one step.
#[derive(Debug, Clone, Copy, Default)]
pub struct LayerContact {
    /// The particle.
    pub particle: u32,
    /// Vertices of the face.
    pub corners: [u32; 3],
    /// Shares of the corners at the nearest point, together 1.
    pub shares: [f32; 3],
    /// What a push does to the gap with all contacts taken together, by the particle and by each corner (1/kg).
    pub gives: [f32; 4],
    /// How much of the particle's side, and of the face's, does not give way (0..1).
    pub held: [f32; 2],
    /// Distance that is kept (m).
    pub gap: f32,
    /// Not a contact but a crossing that is drawn apart, so fast (m/s); 0 otherwise.
    pub drawn: f32,
    /// How much too near the two sides were left because the body holds both against each other (m), below 0 where they have
    /// room; minus infinity where it does not.
    pub pinched: f32,
    /// Whether it was touched when it was last looked at, so that it sticks somewhere.
    pub sticks: bool,
    /// From the face to the side on which the particle belongs, unit length.
    pub normal: Vec3A,
    /// What the last solve does to the place of the particle: times its inverse mass and its share (kg m).
    pub push: Vec3A,
    /// The same to where the substep started, so that no speed comes of it (kg m).
    pub carry: Vec3A,
    /// What the upper side bears of what lies on it, passed on to the lower one (kg m).
    pub passed: Vec3A,
    /// Where the particle sticks, from the nearest point of the face (m).
    pub anchor: Vec3A,
}

/// What holds the particles of a garment from below.
#[derive(Clone, Copy)]
pub struct RestingOn<'a> {
    /// Where to the body, or cloth that lies on it, moves each: a unit vector, or 0 `[particles]`.
    pub support: &'a [Vec3A],
    /// How far it moved it in the last substep (m) `[particles]`.
    pub lift: &'a [Vec3A],
}

/// What all contacts of a pair have in common in a substep.
#[derive(Debug, Clone, Copy)]
pub struct ContactLaw {
    /// Coulomb coefficient of what sticks and of what slides (1).
    pub friction: [f32; 2],
    /// Whether contacts know where they stick.
    pub sticks: bool,
    /// Fastest that what is found on the wrong side is pushed out (m/s).
    pub push: f32,
    /// Length of the substep (s).
    pub dt: f32,
}

impl LayerContact {
    /// Takes the loads that all contacts together put on the particles of the particle's garment and of the face's.
    pub fn weigh(&mut self, of: [ParticleColumns<'_>; 2], load: [&[f32]; 2]) {
        let i = self.particle as usize;
        let face = |k: usize| {
            let j = self.corners[k] as usize;
            self.shares[k] * of[1].w.get(j) * load[1][j]
        };
        self.gives = [of[0].w.get(i) * load[0][i], face(0), face(1), face(2)];
    }

    /// Whether something that moves a particle along `support` holds it against this contact's push, which is along `share`
    /// times the normal.
    #[inline(always)]
    pub fn holds(&self, support: Vec3A, share: f32) -> bool {
        support.dot(self.normal) * share.signum() < -SUPPORTED
    }

    /// Notes which of the four particles do not give way; gives how far a push moves the two sides apart by the others (kg).
    #[inline(always)]
    fn give(&mut self, rest: [RestingOn<'_>; 2]) -> (f32, [bool; 4]) {
        let own = self.holds(rest[0].support[self.particle as usize], 1.0);
        let face = [0, 1, 2].map(|k| self.holds(rest[1].support[self.corners[k] as usize], -1.0));
        let free = |held: bool, give: f32| if held { 0.0 } else { give };
        let [i, a, b, c] = self.gives;
        let sum = free(own, i) + free(face[0], a) + free(face[1], b) + free(face[2], c);
        let share = |k: usize| if face[k] { self.shares[k] } else { 0.0 };
        self.held = [f32::from(u8::from(own)), share(0) + share(1) + share(2)];
        // Where all are held there is no room: the body is in its own way, and cloth gives in.
        let least = LEAST_GIVE * (i + a + b + c);
        (if sum > 0.0 { sum.max(least).recip() } else { 0.0 }, [own, face[0], face[1], face[2]])
    }

    /// Where the particle is from the nearest point of the face, and where it was when the substep started (m). Those that
    /// something holds are taken to be where that will put them.
    #[inline(always)]
    fn relative(&self, of: [ParticleColumns<'_>; 2], rest: [RestingOn<'_>; 2], held: [bool; 4]) -> [Vec3A; 2] {
        let i = self.particle as usize;
        let (mut x, mut before) = (get(of[0].x, i), get(of[0].previous, i));
        if held[0] {
            x += rest[0].lift[i];
        }
        for k in 0..3 {
            let j = self.corners[k] as usize;
            let lift = if held[k + 1] { rest[1].lift[j] } else { Vec3A::ZERO };
            x -= (get(of[1].x, j) + lift) * self.shares[k];
            before -= get(of[1].previous, j) * self.shares[k];
        }
        [x, before]
    }

    /// How far the particle is from where it sticks (m), if it touches.
    pub fn slip(&self, of: [ParticleColumns<'_>; 2]) -> Option<Vec3A> {
        let face = |k: usize| get(of[1].x, self.corners[k] as usize) * self.shares[k];
        let x = get(of[0].x, self.particle as usize) - (face(0) + face(1) + face(2));
        self.sticks.then(|| (x - self.anchor).reject_from_normalized(self.normal))
    }

    /// Solves the contact as the constraints of a substep have left the garments.
    #[inline(always)]
    pub fn solve(&mut self, of: [ParticleColumns<'_>; 2], rest: [RestingOn<'_>; 2], law: ContactLaw) {
        self.pinched = f32::NEG_INFINITY;
        let (give, held) = self.give(rest);
        if self.drawn > 0.0 {
            self.push = self.normal * (self.drawn * law.dt * give);
            self.carry = self.push;
            return;
        }
        let [x, before] = self.relative(of, rest, held);
        let n = self.normal;
        let depth = self.gap - x.dot(n);
        self.pinched = if self.held[0] * self.held[1] > PINCHED { depth } else { f32::NEG_INFINITY };
        let moved = x - before;
        (self.push, self.carry) = (Vec3A::ZERO, Vec3A::ZERO);
        let from = if law.sticks && std::mem::take(&mut self.sticks) { self.anchor } else { before };
        // Not so where anything is not finite: what is wrong with one garment stays in it.
        if !(depth > 0.0 && moved.length_squared() < FARTHEST_MOVE_M * FARTHEST_MOVE_M && (x - from).is_finite()) {
            return;
        }
        let along = moved.dot(n);
        let load = depth.min((-along).max(0.0));
        let carried = (depth - load).min(law.push * law.dt);
        let slip = (x - from).reject_from_normalized(n);
        let sliding = ((before - from) * BACK + moved).reject_from_normalized(n);
        let slid = sliding.length();
        // What lies on the upper side presses as well, as much as it did in the substep before.
        let pressed = if give > 0.0 { self.passed.dot(n).abs() / give } else { 0.0 };
        let [holds, slows] = law.friction.map(|mu| mu * (load + pressed.min(MOST_ABOVE * load)));
        let slowed = if slid <= holds { sliding } else { sliding * (slows / slid).min(1.0) };
        let kept = if slid <= holds { slip } else { slip.clamp_length_max(slows / BACK) };
        (self.sticks, self.anchor) = (true, x - kept);
        self.push = (n * (load + carried) - slowed) * give;
        self.carry = n * (carried * give);
    }

    /// Passes on what the upper side bears, by this contact's part of what holds it; `held_by` is the sum of the parts. The
    /// upper side is the particle or the face.
    pub fn pass(&mut self, particle_above: bool, bears: &[Vec3A], held_by: &[f32]) {
        let push = self.push.length();
        let part = |i: u32, share: f32, held: f32| {
            let all = held_by[i as usize];
            if all > 0.0 { bears[i as usize] * (push * share * held / all) } else { Vec3A::ZERO }
        };
        self.passed = if particle_above {
            part(self.particle, 1.0, self.held[1])
        } else {
            (0..3).map(|k| part(self.corners[k], self.shares[k], self.held[0])).sum()
        };
    }
}
