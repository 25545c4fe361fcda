//! The heavy elastica: a thin inextensible strip, clamped level at one end, bent by its own weight and a load at its tip.
//!
//! theta'' = -(Gamma (1 - s) + p) cos(theta), theta(0) = 0, theta'(1) = 0, with Gamma = w L^3 / B of its own weight w
//! (N/m2) and p = P L^2 / B of the tip's load P (N/m); theta is the angle below the horizontal (Romero et al. 2021,
//! "Physical validation of simulators in computer graphics"; with Gamma = 0 Euler's elastica).
//!
//! It is shot from the tip: with d = pi/2 - theta and t = 1 - s the equation is d'' = (Gamma t + p) sin(d), d'(0) = 0,
//! and d(1) grows with d(0). Under much weight d(0) is tiny, so that its logarithm is what is searched for.

use std::f64::consts::FRAC_PI_2;

use super::{bisect, runge_kutta};

/// Steps of the integration: its error is below 1e-9 up to Gamma = 1000.
const STEPS: usize = 4_000;

/// Least logarithm of the tip's angle to the vertical that is searched.
const LEAST_LOG: f64 = -80.0;

/// Where the tip comes to lie, in lengths of the strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tip {
    /// Depth of the tip below the clamp, in lengths of the strip (1).
    pub drop: f64,
    /// Away from the clamp.
    pub reach: f64,
}

impl Tip {
    /// Drop over reach: the H/W of the cantilever test.
    pub fn slope(self) -> f64 {
        self.drop / self.reach
    }
}

/// The tip under own weight `gamma` and tip load `p`.
pub fn tip(gamma: f64, p: f64) -> Tip {
    let log = bisect(LEAST_LOG, FRAC_PI_2.ln(), |log| shoot(gamma, p, log.exp())[0] > FRAC_PI_2);
    let [_, _, drop, reach] = shoot(gamma, p, log.exp());
    Tip { drop, reach }
}

/// d, d', drop and reach at the clamp for an angle of the tip to the vertical.
fn shoot(gamma: f64, p: f64, tip: f64) -> [f64; 4] {
    let h = 1.0 / STEPS as f64;
    let rates = |t: f64, y: [f64; 4]| {
        let (sin, cos) = y[0].sin_cos();
        [y[1], (gamma * t + p) * sin, cos, sin]
    };
    let mut y = [tip, 0.0, 0.0, 0.0];
    for k in 0..STEPS {
        y = runge_kutta(k as f64 * h, h, y, &rates);
        // Far beyond the level clamp nothing is asked any more.
        if y[0] > 2.0 {
            break;
        }
    }
    y
}

/// Peirce's overhang in bending lengths (B/w)^(1/3): how long a strip is whose chord hangs at an angle below the
/// horizontal (rad).
pub fn overhang(angle: f64) -> f64 {
    bisect(0.1, 10.0, |length| tip(length.powi(3), 0.0).slope() > angle.tan())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cantilever_has_the_tabled_slopes() {
        let table = [
            (0.1, 0.01250),
            (0.5, 0.06244),
            (1.0, 0.12456),
            (2.0, 0.24667),
            (5.0, 0.58572),
            (10.0, 1.0668),
            (20.0, 1.8639),
            (50.0, 3.7056),
            (100.0, 5.8881),
            (200.0, 8.9068),
            (500.0, 14.769),
            (1000.0, 21.335),
        ];
        for (gamma, slope) in table {
            let found = tip(gamma, 0.0).slope();
            assert!((found / slope - 1.0).abs() < 5e-4, "Gamma {gamma}: {found}, not {slope}");
        }
    }

    #[test]
    fn the_tip_loaded_elastica_has_the_tabled_tips() {
        let table = [
            (0.5, 0.16214, 0.98408),
            (1.0, 0.30172, 0.94357),
            (2.0, 0.49346, 0.83936),
            (5.0, 0.71379, 0.61237),
            (10.0, 0.81061, 0.44500),
        ];
        for (p, drop, reach) in table {
            let found = tip(0.0, p);
            assert!((found.drop - drop).abs() < 1e-5 && (found.reach - reach).abs() < 1e-5, "p {p}: {found:?}");
        }
    }

    #[test]
    fn peirces_overhang_is_two_bending_lengths() {
        assert!((overhang(41.5f64.to_radians()) - 2.0003).abs() < 5e-5);
    }
}
