//! Numbers by seed: the same on every machine, because nothing but integers and basic arithmetic makes them.

use glam::Vec3;

/// A sequence of numbers (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators": SplitMix64).
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// The sequence of one seed of one case: other cases get other numbers from the same seed.
    pub fn new(case: &str, seed: u64) -> Self {
        let name = case.bytes().fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x100_0000_01b3));
        Self(name ^ seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number from 0 to 1, 1 excluded.
    pub fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// A number of a range.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// A whole number below `n`, which is not 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// A power of ten with an exponent of a range.
    pub fn decades(&mut self, low: f32, high: f32) -> f32 {
        10f64.powf(f64::from(self.between(low, high))) as f32
    }

    /// A point of the cube from -1 to 1.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A direction, all alike likely.
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
            let mut random = Random::new(case, seed);
            [(); 8].map(|()| random.unit())
        };
        assert_eq!(some("a", 1), some("a", 1));
        assert_ne!(some("a", 1), some("a", 2));
        assert_ne!(some("a", 1), some("b", 1));
        assert!(some("a", 1).iter().all(|u| (0.0..1.0).contains(u)));
    }

    #[test]
    fn directions_have_unit_length_and_no_preference() {
        let mut random = Random::new("directions", 3);
        let mut sum = Vec3::ZERO;
        for _ in 0..4_000 {
            let d = random.direction();
            assert!((d.length() - 1.0).abs() < 1e-5);
            sum += d;
        }
        assert!(sum.length() / 4_000.0 < 0.04, "{sum}");
    }
}
