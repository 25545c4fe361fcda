//! Columns: when an upright strip gives way under its own weight and a load on its top.
//!
//! Near the straight state B theta'' + (P + w (L - s)) theta = 0, theta(0) = 0 at the clamp, theta'(L) = 0 at the free
//! top. Under its own weight alone that is Greenhill's column, under a load alone Euler's.

use std::f64::consts::PI;

use super::{bisect, runge_kutta};

/// Steps of the integration.
const STEPS: usize = 2_000;

/// Whether a clamped-free column with own weight Gamma = w L^3 / B and load p = P L^2 / B has given way.
fn gives_way(gamma: f64, p: f64) -> bool {
    let h = 1.0 / STEPS as f64;
    let rates = |t: f64, y: [f64; 2]| [y[1], -(gamma * t + p) * y[0]];
    let mut y = [1.0, 0.0];
    for k in 0..STEPS {
        y = runge_kutta(k as f64 * h, h, y, &rates);
        if y[0] < 0.0 {
            return true;
        }
    }
    false
}

/// Critical w L^3 / B of a clamped column under its own weight (Greenhill 1881).
pub fn greenhill() -> f64 {
    bisect(1.0, 20.0, |gamma| gives_way(gamma, 0.0))
}

/// Critical P L^2 / B of a clamped column with a free top whose own weight is `own` times the load.
pub fn loaded(own: f64) -> f64 {
    bisect(0.1, 10.0, |p| gives_way(own * p, p))
}

toile_base::named! {
    /// How the ends of a column are held, softest first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Ends {
        /// Clamped below, free above.
        Free = "free",
        /// Pinned at both ends.
        Pinned = "pinned",
        /// Clamped at one end, pinned at the other.
        ClampedPinned = "clamped-pinned",
        /// Clamped at both ends.
        Clamped = "clamped",
    }
}

impl Ends {
    /// Euler's critical P L^2 / B.
    pub fn critical(self) -> f64 {
        match self {
            Self::Free => 0.25 * PI * PI,
            Self::Pinned => PI * PI,
            // The first root of tan x = x, squared.
            Self::ClampedPinned => bisect(4.0, 4.7, |x| x.tan() > x).powi(2),
            Self::Clamped => 4.0 * PI * PI,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_give_way_at_the_tabled_loads() {
        assert!((greenhill() - 7.837).abs() < 1e-3);
        let tabled = [2.467, 9.870, 20.191, 39.478];
        for (ends, load) in Ends::ALL.into_iter().zip(tabled) {
            assert!((ends.critical() - load).abs() < 1e-3, "{ends:?}");
        }
        assert!((loaded(0.0) - Ends::Free.critical()).abs() < 1e-6);
    }

    #[test]
    fn own_weight_lowers_the_load_by_about_a_third_of_it() {
        assert!((loaded(0.1) * (1.0 + 0.3 * 0.1) / loaded(0.0) - 1.0).abs() < 0.01);
    }
}
