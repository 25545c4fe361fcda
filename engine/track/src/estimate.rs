//! A measured length and its uncertainty.

use toile_base::numeric::statistics::median_of;

/// A length with the standard deviation of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The length (m).
    pub value: f32,
    /// Standard deviation of the error (m), model and sensor included.
    pub sigma: f32,
}

impl Estimate {
    /// A length known to within `sigma`, both in metres.
    pub const fn new(value: f32, sigma: f32) -> Self {
        Self { value, sigma }
    }

    /// Two independent estimates of one length, weighted by inverse variance.
    pub fn fuse(self, other: Self) -> Self {
        let (a, b) = (self.sigma.powi(-2), other.sigma.powi(-2));
        Self { value: (a * self.value + b * other.value) / (a + b), sigma: (a + b).sqrt().recip() }
    }

    /// The same with an independent error added.
    pub fn widened(self, sigma: f32) -> Self {
        Self { sigma: self.sigma.hypot(sigma), ..self }
    }
}

/// A sample farther from the median than this many robust standard deviations is an outlier.
const OUTLIER: f32 = 3.0;

/// Median absolute deviation of a normal distribution times this is its standard deviation.
const MAD_TO_SIGMA: f32 = 1.4826;

/// Mean of a parameter over the frames of one second, without outliers, and the standard error of that mean
/// (Gultepe 2013, section 6.4, averages the parameters and not the depth, because no person stands still for a second;
/// the outliers are our addition). `None` without samples; one sample has no scatter and gets error 0.
pub fn temporal_mean(samples: &[f32]) -> Option<Estimate> {
    let mut sorted: Vec<f32> = samples.iter().copied().filter(|s| s.is_finite()).collect();
    sorted.sort_by(f32::total_cmp);
    let median = median_of(sorted.iter().copied())?;
    let spread = median_of(sorted.iter().map(|s| (s - median).abs()))?;
    // A frame or two alike make the deviation zero; a millimetre keeps their neighbours.
    let reach = OUTLIER * (MAD_TO_SIGMA * spread).max(1e-3);
    let kept: Vec<f32> = sorted.into_iter().filter(|s| (s - median).abs() <= reach).collect();
    let n = kept.len() as f32;
    let mean = kept.iter().sum::<f32>() / n;
    let variance = kept.iter().map(|s| (s - mean).powi(2)).sum::<f32>() / (n - 1.0).max(1.0);
    Some(Estimate { value: mean, sigma: (variance / n).sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fusing_trusts_the_surer_one_and_is_surer_than_both() {
        let both = Estimate::new(1.0, 0.01).fuse(Estimate::new(1.1, 0.1));
        assert!((both.value - 1.000_99).abs() < 1e-4, "{both:?}");
        assert!(both.sigma < 0.01);
    }

    #[test]
    fn one_wild_frame_does_not_move_the_mean() {
        let mut samples = vec![1.70, 1.71, 1.69, 1.70, 1.705, 1.695, 1.70];
        let calm = temporal_mean(&samples).unwrap();
        samples.extend([2.4, f32::NAN]);
        let wild = temporal_mean(&samples).unwrap();
        assert!((wild.value - calm.value).abs() < 1e-6, "{wild:?} {calm:?}");
        assert!(temporal_mean(&[]).is_none());
    }
}
