//! Motion input: where the joints are at a step's own time, from frames that come four times as seldom, late, or not at all.
//!
//! Each joint goes on at the velocity of its last two frames, which fades while no frame comes. When one comes, the joint
//! does not jump to it: what it is off by, in place, velocity and acceleration, fades in the impulse response of three
//! equal poles, e(t) = (a + b t + c t^2) exp(-t k), whose three coefficients are those three. So the path has no corner in its
//! acceleration, whatever the sensor does, and in steady motion it does not lag (dead reckoning with smoothed
//! corrections; the idea is that of network games: Murphy 2011, "Believable dead reckoning for networked games").

use glam::Vec3;
use toile_base::clock::seconds_between;
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::skeleton::JOINTS;

/// How far a velocity carries that no frame confirms (s): the joint comes to rest after as many times it. For
/// the first third of that time, which is a frame of 30 Hz and its delay, it keeps nine tenths of itself.
pub const FADE_S: f32 = 0.13;

/// Poles of the correction, times the sensor's period (1). Higher ones follow a fast reach a little sooner and
/// shake it far more, for jerk grows with their square.
const POLES: f32 = 3.0;

/// The sensor's period, as far as it decides on the correction (s): 60 Hz to 6 Hz.
const PERIODS_S: [f32; 2] = [1.0 / 60.0, 1.0 / 6.0];

/// How fast the period follows the sensor: share of a new one.
const PERIOD_SHARE: f32 = 0.35;

/// Speed at which half of a joint's velocity is believed (m/s): what is slower is the sensor's noise, which must not be drawn
/// out into the time ahead.
pub const HALF_BELIEVED_M_S: f32 = 0.1;

/// Fastest that a joint is expected to go on (m/s): a punch.
const FASTEST_M_S: f32 = 10.0;

/// A gap between two frames across which no velocity is taken (s).
const LONGEST_GAP_S: f32 = 0.3;

/// A silence after which the next frame is taken as it is (s): another person may stand there.
pub const LONGEST_SILENCE_S: f32 = 1.0;

/// One joint between frames.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct JointPath {
    /// Where the last frame had it (m), how it goes on (m/s).
    place: Vec3,
    velocity: Vec3,
    /// The correction's coefficients (m, m/s, m/s2).
    off: [Vec3; 3],
    /// As the last frame had it; 0 is absent.
    confidence: f32,
}

/// The joints from frame to frame.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionInput {
    paths: [JointPath; JOINTS],
    /// When the last frame was seen, and at which step's time it was taken (ns).
    seen_ns: Option<u64>,
    taken_ns: u64,
    /// Running period of the sensor, and the poles that came of it at the last frame (s, 1/s).
    period: f32,
    poles: f32,
}

impl Default for MotionInput {
    fn default() -> Self {
        let period = 1.0 / 30.0;
        Self { paths: [JointPath::default(); JOINTS], seen_ns: None, taken_ns: 0, period, poles: POLES / period }
    }
}

impl MotionInput {
    /// Takes a filtered frame, stamped on the loop's clock, in the step whose time is `now_ns`. One that is no newer than
    /// the last is passed over; says whether it was taken.
    pub fn take(&mut self, frame: &Joints, now_ns: u64) -> bool {
        if self.seen_ns.is_some_and(|last| frame.time_ns <= last) {
            return false;
        }
        let gap = self.seen_ns.map_or(f32::INFINITY, |last| seconds_between(last, frame.time_ns));
        let before = self.clone();
        if gap < LONGEST_GAP_S {
            self.period += (gap.clamp(PERIODS_S[0], PERIODS_S[1]) - self.period) * PERIOD_SHARE;
            self.poles = POLES / self.period;
        }
        (self.seen_ns, self.taken_ns) = (Some(frame.time_ns), now_ns);
        for (i, joint) in frame.joints.iter().enumerate() {
            self.paths[i] = self.follow(&before, i, joint, gap);
        }
        true
    }

    /// A joint's path from this frame on, so that it goes on from where it is.
    fn follow(&self, before: &Self, i: usize, joint: &TrackedJoint, gap: f32) -> JointPath {
        let old = &before.paths[i];
        let known = joint.confidence > 0.0 && joint.position.is_finite();
        if !known {
            return JointPath::default();
        }
        let mut path = JointPath { place: joint.position, confidence: joint.confidence, ..JointPath::default() };
        if old.confidence == 0.0 || gap > LONGEST_SILENCE_S {
            return path;
        }
        if gap < LONGEST_GAP_S {
            path.velocity = believed((joint.position - old.place) / gap);
        }
        let now = self.taken_ns;
        let (was, is) = (before.motion(old, now), self.motion(&path, now));
        let [e, v, a] = std::array::from_fn(|k| was[k] - is[k]);
        let k = self.poles;
        let b = v + e * k;
        path.off = [e, b, (a + b * (2.0 * k) - e * (k * k)) * 0.5];
        path
    }

    /// Place, velocity and acceleration of a joint at a step's time.
    fn motion(&self, path: &JointPath, now_ns: u64) -> [Vec3; 3] {
        // A frame from the time after the step is gone back from, a little.
        let ahead = seconds_between(self.seen_ns.unwrap_or(now_ns), now_ns).max(-FADE_S);
        // The way is FADE_S * x / root(1 + x^2), and these its derivatives.
        let x = ahead / FADE_S;
        let root = (1.0 + x * x).sqrt().recip();
        let cube = root * root * root;
        let (way, pace, slowing) = (FADE_S * x * root, cube, -3.0 / FADE_S * x * root * root * cube);
        let since = seconds_between(self.taken_ns, now_ns).max(0.0);
        let (k, [a, b, c]) = (self.poles, path.off);
        let (off, slope, bend) = (a + (b + c * since) * since, b + c * (2.0 * since), c * 2.0);
        let left = (-k * since).exp();
        [
            path.place + path.velocity * way + off * left,
            path.velocity * pace + (slope - off * k) * left,
            path.velocity * slowing + (bend - slope * (2.0 * k) + off * (k * k)) * left,
        ]
    }

    /// The joints at a step's time; those never seen are absent.
    pub fn at(&self, now_ns: u64) -> Joints {
        let mut joints = Joints::absent(now_ns);
        for (to, path) in joints.joints.iter_mut().zip(&self.paths) {
            if path.confidence > 0.0 {
                let [position, ..] = self.motion(path, now_ns);
                *to = TrackedJoint { position, confidence: path.confidence };
            }
        }
        joints
    }

    /// When the newest frame was seen (ns).
    pub fn seen_ns(&self) -> Option<u64> {
        self.seen_ns
    }
}

/// As much of a velocity as is not noise.
fn believed(velocity: Vec3) -> Vec3 {
    let speed = velocity.length();
    (velocity * (speed / (speed + HALF_BELIEVED_M_S))).clamp_length_max(FASTEST_M_S)
}

#[cfg(test)]
mod tests;
