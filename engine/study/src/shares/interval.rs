//! Shares with intervals by the bootstrap: people are counted again as often as chance has it, each with their weight.
//!
//! A person is counted k times with the probability of Poisson(1) (Hanley and MacGibbon 2006), by seed and number, which for many people
//! is the same as drawing as many of them with replacement.

use serde::Serialize;

use crate::population::{Purpose, generator};

/// How often people are counted again.
const REPLICATES: usize = 200;

/// Most groups that people are counted in: of more people, each group stands for several.
const MOST_GROUPS: usize = 20_000;

/// A share of people, and the interval in which 95 of 100 such studies would have it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Share {
    /// The share, weights counted (0..1).
    pub share: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// How often each group is counted in each replicate.
pub(super) struct Bootstrap {
    counts: Vec<Vec<u8>>,
    groups: usize,
}

impl Bootstrap {
    /// For so many people.
    pub fn new(people: usize, seed: u64) -> Self {
        let groups = people.min(MOST_GROUPS);
        let one = |replicate: usize| {
            let mut random = generator(seed, Purpose::Resample, replicate as u64);
            (0..groups).map(|_| poisson(random.uniform_f64())).collect()
        };
        Self { counts: (0..REPLICATES).map(one).collect(), groups }
    }

    /// The mean of values over people, each with the weight beside it (value x weight, weight), in the order of the people.
    pub fn mean(&self, all: impl Iterator<Item = (f64, f64)>) -> Share {
        let mut sums = vec![(0.0, 0.0); self.groups.max(1)];
        for (i, (value, weight)) in all.enumerate() {
            let sum = &mut sums[i % self.groups.max(1)];
            *sum = (sum.0 + value, sum.1 + weight);
        }
        let ratio = |(value, weight): (f64, f64)| if weight > 0.0 { value / weight } else { 0.0 };
        let all = |counts: &Vec<u8>| {
            let counted = counts.iter().zip(&sums);
            counted.fold((0.0, 0.0), |(v, w), (n, s)| (v + f64::from(*n) * s.0, w + f64::from(*n) * s.1))
        };
        let mut found: Vec<f64> = self.counts.iter().map(|counts| ratio(all(counts))).collect();
        found.sort_by(f64::total_cmp);
        let share = ratio(sums.iter().fold((0.0, 0.0), |(v, w), s| (v + s.0, w + s.1)));
        let at = |quantile: f64| found[((REPLICATES - 1) as f64 * quantile).round() as usize];
        Share { share, low: at(0.025).min(share), high: at(0.975).max(share) }
    }
}

/// The quantile of Poisson(1).
fn poisson(uniform: f64) -> u8 {
    let (mut k, mut term) = (0u8, (-1.0f64).exp());
    let mut below = term;
    while uniform >= below && k < 12 {
        k += 1;
        term /= f64::from(k);
        below += term;
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_as_wide_as_a_share_of_so_many_people_is_uncertain() {
        let people = 1000;
        let bootstrap = Bootstrap::new(people, 3);
        let share = bootstrap.mean((0..people).map(|i| (f64::from(u8::from(i % 4 == 0)), 1.0)));
        let sigma = (0.25f64 * 0.75 / people as f64).sqrt();
        assert!((share.share - 0.25).abs() < 1e-12);
        let width = share.high - share.low;
        assert!((width / (2.0 * 1.96 * sigma) - 1.0).abs() < 0.25, "{width}");
        // Nine of ten such intervals and more hold the truth.
        let holds = |seed: u64| {
            let mut random = generator(seed, Purpose::Person, 0);
            let drawn: Vec<(f64, f64)> =
                (0..300).map(|_| (f64::from(u8::from(random.uniform_f64() < 0.3)), 1.0)).collect();
            let found = Bootstrap::new(300, seed).mean(drawn.into_iter());
            (found.low..=found.high).contains(&0.3)
        };
        let held = (0..100).filter(|seed| holds(*seed)).count();
        assert!(held >= 88, "{held}");
    }

    #[test]
    fn a_weight_counts_as_so_many_people_and_of_one_person_nothing_is_uncertain() {
        let share = Bootstrap::new(2, 1).mean([(3.0, 3.0), (0.0, 1.0)].into_iter());
        assert_eq!(share.share, 0.75);
        assert!(share.low >= 0.0 && share.high <= 1.0);
        assert_eq!((0..5).map(|i| poisson([0.0, 0.4, 0.8, 0.95, 0.99][i])).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
    }
}
