//! Bone lengths kept constant: tracked ones vary by a tenth.
//!
//! Each bone's length is estimated while the session runs and the tracked bone is pulled to it along its own direction,
//! from the pelvis outward, so that directions stay exactly as they were seen.

use glam::Vec3;
use toile_base::skeleton::Joint;

/// Largest step of the estimate in its first frame (m); the n-th frame moves it by this over n at most.
const FIRST_STEP: f32 = 0.05;

/// Smallest largest step (m): 12 mm a second at 30 Hz, so that an estimate learned from a bad pose is unlearned.
const LAST_STEP: f32 = 4e-4;

/// Largest change of a bone by the pull, over its length: one that is off by more has no direction to be believed.
const LARGEST_PULL: f32 = 0.5;

/// Shortest bone that has a direction (m).
const SHORTEST: f32 = 1e-3;

/// Running median of one bone's length: it moves towards each new length by a bounded step (Robbins and Monro 1951),
/// so that an outlier counts no more than any other length on its side.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BoneLength {
    /// The joint that the bone starts from; another one is another bone.
    from: Option<Joint>,
    /// The estimate (m).
    length: f32,
    /// Number of lengths that were taken in.
    count: u32,
}

impl BoneLength {
    /// A bone whose length (m) has been measured.
    pub fn fixed(from: Joint, length: f32) -> Self {
        Self { from: Some(from), length, count: u32::MAX }
    }

    /// Takes a length (m) that was seen with a confidence of `weight` (0..1).
    pub fn learn(&mut self, from: Joint, seen: f32, weight: f32) {
        if self.from != Some(from) {
            *self = Self { from: Some(from), length: seen, count: 1 };
            return;
        }
        let step = weight * (FIRST_STEP / self.count as f32).max(LAST_STEP);
        self.length += (seen - self.length).clamp(-step, step);
        self.count = self.count.saturating_add(1);
    }

    /// The bone from `from` with its length pulled to the estimate by `pull` (0 as seen .. 1 the estimate).
    pub fn pulled(&self, from: Joint, bone: Vec3, pull: f32) -> Vec3 {
        let length = bone.length();
        if self.from != Some(from) || length < SHORTEST {
            return bone;
        }
        bone * (1.0 + pull * (self.length / length - 1.0).clamp(-LARGEST_PULL, LARGEST_PULL))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::numeric::random::SplitMix64;

    #[test]
    fn the_estimate_is_the_median_and_outliers_do_not_count_more() {
        let mut rng = SplitMix64::new(1);
        let mut bone = BoneLength::default();
        for i in 0..3000 {
            let length = if i % 10 == 0 { 0.9 } else { 0.25 + 0.02 * rng.gaussian() };
            bone.learn(Joint::LeftShoulder, length, 1.0);
        }
        let pulled = bone.pulled(Joint::LeftShoulder, Vec3::X * 0.3, 1.0);
        assert!((pulled.x - 0.2528).abs() < 0.006, "{pulled}");
    }

    #[test]
    fn another_parent_is_another_bone() {
        let mut bone = BoneLength::default();
        bone.learn(Joint::Chest, 0.2, 1.0);
        assert_eq!(bone.pulled(Joint::LeftClavicle, Vec3::X, 1.0), Vec3::X);
        bone.learn(Joint::LeftClavicle, 0.1, 1.0);
        assert!((bone.pulled(Joint::LeftClavicle, Vec3::X * 0.12, 1.0).x - 0.1).abs() < 1e-6);
    }
}
