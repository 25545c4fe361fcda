//! Several lengths of one body with the covariance of their errors, and the update of the others by one that becomes known.

use crate::estimate::Estimate;

/// `N` lengths whose errors go together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correlated<const N: usize> {
    /// The lengths (m).
    pub mean: [f32; N],
    /// Covariance of their errors (m2), symmetric.
    pub covariance: [[f32; N]; N],
}

impl<const N: usize> Correlated<N> {
    /// One of the lengths with its standard deviation.
    pub fn at(&self, index: usize) -> Estimate {
        Estimate::new(self.mean[index], self.covariance[index][index].max(0.0).sqrt())
    }

    /// All of them.
    pub fn estimates(&self) -> [Estimate; N] {
        std::array::from_fn(|i| self.at(i))
    }

    /// The same once one of them is measured otherwise: all others follow as far as their errors go with its own (the update of a
    /// Kalman filter with one scalar measurement).
    pub fn observed(&self, index: usize, seen: Estimate) -> Self {
        let column: [f32; N] = std::array::from_fn(|i| self.covariance[i][index]);
        let variance = column[index] + seen.sigma * seen.sigma;
        let off = seen.value - self.mean[index];
        Self {
            mean: std::array::from_fn(|i| self.mean[i] + column[i] / variance * off),
            covariance: std::array::from_fn(|i| {
                std::array::from_fn(|j| self.covariance[i][j] - column[i] * column[j] / variance)
            }),
        }
    }

    /// A mixture, each part with its share: mean, and the covariance within and between the parts.
    pub fn mixed(parts: &[(f32, Self)]) -> Self {
        let mean = std::array::from_fn(|i| parts.iter().map(|(w, p)| w * p.mean[i]).sum());
        let between = |p: &Self, i: usize, j: usize| (p.mean[i] - mean_of(parts, i)) * (p.mean[j] - mean_of(parts, j));
        let covariance = std::array::from_fn(|i| {
            std::array::from_fn(|j| parts.iter().map(|(w, p)| w * (p.covariance[i][j] + between(p, i, j))).sum())
        });
        Self { mean, covariance }
    }
}

fn mean_of<const N: usize>(parts: &[(f32, Correlated<N>)], index: usize) -> f32 {
    parts.iter().map(|(w, p)| w * p.mean[index]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_told_moves_what_goes_with_it_and_nothing_else() {
        let known = Correlated::<3> {
            mean: [1.0, 0.8, 0.4],
            covariance: [[4e-4, 2e-4, 0.0], [2e-4, 4e-4, 0.0], [0.0, 0.0, 1e-4]],
        };
        let then = known.observed(0, Estimate::new(1.04, 0.0));
        assert!((then.mean[0] - 1.04).abs() < 1e-6 && then.at(0).sigma < 1e-4);
        assert!((then.mean[1] - 0.82).abs() < 1e-6, "half of the way with a correlation of a half");
        assert!(then.at(1).sigma < known.at(1).sigma && then.at(2) == known.at(2));
        // An observation of large error moves less.
        assert!(known.observed(0, Estimate::new(1.04, 0.02)).mean[0] < 1.021);
    }

    #[test]
    fn a_mixture_is_as_wide_as_its_parts_lie_apart() {
        let part = |mean: f32| Correlated::<1> { mean: [mean], covariance: [[1e-4]] };
        let both = Correlated::mixed(&[(0.5, part(1.0)), (0.5, part(1.1))]);
        assert!((both.mean[0] - 1.05).abs() < 1e-6);
        assert!((both.covariance[0][0] - (1e-4 + 2.5e-3)).abs() < 1e-6);
    }
}
