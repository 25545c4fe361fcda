//! Probability of each size: bodies drawn from the measures' errors, each given the size that suits it best.

use super::{EaseRange, MadeSize, ScoredZone};

/// Bodies drawn from the measures' errors: a probability is then known to about a hundredth. A power of two, so that
/// the shares sum to exactly 1.
const BODIES: usize = 512;

/// Values that a girth may turn out to have when it is taken by tape: strata of equal probability.
const TAPED: usize = 32;

/// Bodies drawn for each of those.
const BODIES_TAPED: usize = 128;

/// A centimetre too tight is worse than one too loose by this: one cannot wear it.
pub const TIGHT_TO_LOOSE: f32 = 2.0;

/// Penalty of ease within the comfortable range but off its middle, per metre, next to 1 outside: it decides between
/// sizes that both fit.
pub const OFF_MIDDLE: f32 = 0.1;

/// Mean penalty and probability of each size.
pub(super) struct SizeProbabilities {
    /// Mean penalty (m of ease outside the comfortable range) `[sizes]`.
    pub penalty: Vec<f32>,
    /// Share of the bodies that the size suits best `[sizes]`; sums to 1.
    pub share: Vec<f32>,
}

impl SizeProbabilities {
    /// Judges all sizes on bodies with the measures' errors.
    pub(super) fn of(zones: &[ScoredZone], sizes: &[MadeSize]) -> Self {
        Self::drawn(BODIES, sizes, |body, i| zones[i].body.sigma * normal(body, i), zones)
    }

    /// Judges all sizes on `bodies` bodies; `error` is how much larger zone `i` of a body is than measured (m).
    fn drawn(bodies: usize, sizes: &[MadeSize], error: impl Fn(usize, usize) -> f32, zones: &[ScoredZone]) -> Self {
        let mut chances = Self { penalty: vec![0.0; sizes.len()], share: vec![0.0; sizes.len()] };
        let mut each = vec![0.0; sizes.len()];
        let mut errors = vec![0.0; zones.len()];
        for body in 0..bodies {
            errors.iter_mut().enumerate().for_each(|(i, e)| *e = error(body, i));
            for (size, penalty) in sizes.iter().zip(&mut each) {
                let zones = zones.iter().zip(&errors);
                *penalty = zones.filter_map(|(z, e)| Some(z.weight * penalty_at(z, ease_of(z, size)? - e))).sum();
            }
            for (mean, penalty) in chances.penalty.iter_mut().zip(&each) {
                *mean += penalty / bodies as f32;
            }
            chances.share[least(&each)] += 1.0 / bodies as f32;
        }
        chances
    }
}

/// Probability of the most probable size that is to be expected once the girth of zone `known` has been taken: the mean,
/// over the values that the tape may read, of the largest probability given that value. It is never less than the
/// largest probability now (Raiffa and Schlaifer 1961, expected value of perfect information, with the right size worth
/// 1 and any other 0).
pub(super) fn once_known(zones: &[ScoredZone], sizes: &[MadeSize], known: usize) -> f32 {
    let taped = |stratum: usize| zones[known].body.sigma * quantile((stratum as f32 + 0.5) / TAPED as f32);
    let surest = |stratum: usize| {
        let error = |body: usize, i: usize| {
            if i == known { taped(stratum) } else { zones[i].body.sigma * normal(body, i) }
        };
        SizeProbabilities::drawn(BODIES_TAPED, sizes, error, zones).share.into_iter().fold(0.0, f32::max)
    };
    (0..TAPED).map(surest).sum::<f32>() / TAPED as f32
}

/// Ease of a size on the body as measured (m).
pub(super) fn ease_of(zone: &ScoredZone, size: &MadeSize) -> Option<f32> {
    Some(size.zones.iter().find(|z| z.zone == zone.ease.zone)?.girth_m - zone.body.value)
}

fn penalty_at(zone: &ScoredZone, ease: f32) -> f32 {
    let EaseRange { least, most, .. } = zone.ease;
    let outside = TIGHT_TO_LOOSE * (least - ease).max(0.0) + (ease - most).max(0.0);
    outside + OFF_MIDDLE * (ease - 0.5 * (least + most)).abs()
}

/// Index of the smallest value, the first of equals.
pub(super) fn least(values: &[f32]) -> usize {
    (0..values.len()).min_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0)
}

/// Standard normal deviate number `index` of dimension `dimension`: a Halton sequence through the normal's quantile,
/// so that few bodies fill the space evenly and every run draws the same.
fn normal(index: usize, dimension: usize) -> f32 {
    const BASES: [usize; 3] = [2, 3, 5];
    let base = BASES[dimension % BASES.len()];
    let (mut n, mut fraction, mut value) = (index + 1, 1.0, 0.0);
    while n > 0 {
        fraction /= base as f32;
        value += fraction * (n % base) as f32;
        n /= base;
    }
    quantile(value)
}

/// Quantile of the normal distribution (Abramowitz and Stegun 26.2.23, error below 4.5e-4).
fn quantile(p: f32) -> f32 {
    let tail = p.min(1.0 - p).max(1e-6);
    let t = (-2.0 * tail.ln()).sqrt();
    let x =
        t - (2.515_517 + t * (0.802_853 + t * 0.010_328)) / (1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308)));
    if p < 0.5 { -x } else { x }
}

#[cfg(test)]
mod tests {
    use super::quantile;

    #[test]
    fn quantiles_are_those_of_the_normal_distribution() {
        for (p, x) in [(0.5, 0.0), (0.841_345, 1.0), (0.022_75, -2.0)] {
            assert!((quantile(p) - x).abs() < 5e-4, "{p}: {}", quantile(p));
        }
    }
}
