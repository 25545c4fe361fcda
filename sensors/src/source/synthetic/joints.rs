//! The noise of a joint tracker: jitter on every joint, and hands and feet that are lost for a few frames.

use glam::Vec3;
use toile_base::skeleton::{JOINTS, Joint};

use toile_base::frame::Joints;
use toile_base::numeric::random::SplitMix64;

/// Joints that a tracker loses: the ends of the limbs.
const LOST: [Joint; 6] =
    [Joint::LeftWrist, Joint::LeftHand, Joint::LeftToe, Joint::RightWrist, Joint::RightHand, Joint::RightToe];

/// Standard deviation of a position along each axis (m).
const JITTER: f32 = 0.008;

/// Probability that a joint of [`LOST`] is lost in a frame.
const DROPOUT: f32 = 0.01;

/// The noise, with its own generator: the same seed and frames give the same bits.
#[derive(Debug, Clone, PartialEq)]
pub struct JointNoise {
    rng: SplitMix64,
    /// Frames that each joint stays lost.
    left: [u8; JOINTS],
}

impl JointNoise {
    /// Jitter of 8 mm, and each hand, wrist and toe lost once in about three seconds at 30 Hz.
    pub const fn new(seed: u64) -> Self {
        Self { rng: SplitMix64::new(seed), left: [0; JOINTS] }
    }

    /// A frame as a tracker would give it. Lost joints have a confidence below the gate for 2 to 9 frames and wander by
    /// ten times the jitter; absent ones stay absent.
    pub fn apply(&mut self, truth: &Joints) -> Joints {
        let mut out = *truth;
        for joint in Joint::ALL {
            let lost = self.is_lost(joint);
            let spread = if lost { 10.0 * JITTER } else { JITTER };
            let shift = Vec3::new(self.rng.gaussian(), self.rng.gaussian(), self.rng.gaussian()) * spread;
            let guess = 0.1 + 0.3 * self.rng.uniform();
            let tracked = out.at_mut(joint);
            if tracked.confidence > 0.0 {
                tracked.position += shift;
                if lost {
                    tracked.confidence = tracked.confidence.min(guess);
                }
            }
        }
        out
    }

    fn is_lost(&mut self, joint: Joint) -> bool {
        let left = &mut self.left[joint.index()];
        if *left > 0 {
            *left -= 1;
            return true;
        }
        if LOST.contains(&joint) && self.rng.uniform() < DROPOUT {
            *left = 1 + (self.rng.next_u64() % 8) as u8;
            return true;
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::frame::TrackedJoint;

    #[test]
    fn jitter_has_its_sigma_and_only_limb_ends_are_lost() {
        let mut truth = Joints::absent(0);
        truth.joints = [TrackedJoint { position: Vec3::Y, confidence: 1.0 }; JOINTS];
        *truth.at_mut(Joint::LeftClavicle) = TrackedJoint::default();
        let mut noise = JointNoise::new(2);
        let (mut squares, mut lost) = (0.0, 0);
        for _ in 0..3000 {
            let seen = noise.apply(&truth);
            squares += (seen.at(Joint::Head).position - Vec3::Y).length_squared();
            lost += usize::from(!seen.at(Joint::LeftHand).is_believed());
            assert!(seen.at(Joint::Head).is_believed() && seen.is_valid());
            assert_eq!(seen.at(Joint::LeftClavicle).confidence, 0.0);
        }
        let sigma = (squares / 9000.0f32).sqrt();
        assert!((sigma - 0.008).abs() < 0.0003, "{sigma}");
        assert!((60..360).contains(&lost), "{lost} of 3000 frames");
    }
}
