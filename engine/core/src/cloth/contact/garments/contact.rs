//! One contact between a particle and a face, or two edges, and its solution in a substep.
//!
//! A contact acts on positions, as contact with the body does ([`push`](crate::cloth::contact::body)): what came too near in this
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

/// Most contacts that one edge of a border makes with another garment: the deepest of those that it lies across.
pub const CONTACTS_AN_EDGE: usize = 2;

/// Vertices of one contact: a particle and a face, or an edge and an edge.
pub const VERTICES: usize = 4;

/// Two places of two garments that may come too near to each other, for one step: a particle and a face, or two edges.
#[derive(Debug, Clone, Copy)]
pub struct LayerContact {
    /// Its vertices: those of one side, then those of the other.
    pub vertices: [u32; VERTICES],
    /// Shares of the vertices, 1 together on the first side and -1 on the other.
    pub shares: [f32; VERTICES],
    /// How many vertices the first side has: 1 is a particle before a face, 2 an edge before an edge.
    pub own: u8,
    /// Whether it was touched when it was last looked at, so that it sticks somewhere.
    pub sticks: bool,
    /// What a push does to the gap with all contacts taken together, by each vertex (1/kg).
    pub gives: [f32; VERTICES],
    /// Distance that is kept (m).
    pub gap: f32,
    /// Not a contact but a crossing that is drawn apart, so fast (m/s); 0 otherwise.
    pub drawn: f32,
    /// What the upper side bears of what lies on it, passed on to the lower one (kg m).
    pub passed: Vec3A,
    /// Where the first side sticks, from the nearest point of the other (m).
    pub anchor: Vec3A,
}

/// What a contact leaves behind for the next step.
#[derive(Debug, Clone, Copy, Default)]
pub struct ContactMemory {
    /// How far the first side has slid from where it sticks (m), if it touched.
    slip: Option<Vec3A>,
    /// What was passed on between the two (kg m).
    passed: f32,
}

impl ContactMemory {
    /// That of several contacts of one edge, of which this is the deepest that was looked at so far.
    pub fn with(self, other: Self) -> Self {
        Self { slip: self.slip.or(other.slip), passed: self.passed.max(other.passed) }
    }
}

/// What a contact does to its vertices, as they gather it.
#[derive(Debug, Clone, Copy, Default)]
pub struct ContactPush {
    /// What the last solve does to the place of a vertex: times its inverse mass and its share (kg m).
    pub push: Vec3A,
    /// From the other side to the one on which the first belongs, unit length.
    pub normal: Vec3A,
    /// The part of the push, along the normal, that is also done to where the substep started, so that no speed comes of it (kg m).
    pub carry: f32,
    /// How much of each side does not give way (0..1).
    pub held: [f32; 2],
    /// How much too near the two sides were left because the body holds both against each other (m), below 0 where they have
    /// room; minus infinity where it does not.
    pub pinched: f32,
}

impl LayerContact {
    /// A particle before a face, which stays `gap` (m) away; `anchor` is how far it is from the nearest point now (m).
    pub fn with_face(particle: u32, corners: [u32; 3], shares: [f32; 3], gap: f32, anchor: Vec3A) -> Self {
        let ([a, b, c], [u, v, w]) = (corners, shares);
        Self::new([particle, a, b, c], [1.0, -u, -v, -w], 1, gap, anchor)
    }

    /// An edge before an edge, each by how far along it (1) the two meet.
    pub fn with_edge(edges: [[u32; 2]; 2], along: [f32; 2], gap: f32, anchor: Vec3A) -> Self {
        let ([[a, b], [c, d]], [s, t]) = (edges, along);
        Self::new([a, b, c, d], [1.0 - s, s, t - 1.0, -t], 2, gap, anchor)
    }

    /// A particle and another one of the same garment.
    pub fn with_particle(particle: u32, other: u32, gap: f32) -> Self {
        Self::with_face(particle, [other; 3], [1.0, 0.0, 0.0], gap, Vec3A::ZERO)
    }

