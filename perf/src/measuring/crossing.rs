//! Calibration by one family, judgement by another: the error that is added to what a fit states, set on people of one family so that
//! it holds for 68 of 100 of them, and how it then holds for people of the other.

use serde::Serialize;
use toile_base::numeric::statistics::quantile;
use toile_track::fit::measuring::{MEASURES, model_error};

use super::study::{MeasuringStudy, StatedError};

/// Share of a normal distribution within one standard deviation.
const ONE_SIGMA: f64 = 0.68;

/// Greatest error that is added, and the steps in which it is sought (mm).
const MOST_MM: f64 = 120.0;
const STEP_MM: f64 = 0.5;

/// How one measure's stated errors hold where another family has set them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CrossedMeasure {
    /// Name of the measure.
    pub measure: &'static str,
    /// Whether the shopper turned.
    pub turned: bool,
    /// The added error by the other family's people (mm).
    pub other_mm: f64,
    /// Share of truths within one stated standard deviation, and within two, with that.
    pub other_within: [f64; 2],
    /// The added error that ships (mm).
    pub ships_mm: f64,
    /// Shares with that.
    pub ships_within: [f64; 2],
}

/// How the errors stated of the people of `on` hold, calibrated by the people of `by`.
pub fn crossed(by: &[&MeasuringStudy], on: &[&MeasuringStudy]) -> Vec<CrossedMeasure> {
    let of = |studies: &[&MeasuringStudy], turned: bool, measure: usize| -> Vec<StatedError> {
        studies.iter().flat_map(|s| s.stated(turned)[measure].iter().copied()).collect()
    };
    let ways = [false, true].into_iter().flat_map(|turned| (0..MEASURES.len()).map(move |i| (turned, i)));
    ways.filter_map(|(turned, i)| {
        let (own, others) = (of(by, turned, i), of(on, turned, i));
        if own.is_empty() || others.is_empty() {
            return None;
        }
        let other_mm = calibrated(&own);
        let ships_mm = f64::from(model_error(turned)[i]) * 1e3;
        Some(CrossedMeasure {
            measure: MEASURES[i].0,
            turned,
            other_mm,
            other_within: [1.0, 2.0].map(|n| within(&others, other_mm, n)),
            ships_mm,
            ships_within: [1.0, 2.0].map(|n| within(&others, ships_mm, n)),
        })
    })
    .collect()
}

/// The least added error (mm) with which 68 of 100 lie within one standard deviation.
fn calibrated(errors: &[StatedError]) -> f64 {
    let steps = (0..=(MOST_MM / STEP_MM) as usize).map(|k| k as f64 * STEP_MM);
    steps.clone().find(|mm| within(errors, *mm, 1.0) >= ONE_SIGMA).unwrap_or(MOST_MM)
}

fn within(errors: &[StatedError], added_mm: f64, sigmas: f64) -> f64 {
    let inside = errors.iter().filter(|e| e.error_mm.abs() <= sigmas * e.own_mm.hypot(added_mm));
    inside.count() as f64 / errors.len().max(1) as f64
}

/// One decile of stated probabilities of being within a distance of the truth, and how often that held.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StatedDecile {
    /// Mean of the stated probabilities.
    pub stated: f64,
    /// Share that held.
    pub held: f64,
    /// Cases.
    pub cases: usize,
}

/// Half the step between two sizes of clothes (mm): 4 cm of girth.
const HALF_STEP_MM: f64 = 20.0;

/// How often a girth lies within half a size of the truth, against how probable that was stated, by deciles of the latter.
pub fn reliability(studies: &[&MeasuringStudy], turned: bool) -> Vec<StatedDecile> {
    let girths = MEASURES.iter().enumerate().filter(|(_, m)| m.0.ends_with("_girth")).map(|(i, _)| i);
    let mut cases: Vec<(f64, bool)> = Vec::new();
    for i in girths {
        let added = f64::from(model_error(turned)[i]) * 1e3;
        for e in studies.iter().flat_map(|s| &s.stated(turned)[i]) {
            let sigma = e.own_mm.hypot(added);
            cases.push((normal_within(HALF_STEP_MM / sigma), e.error_mm.abs() <= HALF_STEP_MM));
        }
    }
    let mut stated: Vec<f64> = cases.iter().map(|c| c.0).collect();
    let edges: Vec<f64> = (0..=10).filter_map(|k| quantile(&mut stated, f64::from(k) / 10.0)).collect();
    let bins = edges.windows(2).enumerate().map(|(k, edge)| {
        let of: Vec<&(f64, bool)> = cases.iter().filter(|c| c.0 >= edge[0] && (c.0 < edge[1] || k == 9)).collect();
        let n = of.len().max(1) as f64;
        StatedDecile {
            stated: of.iter().map(|c| c.0).sum::<f64>() / n,
            held: of.iter().filter(|c| c.1).count() as f64 / n,
            cases: of.len(),
        }
    });
    bins.filter(|b| b.cases > 0).collect()
}

/// Probability that a normal variable lies within so many standard deviations (Abramowitz and Stegun 7.1.26, off by 1.5e-7).
fn normal_within(sigmas: f64) -> f64 {
    let x = sigmas / std::f64::consts::SQRT_2;
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let terms = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    1.0 - terms.iter().rev().fold(0.0, |sum, c| (sum + c) * t) * (-x * x).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_calibrated_on_one_half_holds_on_the_other() {
        let of = |from: usize| -> Vec<StatedError> {
            let spread = |k: usize| 10.0 * (((k * 37 + from) % 100) as f64 / 50.0 - 1.0);
            (0..100).map(|k| StatedError { error_mm: spread(k), own_mm: 1.0 }).collect()
        };
        let added = calibrated(&of(0));
        assert!((6.0..8.0).contains(&added), "{added}");
        assert!((within(&of(11), added, 1.0) - 0.68).abs() < 0.03);
        assert_eq!(within(&of(11), added, 2.0), 1.0);
    }

    #[test]
    fn two_thirds_lie_within_one_standard_deviation() {
        assert!((normal_within(1.0) - 0.682_689_5).abs() < 1e-6);
        assert!((normal_within(2.0) - 0.954_499_7).abs() < 1e-6);
        assert!(normal_within(0.0).abs() < 1e-6);
    }
}
