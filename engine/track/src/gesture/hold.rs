//! A hand held out towards the mirror to confirm.

use glam::Vec3;

use super::{Gesture, LONGEST_GAP_NS};

/// How long a hand is held out to confirm (ns): Kinect interfaces of the time ask for one to two seconds.
const HOLD_NS: u64 = 1_000_000_000;

/// A held hand stays within this of where it was (arm lengths): tremor, and the jitter of a tracker at 3.5 m.
const WITHIN: f32 = 0.15;

/// The place that a held hand is compared with follows it by this part a frame, for the first frame is as noisy as any.
const FOLLOW: f32 = 0.1;

/// A held hand is this far from its shoulder, before it, and at least this high above it (arm lengths): one that holds a
/// phone or a bag, with a bent elbow, is nearer or lower.
const REACH: f32 = 0.80;
const BEFORE: f32 = 0.55;
const HEIGHT: f32 = -0.40;

/// Once held out, a hand stays so to within this of those bounds (arm lengths).
const SLACK: f32 = 0.08;

/// A hand with the other one this near (arm lengths) holds something that both work at.
const TOGETHER: f32 = 0.4;

/// Both hands at one moment, in arm lengths along the trunk's axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct HoldInput {
    pub now: u64,
    /// Position of the wrist.
    pub at: Vec3,
    /// Wrist from its shoulder.
    pub reach: Option<Vec3>,
    /// The other wrist, and the same from its own shoulder.
    pub other: Option<Vec3>,
    pub other_reach: Option<Vec3>,
    /// Whether the shopper faces the mirror and does not walk.
    pub calm: bool,
    /// Whether something was recognised just now: the time of holding starts over.
    pub cooling: bool,
}

/// A hand that is being held out.
#[derive(Debug, Clone, Copy)]
struct HeldHand {
    at: Vec3,
    since: u64,
    confirmed: bool,
}

/// The hold of one hand.
#[derive(Debug, Clone)]
pub(super) struct Hold {
    held: Option<HeldHand>,
    seen_ns: u64,
}

fn is_out(reach: Option<Vec3>, slack: f32) -> bool {
    reach.is_some_and(|d| d.length() >= REACH - slack && d.z >= BEFORE - slack && d.y >= HEIGHT - slack)
}

impl Hold {
    pub(super) const fn new() -> Self {
        Self { held: None, seen_ns: 0 }
    }

    /// One step with a hand that is seen. A hand confirms once, until it is drawn back or held out elsewhere.
    pub(super) fn step(&mut self, arms: &HoldInput) -> Option<Gesture> {
        let lost = arms.now.saturating_sub(self.seen_ns) > LONGEST_GAP_NS;
        self.seen_ns = arms.now;
        let slack = if self.held.is_some() { SLACK } else { 0.0 };
        let alone = !is_out(arms.other_reach, SLACK) && arms.other.is_none_or(|o| o.distance(arms.at) > TOGETHER);
        if lost || !arms.calm || !alone || !is_out(arms.reach, slack) {
            self.held = None;
            return None;
        }
        let begun = HeldHand { at: arms.at, since: arms.now, confirmed: false };
        let held = self.held.get_or_insert(begun);
        if held.at.distance(arms.at) > WITHIN {
            *held = begun;
        }
        held.at = held.at.lerp(arms.at, FOLLOW);
        if arms.cooling {
            held.since = arms.now;
        }
        if held.confirmed || arms.now - held.since < HOLD_NS {
            return None;
        }
        held.confirmed = true;
        Some(Gesture::Confirm)
    }
}
