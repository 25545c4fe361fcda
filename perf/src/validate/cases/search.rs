//! Trials: searches for the value at which something gives way, and times at which something passes zero.

use crate::validate::case::CaseOutcome;
use crate::validate::specimen::SpecimenError;

/// Halvings of a search: the last interval is half a per cent of a factor of ten.
const HALVINGS: usize = 9;

/// The value between two at which a trial turns from holding to giving way, halving their ratio; `trial` gives what it
/// ran and whether it gave way. Ends at an end of the range if it never turns.
///
/// # Errors
/// As the trial.
pub fn threshold(
    range: [f64; 2],
    trial: impl Fn(f64) -> Result<(CaseOutcome, bool), SpecimenError>,
) -> Result<CaseOutcome, SpecimenError> {
    let [mut low, mut high] = range;
    let mut last = None;
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        let (outcome, gave) = trial(middle)?;
        *(if gave { &mut high } else { &mut low }) = middle;
        last = Some(outcome);
    }
    let got = (low * high).sqrt();
    Ok(last.map_or(CaseOutcome::none(got), |outcome| CaseOutcome { got, ..outcome }))
}

/// Times at which samples taken every `step` seconds from time 0 pass zero, between two samples along the straight line.
pub fn crossings(samples: &[f64], step: f64) -> Vec<f64> {
    let pairs = samples.windows(2).enumerate().filter(|(_, w)| w[0] * w[1] < 0.0 || (w[0] != 0.0 && w[1] == 0.0));
    pairs.map(|(k, w)| (k as f64 + w[0] / (w[0] - w[1])) * step).collect()
}

/// Mean period between the first and the last of some crossings, two a period; NaN where there are too few.
pub fn period(crossings: &[f64]) -> f64 {
    match crossings {
        [first, .., last] if crossings.len() > 2 => 2.0 * (last - first) / (crossings.len() - 1) as f64,
        _ => f64::NAN,
    }
}

/// Time of the highest of some samples, by the parabola through it and its neighbours.
pub fn peak(samples: &[f64], step: f64) -> f64 {
    let highest = samples.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(k, _)| k);
    if highest == 0 || highest + 1 >= samples.len() {
        return f64::NAN;
    }
    let [a, b, c] = [samples[highest - 1], samples[highest], samples[highest + 1]];
    (highest as f64 + 0.5 * (a - c) / (a - 2.0 * b + c)) * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_has_its_period_and_its_peak() {
        let samples: Vec<f64> = (0..400).map(|k| (0.05 * f64::from(k) + 0.3).sin()).collect();
        assert!((period(&crossings(&samples, 0.05)) - std::f64::consts::TAU).abs() < 1e-4);
        let first = &samples[..60];
        assert!((peak(first, 0.05) - (std::f64::consts::FRAC_PI_2 - 0.3)).abs() < 1e-4);
        assert!(period(&[1.0, 2.0]).is_nan() && peak(&[0.0, 1.0], 1.0).is_nan());
    }

    #[test]
    fn a_threshold_is_found_to_half_a_per_cent() {
        let found = threshold([1.0, 10.0], |x| Ok((CaseOutcome::none(x), x > 3.21))).unwrap();
        assert!((found.got / 3.21 - 1.0).abs() < 5e-3);
    }
}
