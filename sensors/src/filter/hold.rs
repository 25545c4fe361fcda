//! Dropouts: a joint that is not believed stays where it was relative to its parent, and comes back without a jump.
//!
//! Held relative to the parent joint and turned with the parent's bone, a lost hand travels with its arm. When the
//! joint is seen again, the distance between the held and the seen place is taken back over [`BLEND_SECONDS`].

use glam::{Quat, Vec3};

/// Time over which a joint that is seen again moves from its held to its seen place (s).
pub const BLEND_SECONDS: f32 = 0.2;

/// Time constant with which a held joint drifts to where the sensor infers it, where it does (s). An inference is too
/// restless to be followed and too good to be ignored for a whole session: Kinect infers legs behind a table well.
const INFERENCE_SECONDS: f32 = 0.7;

/// Confidence of a joint that is held: below the gate, for no sensor has seen it.
pub const HELD_CONFIDENCE: f32 = 0.25;

/// State of one joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// From the parent joint to this one at the last frame (m).
    offset: Vec3,
    /// Direction of the parent's own bone at the last frame, or zero.
    bone: Vec3,
    /// Held minus seen place at the moment of return (m).
    correction: Vec3,
    /// Time since the return (s).
    since: f32,
    /// Confidence handed out, between [`HELD_CONFIDENCE`] and 1.
    trust: f32,
}

impl Hold {
    /// A joint seen for the first time: nothing to blend from.
    pub fn first_seen() -> Self {
        Self { offset: Vec3::ZERO, bone: Vec3::ZERO, correction: Vec3::ZERO, since: BLEND_SECONDS, trust: 1.0 }
    }

    /// Where the joint is held (m), its parent being at `parent` and the parent's bone pointing along `bone`; `hint` is
    /// the offset from the parent that the sensor infers.
    pub fn held(&self, parent: Vec3, bone: Vec3, hint: Option<Vec3>, dt: f32) -> Vec3 {
        let offset = turn(self.bone, bone) * self.offset;
        let drift = hint.map_or(Vec3::ZERO, |hint| (hint - offset) * (1.0 - (-dt / INFERENCE_SECONDS).exp()));
        parent + offset + drift
    }

    /// The joint is seen again at `seen`, having been held at `held`: blend from here.
    pub fn resume(&mut self, held: Vec3, seen: Vec3) {
        self.correction = held - seen;
        self.since = 0.0;
    }

    /// What to add to the seen place (m); falls to zero along a smooth step.
    pub fn correction(&self) -> Vec3 {
        let t = (self.since / BLEND_SECONDS).clamp(0.0, 1.0);
        self.correction * (1.0 - t * t * (3.0 - 2.0 * t))
    }

    /// Ends a frame: remembers where the joint lies relative to its parent, and how far it is believed.
    pub fn remember(&mut self, offset: Vec3, bone: Vec3, seen: bool, dt: f32) {
        self.offset = offset;
        self.bone = bone;
        self.since += dt;
        let step = (1.0 - HELD_CONFIDENCE) * dt / BLEND_SECONDS;
        self.trust = if seen { self.trust + step } else { self.trust - step }.clamp(HELD_CONFIDENCE, 1.0);
    }

    /// Confidence handed out: 1 for seen, [`HELD_CONFIDENCE`] for held, in between while one becomes the other.
    pub fn trust(&self) -> f32 {
        self.trust
    }
}

/// The smallest turn from one direction to another; none where either is unknown.
fn turn(from: Vec3, to: Vec3) -> Quat {
    match (from.try_normalize(), to.try_normalize()) {
        (Some(from), Some(to)) => Quat::from_rotation_arc(from, to),
        _ => Quat::IDENTITY,
    }
}
