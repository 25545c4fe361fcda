//! A shopper's turn: the sides that were seen, whether they suffice to measure from all sides, and whether the shopper turns at all.
//! It is offered and never asked for: a shopper who stands still loses nothing.

use std::f32::consts::{PI, TAU};

use toile_base::frame::Joints;
use toile_base::skeleton::Joint;
use toile_fitting::dress::depth::TURN_NS;
use toile_track::fit;

/// Sides that are distinguished: of ten degrees each, so that the count of them says the gap to within a side.
pub const SIDES: usize = 36;

/// Largest gap between neighbouring sides around a person who was seen from all sides, in sides: as the body fit takes it.
const CLOSED: usize = (fit::CLOSED / TAU * SIDES as f32) as usize;

/// The offer stands for so long (ns): the sentence is read twice in that time. The front is measured and dressed meanwhile, so
/// the shopper does not wait for its end.
const OFFER_NS: u64 = 4_000_000_000;

/// Who is turned by more than this from how they first stood has begun to turn (rad): 25 degrees; people sway and look round by half of it.
const BEGUN: f32 = 0.44;

/// Without a new side for so long, they turn no more (ns): a slow turn shows a side each sixth of a second.
const STILL_NS: u64 = 2_000_000_000;

/// A turn is at an end after this (ns): no later depth is looked at.
const LONGEST_NS: u64 = TURN_NS;

/// Between frames that are no farther apart than this (ns), no person turns by a quarter of a circle.
const CONTINUOUS_NS: u64 = 300_000_000;

/// How far a turn has got.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TurnState {
    /// They stand as they stood.
    Offered,
    /// They turn.
    Turning,
    /// They were seen from all sides.
    Enough,
    /// They did not turn, or not all round.
    Ended,
}

/// Follows a turn by where the shopper faces. Knows no time but those that it is given.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyTurn {
    state: TurnState,
    /// When it was offered, when it was begun, and when a new side was seen last (ns).
    offered_ns: u64,
    begun_ns: u64,
    new_ns: u64,
    /// Where they faced first, and last with when (rad, ns).
    first: Option<f32>,
    last: Option<(u64, f32)>,
    seen: [bool; SIDES],
}

impl BodyTurn {
    /// Offered at a time (ns).
    pub fn new(now_ns: u64) -> Self {
        let seen = [false; SIDES];
        Self {
            state: TurnState::Offered,
            offered_ns: now_ns,
            begun_ns: 0,
            new_ns: now_ns,
            first: None,
            last: None,
            seen,
        }
    }

    /// How far it has got.
    pub fn state(&self) -> TurnState {
        self.state
    }

    /// Sides that were seen, from where the shopper faced first, to their left.
    pub fn seen(&self) -> &[bool; SIDES] {
        &self.seen
    }

    /// How far they are turned from where they faced first (rad, 0 .. 2 pi, to their left), where that is known.
    pub fn turned(&self) -> Option<f32> {
        Some((self.last?.1 - self.first?).rem_euclid(TAU))
    }

    /// Takes where they face (rad), where that is seen, and the time (ns); gives how far the turn has got.
    pub fn update(&mut self, now_ns: u64, facing: Option<f32>) -> TurnState {
        if matches!(self.state, TurnState::Enough | TurnState::Ended) {
            return self.state;
        }
        if let Some(facing) = facing.filter(|f| f.is_finite()) {
            self.face(now_ns, facing);
        }
        let since = |then: u64| now_ns.saturating_sub(then);
        self.state = match self.state {
            _ if self.is_closed() => TurnState::Enough,
            TurnState::Offered if self.is_begun() => {
                (self.begun_ns, self.new_ns) = (now_ns, now_ns);
                TurnState::Turning
            }
            TurnState::Offered if since(self.offered_ns) >= OFFER_NS => TurnState::Ended,
            TurnState::Turning if since(self.new_ns) >= STILL_NS || since(self.begun_ns) >= LONGEST_NS => {
                TurnState::Ended
            }
            state => state,
        };
        self.state
    }

    fn face(&mut self, now_ns: u64, facing: f32) {
        // Some sensors take every person to face them, and swap left and right of a person seen from behind. A half turn between two
        // frames is therefore theirs and not the person's.
        let jumped =
            |&(then, last): &(u64, f32)| now_ns.saturating_sub(then) <= CONTINUOUS_NS && apart(facing, last) > 0.5 * PI;
        let facing = if self.last.as_ref().is_some_and(jumped) { facing + PI } else { facing };
        let first = *self.first.get_or_insert(facing);
        self.last = Some((now_ns, facing));
        let wide = TAU / SIDES as f32;
        // The first side lies around where they faced first.
        let side = ((facing - first + 0.5 * wide).rem_euclid(TAU) / wide) as usize % SIDES;
        if !self.seen[side] {
            (self.seen[side], self.new_ns) = (true, now_ns);
        }
    }

    fn is_begun(&self) -> bool {
        self.turned().is_some_and(|turned| turned.min(TAU - turned) > BEGUN)
    }

    /// Whether no gap between neighbouring sides is too wide, each counted from middle to middle.
    fn is_closed(&self) -> bool {
        let seen = |side: usize| self.seen[side % SIDES];
        (0..SIDES).filter(|side| seen(*side)).count() > 1
            && (0..SIDES).filter(|side| seen(*side)).all(|side| (1..=CLOSED).any(|ahead| seen(side + ahead)))
    }
}

