//! Strings without stiffness: the catenary, and the rope around a post.

use std::f64::consts::PI;

use super::{bisect, runge_kutta};

/// A string of own weight between two points of equal height, one unit apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Catenary {
    /// How far its middle hangs below its ends, in spans.
    pub sag: f64,
    /// Its horizontal tension over its weight.
    pub tension: f64,
}

/// The catenary of a length in spans (above 1): 2 a sinh(1 / 2a) = length.
pub fn catenary(length: f64) -> Catenary {
    let a = bisect(0.02, 100.0, |a| 2.0 * a * (0.5 / a).sinh() < length);
    Catenary { sag: a * ((0.5 / a).cosh() - 1.0), tension: a / length }
}

/// Ratio of the two pulls at which a rope slips around a post: e^(mu angle) (Eytelwein, Euler).
pub fn capstan(mu: f64, angle: f64) -> f64 {
    (mu * angle).exp()
}

/// The same over the upper half of a post for a rope whose own weight there counts: `own` is w R / T1, the weight of a
/// length of one radius over the lighter pull. At the angle a from the lighter side the post bears T + w R sin(a) a radian,
/// and the rope slips where dT/da = mu (T + w R sin a) + w R cos a.
pub fn capstan_heavy(mu: f64, own: f64) -> f64 {
    const STEPS: usize = 2_000;
    let h = PI / STEPS as f64;
    let rates = |a: f64, t: [f64; 1]| [mu * (t[0] + own * a.sin()) + own * a.cos()];
    (0..STEPS).fold([1.0], |t, k| runge_kutta(k as f64 * h, h, t, &rates))[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn catenaries_and_posts_are_as_tabled() {
        let table =
            [(1.05, 0.13930, 0.87585), (1.2, 0.29234, 0.39129), (1.5, 0.50263, 0.20549), (2.0, 0.79639, 0.11482)];
        for (length, sag, tension) in table {
            let found = catenary(length);
            assert!((found.sag - sag).abs() < 1e-5 && (found.tension - tension).abs() < 1e-5, "{length}: {found:?}");
        }
        assert!((capstan_heavy(0.3, 0.0) - capstan(0.3, PI)).abs() < 1e-9 && capstan_heavy(0.3, 0.1) > 2.6);
        assert!((capstan(0.3, PI) - 2.566).abs() < 1e-3 && (capstan(0.3, 2.0 * PI) - 6.586).abs() < 1e-3);
    }
}
