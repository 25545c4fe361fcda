//! Lateral buckling of a plate that stands on edge, clamped at one short side, under its own weight.
//!
//! Ritz's method: w(x, y) = x^2 sum a_ij x^i y^j over 0 < x < 1, -b/2 < y < b/2 (lengths in L). The plate's energy is
//! D/2 int (w_xx + w_yy)^2 - 2 (1 - nu)(w_xx w_yy - w_xy^2); the membrane forces of its own weight, those of a beam
//! (Timoshenko and Goodier, "Theory of elasticity", art. 22; per Gamma D / L^2),
//! N_xx = 6 (1-x)^2 y / b^2, N_xy = 6 (1-x)(y^2 - b^2/4) / b^2, N_yy = y + 6 (y^3/3 - b^2 y/4) / b^2,
//! add Gamma/2 int N_xx w_x^2 + 2 N_xy w_x w_y + N_yy w_y^2. It gives way where the sum is no longer positive definite,
//! which Cholesky's factorisation shows.

use toile_base::numeric::linear;
use toile_base::numeric::linear::Pivot;

use super::bisect;

/// Powers of x and of y; with one more each the result moves by less than a thousandth.
const X: usize = 6;
const Y: usize = 5;
const N: usize = X * Y;

/// Gauss points a direction: exact for the polynomials that occur.
const POINTS: usize = 12;

/// Critical Gamma = w L^3 / D of a plate of a width (in lengths) and Poisson's ratio.
pub fn critical(width: f64, nu: f64) -> f64 {
    let (stiff, load) = matrices(width, nu);
    bisect(1.0, 200.0, |gamma| !positive(&stiff, &load, gamma))
}

/// The limit of a narrow plate: 12.854 (1 - nu^2) sqrt(2 / (1 + nu)).
pub fn narrow(nu: f64) -> f64 {
    12.854 * (1.0 - nu * nu) * (2.0 / (1.0 + nu)).sqrt()
}

type Matrix = Vec<[f64; N]>;

fn matrices(b: f64, nu: f64) -> (Matrix, Matrix) {
    let (mut stiff, mut load) = (vec![[0.0; N]; N], vec![[0.0; N]; N]);
    for (px, wx) in gauss() {
        for (py, wy) in gauss() {
            let (x, y, area) = (0.5 * (px + 1.0), 0.5 * b * py, 0.25 * b * wx * wy);
            let shapes: Vec<[f64; 5]> = (0..N).map(|k| derivatives(k / Y, k % Y, x, y, b)).collect();
            let out = 1.0 - x;
            let nxx = 6.0 * out * out * y / (b * b);
            let nxy = 6.0 * out * (y * y - 0.25 * b * b) / (b * b);
            let nyy = y + 6.0 * (y.powi(3) / 3.0 - 0.25 * b * b * y) / (b * b);
            for (i, f) in shapes.iter().enumerate() {
                for (j, g) in shapes.iter().enumerate() {
                    let curved =
                        (f[2] + f[3]) * (g[2] + g[3]) - (1.0 - nu) * (f[2] * g[3] + f[3] * g[2] - 2.0 * f[4] * g[4]);
                    stiff[i][j] += area * curved;
                    load[i][j] += area * (nxx * f[0] * g[0] + nxy * (f[0] * g[1] + f[1] * g[0]) + nyy * f[1] * g[1]);
                }
            }
        }
    }
    (stiff, load)
}

/// w_x, w_y, w_xx, w_yy, w_xy of x^(2+i) (2y/b)^j.
fn derivatives(i: usize, j: usize, x: f64, y: f64, b: f64) -> [f64; 5] {
    let scale = 2.0 / b;
    let power = |base: f64, n: usize, d: usize| {
        let factor = (0..d).map(|k| n as f64 - k as f64).product::<f64>();
        if n < d { 0.0 } else { factor * base.powi((n - d) as i32) }
    };
    let f = |d| power(x, i + 2, d);
    let g = |d: usize| power(y * scale, j, d) * scale.powi(d as i32);
    [f(1) * g(0), f(0) * g(1), f(2) * g(0), f(0) * g(2), f(1) * g(1)]
}

/// Whether stiff + gamma load is positive definite.
fn positive(stiff: &Matrix, load: &Matrix, gamma: f64) -> bool {
    let mut sum = stiff.clone();
    sum.iter_mut().flatten().zip(load.iter().flatten()).for_each(|(s, l)| *s += gamma * l);
    linear::factor(&mut sum, Pivot::Positive).is_some()
}

/// Points and weights of Gauss-Legendre quadrature on -1 .. 1: roots of the Legendre polynomial by Newton's method.
fn gauss() -> [(f64, f64); POINTS] {
    std::array::from_fn(|k| {
        let n = POINTS as f64;
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut p, mut before) = (x, 1.0);
            for m in 2..=POINTS {
                let m = m as f64;
                (p, before) = (((2.0 * m - 1.0) * x * p - (m - 1.0) * before) / m, p);
            }
            slope = n * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plates_give_way_at_the_tabled_weights() {
        let widths = [0.1, 0.2, 0.3, 0.5];
        for (nu, limit, table) in
            [(0.0, 18.18, [19.41, 20.67, 22.05, 25.00]), (0.3, 14.51, [15.68, 17.02, 18.50, 21.66])]
        {
            assert!((narrow(nu) / limit - 1.0).abs() < 1e-3);
            for (width, gamma) in widths.into_iter().zip(table) {
                let found = critical(width, nu);
                assert!((found / gamma - 1.0).abs() < 0.02, "nu {nu}, width {width}: {found}, not {gamma}");
            }
        }
    }
}
