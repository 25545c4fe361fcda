//! Oscillations: the plane pendulum at any amplitude, and the modes of a hanging chain.

use std::f64::consts::{FRAC_PI_2, PI};

use super::bisect;

/// Period of a pendulum let go at an angle (rad), over that of small swings: 1 / agm(1, cos(angle / 2)) (Gauss).
pub fn pendulum(angle: f64) -> f64 {
    let (mut a, mut g) = (1.0, (0.5 * angle).cos());
    for _ in 0..40 {
        (a, g) = (0.5 * (a + g), f64::sqrt(a * g));
    }
    1.0 / a
}

/// Bessel's J0 by its integral, (1/pi) int_0^pi cos(x sin t) dt: the trapezoidal rule is exact for periodic functions.
pub fn j0(x: f64) -> f64 {
    const STEPS: usize = 200;
    (0..STEPS).map(|k| (x * (PI * (k as f64 + 0.5) / STEPS as f64).sin()).cos()).sum::<f64>() / STEPS as f64
}

/// The n-th root of J0, n from 1: roots lie near (n - 1/4) pi.
pub fn j0_root(n: usize) -> f64 {
    let near = (n as f64 - 0.25) * PI;
    let rising = n.is_multiple_of(2);
    bisect(near - 0.25 * FRAC_PI_2, near + 0.5 * FRAC_PI_2, |x| (j0(x) > 0.0) == rising)
}

/// Frequency (Hz) of the n-th mode of a chain of a length (m) that hangs in gravity g (m/s2):
/// omega = j_0n / 2 sqrt(g / L) (Bernoulli 1732).
pub fn chain_mode_hz(n: usize, length: f64, g: f64) -> f64 {
    0.5 * j0_root(n) * (g / length).sqrt() / (2.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_and_modes_are_as_tabled() {
        for (degrees, ratio) in [(30.0f64, 1.01741), (60.0, 1.07318), (90.0, 1.18034), (120.0, 1.37288)] {
            assert!((pendulum(degrees.to_radians()) - ratio).abs() < 5e-6, "{degrees}");
        }
        for (n, hz) in [(1, 0.599), (2, 1.376), (3, 2.157)] {
            assert!((chain_mode_hz(n, 1.0, 9.81) - hz).abs() < 1e-3, "mode {n}: {}", chain_mode_hz(n, 1.0, 9.81));
        }
    }
}
