//! A printed texture: spots of many sizes and colours, from a seed.

use toile_base::numeric::random::SplitMix64;

/// Texels along a side.
const SIDE: usize = 2_048;

/// Spots of the finest size along a side; each coarser size has half as many.
const FINEST: usize = 96;

/// Sizes of spots, and the part of the places of each that have one, the finest first: larger ones show between smaller ones, so that
/// the print has something to follow at every distance.
const SIZES: usize = 4;
const COVER: [f32; SIZES] = [0.35, 0.5, 0.7, 1.0];

/// A picture that lies once on a surface, u and v from 0 to 1.
#[derive(Debug, Clone)]
pub struct Print {
    /// Red, green, blue, 0 to 1 `[SIDE x SIDE]`.
    texels: Vec<[f32; 3]>,
}

impl Print {
    /// The print of a seed.
    pub fn new(seed: u64) -> Self {
        let mut random = SplitMix64::new(seed);
        let mut texels = vec![[0.72, 0.70, 0.66]; SIDE * SIDE];
        for size in (0..SIZES).rev() {
            let along = FINEST >> size;
            let cell = SIDE as f32 / along as f32;
            for i in 0..along * along {
                if random.uniform() > COVER[size] {
                    continue;
                }
                let middle = [(i % along) as f32, (i / along) as f32].map(|k| (k + random.uniform()) * cell);
                let radius = cell * random.between(0.25, 0.6);
                let colour: [f32; 3] = std::array::from_fn(|_| random.between(0.08, 0.95));
                spot(&mut texels, middle, radius, colour);
            }
        }
        Self { texels }
    }

    /// The colour at a point, bilinear.
    pub fn at(&self, u: f32, v: f32) -> [f32; 3] {
        let at = |t: f32| (t.clamp(0.0, 1.0) * SIDE as f32 - 0.5).clamp(0.0, SIDE as f32 - 1.001);
        let (x, y) = (at(u), at(v));
        let (i, j) = (x as usize, y as usize);
        let (a, b) = (x - i as f32, y - j as f32);
        let texel = |i: usize, j: usize| self.texels[j * SIDE + i];
        let [p, q, r, s] = [texel(i, j), texel(i + 1, j), texel(i, j + 1), texel(i + 1, j + 1)];
        std::array::from_fn(|c| (p[c] * (1.0 - a) + q[c] * a) * (1.0 - b) + (r[c] * (1.0 - a) + s[c] * a) * b)
    }
}

/// A spot with an edge of two texels.
fn spot(texels: &mut [[f32; 3]], [x, y]: [f32; 2], radius: f32, colour: [f32; 3]) {
    let span = |c: f32| ((c - radius - 1.0).max(0.0) as usize)..((c + radius + 2.0) as usize).min(SIDE);
    for j in span(y) {
        for i in span(x) {
            let d = (i as f32 - x).hypot(j as f32 - y);
            let cover = ((radius - d) * 0.5 + 0.5).clamp(0.0, 1.0);
            for (t, c) in texels[j * SIDE + i].iter_mut().zip(colour) {
                *t += (c - *t) * cover;
            }
        }
    }
}
