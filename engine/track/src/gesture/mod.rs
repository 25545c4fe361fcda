//! Gestures: a hand swiped left, right or up, held out to confirm, opened or closed.
//!
//! Left and right are the shopper's own. Everything is measured in arm lengths from the middle of the shoulders along
//! the trunk's own axes, so that the shopper's size, place and distance do not matter, nor a slow turn.

mod event;
mod grip;
mod hand;
mod hold;
mod hull;
mod position_history;
mod swipe;
mod trunk;

use toile_base::frame::{DepthFrame, HandState as ReportedState, Joints};
use toile_base::skeleton::Joint;

pub use event::{Gesture, GestureEvent, GestureEvents};
pub use hand::{HandRegion, HandSegmenter, HandShape};
pub use trunk::{Side, Trunk};

use event::LONGEST_GAP_NS;
use grip::Grip;
use hold::{Hold, HoldInput};
use position_history::PositionHistory;
use swipe::{Swipe, SwipeInput};
use trunk::{ArmLength, TrunkDirection};

/// Shortest time between two frames that are looked at (ns): a motion-capture system's 120 Hz carries nothing that 40 Hz
/// does not, and would need longer trails.
const SHORTEST_STEP_NS: u64 = 20_000_000;

/// After an event no other is given for this long (ns): arms need as long to come to rest.
const COOL_DOWN_NS: u64 = 500_000_000;

/// The trunk moves faster than this (arm lengths/s) in a person who walks, jumps or sits down: no time for gestures.
/// Standing people sway at under a tenth of it.
const WALKING: f32 = 0.6;

/// A trunk turned farther than this from the camera does not look into the mirror: cosine of 55 degrees.
const FACING: f32 = 0.57;

/// State of one hand's recognisers.
#[derive(Debug, Clone)]
struct HandState {
    history: PositionHistory,
    swipe: Swipe,
    hold: Hold,
    grip: Grip,
}

impl HandState {
    const fn new() -> Self {
        Self { history: PositionHistory::new(), swipe: Swipe::new(), hold: Hold::new(), grip: Grip::new() }
    }
}

/// The recogniser of one shopper's gestures.
#[derive(Debug, Clone)]
pub struct Gestures {
    last_ns: Option<u64>,
    quiet_until_ns: u64,
    scale: ArmLength,
    facing: TrunkDirection,
    trunk: PositionHistory,
    hands: [HandState; 2],
    segmenter: HandSegmenter,
}

impl Default for Gestures {
    fn default() -> Self {
        Self::new()
    }
}

impl Gestures {
    /// A recogniser that has seen no person yet. Allocates all that it will ever need.
    pub fn new() -> Self {
        Self {
            last_ns: None,
            quiet_until_ns: 0,
            scale: ArmLength::new(),
            facing: TrunkDirection::new(),
            trunk: PositionHistory::new(),
            hands: [HandState::new(), HandState::new()],
            segmenter: HandSegmenter::new(),
        }
    }

    /// Forgets the shopper; call it when another one is tracked.
    pub fn reset(&mut self) {
        self.last_ns = None;
        self.quiet_until_ns = 0;
        self.scale = ArmLength::new();
        self.rest();
    }

    /// Takes a frame of filtered joints, and the depth of about the same time where there is any. Frames that come less
    /// than 20 ms after the one before, or shortly before it, are passed over; after a clock set back by more it starts over.
    pub fn push(&mut self, joints: &Joints, depth: Option<&DepthFrame>) -> GestureEvents {
        let now = joints.time_ns;
        if self.last_ns.is_some_and(|last| last.saturating_sub(now) > LONGEST_GAP_NS) {
            self.reset();
        }
        match self.last_ns {
            Some(last) if now < last.saturating_add(SHORTEST_STEP_NS) => return GestureEvents::default(),
            Some(last) if now - last > LONGEST_GAP_NS => self.rest(),
            _ => {}
        }
        self.last_ns = Some(now);
        self.scale.see(joints);
        let (Some(arm), Some(trunk)) = (self.scale.arm(), Trunk::of(joints)) else {
            self.rest();
            return GestureEvents::default();
        };
        let trunk = self.facing.settled(trunk, now);
        self.trunk.push(now, trunk.origin / arm);
        let calm = self.trunk.velocity().is_some_and(|v| v.length() < WALKING) && trunk.forward.z > FACING;
        let mut events = GestureEvents::default();
        self.swipes(joints, &trunk, arm, calm, &mut events);
        if depth.is_some() || joints.hands != [ReportedState::Unknown; 2] {
            self.grips(joints, depth, &trunk, arm, &mut events);
        }
        events
    }

    /// Ends every gesture that has begun.
    fn rest(&mut self) {
        self.facing = TrunkDirection::new();
        self.trunk = PositionHistory::new();
        self.hands = [HandState::new(), HandState::new()];
    }

    fn swipes(&mut self, joints: &Joints, trunk: &Trunk, arm: f32, calm: bool, events: &mut GestureEvents) {
        let now = joints.time_ns;
        let local = |joint: Joint| joints.believed(joint).map(|p| trunk.local(p) / arm);
        let at = Side::BOTH.map(|side| local(side.wrist()));
        let reach = [0, 1].map(|i| Some(at[i]? - local(Side::BOTH[i].shoulder())?));
        let cooling = now < self.quiet_until_ns;
        for (i, side) in Side::BOTH.into_iter().enumerate() {
            let hand = &mut self.hands[i];
            if let Some(at) = at[i] {
                hand.history.push(now, at);
            }
            let (Some(place), Some(velocity)) = (at[i], hand.history.velocity()) else { continue };
            let (other, other_reach) = (at[1 - i], reach[1 - i]);
            let moment =
                SwipeInput { now, at: place, velocity, other, head: local(Joint::Head), calm: calm && !cooling };
            let arms = HoldInput { now, at: place, reach: reach[i], other, other_reach, calm, cooling };
            let held = hand.hold.step(&arms);
            let found = hand.swipe.step(&moment).or(held);
            events[i] = found.map(|gesture| GestureEvent { time_ns: now, side, gesture });
        }
        if events.iter().any(Option::is_some) {
            self.quiet_until_ns = now.saturating_add(COOL_DOWN_NS);
        }
    }

    /// What the hands that are held up do: as the sensor reports it, else as the depth image shows it.
    fn grips(
        &mut self,
        joints: &Joints,
        depth: Option<&DepthFrame>,
        trunk: &Trunk,
        arm: f32,
        events: &mut GestureEvents,
    ) {
        let now = joints.time_ns;
        for (i, side) in Side::BOTH.into_iter().enumerate() {
            let presented = |wrist| swipe::is_presented(trunk.local(wrist) / arm);
            let is_presented = joints.believed(side.wrist()).is_some_and(presented);
            let openness = match joints.hands[i] {
                _ if !is_presented => None,
                ReportedState::Open => Some(1.0),
                ReportedState::Closed => Some(0.0),
                ReportedState::Unknown => depth
                    .zip(HandRegion::of(joints, side, arm))
                    .and_then(|(depth, region)| self.segmenter.shape(depth, &region).map(|shape| shape.openness())),
            };
            let found = self.hands[i].grip.step(now, openness);
            events[2 + i] = found.map(|gesture| GestureEvent { time_ns: now, side, gesture });
        }
    }
}
