//! A synthetic depth camera, and the noise of a real one.

/// A small seeded generator (SplitMix64, Steele et al. 2014): the same seed gives the same bits everywhere.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rng(u64);

impl Rng {
    /// A generator of its own sequence for each seed.
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

    /// Uniform in 0 .. 1, 1 excluded.
    pub fn uniform(&mut self) -> f32 {
        (self.next_u64() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// Normally distributed, mean 0 and deviation 1, cut at 4: the sum of twelve uniforms would be cut at 6 and costs
    /// as much, so Marsaglia's polar method (1964) it is.
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
