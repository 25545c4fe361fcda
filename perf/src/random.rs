//! Random numbers of a case and a seed: other cases get other numbers from the same seed, on every machine the same.

use glam::Vec3;
use toile_base::numeric::hash;
use toile_base::numeric::random::SplitMix64;

/// The random numbers of one seed of one case.
#[derive(Debug, Clone)]
pub struct CaseRandom(SplitMix64);

impl CaseRandom {
    /// A generator by the case's name and the seed.
    pub fn new(case: &str, seed: u64) -> Self {
        Self(SplitMix64::new(hash::of_bytes(case.as_bytes()) ^ seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
    }

    /// A number of a range.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        self.0.between(low, high)
    }

    /// A whole number below `n`, which is not 0.
    pub fn below(&mut self, n: usize) -> usize {
        self.0.below(n)
    }

    /// A power of ten with an exponent of a range.
    pub fn decades(&mut self, low: f32, high: f32) -> f32 {
        10f64.powf(f64::from(self.between(low, high))) as f32
    }

    /// A point of the cube from -1 to 1.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A direction, all equally likely.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let p = self.point();
            if (1e-4..=1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_of_a_case_gives_its_numbers_and_no_others() {
        let some = |case: &str, seed: u64| {
            let mut random = CaseRandom::new(case, seed);
            [(); 8].map(|()| random.between(0.0, 1.0))
        };
        assert_eq!(some("a", 1), some("a", 1));
        assert_ne!(some("a", 1), some("a", 2));
        assert_ne!(some("a", 1), some("b", 1));
        assert!(some("a", 1).iter().all(|u| (0.0..1.0).contains(u)));
    }

    #[test]
    fn directions_have_unit_length_and_no_preference() {
        let mut random = CaseRandom::new("directions", 3);
        let mut sum = Vec3::ZERO;
        for _ in 0..4_000 {
            let d = random.direction();
            assert!((d.length() - 1.0).abs() < 1e-5);
            sum += d;
        }
        assert!(sum.length() / 4_000.0 < 0.04, "{sum}");
    }
}
