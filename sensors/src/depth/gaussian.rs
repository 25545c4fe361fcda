//! The smoothing of Gultepe 2013, section 6.1: all that is not the shopper is filled with the shopper's mean depth
//! (equation 6.1), then the image is convolved with a Gaussian (equation 6.2), which blurs the outline on purpose.

/// Taps on each side, in deviations.
const REACH: f32 = 3.0;

/// Largest deviation (px).
const WIDEST: f32 = 16.0;

/// The seed's filter; keeps its arrays from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct Gaussian {
    filled: Vec<f32>,
    along: Vec<f32>,
    weights: Vec<f32>,
}

impl Gaussian {
    /// Smooths an image of `width` columns (mm, 0 = not the shopper) with a deviation (px, at most 16) into `out` (mm, 0
    /// where the shopper is not) `[depths]`. At the image's edge, its last pixel goes on.
    ///
    /// # Panics
    /// If the image has not a multiple of `width` pixels.
    pub fn run(&mut self, width: usize, depth_mm: &[u16], sigma: f32, out: &mut Vec<f32>) {
        assert!(width > 0 && depth_mm.len().is_multiple_of(width), "an image of full rows");
        let height = depth_mm.len() / width;
        let reach = self.set(sigma);
        self.fill(depth_mm);
        self.along.clear();
        self.along.resize(depth_mm.len(), 0.0);
        out.clear();
        out.resize(depth_mm.len(), 0.0);
        let clamp = |x: usize, t: usize, size: usize| (x + t).saturating_sub(reach).min(size - 1);
        for (row, along) in self.filled.chunks_exact(width).zip(self.along.chunks_exact_mut(width)) {
            for (t, weight) in self.weights.iter().enumerate() {
                for u in 0..width {
                    along[u] += weight * row[clamp(u, t, width)];
                }
            }
        }
        for v in 0..height {
            let out = &mut out[v * width..(v + 1) * width];
            for (t, weight) in self.weights.iter().enumerate() {
                let from = clamp(v, t, height) * width;
                out.iter_mut().zip(&self.along[from..from + width]).for_each(|(o, a)| *o += weight * a);
            }
        }
        out.iter_mut().zip(depth_mm).filter(|(_, d)| **d == 0).for_each(|(o, _)| *o = 0.0);
    }

    /// Weights of a deviation, their sum 1; gives the taps on each side.
    fn set(&mut self, sigma: f32) -> usize {
        let sigma = if sigma.is_finite() { sigma.clamp(0.1, WIDEST) } else { 0.1 };
        let reach = (sigma * REACH).ceil() as usize;
        let at = |t: usize| {
            let x = (t as f32 - reach as f32) / sigma;
            (-0.5 * x * x).exp()
        };
        self.weights.clear();
        self.weights.extend((0..=2 * reach).map(at));
        let sum: f32 = self.weights.iter().sum();
        self.weights.iter_mut().for_each(|w| *w /= sum);
        reach
    }

    /// The image with the shopper's mean depth where the shopper is not.
    fn fill(&mut self, depth_mm: &[u16]) {
        let (sum, count) =
            depth_mm.iter().filter(|d| **d != 0).fold((0u64, 0u64), |(s, n), d| (s + u64::from(*d), n + 1));
        let mean = sum as f32 / count.max(1) as f32;
        self.filled.clear();
        self.filled.extend(depth_mm.iter().map(|d| if *d == 0 { mean } else { f32::from(*d) }));
    }
}
