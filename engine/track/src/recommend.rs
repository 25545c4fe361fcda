//! The size that fits: by the primary measures of the garment's kind (EN 13402-2), with the ease and a verdict for
//! each zone, never a bare label.
//!
//! The body is uncertain, so each size is judged on many bodies drawn from the measurement's errors: the size whose
//! mean penalty is least is recommended, and the next one is named with the share of bodies that it would suit better.

use toile_assets::sizes::{GarmentKind, Girth, SizeError, SizeTable};

use crate::estimate::Estimate;
use crate::measure::Measurements;

/// A zone of fit is where a girth is taken.
pub type Zone = Girth;

/// Finished girth of a garment at one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneGirth {
    /// Where.
    pub zone: Zone,
    /// Girth of the garment (m).
    pub girth_m: f32,
}

/// Ease (garment less body) that feels right at one zone; negative where the cloth is meant to stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EaseRange {
    /// Where.
    pub zone: Zone,
    /// Less than this is tight (m).
    pub least: f32,
    /// More than this is loose (m).
    pub most: f32,
}

/// One size of a garment as it is made.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeSize {
    /// Code, as in the size table.
    pub code: String,
    /// Finished girths, those zones that the garment covers.
    pub zones: Vec<ZoneGirth>,
}

/// A garment to choose a size of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offer<'a> {
    /// Its name.
    pub garment: &'a str,
    /// Its kind, which says which measures are primary.
    pub kind: GarmentKind,
    /// The table that its sizes are designated by.
    pub table: &'a SizeTable,
    /// The sizes that are made, smallest first.
    pub sizes: &'a [MadeSize],
    /// Comfortable ease at the zones that matter.
    pub ease: &'a [EaseRange],
}

/// How a zone fits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Verdict {
    Tight,
    Good,
    Loose,
}

impl Verdict {
    /// The word for reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tight => "tight",
            Self::Good => "good",
            Self::Loose => "loose",
        }
    }
}

/// The fit at one zone.
#[derive(Debug, Clone, PartialEq)]
pub struct ZoneFit {
    /// Where.
    pub zone: Zone,
    /// Whether the size is chosen by this zone.
    pub primary: bool,
    /// Garment less body (m).
    pub ease: f32,
    /// Standard deviation of the ease (m): that of the body's measure.
    pub sigma: f32,
    /// How it will feel.
    pub verdict: Verdict,
    /// The same for a person to read.
    pub sentence: String,
}

/// Another size that may suit as well.
#[derive(Debug, Clone, PartialEq)]
pub struct RunnerUp {
    /// Its code.
    pub size: String,
    /// Probability that it suits this person best.
    pub probability: f32,
}

/// A size, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Recommendation {
    /// Name of the garment.
    pub garment: String,
    /// Code of the size.
    pub size: String,
    /// Probability that this size suits this person best, given the errors of the measures.
    pub probability: f32,
    /// Fit by zone, the primary ones first.
    pub zones: Vec<ZoneFit>,
    /// The next best size, if it may be the better one at all.
    pub runner_up: Option<RunnerUp>,
    /// Set where no size is made for this person, or guesses stand for measures: a sentence.
    pub note: Option<String>,
}

/// Why no size can be named; each message says what, where, and the cure.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecommendError {
    /// The table does not know the kind of garment.
    #[error("the size table {table} designates no {kind}; give the garment {garment} a table that does.")]
    NotDesignated {
        /// Name of the garment.
        garment: String,
        /// Its kind.
        kind: &'static str,
        /// Name of the table.
        table: String,
    },
    /// Nothing to choose from, or no zone to judge by.
    #[error("the garment {garment} has no {what}; add it to the garment's file.")]
    Nothing {
        /// Name of the garment.
        garment: String,
        /// What is missing.
        what: &'static str,
    },
    /// A size that is not made.
    #[error("the garment {garment} is not made in size {size}; choose one of {sizes}.")]
    NotMade {
        /// Name of the garment.
        garment: String,
        /// What was asked for.
        size: String,
        /// What there is.
        sizes: String,
    },
    /// A size that the table does not know.
    #[error(transparent)]
    Size(#[from] SizeError),
}

/// Bodies drawn from the measures' errors.
const BODIES: usize = 512;

/// Weight of a zone that the size is chosen by, of one that it also promises to fit, and of any other.
const WEIGHTS: [f32; 3] = [1.0, 0.2, 0.1];

