//! Strokes of one hand: a small state machine, one step a frame.
//!
//! Gultepe 2013 (appendix C) listens for the hand's speed to pass a threshold. By itself that also fires on waving,
//! scratching, dressing and on the way back. So a stroke must begin with the hand presented and still, go straight along
//! one axis, and not turn back at once.
//!
//! ```text
//! away -> still -> stroke -> proving -> event
//! ```

use glam::Vec3;

use super::{Gesture, LONGEST_GAP_NS};

/// A hand is presented when it is this far before the shoulders (arm lengths): hanging arms are at 0.1, a hand in the
/// hair at 0.2.
const BEFORE: f32 = 0.30;

/// A hand is presented between these heights above the shoulders (arm lengths): waist and crown.
const HEIGHTS: [f32; 2] = [-0.75, 0.70];

/// A hand that is farther to the side than this (arm lengths from the middle) is at a rail or a wall, not before the
/// mirror.
const SIDEWAYS: f32 = 0.9;

/// Slower than this a hand is still (arm lengths/s): tremor and jitter of a tracker stay under a third of it.
const STILL: f32 = 0.55;

/// Faster than this a still hand has set off (arm lengths/s).
const SET_OFF: f32 = 1.0;

/// How long a hand must be still before a stroke counts (ns): two frames at 15 Hz.
const STILL_NS: u64 = 130_000_000;

/// Slower than this along its axis a stroke has ended (arm lengths/s).
const ENDED: f32 = 0.7;

/// A stroke reaches this speed (arm lengths/s), which is 1.1 m/s for a person of average size.
const FAST: f32 = 1.9;

/// A stroke is at least this long (arm lengths): the breadth of the shoulders less a little.
const LONG: f32 = 0.50;

/// A stroke takes no longer than this (ns).
const LONGEST_STROKE_NS: u64 = 900_000_000;

/// Largest part of a stroke's length that it may leave its axis by, across the view and in depth: arms swing in arcs
/// about the shoulder, towards the mirror and away from it.
const ASIDE: f32 = 0.5;
const DEEP: f32 = 0.9;

/// How long a stroke to the side must not turn back to be believed (ns); wavers turn within it. A stroke upwards may be
/// followed by dropping the arm, and people do not wave up and down.
const PROVING_NS: [u64; 2] = [130_000_000, 0];

/// A stroke that gives back this part of its length has turned.
const TURNED_BACK: f32 = 0.35;

/// The other hand must stay within this part of a stroke's length: both hands moving is dressing, not pointing.
const OTHER_HAND: f32 = 0.5;

/// With the other wrist nearer to the middle of the shoulders than this (arm lengths) the shopper dresses.
const AT_COLLAR: f32 = 0.50;

/// A wrist nearer to the head than this (arm lengths) at a stroke's end went to the hair, the glasses or the ear.
const AT_HEAD: f32 = 0.45;

/// A stroke ends at least this far before the shoulders (arm lengths): arms stretched to the sides and hands put behind the
/// back end at the trunk's own plane.
const END_BEFORE: f32 = 0.20;

/// A stroke that undoes the last one within this time (ns) to within this distance (arm lengths) is the hand's way back.
const WAY_BACK_NS: u64 = 1_300_000_000;
const WAY_BACK: f32 = 0.4;

/// One hand at one moment, in arm lengths along the trunk's axes (left, up, forward of the middle of the shoulders).
#[derive(Debug, Clone, Copy)]
pub(super) struct SwipeInput {
    pub now: u64,
    pub at: Vec3,
    /// Velocity of the hand (arm lengths/s).
    pub velocity: Vec3,
    pub other: Option<Vec3>,
    pub head: Option<Vec3>,
    /// Whether the shopper faces the mirror, does not walk, and nothing was recognised just now.
    pub calm: bool,
}

/// A direction that a stroke may have.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SwipeAxis {
    gesture: Gesture,
    along: Vec3,
    /// Across the axis in the plane of the view.
    across: Vec3,
    /// How long it must not turn back (ns).
    proving_ns: u64,
}

const AXES: [SwipeAxis; 3] = [
    SwipeAxis { gesture: Gesture::SwipeLeft, along: Vec3::X, across: Vec3::Y, proving_ns: PROVING_NS[0] },
    SwipeAxis { gesture: Gesture::SwipeRight, along: Vec3::NEG_X, across: Vec3::Y, proving_ns: PROVING_NS[0] },
    SwipeAxis { gesture: Gesture::SwipeUp, along: Vec3::Y, across: Vec3::X, proving_ns: PROVING_NS[1] },
];

/// A hand that is presented and still.
#[derive(Debug, Clone, Copy)]
struct StillHand {
    since: u64,
    at: Vec3,
    other: Option<Vec3>,
}

/// A stroke on its way.
#[derive(Debug, Clone, Copy)]
struct Stroke {
    from: Vec3,
    other: Option<Vec3>,
    since: u64,
    fastest: f32,
}

#[derive(Debug, Clone, Copy)]
enum SwipeState {
    Away,
    Still(StillHand),
    Stroke(Stroke),
    Proving(FinishedStroke),
}

/// A stroke that has ended, until it is believed.
#[derive(Debug, Clone, Copy)]
struct FinishedStroke {
    from: Vec3,
    axis: SwipeAxis,
    length: f32,
    since: u64,
}

