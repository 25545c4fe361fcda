//! Root: how much of the body's own motion the cloth feels, and what happens when the body jumps.
//!
//! The cloth lives in world space, so it feels all of the root's motion. Three scales take some of it back, as if that
//! part of the motion belonged to the frame of reference. With o the root's origin, r = x - o, V its velocity and w its
//! angular velocity over the step (rad/s), a primed quantity that of the step before, and s_l, s_a, s_c the scales:
//!
//!   dv = (1 - s_l) (V - V') + (1 - s_a) (w - w') x r           once, at the start of the step: Euler's term
//!   a  = (1 - s_a) 2 w x (v - V - w x r) + (1 - s_c) w x (w x r)   over the step: Coriolis and the pull to the axis
//!
//! These are the inertial accelerations of a rotating frame (any mechanics text; Goldstein, 4.10), with their signs
//! turned, because here they are compensated. All 1 is plain dynamics and costs nothing; all 0 is a cloth that hangs as
//! if the root stood still. Velocities over a step are chords: the arc's error is of order w dt.
//!
//! A root that moves or turns further in one step than cloth can follow has been teleported: see [`Teleport`]. A root
//! that is not finite is held where it last was.

use glam::{Affine3A, Mat3A, Quat, Vec3A};
use toile_base::numeric::portable;

use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, V3, Width, WriteColumn};

/// What becomes of the cloth when its body jumps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Teleport {
    /// It is dressed again where the body now stands, at rest.
    #[default]
    Reset,
    /// It is carried along as it is: shape, and velocity relative to the body.
    Keep,
}

/// How the root's motion is passed on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RootSettings {
    /// How much of the root's linear acceleration the cloth feels (1 all, 0 none).
    pub linear: f32,
    /// How much of its angular acceleration, and of Coriolis' force.
    pub angular: f32,
    /// How much of the centrifugal force of its turning.
    pub centrifugal: f32,
    /// A root that moves further than this in one step has been teleported (m).
    pub teleport_m: f32,
    /// A root that turns further than this in one step has been teleported (degrees).
    pub teleport_degrees: f32,
    /// What is done with the garment after a teleport.
    pub teleport: Teleport,
}

impl Default for RootSettings {
    fn default() -> Self {
        Self {
            linear: 1.0,
            angular: 1.0,
            centrifugal: 1.0,
            // 60 m/s and 20 turns a second at 120 steps: six times what a body reaches.
            teleport_m: 0.5,
            teleport_degrees: 60.0,
            teleport: Teleport::Reset,
        }
    }
}

/// What a step of the root means for the cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RootStep {
    /// Nothing to be done: the scales are all 1, or the root is new.
    Plain,
    /// Run [`Carried::apply`] before the step's first substep, and add the accelerations in each.
    Carried(Carried),
    /// It jumped and the garment is to be dressed again at the root, at rest.
    Reset,
    /// It jumped and the garment is to be carried along: run [`Moved::apply`], pins and colliders likewise.
    Keep(Moved),
}

/// The root from step to step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RootMotion {
    /// The settings; may be changed between steps.
    pub settings: RootSettings,
    at: Option<Affine3A>,
    /// From the root of the step before to this one's, in world space.
    motion: Affine3A,
    velocity: Vec3A,
    turning: Vec3A,
    /// Steps whose root was not finite or not rigid.
    pub held: u64,
    /// Jumps of the root.
    pub teleports: u64,
}

impl RootMotion {
    /// A root that has not been seen yet.
    pub fn new(settings: RootSettings) -> Self {
        Self {
            settings,
            at: None,
            motion: Affine3A::IDENTITY,
            velocity: Vec3A::ZERO,
            turning: Vec3A::ZERO,
            held: 0,
            teleports: 0,
        }
    }

    /// The root's motion of the last step, in world space: what it carries goes from x to `motion * x`.
    pub fn motion(&self) -> Affine3A {
        self.motion
    }

    /// Where the root is at the end of a step of `dt` seconds (a rotation and a place); the first only sets it there.
    pub fn advance(&mut self, root: &Affine3A, dt: f32) -> RootStep {
        let rigid = root.is_finite() && root.matrix3.determinant() > 0.5;
        self.held += u64::from(!rigid);
        let Some(before) = self.at else {
            self.at = rigid.then_some(*root);
            return RootStep::Plain;
        };
        let after = if rigid { *root } else { before };
        self.at = Some(after);
        let turn = portable::unit(Quat::from_mat3a(&(after.matrix3 * before.matrix3.transpose())));
        let moved = after.translation - before.translation;
        // Made of the turn, not of the product of two matrices: nothing that it carries may grow over the hours.
        let turned = Mat3A::from_quat(turn);
        self.motion = Affine3A { matrix3: turned, translation: after.translation - turned * before.translation };
        let arc = Vec3A::from(turn.to_scaled_axis());
        let old = (self.velocity, self.turning);
        let s = self.settings;
        if moved.length() > s.teleport_m || arc.length() > s.teleport_degrees.to_radians() {
            self.teleports += 1;
            // The jump itself is no velocity; what the root had is turned with it, so that the next step feels none.
            (self.velocity, self.turning) = (turned * old.0, turned * old.1);
            return match s.teleport {
                Teleport::Reset => {
                    (self.velocity, self.turning) = (Vec3A::ZERO, Vec3A::ZERO);
                    RootStep::Reset
                }
                Teleport::Keep => RootStep::Keep(Moved { motion: self.motion }),
            };
        }
        (self.velocity, self.turning) = (moved / dt, arc / dt);
        if [s.linear, s.angular, s.centrifugal] == [1.0; 3] {
            return RootStep::Plain;
        }
        RootStep::Carried(Carried {
            origin: before.translation,
            velocity: self.velocity,
            turning: self.turning,
            jolt: (self.velocity - old.0) * (1.0 - s.linear),
            twist: (self.turning - old.1) * (1.0 - s.angular),
            angular: 1.0 - s.angular,
            centrifugal: 1.0 - s.centrifugal,
            dt,
        })
    }
}

