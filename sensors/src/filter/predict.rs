//! Prediction to the time at which the picture is seen: a joint goes on as fast as it moves, for so long.
//!
//! From a frame's arrival to the picture some 38 ms pass, and 37 more in sensor and display. The velocity is that of the
//! frames handed in, smoothed once more, for what is added is noise too; and joints that are not seen stay.

use glam::Vec3;
use toile_base::skeleton::JOINTS;

use super::Filter;
use super::gate::in_the_room;
use toile_base::clock::seconds_between;
use toile_base::frame::Joints;

/// Time constant of the velocity (s): two frames at 30 Hz.
const VELOCITY_SECONDS: f32 = 0.066;

/// Longest time that is predicted (s), and farthest that a joint is carried (m): beyond, it is somewhere else.
const LONGEST_LEAD: f32 = 0.15;
const FARTHEST: f32 = 0.12;

/// Speed (m/s) below which nothing is added, and above which everything is: what rests stays at rest.
const RESTING: [f32; 2] = [0.15, 0.4];

/// Predicts filtered joints.
#[derive(Debug, Clone)]
pub struct Predictor {
    lead: f32,
    last: Joints,
    velocity: [Vec3; JOINTS],
}

impl Predictor {
    /// A predictor that looks `lead` seconds ahead of each frame handed in, cut at 150 ms.
    pub fn new(lead: f32) -> Self {
        let lead = if lead.is_finite() { lead.clamp(0.0, LONGEST_LEAD) } else { 0.0 };
        Self { lead, last: Joints::absent(0), velocity: [Vec3::ZERO; JOINTS] }
    }

    /// The joints as they will be at a time (ns); before the newest frame, as in it.
    pub fn at(&self, time_ns: u64) -> Joints {
        let ahead = seconds_between(self.last.time_ns, time_ns).clamp(0.0, LONGEST_LEAD);
        let mut out = self.last;
        out.time_ns = time_ns.max(self.last.time_ns);
        for (joint, velocity) in out.joints.iter_mut().zip(&self.velocity) {
            let speed = velocity.length();
            let t = ((speed - RESTING[0]) / (RESTING[1] - RESTING[0])).clamp(0.0, 1.0);
            joint.position += (*velocity * (t * t * (3.0 - 2.0 * t) * ahead)).clamp_length_max(FARTHEST);
        }
        out
    }

    fn observe(&mut self, frame: &Joints) {
        let frame = in_the_room(frame);
        let dt = seconds_between(self.last.time_ns, frame.time_ns);
        for (i, joint) in frame.joints.iter().enumerate() {
            let before = &self.last.joints[i];
            let moved = joint.position - before.position;
            let seen = joint.is_believed() && before.is_believed();
            let share = 1.0 - (-dt / VELOCITY_SECONDS).exp();
            self.velocity[i] = if seen && dt > 0.0 && dt < 1.0 {
                self.velocity[i] + (moved / dt - self.velocity[i]) * share
            } else {
                Vec3::ZERO
            };
        }
        self.last = frame;
    }
}

impl Filter for Predictor {
    /// Takes a frame and gives the joints as they will be after the lead, at the frame's own time.
    fn push(&mut self, frame: &Joints) -> Joints {
        self.observe(frame);
        let ahead = self.at(frame.time_ns.saturating_add((f64::from(self.lead) * 1e9) as u64));
        Joints { time_ns: frame.time_ns, ..ahead }
    }

    fn reset(&mut self) {
        *self = Self::new(self.lead);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::frame::TrackedJoint;

    fn at(ms: u64, x: f32) -> Joints {
        let joints = [TrackedJoint { position: Vec3::new(x, 1.0, 0.0), confidence: 1.0 }; JOINTS];
        Joints { joints, ..Joints::absent(ms * 1_000_000) }
    }

    #[test]
    fn a_steady_move_is_where_it_will_be_and_rest_stays() {
        let mut predictor = Predictor::new(0.04);
        let mut out = at(0, 0.0);
        for i in 0..30 {
            out = predictor.push(&at(i * 33, 0.033 * i as f32));
        }
        assert!((out.joints[0].position.x - 0.033 * 29.0 - 0.04).abs() < 2e-3, "{}", out.joints[0].position.x);
        assert!((predictor.at(out.time_ns + 100_000_000).joints[0].position.x - 0.957 - 0.1).abs() < 5e-3);
        let mut still = Predictor::new(0.04);
        for i in 0..30 {
            let x = 0.002 * (i as f32 * 1.7).sin();
            assert_eq!(still.push(&at(i * 33, x)).joints[0].position.x, x);
        }
    }

    #[test]
    fn lost_joints_time_backwards_and_numbers_that_are_none_predict_nothing() {
        let mut predictor = Predictor::new(f32::NAN);
        let mut bad = at(99, 0.3);
        bad.joints[3].position.x = f32::NAN;
        bad.joints[4].confidence = 0.0;
        for frame in [at(0, 0.0), at(33, 0.1), at(10, 9.0), at(10, 0.0), bad] {
            let out = predictor.push(&frame);
            assert!(out.is_valid() && out.joints[4].position == frame.joints[4].position);
        }
        assert!(predictor.push(&at(132, 0.4)).is_valid(), "the next good frame is good");
    }
}