/// A centimetre too tight is worse than one too loose by this: one cannot wear it.
const TIGHT_TO_LOOSE: f32 = 2.0;

/// Penalty of ease within the comfortable range but off its middle, per metre, next to 1 outside: it decides between
/// sizes that both fit.
const OFF_MIDDLE: f32 = 0.1;

/// A runner-up less probable than this is not worth a word.
const WORTH_NAMING: f32 = 0.05;

/// Recommends the size of a garment for a measured person.
pub fn recommend(measured: &Measurements, offer: &Offer) -> Result<Recommendation, RecommendError> {
    judge(measured, offer, None)
}

/// Judges a size that the person insists on.
pub fn evaluate(measured: &Measurements, offer: &Offer, size: &str) -> Result<Recommendation, RecommendError> {
    judge(measured, offer, Some(size))
}

/// A zone to judge by: its weight, comfortable range, and the body there.
struct Judged {
    ease: EaseRange,
    weight: f32,
    body: Estimate,
}

fn judge(measured: &Measurements, offer: &Offer, wanted: Option<&str>) -> Result<Recommendation, RecommendError> {
    let zones = zones(measured, offer)?;
    let index = |code: &str| offer.sizes.iter().position(|s| s.code == code);
    for size in offer.sizes {
        offer.table.size(&size.code)?;
    }
    let (penalty, share) = penalties(&zones, offer.sizes);
    let best = least(&penalty);
    let chosen = match wanted {
        Some(code) => index(code).ok_or_else(|| RecommendError::NotMade {
            garment: offer.garment.to_owned(),
            size: code.to_owned(),
            sizes: offer.sizes.iter().map(|s| s.code.as_str()).collect::<Vec<_>>().join(", "),
        })?,
        None => best,
    };
    // Against a size insisted on stands the one that would be recommended.
    let other = if chosen == best { runner_up(&share, best) } else { Some(best) };
    let runner_up = other
        .filter(|&i| i == best || share[i] >= WORTH_NAMING)
        .map(|i| RunnerUp { size: offer.sizes[i].code.clone(), probability: share[i] });
    Ok(Recommendation {
        garment: offer.garment.to_owned(),
        size: offer.sizes[chosen].code.clone(),
        probability: share[chosen],
        zones: zones.iter().filter_map(|z| fit(z, &offer.sizes[chosen])).collect(),
        runner_up,
        note: note(measured, offer, &zones),
    })
}

/// The zones that garment and ease ranges share, primary ones first.
fn zones(measured: &Measurements, offer: &Offer) -> Result<Vec<Judged>, RecommendError> {
    let nothing = |what| RecommendError::Nothing { garment: offer.garment.to_owned(), what };
    let designation = offer.table.designation(offer.kind).ok_or_else(|| RecommendError::NotDesignated {
        garment: offer.garment.to_owned(),
        kind: offer.kind.name(),
        table: offer.table.name.clone(),
    })?;
    let first = offer.sizes.first().ok_or_else(|| nothing("sizes"))?;
    let [_, _, chest, waist, hip] = measured.completed(offer.table.population);
    let rank = |zone: Zone| match zone {
        z if designation.primary.contains(&z) => 0,
        z if designation.secondary.contains(&z) => 1,
        _ => 2,
    };
    let mut zones: Vec<Judged> = offer
        .ease
        .iter()
        .filter(|e| first.zones.iter().any(|z| z.zone == e.zone))
        .map(|&ease| Judged {
            ease,
            weight: WEIGHTS[rank(ease.zone)],
            body: match ease.zone {
                Zone::Chest => chest,
                Zone::Waist => waist,
                Zone::Hip => hip,
            },
        })
        .collect();
    zones.sort_by_key(|z| rank(z.ease.zone));
    match zones.first() {
        Some(z) if designation.primary.contains(&z.ease.zone) => Ok(zones),
        _ => Err(nothing("girth and ease at the zone that its size is chosen by")),
    }
}