    /// A particle that is drawn away from a face (m/s).
    pub fn drawn_from(particle: u32, corners: [u32; 3], shares: [f32; 3], drawn: f32) -> Self {
        Self { drawn, ..Self::with_face(particle, corners, shares, 0.0, Vec3A::ZERO) }
    }

    fn new(vertices: [u32; VERTICES], shares: [f32; VERTICES], own: u8, gap: f32, anchor: Vec3A) -> Self {
        let gives = [0.0; VERTICES];
        Self { vertices, shares, own, sticks: false, gives, gap, drawn: 0.0, passed: Vec3A::ZERO, anchor }
    }

    /// Which side a vertex is of: 0 or 1.
    #[inline(always)]
    pub fn side(&self, k: usize) -> usize {
        usize::from(k >= usize::from(self.own))
    }

    /// The vertices of a side with their shares.
    #[inline(always)]
    pub fn of_side(&self, side: usize) -> impl Iterator<Item = (u32, f32)> {
        let (own, end) = (usize::from(self.own), [usize::from(self.own), VERTICES][side]);
        let first = [0, own][side];
        (first..end).map(|k| (self.vertices[k], self.shares[k]))
    }
}

impl ContactPush {
    /// Along a normal, with nothing done yet.
    pub fn along(normal: Vec3A) -> Self {
        Self { normal, pinched: f32::NEG_INFINITY, ..Self::default() }
    }

    /// Whether something that moves a vertex along `support` holds it against this contact's push, which is along `share`
    /// times the normal.
    #[inline(always)]
    pub fn holds(&self, support: Vec3A, share: f32) -> bool {
        support.dot(self.normal) * share.signum() < -SUPPORTED
    }
}

/// What holds a particle from below.
#[derive(Debug, Clone, Copy, Default)]
pub struct Resting {
    /// Where to the body, or cloth that lies on it, moves it: a unit vector, or 0.
    pub support: Vec3A,
    /// How far it moved it in the last substep (m).
    pub lift: Vec3A,
}