/// The angle between two directions (rad, 0 .. pi).
fn apart(a: f32, b: f32) -> f32 {
    let turned = (a - b).rem_euclid(TAU);
    turned.min(TAU - turned)
}

/// Where a body faces, about the vertical (rad): 0 towards the mirror, positive to the shopper's own left. By hips and shoulders, as far
/// as they are seen.
pub fn facing(frame: &Joints) -> Option<f32> {
    use Joint::{LeftHip, LeftShoulder, RightHip, RightShoulder};
    let across = |left, right| Some(frame.believed(left)? - frame.believed(right)?);
    let hips = across(LeftHip, RightHip)?;
    let across = hips + across(LeftShoulder, RightShoulder).unwrap_or_default();
    (across.x.hypot(across.z) > 1e-3).then(|| (-across.z).atan2(across.x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Quat, Vec3};
    use toile_base::skeleton::JOINTS;

    const FRAME_NS: u64 = 33_333_333;

    /// Turns by a way (rad) in so many seconds, then stands for `after_s`; gives the state and how long it took (s).
    fn turn(way: impl Fn(f32) -> f32, seconds: f32, after_s: f32) -> (TurnState, f32) {
        let mut turn = BodyTurn::new(0);
        let frames = ((seconds + after_s) * 30.0) as u64;
        for i in 0..frames {
            let t = (i as f32 / 30.0 / seconds).min(1.0);
            let state = turn.update(i * FRAME_NS, Some(way(t)));
            if matches!(state, TurnState::Enough | TurnState::Ended) {
                return (state, i as f32 / 30.0);
            }
        }
        (turn.state(), seconds + after_s)
    }

    #[test]
    fn a_slow_turn_either_way_is_enough_before_it_is_whole() {
        for way in [TAU, -TAU] {
            let (state, took) = turn(|t| 0.3 + way * t, 6.0, 5.0);
            assert_eq!(state, TurnState::Enough);
            assert!((4.0..6.0).contains(&took), "{took} s");
        }
    }

    #[test]
    fn who_sways_is_not_waited_for_and_who_stops_is_waited_for_no_longer_than_is_said() {
        let (state, took) = turn(|t| 0.2 * (40.0 * t).sin(), 20.0, 0.0);
        assert_eq!(state, TurnState::Ended);
        assert!((took - OFFER_NS as f32 * 1e-9).abs() < 0.1, "{took} s");
        let (state, took) = turn(|t| t * PI * 0.9, 3.0, 10.0);
        assert_eq!(state, TurnState::Ended);
        assert!(took < 3.0 + STILL_NS as f32 * 1e-9 + 0.2, "{took} s");
    }

    #[test]
    fn a_gap_of_a_hundred_degrees_is_closed_and_a_wider_one_is_not() {
        let seen = |degrees: &[f32]| {
            let mut turn = BodyTurn::new(0);
            // Farther apart in time than frames that follow each other: nothing is taken for mirrored.
            let sides = (0..).zip(degrees).map(|(i, d)| turn.update(i * 500_000_000, Some(d.to_radians())));
            sides.last().unwrap()
        };
        assert_eq!(seen(&[0.0, 90.0, 180.0, 270.0]), TurnState::Enough);
        assert_eq!(seen(&[0.0, 100.0, 200.0, 300.0]), TurnState::Enough);
        assert_eq!(seen(&[0.0, 120.0, 240.0]), TurnState::Turning);
    }

    #[test]
    fn joints_that_are_named_the_wrong_way_round_from_behind_do_not_hide_the_back() {
        let mirrored = |t: f32| {
            let facing = (t * TAU + PI).rem_euclid(TAU) - PI;
            if facing.abs() > 0.5 * PI { facing + PI } else { facing }
        };
        assert_eq!(turn(mirrored, 6.0, 3.0).0, TurnState::Enough);
    }

    #[test]
    fn who_is_not_seen_ends_it_too() {
        let mut turn = BodyTurn::new(0);
        assert_eq!(turn.update(OFFER_NS - 1, None), TurnState::Offered);
        assert_eq!(turn.update(OFFER_NS, None), TurnState::Ended);
        assert_eq!(turn.update(OFFER_NS + 1, Some(1.0)), TurnState::Ended);
    }

    #[test]
    fn a_body_faces_as_its_hips_and_shoulders_lie() {
        use Joint::{LeftHip, LeftShoulder, RightHip, RightShoulder};
        for yaw in [0.0_f32, 0.7, 2.5, -1.4, -3.0] {
            let mut at = [Vec3::ZERO; JOINTS];
            let around = Quat::from_rotation_y(yaw);
            for (joint, x) in [(LeftHip, 0.1), (RightHip, -0.1), (LeftShoulder, 0.18), (RightShoulder, -0.18)] {
                at[joint.index()] = around * Vec3::new(x, 1.0, 0.02);
            }
            let frame = Joints::seen(0, at);
            assert!(apart(facing(&frame).unwrap(), yaw) < 1e-4, "{yaw}");
            let mut hidden = frame;
            hidden.at_mut(LeftShoulder).confidence = 0.0;
            assert!(apart(facing(&hidden).unwrap(), yaw) < 1e-4, "by the hips alone");
            hidden.at_mut(LeftHip).confidence = 0.0;
            assert_eq!(facing(&hidden), None);
        }
    }
}
