//! A small seeded random generator.

/// SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators"): the same seed gives the
/// same bits on every machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// A generator whose state starts at `seed`.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 random bits.
    pub const fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in 0 .. 1, 1 excluded: the upper 24 bits, all that an `f32` holds.
    pub fn uniform(&mut self) -> f32 {
        (self.next_u64() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// Uniform in 0 .. 1, 1 excluded: the upper 53 bits, all that an `f64` holds.
    pub fn uniform_f64(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in `low` .. `high`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.uniform()
    }

    /// A whole number below `n`, which is not 0; by the remainder, whose bias is below n / 2^64.
    pub const fn below(&mut self, n: usize) -> usize {
        (self.next_u64() % n as u64) as usize
    }

    /// Normally distributed, mean 0 and deviation 1, cut at 4 deviations (Marsaglia's polar method, 1964).
    pub fn gaussian(&mut self) -> f32 {
        loop {
            let (x, y) = (2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0);
            let s = x * x + y * y;
            if s > 0.0 && s < 1.0 {
                return (x * (-2.0 * s.ln() / s).sqrt()).clamp(-4.0, 4.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_bits_and_the_moments_are_right() {
        let mut random = SplitMix64::new(7);
        let all: Vec<f32> = (0..100_000).map(|_| random.gaussian()).collect();
        let mean = all.iter().sum::<f32>() / 1e5;
        let variance = all.iter().map(|x| x * x).sum::<f32>() / 1e5;
        assert!(mean.abs() < 0.01 && (variance - 1.0).abs() < 0.02, "{mean} {variance}");
        assert_eq!(SplitMix64::new(1).next_u64(), SplitMix64::new(1).next_u64());
        assert_ne!(SplitMix64::new(1).next_u64(), SplitMix64::new(2).next_u64());
        // The first number of the published generator for seed 0.
        assert_eq!(SplitMix64::new(0).next_u64(), 0xe220_a839_7b1d_cdaf);
    }

    #[test]
    fn uniform_numbers_stay_in_their_range() {
        let mut random = SplitMix64::new(3);
        for _ in 0..10_000 {
            assert!((0.0..1.0).contains(&random.uniform()) && (0.0..1.0).contains(&random.uniform_f64()));
            assert!((-2.0..5.0).contains(&random.between(-2.0, 5.0)) && random.below(7) < 7);
        }
    }
}
