//! Exact values that each case is compared with, from its own equation in f64.

pub mod column;
pub mod elastica;
pub mod oscillation;
pub mod plate;
pub mod string;

/// The x between `low` and `high` where `above` turns from false to true, halved until f64 has no more digits.
pub fn bisect(mut low: f64, mut high: f64, above: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        *(if above(middle) { &mut high } else { &mut low }) = middle;
    }
    0.5 * (low + high)
}

/// One step of the classical Runge-Kutta method for y' = f(t, y).
pub fn runge_kutta<const N: usize>(t: f64, h: f64, y: [f64; N], f: &impl Fn(f64, [f64; N]) -> [f64; N]) -> [f64; N] {
    let at = |k: [f64; N], by: f64| std::array::from_fn(|i| y[i] + k[i] * by);
    let one = f(t, y);
    let two = f(t + 0.5 * h, at(one, 0.5 * h));
    let three = f(t + 0.5 * h, at(two, 0.5 * h));
    let four = f(t + h, at(three, h));
    std::array::from_fn(|i| y[i] + h / 6.0 * (one[i] + 2.0 * (two[i] + three[i]) + four[i]))
}
