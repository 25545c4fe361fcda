//! Depth smoothed along surfaces: a separable bilateral filter (Tomasi and Manduchi 1998; separable after Pham and van
//! Vliet 2005) whose range is the sensor's own noise at each depth.
//!
//! Along rows first, then along columns of what came out. Each tap counts by a Gaussian of its distance and by Tukey's
//! parabola of its difference d, cut at `R = CUT sigma(z)`: `max(0, 1 - (d / R)^2)`. What differs by more than the noise
//! is another surface and counts nothing, so that edges stay where they are; what is symmetric around a pixel, as a
//! slope is, does not move it. Nothing measured (0) differs from every depth by more than any noise.
//!
//! All is plain `f32` in one order of additions, which the compiler turns into lanes; [`plain`] computes the same bits
//! pixel by pixel.

use super::noise::SensorNoise;

/// Taps on each side.
const REACH: usize = 4;
const TAPS: usize = 2 * REACH + 1;

/// Gaussian of the distance, deviation 2 px.
const WEIGHTS: [f32; TAPS] =
    [0.135_335_28, 0.324_652_47, 0.606_530_66, 0.882_496_9, 1.0, 0.882_496_9, 0.606_530_66, 0.324_652_47, 0.135_335_28];

/// The taps beside the pixel itself, which has weight 1 and no difference.
const OTHERS: [usize; TAPS - 1] = [0, 1, 2, 3, 5, 6, 7, 8];

/// Differences beyond this many deviations are edges. Two readings of one surface differ by 1.4 deviations.
const CUT: f32 = 4.0;

/// The edge-preserving filter; keeps its arrays from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct EdgePreserving {
    /// One row with [`REACH`] empty pixels on both sides.
    padded: Vec<f32>,
    /// The last [`TAPS`] rows smoothed along themselves, round and round.
    rows: Vec<f32>,
}

impl EdgePreserving {
    /// Smooths an image of `width` columns (mm, 0 = nothing) into `out` (mm, 0 where nothing was) `[depths]`.
    ///
    /// # Panics
    /// If the image has not a multiple of `width` pixels.
    pub fn run(&mut self, width: usize, depth_mm: &[u16], noise: &SensorNoise, out: &mut Vec<f32>) {
        assert!(width > 0 && depth_mm.len().is_multiple_of(width), "an image of full rows");
        let height = depth_mm.len() / width;
        out.resize(depth_mm.len(), 0.0);
        self.padded.clear();
        self.padded.resize(width + 2 * REACH, 0.0);
        self.rows.clear();
        self.rows.resize(width * TAPS, 0.0);
        // Row v of the result needs the smoothed rows up to v + REACH; below the image they are empty.
        for v in 0..height + REACH {
            let slot = v % TAPS * width;
            let row = &mut self.rows[slot..slot + width];
            if v < height {
                let raw = &depth_mm[v * width..(v + 1) * width];
                self.padded[REACH..REACH + width].iter_mut().zip(raw).for_each(|(p, d)| *p = f32::from(*d));
                along(&self.padded, noise, row);
            } else {
                row.fill(0.0);
            }
            if let Some(done) = v.checked_sub(REACH) {
                let taps = std::array::from_fn(|t| {
                    // Slots of rows above the image were never written and are empty.
                    let slot = (done + TAPS + t - REACH) % TAPS * width;
                    &self.rows[slot..slot + width]
                });
                across(taps, noise, &mut out[done * width..(done + 1) * width]);
            }
        }
    }
}

/// Smooths one row along itself.
fn along(padded: &[f32], noise: &SensorNoise, out: &mut [f32]) {
    let width = out.len();
    let taps: [&[f32]; TAPS] = std::array::from_fn(|t| &padded[t..t + width]);
    across(taps, noise, out);
}

/// Smooths the middle of nine rows across them, each pixel with those of the same column.
fn across(taps: [&[f32]; TAPS], noise: &SensorNoise, out: &mut [f32]) {
    let width = out.len();
    let taps = taps.map(|row| &row[..width]);
    let (least, growth, from) = (noise.least * 1e3, noise.growth * 1e-3, noise.from * 1e3);
    for x in 0..width {
        let here = taps[REACH][x];
        let beyond = here - from;
        let range = CUT * (least + growth * (beyond * beyond));
        // The parabola times the square of the range, which the quotient takes out again. The pixel itself counts most,
        // so that the total is never 0.
        let square = range * range;
        let (mut sum, mut total) = (0.0, square);
        for t in OTHERS {
            let d = taps[t][x] - here;
            let near = square - d * d;
            let weight = if near > 0.0 { near } else { 0.0 } * WEIGHTS[t];
            sum += weight * d;
            total += weight;
        }
        let smoothed = here + sum / total;
        out[x] = if here > 0.0 { smoothed } else { 0.0 };
    }
}

/// The same, written pixel by pixel without lanes, rings or padding: what the fast one is held to, bit for bit.
pub fn plain(width: usize, depth_mm: &[u16], noise: &SensorNoise) -> Vec<f32> {
    let height = depth_mm.len() / width;
    let raw: Vec<f32> = depth_mm.iter().map(|d| f32::from(*d)).collect();
    let tap = |image: &[f32], u: isize, v: isize| {
        let inside = u >= 0 && v >= 0 && (u as usize) < width && (v as usize) < height;
        if inside { image[v as usize * width + u as usize] } else { 0.0 }
    };
    let pass = |image: &[f32], [du, dv]: [isize; 2]| -> Vec<f32> {
        let pixel = |i: usize| {
            let (u, v) = ((i % width) as isize, (i / width) as isize);
            let here = image[i];
            if here == 0.0 {
                return 0.0;
            }
            let range = CUT * noise.sigma_mm(here);
            let square = range * range;
            let (mut sum, mut total) = (0.0f32, square);
            for (t, weight) in (-(REACH as isize)..).zip(WEIGHTS).filter(|(t, _)| *t != 0) {
                let d = tap(image, u + t * du, v + t * dv) - here;
                let near = square - d * d;
                if near > 0.0 {
                    sum += near * weight * d;
                    total += near * weight;
                }
            }
            here + sum / total
        };
        (0..image.len()).map(pixel).collect()
    };
    pass(&pass(&raw, [1, 0]), [0, 1])
}
