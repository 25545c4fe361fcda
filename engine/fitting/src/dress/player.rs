//! A session played to a body that is stepped faster or slower than the sensor saw it, as the loop plays it: a step knows the
//! frames that have come by then and none that comes later.

use std::borrow::Cow;

use toile_base::clock::{ns_to_ticks, ticks_to_ns};
use toile_base::frame::Joints;
use toile_engine::frame_loop::motion_input::MotionInput;

/// Filtered joints on their way to the steps.
#[derive(Debug, Clone)]
pub struct Player<'a> {
    track: Cow<'a, [Joints]>,
    next: usize,
    tick: u64,
    intake: MotionInput,
}

impl<'a> Player<'a> {
    /// From the first frame of a filtered track on. An empty track has no steps.
    pub fn new(track: impl Into<Cow<'a, [Joints]>>) -> Self {
        Self { track: track.into(), next: 0, tick: 0, intake: MotionInput::default() }
    }

    /// Steps from the first frame to the last, at the engine's rate; at least one where there is a frame.
    pub fn steps(&self) -> u64 {
        let span = self.track.first().zip(self.track.last()).map(|(first, last)| last.time_ns - first.time_ns);
        span.map_or(0, |ns| ns_to_ticks(ns).max(1))
    }

    /// The joints at the end of the next step, from what had arrived when it began.
    pub fn step(&mut self) -> Joints {
        let begin = self.track.first().map_or(0, |first| first.time_ns);
        let (scheduled, end) = (begin + ticks_to_ns(self.tick), begin + ticks_to_ns(self.tick + 1));
        while let Some(frame) = self.track.get(self.next).filter(|frame| frame.time_ns <= scheduled) {
            self.intake.take(frame, end);
            self.next += 1;
        }
        self.tick += 1;
        self.intake.at(end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use toile_base::skeleton::Joint;

    /// Frames of 30 Hz in which the pelvis moves at 1 m/s.
    fn track(frames: u64) -> Vec<Joints> {
        let frame = |i: u64| {
            let mut joints = Joints::absent(i * 33_333_333);
            let pelvis = joints.at_mut(Joint::Pelvis);
            (pelvis.position, pelvis.confidence) = (Vec3::X * (i as f32 / 30.0), 1.0);
            joints
        };
        (0..frames).map(frame).collect()
    }

    #[test]
    fn a_step_knows_no_frame_that_comes_later() {
        let (whole, cut) = (track(30), track(15));
        let (mut a, mut b) = (Player::new(&whole), Player::new(&cut));
        // The sixteenth frame comes at 500 ms, with step 60.
        for step in 0..60 {
            assert_eq!(a.step(), b.step(), "step {step}");
        }
        // A new frame moves nobody in the step that takes it, for the correction begins at nothing.
        a.step();
        b.step();
        assert_ne!(a.step(), b.step());
    }

    #[test]
    fn steps_last_from_the_first_frame_to_the_last() {
        assert_eq!(Player::new(track(31)).steps(), 119);
        assert_eq!((Player::new(track(1)).steps(), Player::new(Vec::new()).steps()), (1, 0));
    }
}
