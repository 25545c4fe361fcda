//! Differences of heads from the mannequin's: the covariance of displacements at two places of a head, and the most likely field given
//! observations of it.

use glam::{DMat3, DVec3};

/// Standard deviation of the smooth part of the field (m), and the reach of its radial function (m).
const SMOOTH: f64 = 0.006;
const REACH: f64 = 0.075;

/// The same for what is finer.
const FINE: f64 = 0.002;
const FINE_REACH: f64 = 0.030;

/// Standard deviation of the affine part: of a change of place a metre of head (1).
const AFFINE: f64 = 0.06;

/// Share of the variance that both sides have in common: heads are nearly symmetric.
const SYMMETRIC: f64 = 0.92;

/// A smooth function of compact support, 1 at 0 and 0 from 1 on (Wendland 1995, C2 in three dimensions).
pub(super) fn wendland(x: f64) -> f64 {
    if x >= 1.0 { 0.0 } else { (1.0 - x).powi(4) * (4.0 * x + 1.0) }
}

/// Covariance of the displacements along any one axis at two places (m2), places counted from the middle of the head.
fn plain(a: DVec3, b: DVec3) -> f64 {
    let apart = a.distance(b);
    SMOOTH * SMOOTH * wendland(apart / REACH) + FINE * FINE * wendland(apart / FINE_REACH) + AFFINE * AFFINE * a.dot(b)
}

/// Covariance of the displacements at two places (m2): alike beside each other, and mirrored across the middle.
pub(super) fn covariance(a: DVec3, b: DVec3) -> DMat3 {
    let mirror = DVec3::new(-1.0, 1.0, 1.0);
    let own = plain(a, b);
    let across = plain(a, b * mirror);
    // Both halves of a symmetric field: (d(x) + M d(M x)) / 2, scaled to keep its variance.
    let half = 0.5 * SYMMETRIC;
    let same = DVec3::splat((half + 1.0 - SYMMETRIC) * own);
    DMat3::from_diagonal(same + mirror * (half * across))
}

/// An observation of the field: along `along` (a unit of what is observed a metre) at a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observation {
    /// The place, from the middle of the head (m).
    pub place: DVec3,
    /// How what is observed changes with the displacement there.
    pub along: DVec3,
    /// What was observed, with its standard deviation.
    pub value: f64,
    pub sigma: f64,
}

/// The most likely field: a sum of the prior's functions around the observations.
#[derive(Debug, Clone, Default)]
pub(super) struct OffsetField {
    parts: Vec<(DVec3, DVec3)>,
}

impl OffsetField {
    /// Of all observations together.
    pub(super) fn of(observations: &[Observation]) -> Self {
        let n = observations.len();
        let mut matrix = vec![vec![0.0; n]; n];
        for (i, a) in observations.iter().enumerate() {
            for (j, b) in observations.iter().enumerate().take(i + 1) {
                matrix[i][j] = a.along.dot(covariance(a.place, b.place) * b.along);
            }
            matrix[i][i] += a.sigma * a.sigma;
        }
        let mut weights: Vec<f64> = observations.iter().map(|o| o.value).collect();
        solve(&mut matrix, &mut weights);
        Self { parts: observations.iter().zip(weights).map(|(o, w)| (o.place, o.along * w)).collect() }
    }

    /// The displacement at a place (m).
    pub(super) fn at(&self, place: DVec3) -> DVec3 {
        self.parts.iter().map(|(from, by)| covariance(place, *from) * *by).sum()
    }
}

/// Solves a symmetric positive system in place by Cholesky's factors; the lower triangle is read.
pub(super) fn solve(a: &mut [Vec<f64>], x: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| a[i][k] * a[j][k]).sum();
            let rest = a[i][j] - dot;
            a[i][j] = if i == j { rest.max(1e-18).sqrt() } else { rest / a[j][j] };
        }
    }
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| a[i][k] * x[k]).sum();
        x[i] = (x[i] - dot) / a[i][i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| a[k][i] * x[k]).sum();
        x[i] = (x[i] - dot) / a[i][i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_goes_through_what_is_surely_observed_and_is_nearly_the_same_on_both_sides() {
        let place = DVec3::new(0.04, -0.02, 0.08);
        let observed = DVec3::new(0.003, -0.002, 0.004);
        let of = |along: DVec3, value: f64| Observation { place, along, value, sigma: 1e-6 };
        let field = OffsetField::of(&[of(DVec3::X, observed.x), of(DVec3::Y, observed.y), of(DVec3::Z, observed.z)]);
        assert!(field.at(place).distance(observed) < 1e-5);
        let mirror = DVec3::new(-1.0, 1.0, 1.0);
        let other = field.at(place * mirror);
        assert!(other.distance(observed * mirror) < 0.3 * observed.length(), "{other}");
        assert!(field.at(DVec3::new(0.0, 0.05, -0.08)).length() < 0.7 * observed.length());
    }
}
