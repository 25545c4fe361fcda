//! Well-spread deterministic samples: what is jittered, and how.
//!
//! One Sobol sequence runs through the whole picture along a Z-shaped curve, so that neighbouring pixels complete each
//! other and their noise is fine-grained (Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of Monte Carlo
//! sampling error via hierarchical ordering of pixels"). Its points are shuffled and scrambled by hashing (Burley 2020,
//! "Practical hash-based Owen scrambling"). A sample depends on the pixel and its number alone.

use glam::Vec2;

/// Most samples a pixel may take; a power of two, so that each pixel owns one aligned block of the sequence.
pub const MOST_SAMPLES: u32 = 64;

/// One sample of one pixel.
#[derive(Debug, Clone, Copy)]
pub struct PixelSample(u32);

/// Use of a pair of random numbers: each use has its own, independent sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum SampleDimension {
    /// The place in the pixel.
    Pixel = 1,
    /// The place on the key light.
    Key,
    /// The place on the rim light.
    Rim,
    /// The direction of the occlusion ray.
    Ambient,
    /// The reach of the occlusion ray.
    Reach,
    /// Whether a ray finds a gap between threads.
    Gap,
}

impl PixelSample {
    /// The sample with this number (below [`MOST_SAMPLES`]) of the pixel (x, y).
    pub fn new(x: u32, y: u32, number: u32) -> Self {
        Self((spread(x) | spread(y) << 1).wrapping_mul(MOST_SAMPLES) | number)
    }

    /// Two numbers in [0, 1), well spread over the samples of a pixel and over the pixels of a neighbourhood.
    pub fn pair(self, dimension: SampleDimension) -> Vec2 {
        let seed = mix(dimension as u32);
        let index = scramble(self.0.reverse_bits(), seed).reverse_bits();
        let first = scramble(index, mix(seed ^ 0x68e3_1da4));
        let second = scramble(pascal(index), mix(seed ^ 0xb529_7a4d));
        // The sequence's numbers are bit-reversed here, and the scramble works on reversed bits: they cancel.
        Vec2::new(unit(first.reverse_bits()), unit(second.reverse_bits()))
    }
}

/// Warps the unit square to the unit disc, evenly: squared radius by turn.
pub fn disc(at: Vec2) -> Vec2 {
    let quarter = (4.0 * at.y) as u32;
    // Sine and cosine of -45..45 degrees by their series (error below 4e-7), then whole quarter turns: the same bits on
    // every machine, unlike a library's.
    let x = std::f32::consts::FRAC_PI_2 * (4.0 * at.y - quarter as f32 - 0.5);
    let s = x * x;
    let sin = x * (1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0)));
    let cos = 1.0 - s / 2.0 * (1.0 - s / 12.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0)));
    let turned = match quarter {
        0 => Vec2::new(cos, sin),
        1 => Vec2::new(-sin, cos),
        2 => Vec2::new(-cos, -sin),
        _ => Vec2::new(sin, -cos),
    };
    turned * at.x.sqrt()
}

/// The upper 24 bits as a number in [0, 1).
fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / (1 << 24) as f32)
}

/// Spreads 16 bits to the even places (Z order).
fn spread(x: u32) -> u32 {
    let x = x & 0xffff;
    let x = (x | x << 8) & 0x00ff_00ff;
    let x = (x | x << 4) & 0x0f0f_0f0f;
    let x = (x | x << 2) & 0x3333_3333;
    (x | x << 1) & 0x5555_5555
}

/// The second Sobol dimension before its bits are reversed: the index times Pascal's triangle modulo 2, which by
/// Lucas' theorem is a sum over supersets of bit positions.
fn pascal(x: u32) -> u32 {
    let x = x ^ (x >> 1 & 0x5555_5555);
    let x = x ^ (x >> 2 & 0x3333_3333);
    let x = x ^ (x >> 4 & 0x0f0f_0f0f);
    let x = x ^ (x >> 8 & 0x00ff_00ff);
    x ^ x >> 16
}

/// A hash in which every bit depends on the lower bits alone: on reversed numbers this is Owen's nested scrambling
/// (Laine and Karras 2011, constants of Vegdahl 2021).
fn scramble(x: u32, seed: u32) -> u32 {
    let x = x ^ x.wrapping_mul(0x3d20_adea);
    let x = x.wrapping_add(seed);
    let x = x.wrapping_mul(seed >> 16 | 1);
    let x = x ^ x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// An integer hash that mixes all bits (Wellons 2018, "Prospecting for hash functions").
pub fn mix(x: u32) -> u32 {
    let x = (x ^ x >> 16).wrapping_mul(0x7feb_352d);
    let x = (x ^ x >> 15).wrapping_mul(0x846c_a68b);
    x ^ x >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixels_samples_fill_every_elementary_box() {
        for pixel in 0..50 {
            for (columns, rows) in [(1, 16), (2, 8), (4, 4), (8, 2), (16, 1)] {
                let mut seen = [false; 16];
                for number in 0..16 {
                    let p = PixelSample::new(pixel * 7, pixel * 3, number).pair(SampleDimension::Key);
                    let cell = (p.x * columns as f32) as usize * rows + (p.y * rows as f32) as usize;
                    assert!(!seen[cell], "pixel {pixel}: two samples in one of {columns} x {rows} boxes");
                    seen[cell] = true;
                }
            }
        }
    }

    #[test]
    fn the_disc_is_filled_evenly() {
        let n = 4096;
        let points: Vec<_> =
            (0..n).map(|i| disc(PixelSample::new(i / 64, 9, i % 64).pair(SampleDimension::Rim))).collect();
        let mean = points.iter().sum::<Vec2>() / n as f32;
        let inner = points.iter().filter(|p| p.length_squared() < 0.5).count();
        assert!(points.iter().all(|p| p.length() < 1.000_001));
        assert!(mean.length() < 0.01 && inner.abs_diff(n as usize / 2) < 40, "{mean} {inner}");
    }

    #[test]
    fn uses_are_independent() {
        let (mut xx, mut xy) = (0.0, 0.0);
        let n = 4096;
        for i in 0..n {
            let sample = PixelSample::new(i / 64, 5, i % 64);
            let (a, b) = (sample.pair(SampleDimension::Key) - 0.5, sample.pair(SampleDimension::Ambient) - 0.5);
            xx += a.x * b.x;
            xy += a.x * b.y;
        }
        let variance = 1.0 / 12.0;
        assert!((xx / n as f32).abs() < 0.03 * variance && (xy / n as f32).abs() < 0.03 * variance, "{xx} {xy}");
    }
}
