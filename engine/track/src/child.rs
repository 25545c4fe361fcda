//! Estimates from the stature whether a shopper is a child; it changes no measure.

use toile_assets::sizes::Population;

use crate::estimate::Estimate;
use crate::tape_readings;

/// Median stature of children of 4 to 13 years, year by year (m): the mean of girls and boys of the growth charts of the CDC (2000).
const MEDIANS: [f32; 10] = [1.02, 1.09, 1.15, 1.22, 1.28, 1.33, 1.38, 1.44, 1.50, 1.57];

/// How far children of one age differ, as a share of their stature (standard deviation; the same charts: 4.3 to 4.9 %).
const SPREAD: f32 = 0.046;

/// Children among those who step before a camera in a shop for adults.
const AMONG_SHOPPERS: f32 = 0.05;

/// How likely a person of this stature (m) is a child of 4 to 13 years rather than an adult, 0 to 1.
pub fn child_odds(stature: Estimate) -> f32 {
    let density = |mean: f32, sigma: f32| {
        let sigma = sigma.hypot(stature.sigma);
        (-0.5 * ((stature.value - mean) / sigma).powi(2)).exp() / sigma
    };
    let child = MEDIANS.iter().map(|m| density(*m, SPREAD * m)).sum::<f32>() / MEDIANS.len() as f32;
    let adults = [Population::Women, Population::Men].map(|p| tape_readings::population(p).at(0));
    let adult = adults.iter().map(|a| density(a.value, a.sigma)).sum::<f32>() / adults.len() as f32;
    let (child, adult) = (AMONG_SHOPPERS * child, (1.0 - AMONG_SHOPPERS) * adult);
    // Beyond both kinds of people the nearer one: far below all children is a child, far above all adults is none.
    if child + adult > f32::MIN_POSITIVE { child / (child + adult) } else { f32::from(stature.value < MEDIANS[0]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shorter_the_likelier_a_child() {
        let at = |stature: f32| child_odds(Estimate::new(stature, 0.006));
        assert!(at(1.20) > 0.99 && at(0.3) == 1.0, "{} {}", at(1.20), at(0.3));
        assert!(at(1.63) < 0.03 && at(1.80) < 1e-3 && at(3.0) < 1e-3, "{} {} {}", at(1.63), at(1.80), at(3.0));
        // A small woman may be taken for a child, which is why it moves nothing.
        assert!((0.1..0.9).contains(&at(1.47)), "{}", at(1.47));
        let odds: Vec<f32> = (10..18).map(|dm| at(dm as f32 * 0.1)).collect();
        assert!(odds.windows(2).all(|w| w[0] >= w[1]), "{odds:?}");
        // Who is not measured well is not known well.
        assert!(child_odds(Estimate::new(1.20, 0.2)) < at(1.20));
    }
}
