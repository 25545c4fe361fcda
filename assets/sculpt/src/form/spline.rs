//! Natural cubic splines through the rows of a table.

/// Columns of a table row after its place.
pub(super) const WIDTH: usize = 8;

/// A curve of eight values over a place: it passes through every row, with continuous curvature, straight at the ends.
#[derive(Debug, Clone)]
pub(super) struct Spline {
    places: Vec<f32>,
    values: Vec<[f32; WIDTH]>,
    /// Second derivatives at the rows.
    bends: Vec<[f32; WIDTH]>,
}

impl Spline {
    /// Rows `[place, values]`, places rising.
    pub(super) fn new(rows: &[[f32; WIDTH + 1]]) -> Self {
        let places: Vec<f32> = rows.iter().map(|r| r[0]).collect();
        assert!(places.windows(2).all(|w| w[0] < w[1]), "the places of a table rise: {places:?}");
        let values: Vec<[f32; WIDTH]> = rows.iter().map(|r| std::array::from_fn(|k| r[k + 1])).collect();
        let mut bends = vec![[0.0; WIDTH]; rows.len()];
        for column in 0..WIDTH {
            for (bend, m) in bends.iter_mut().zip(natural(&places, |i| values[i][column])) {
                bend[column] = m;
            }
        }
        Self { places, values, bends }
    }

    /// First and last place.
    pub(super) fn range(&self) -> [f32; 2] {
        [self.places[0], self.places[self.places.len() - 1]]
    }

    /// Values at a place, and their slopes; beyond the ends the nearest row's.
    pub(super) fn at(&self, place: f32) -> ([f32; WIDTH], [f32; WIDTH]) {
        let [first, last] = self.range();
        let held = place.clamp(first, last);
        let i = (self.places.partition_point(|&x| x <= held).max(1) - 1).min(self.places.len() - 2);
        let h = self.places[i + 1] - self.places[i];
        let (a, b) = ((self.places[i + 1] - held) / h, (held - self.places[i]) / h);
        let mut out = [0.0; WIDTH];
        let mut slope = [0.0; WIDTH];
        for k in 0..WIDTH {
            let (y0, y1, m0, m1) = (self.values[i][k], self.values[i + 1][k], self.bends[i][k], self.bends[i + 1][k]);
            out[k] = a * y0 + b * y1 + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h * h / 6.0;
            slope[k] = (y1 - y0) / h + ((1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1) * h / 6.0;
        }
        if place == held { (out, slope) } else { (out, [0.0; WIDTH]) }
    }
}

/// Second derivatives of the natural spline, by the tridiagonal system of its continuity.
fn natural(x: &[f32], y: impl Fn(usize) -> f32) -> Vec<f32> {
    let n = x.len();
    let mut m = vec![0.0; n];
    let (mut upper, mut right) = (vec![0.0f32; n], vec![0.0f32; n]);
    for i in 1..n - 1 {
        let (h0, h1) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        let jump = 6.0 * ((y(i + 1) - y(i)) / h1 - (y(i) - y(i - 1)) / h0);
        let pivot = 2.0 * (h0 + h1) - h0 * upper[i - 1];
        upper[i] = h1 / pivot;
        right[i] = (jump - h0 * right[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        m[i] = right[i] - upper[i] * m[i + 1];
    }
    m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_through_its_rows_and_keeps_straight_lines() {
        let row = |x: f32, y: f32| [x, y, 2.0 * x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let spline = Spline::new(&[row(0.0, 1.0), row(1.0, 3.0), row(3.0, -1.0), row(4.0, 0.0)]);
        for (x, y) in [(0.0, 1.0), (1.0, 3.0), (3.0, -1.0), (4.0, 0.0)] {
            assert!((spline.at(x).0[0] - y).abs() < 1e-5);
        }
        for x in [0.3, 1.7, 2.9, 3.5] {
            let (value, slope) = spline.at(x);
            assert!((value[1] - 2.0 * x).abs() < 1e-5 && (slope[1] - 2.0).abs() < 1e-5);
            let ahead = spline.at(x + 1e-3).0[0];
            assert!(((ahead - value[0]) / 1e-3 - slope[0]).abs() < 2e-2);
        }
        assert_eq!(spline.at(9.0).0[0], 0.0);
    }
}
