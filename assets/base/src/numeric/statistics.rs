//! Median and quantile of a sample.
//!
//! Both are inverses of the sample's distribution function (Hyndman and Fan 1996, "Sample quantiles in statistical
//! packages"). A quantile is one of the values: the one below which at least the given share of all values ranks. Where a
//! share falls exactly between two values (half of an even number), [`quantile`] gives the upper one and [`median`] the
//! mean of both (their definition 2). NaN ranks above infinity, by IEEE 754's total order, so that nothing here panics.

use std::cmp::Ordering;

/// A number that can be ranked and averaged.
pub trait Sample: Copy {
    /// The order of two numbers; total, NaN included.
    fn order(&self, other: &Self) -> Ordering;

    /// The number halfway to another; whole numbers round down.
    fn halfway(self, other: Self) -> Self;
}

macro_rules! float_sample {
    ($($float:ty),+) => {$(
        impl Sample for $float {
            fn order(&self, other: &Self) -> Ordering {
                self.total_cmp(other)
            }

            fn halfway(self, other: Self) -> Self {
                0.5 * (self + other)
            }
        }
    )+};
}
float_sample!(f32, f64);

impl Sample for u64 {
    fn order(&self, other: &Self) -> Ordering {
        self.cmp(other)
    }

    fn halfway(self, other: Self) -> Self {
        self.midpoint(other)
    }
}

/// Place of a quantile among `count` sorted values: floor(share * count), at most the last. For a sample that is sorted
/// already, or of which several quantiles are wanted.
pub fn rank(count: usize, share: f64) -> usize {
    // The small addend makes 0.29 * 100 the whole number that it stands for.
    ((share * count as f64 + 1e-9) as usize).min(count.saturating_sub(1))
}

/// The value below which a share (0 to 1) of the values ranks; `None` of nothing. Reorders the values.
pub fn quantile<T: Sample>(values: &mut [T], share: f64) -> Option<T> {
    let rank = rank(values.len(), share);
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(rank, T::order).1)
}

/// The middle value, or the mean of the two middle ones; `None` of nothing. Reorders the values.
pub fn median<T: Sample>(values: &mut [T]) -> Option<T> {
    let (count, upper) = (values.len(), quantile(values, 0.5)?);
    if count % 2 == 1 {
        return Some(upper);
    }
    let lower = values[..count / 2].iter().copied().max_by(T::order)?;
    Some(lower.halfway(upper))
}

/// [`quantile`] of what an iterator gives.
pub fn quantile_of<T: Sample>(values: impl IntoIterator<Item = T>, share: f64) -> Option<T> {
    quantile(&mut values.into_iter().collect::<Vec<T>>(), share)
}

/// [`median`] of what an iterator gives.
pub fn median_of<T: Sample>(values: impl IntoIterator<Item = T>) -> Option<T> {
    median(&mut values.into_iter().collect::<Vec<T>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_sample_is_the_mean_of_its_middle() {
        assert_eq!(median(&mut [3.0f64, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&mut [4.0f32, 1.0, 3.0, 2.0]), Some(2.5));
        assert_eq!(median(&mut [9u64, 4]), Some(6));
        assert_eq!(median(&mut [7.0f32]), Some(7.0));
        assert_eq!(median::<f32>(&mut []), None);
    }

    #[test]
    fn a_quantile_is_the_value_below_which_that_share_ranks() {
        let sample = || (0..100).rev().map(f64::from);
        for (share, expected) in [(0.0, 0.0), (0.29, 29.0), (0.5, 50.0), (0.95, 95.0), (0.99, 99.0), (1.0, 99.0)] {
            assert_eq!(quantile_of(sample(), share), Some(expected), "{share}");
        }
        assert_eq!(quantile_of([2.0f32, 1.0], 0.49), Some(1.0));
        assert_eq!(quantile_of(std::iter::empty::<f32>(), 0.5), None);
    }

    #[test]
    fn ranks_are_those_of_whole_numbers() {
        for count in 1..2000 {
            for percent in 0..100 {
                assert_eq!(rank(count, percent as f64 / 100.0), count * percent / 100, "{percent} % of {count}");
            }
        }
    }

    #[test]
    fn nan_ranks_last_and_nothing_panics() {
        assert_eq!(median_of([1.0, f32::NAN, 0.0]), Some(1.0));
        assert!(quantile_of([f64::NAN], 0.5).is_some_and(f64::is_nan));
    }
}