/// Mean penalty of each size over the bodies, and the share of bodies that it suits best.
fn penalties(zones: &[Judged], sizes: &[MadeSize]) -> (Vec<f32>, Vec<f32>) {
    let mut mean = vec![0.0; sizes.len()];
    let mut share = vec![0.0; sizes.len()];
    let mut each = vec![0.0; sizes.len()];
    for body in 0..BODIES {
        for (size, penalty) in sizes.iter().zip(&mut each) {
            *penalty = zones
                .iter()
                .enumerate()
                .filter_map(|(i, z)| Some(z.weight * penalty_at(z, ease_of(z, size)? - z.body.sigma * normal(body, i))))
                .sum();
        }
        for (mean, penalty) in mean.iter_mut().zip(&each) {
            *mean += penalty / BODIES as f32;
        }
        share[least(&each)] += 1.0 / BODIES as f32;
    }
    (mean, share)
}

/// Ease of a size on the body as measured (m).
fn ease_of(zone: &Judged, size: &MadeSize) -> Option<f32> {
    Some(size.zones.iter().find(|z| z.zone == zone.ease.zone)?.girth_m - zone.body.value)
}

fn penalty_at(zone: &Judged, ease: f32) -> f32 {
    let EaseRange { least, most, .. } = zone.ease;
    let outside = TIGHT_TO_LOOSE * (least - ease).max(0.0) + (ease - most).max(0.0);
    outside + OFF_MIDDLE * (ease - 0.5 * (least + most)).abs()
}

/// Index of the smallest value, the first of equals.
fn least(values: &[f32]) -> usize {
    (0..values.len()).min_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0)
}

fn runner_up(share: &[f32], best: usize) -> Option<usize> {
    (0..share.len()).filter(|&i| i != best).max_by(|&a, &b| share[a].total_cmp(&share[b]).then(b.cmp(&a)))
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

fn fit(zone: &Judged, size: &MadeSize) -> Option<ZoneFit> {
    let ease = ease_of(zone, size)?;
    let EaseRange { least, most, zone: at } = zone.ease;
    let verdict = match ease {
        e if e < least => Verdict::Tight,
        e if e > most => Verdict::Loose,
        _ => Verdict::Good,
    };
    let sigma = zone.body.sigma;
    let cm = |m: f32| m * 100.0;
    let how = match verdict {
        Verdict::Tight => format!("tight by {:.1} cm", cm(least - ease)),
        Verdict::Loose => format!("loose by {:.1} cm", cm(ease - most)),
        Verdict::Good => "good".to_owned(),
    };
    let doubt = match verdict {
        Verdict::Good if ease - least < sigma && ease - least < most - ease => ", perhaps tight",
        Verdict::Good if most - ease < sigma => ", perhaps loose",
        Verdict::Tight if least - ease < sigma => ", perhaps good",
        Verdict::Loose if ease - most < sigma => ", perhaps good",
        _ => "",
    };
    let sentence = format!(
        "The {} has {:.1} cm of ease, give or take {:.1} cm: {how}{doubt} ({:.0} to {:.0} cm is comfortable).",
        at.name(),
        cm(ease),
        cm(sigma),
        cm(least),
        cm(most)
    );
    Some(ZoneFit { zone: at, primary: zone.weight == WEIGHTS[0], ease, sigma, verdict, sentence })
}

/// What the person should know besides: that no size is made for them.
fn note(measured: &Measurements, offer: &Offer, zones: &[Judged]) -> Option<String> {
    let primary = zones.first()?;
    let zone = primary.ease.zone;
    let smallest = offer.table.size(&offer.sizes.first()?.code).ok()?;
    let largest = offer.table.size(&offer.sizes.last()?.code).ok()?;
    let cm = |m: f32| m * 100.0;
    let (name, value) = (zone.name(), cm(primary.body.value));
    if primary.body.value < smallest.range(zone)[0] {
        let (code, limit) = (&smallest.code, cm(smallest.range(zone)[0]));
        return Some(format!(
            "The {name} of {value:.0} cm is smaller than the smallest size made, {code}, is meant for ({limit:.0} cm \
             and up): it is the nearest."
        ));
    }
    if primary.body.value > largest.range(zone)[1] {
        let (code, limit) = (&largest.code, cm(largest.range(zone)[1]));
        return Some(format!(
            "The {name} of {value:.0} cm is larger than the largest size made, {code}, is meant for (up to \
             {limit:.0} cm): it is the nearest."
        ));
    }
    let m = &measured.measures;
    let taken = match zone {
        Zone::Chest => m.chest_girth,
        Zone::Waist => m.waist_girth,
        Zone::Hip => m.hip_girth,
    };
    taken
        .is_none()
        .then(|| format!("The {name} was not seen: its girth is guessed from the stature and the shoulders."))
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