/// Constants of all contacts of a pair in a substep.
#[derive(Debug, Clone, Copy)]
pub struct PairConstants {
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
    /// Takes the loads that all contacts together put on the particles of both garments.
    pub fn weigh(&mut self, of: [ParticleColumns<'_>; 2], load: [&[f32]; 2]) {
        for k in 0..VERTICES {
            let (j, side) = (self.vertices[k] as usize, self.side(k));
            self.gives[k] = self.shares[k].abs() * of[side].w.get(j) * load[side][j];
        }
    }

    /// How far the vertices that nothing holds move the two sides apart by a push (kg); notes how much of each side is held.
    #[inline(always)]
    fn give(&self, rest: &[Resting; VERTICES], push: &mut ContactPush) -> (f32, [bool; VERTICES]) {
        // No closures: those that are not inlined are calls.
        let (mut held, mut sum) = ([false; VERTICES], 0.0);
        push.held = [0.0; 2];
        for k in 0..VERTICES {
            held[k] = push.holds(rest[k].support, self.shares[k]);
            sum += if held[k] { 0.0 } else { self.gives[k] };
            push.held[self.side(k)] += if held[k] { self.shares[k].abs() } else { 0.0 };
        }
        // Where all are held there is no room: the body is in its own way, and cloth gives in.
        let [i, a, b, c] = self.gives;
        let least = LEAST_GIVE * (i + a + b + c);
        (if sum > 0.0 { sum.max(least).recip() } else { 0.0 }, held)
    }

    /// Where the first side is from the other, and where it was when the substep started (m). Vertices that something holds are
    /// taken to be where that will put them.
    #[inline(always)]
    fn relative(&self, of: [ParticleColumns<'_>; 2], rest: &[Resting; VERTICES], held: [bool; VERTICES]) -> [Vec3A; 2] {
        let (mut x, mut before) = (Vec3A::ZERO, Vec3A::ZERO);
        for k in 0..VERTICES {
            let (j, columns) = (self.vertices[k] as usize, &of[self.side(k)]);
            let lift = if held[k] { rest[k].lift } else { Vec3A::ZERO };
            x += (get(columns.x, j) + lift) * self.shares[k];
            before += get(columns.previous, j) * self.shares[k];
        }
        [x, before]
    }

    /// What it leaves behind, as the last step has left the garments.
    pub fn memory(&self, of: [ParticleColumns<'_>; 2], normal: Vec3A) -> ContactMemory {
        let at = |k: usize| get(of[self.side(k)].x, self.vertices[k] as usize) * self.shares[k];
        let slip = || (at(0) + at(1) + at(2) + at(3) - self.anchor).reject_from_normalized(normal);
        ContactMemory { slip: self.sticks.then(slip), passed: self.passed.dot(normal).abs() }
    }

    /// The same contact, going on from what one of the step before has left behind.
    pub fn going_on(self, memory: ContactMemory, normal: Vec3A) -> Self {
        let ContactMemory { slip, passed } = memory;
        let anchor = self.anchor - slip.unwrap_or_default();
        Self { passed: normal * passed, sticks: slip.is_some(), anchor, ..self }
    }

    /// Solves the contact as the constraints of a substep have left the garments; `rest` is what holds its vertices.
    #[inline(always)]
    pub fn solve(
        &mut self,
        of: [ParticleColumns<'_>; 2],
        rest: &[Resting; VERTICES],
        constants: PairConstants,
        push: &mut ContactPush,
    ) {
        let (give, held) = self.give(rest, push);
        let n = push.normal;
        push.pinched = f32::NEG_INFINITY;
        if self.drawn > 0.0 {
            push.carry = self.drawn * constants.dt * give;
            push.push = n * push.carry;
            return;
        }
        let [x, before] = self.relative(of, rest, held);
        let depth = self.gap - x.dot(n);
        push.pinched = if push.held[0] * push.held[1] > PINCHED { depth } else { f32::NEG_INFINITY };
        let moved = x - before;
        (push.push, push.carry) = (Vec3A::ZERO, 0.0);
        let from = if constants.sticks && std::mem::take(&mut self.sticks) { self.anchor } else { before };
        // Not so where anything is not finite: what is wrong with one garment stays in it.
        if !(depth > 0.0 && moved.length_squared() < FARTHEST_MOVE_M * FARTHEST_MOVE_M && (x - from).is_finite()) {
            return;
        }
        let along = moved.dot(n);
        let load = depth.min((-along).max(0.0));
        let carried = (depth - load).min(constants.push * constants.dt);
        let slip = (x - from).reject_from_normalized(n);
        let sliding = ((before - from) * BACK + moved).reject_from_normalized(n);
        let slid = sliding.length();
        // What lies on the upper side presses as well, as much as it did in the substep before.
        let pressed = if give > 0.0 { self.passed.dot(n).abs() / give } else { 0.0 };
        let [holds, slows] = constants.friction.map(|mu| mu * (load + pressed.min(MOST_ABOVE * load)));
        let slowed = if slid <= holds { sliding } else { sliding * (slows / slid).min(1.0) };
        let kept = if slid <= holds { slip } else { slip.clamp_length_max(slows / BACK) };
        (self.sticks, self.anchor) = (true, x - kept);
        push.push = (n * (load + carried) - slowed) * give;
        push.carry = carried * give;
    }

    /// Passes on what the upper side bears, by this contact's part of what holds it. `above` says which side that is, `borne` what
    /// a particle of it bears (kg m) and how strongly it is held (kg m).
    pub fn pass(&mut self, push: &ContactPush, above: usize, borne: impl Fn(u32) -> (Vec3A, f32)) {
        let strength = push.push.length() * push.held[1 - above];
        let part = |(i, share): (u32, f32)| {
            let (bears, held_by) = borne(i);
            if held_by > 0.0 { bears * (strength * share.abs() / held_by) } else { Vec3A::ZERO }
        };
        self.passed = self.of_side(above).map(part).sum();
    }
}