/// A stroke that was believed.
#[derive(Debug, Clone, Copy)]
struct RecognisedStroke {
    from: Vec3,
    gesture: Gesture,
    at_ns: u64,
}

/// The strokes and holds of one hand.
#[derive(Debug, Clone)]
pub(super) struct Swipe {
    state: SwipeState,
    seen_ns: u64,
    last: Option<RecognisedStroke>,
}

impl Swipe {
    pub(super) const fn new() -> Self {
        Self { state: SwipeState::Away, seen_ns: 0, last: None }
    }

    /// One step with a hand that is seen.
    pub(super) fn step(&mut self, m: &SwipeInput) -> Option<Gesture> {
        if m.now.saturating_sub(self.seen_ns) > LONGEST_GAP_NS || !m.calm {
            self.state = SwipeState::Away;
        }
        self.seen_ns = m.now;
        let (state, found) = match self.state {
            SwipeState::Away => (rest(m), None),
            SwipeState::Still(still) => (still.step(m), None),
            SwipeState::Stroke(stroke) => (stroke.step(m), None),
            SwipeState::Proving(proof) => self.prove(m, proof),
        };
        self.state = state;
        found
    }

    /// A stroke that has ended is believed if it does not turn back, and is not itself the way back.
    fn prove(&mut self, m: &SwipeInput, mut proof: FinishedStroke) -> (SwipeState, Option<Gesture>) {
        let length = (m.at - proof.from).dot(proof.axis.along);
        proof.length = proof.length.max(length);
        if length < (1.0 - TURNED_BACK) * proof.length {
            return (SwipeState::Away, None);
        }
        if m.now - proof.since < proof.axis.proving_ns {
            return (SwipeState::Proving(proof), None);
        }
        let FinishedStroke { from, axis, .. } = proof;
        let undoes = |last: &RecognisedStroke| AXES.iter().any(|a| a.gesture == last.gesture && a.along == -axis.along);
        let way_back =
            |last: &RecognisedStroke| m.now - last.at_ns < WAY_BACK_NS && m.at.distance(last.from) < WAY_BACK;
        if self.last.is_some_and(|last| undoes(&last) && way_back(&last)) {
            return (SwipeState::Away, None);
        }
        self.last = Some(RecognisedStroke { from, gesture: axis.gesture, at_ns: m.now });
        (SwipeState::Away, Some(axis.gesture))
    }
}

/// The state of a hand that takes part in no gesture.
fn rest(m: &SwipeInput) -> SwipeState {
    if m.velocity.length() >= STILL || !is_presented(m.at) || !m.calm {
        return SwipeState::Away;
    }
    SwipeState::Still(StillHand { since: m.now, at: m.at, other: m.other })
}

pub(super) fn is_presented(at: Vec3) -> bool {
    at.z >= BEFORE && at.x.abs() <= SIDEWAYS && (HEIGHTS[0]..=HEIGHTS[1]).contains(&at.y)
}

impl StillHand {
    fn step(mut self, m: &SwipeInput) -> SwipeState {
        let speed = m.velocity.length();
        if speed >= SET_OFF {
            let was_still = m.now - self.since >= STILL_NS;
            let stroke = Stroke { from: self.at, other: self.other, since: m.now, fastest: speed };
            return if was_still { SwipeState::Stroke(stroke) } else { SwipeState::Away };
        }
        if !is_presented(m.at) {
            return SwipeState::Away;
        }
        if speed < STILL {
            (self.at, self.other) = (m.at, m.other);
        }
        SwipeState::Still(self)
    }
}

impl Stroke {
    fn step(mut self, m: &SwipeInput) -> SwipeState {
        self.fastest = self.fastest.max(m.velocity.length());
        if m.now - self.since > LONGEST_STROKE_NS {
            return SwipeState::Away;
        }
        let moved = m.at - self.from;
        let along = |a: &SwipeAxis| moved.dot(a.along);
        let Some(axis) = AXES.into_iter().max_by(|a, b| along(a).total_cmp(&along(b))) else { return SwipeState::Away };
        let length = along(&axis);
        if m.velocity.dot(axis.along) >= ENDED {
            return SwipeState::Stroke(self);
        }
        if length < LONG {
            // Slow before it is long: either it sets off late, as at a low rate, or it is no stroke.
            let late = m.velocity.length() >= STILL;
            return if late { SwipeState::Stroke(self) } else { rest(m) };
        }
        if self.is_one(m, &axis, length) {
            SwipeState::Proving(FinishedStroke { from: self.from, axis, length, since: m.now })
        } else {
            rest(m)
        }
    }

    /// Whether a movement that has ended was a stroke: fast, straight, of one hand, and not to the head.
    fn is_one(&self, m: &SwipeInput, axis: &SwipeAxis, length: f32) -> bool {
        let moved = m.at - self.from;
        let straight = moved.dot(axis.across).abs() <= ASIDE * length && moved.z.abs() <= DEEP * length;
        let alone = match (self.other, m.other) {
            (Some(before), Some(after)) => before.distance(after) <= OTHER_HAND * length && after.length() > AT_COLLAR,
            _ => true,
        };
        let to_head = m.head.is_some_and(|head| head.distance(m.at) < AT_HEAD);
        self.fastest >= FAST && straight && alone && !to_head && m.at.z >= END_BEFORE
    }
}