/// The part of the root's motion that the cloth is not to feel in one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carried {
    /// Where the root was at the start of the step (m).
    pub origin: Vec3A,
    /// Its velocity over the step (m/s).
    pub velocity: Vec3A,
    /// Its angular velocity over the step (rad/s).
    pub turning: Vec3A,
    /// (1 - s_l) (V - V') (m/s).
    pub jolt: Vec3A,
    /// (1 - s_a) (w - w') (rad/s).
    pub twist: Vec3A,
    /// 1 - s_a.
    pub angular: f32,
    /// 1 - s_c.
    pub centrifugal: f32,
    /// Length of the step (s).
    pub dt: f32,
}

impl Carried {
    /// Changes the velocities of a range of particles `(first, len)` and adds to their accelerations `to` (m/s2), which
    /// hold the wind's or zeros.
    pub fn apply(&self, width: Width, columns: ParticleColumns<'_>, span: (u32, u32), to: [WriteColumn<'_>; 3]) {
        width.run(Compensate { carried: self, columns, span, to });
    }
}

/// A jump of the root that the cloth makes with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved {
    /// The root's motion, in world space.
    pub motion: Affine3A,
}

impl Moved {
    /// Moves positions, previous positions and velocities of a range of particles `(first, len)`.
    pub fn apply(&self, width: Width, columns: ParticleColumns<'_>, span: (u32, u32)) {
        width.run(Carry { moved: self, columns, span });
    }

    /// Moves one point: the pins' last targets, a collider.
    pub fn point(&self, p: Vec3A) -> Vec3A {
        self.motion.transform_point3a(p)
    }
}

struct Compensate<'a> {
    carried: &'a Carried,
    columns: ParticleColumns<'a>,
    span: (u32, u32),
    to: [WriteColumn<'a>; 3],
}

impl Kernel for Compensate<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let c = self.carried;
        let (velocity, turning) = (V3::<L>::splat(c.velocity), V3::splat(c.turning));
        let (origin, jolt, twist) = (V3::splat(c.origin), V3::splat(c.jolt), V3::splat(c.twist));
        let half = L::splat(0.5 * c.dt);
        let (coriolis, pull) = (L::splat(2.0 * c.angular), L::splat(c.centrifugal));
        let (first, len) = (self.span.0 as usize, self.span.1 as usize);
        let mut t = 0;
        while t < len {
            let (at, n) = (first + t, L::N.min(len - t));
            let r = V3::load(self.columns.x, at, n) - origin;
            let v = V3::load(self.columns.v, at, n) + jolt + twist.cross(r);
            let felt = FeltMotion { velocity, turning, coriolis, pull };
            // The midpoint rule: with the values of the start, what turns would drift outwards.
            let a = felt.at(r + (v - velocity) * half, v + felt.at(r, v) * half);
            v.store(self.columns.v, at, n);
            (V3::load(self.to, at, n) + a).store(self.to, at, n);
            t += n;
        }
    }
}

/// What is felt of a turning frame.
#[derive(Clone, Copy)]
struct FeltMotion<L> {
    /// Of the frame's origin (m/s).
    velocity: V3<L>,
    /// Of the frame (rad/s).
    turning: V3<L>,
    /// Factors of the Coriolis and the centrifugal acceleration (1).
    coriolis: L,
    pull: L,
}

impl<L: Lanes> FeltMotion<L> {
    /// At a place and a velocity (m/s2).
    #[inline(always)]
    fn at(&self, r: V3<L>, v: V3<L>) -> V3<L> {
        let Self { velocity, turning, coriolis, pull } = *self;
        let carried = turning.cross(r);
        turning.cross(v - velocity - carried) * coriolis + turning.cross(carried) * pull
    }
}

struct Carry<'a> {
    moved: &'a Moved,
    columns: ParticleColumns<'a>,
    span: (u32, u32),
}

impl Kernel for Carry<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let motion = self.moved.motion;
        let place = V3::<L>::splat(motion.translation);
        let m = motion.matrix3;
        let axes = [V3::splat(m.x_axis), V3::splat(m.y_axis), V3::splat(m.z_axis)];
        let (first, len) = (self.span.0 as usize, self.span.1 as usize);
        let mut t = 0;
        while t < len {
            let (at, n) = (first + t, L::N.min(len - t));
            let x = turned(axes, V3::load(self.columns.x, at, n)) + place;
            let previous = turned(axes, V3::load(self.columns.previous, at, n)) + place;
            let v = turned(axes, V3::load(self.columns.v, at, n));
            x.store(self.columns.x, at, n);
            previous.store(self.columns.previous, at, n);
            v.store(self.columns.v, at, n);
            t += n;
        }
    }
}

/// A rotation, given by its axes, of a vector.
#[inline(always)]
fn turned<L: Lanes>([x, y, z]: [V3<L>; 3], v: V3<L>) -> V3<L> {
    x * v.x + y * v.y + z * v.z
}

#[cfg(test)]
mod tests;
