//! The size that fits: by the primary measures of the garment's kind (EN 13402-2), with the ease and a verdict for
//! each zone, never a bare label.
//!
//! Reads: `Measurements` with their errors, an `Offer` (finished girths, comfortable ease, size table). Writes: a
//! `Recommendation`. Budget: 10 ms a garment, once a shopper. Thread: the sensor thread.
//!
//! The body is uncertain, so each size is judged on many bodies drawn from the measurement's errors: the size whose
//! mean penalty is least is recommended, and every size has the share of bodies that it suits best as its probability.
//! Where no size is sure, the measure is named whose exact knowledge would make the choice surest.

mod probability;
mod sentences;

use toile_assets::sizes::{GarmentKind, Girth, SizeError, SizeTable};

use crate::estimate::Estimate;
use crate::measure::Measurements;
use probability::{SizeProbabilities, least};

/// A zone of fit is where a girth is taken.
pub type Zone = Girth;

/// Finished girth of a garment at one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneGirth {
    /// The zone.
    pub zone: Zone,
    /// Girth of the garment (m).
    pub girth_m: f32,
}

/// Ease (garment less body) that feels right at one zone; negative where the cloth is meant to stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EaseRange {
    /// The zone.
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
    /// Name of the garment.
    pub garment: &'a str,
    /// Kind of the garment, which decides its primary measures.
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
pub enum Verdict {
    /// Less ease than is comfortable.
    Tight,
    /// Comfortable ease.
    Good,
    /// More ease than is comfortable.
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
    /// The zone.
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
    /// Code of the size.
    pub size: String,
    /// Probability that it suits this person best.
    pub probability: f32,
}

/// A size with its probability.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeProbability {
    /// Code of the size.
    pub size: String,
    /// Probability that it suits this person best, given the errors of the measures.
    pub probability: f32,
}

/// Advice to take a girth by tape, where no size is sure.
#[derive(Debug, Clone, PartialEq)]
pub struct TapeAdvice {
    /// The girth to take.
    pub zone: Zone,
    /// Probability of the most probable size that is to be expected once this girth is known exactly.
    pub probability: f32,
    /// The same for a person to read.
    pub sentence: String,
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
    /// All sizes that are made, smallest first; the probabilities sum to 1.
    pub sizes: Vec<SizeProbability>,
    /// Whether no size is as probable as [`SURE`].
    pub uncertain: bool,
    /// The measure to take by tape, where that is so and a tape would help.
    pub tape: Option<TapeAdvice>,
    /// The recommendation in sentences: how sure the size is, what else may fit, what to do about it.
    pub verdict: String,
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
        /// Kind of the garment.
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
        /// The size asked for.
        size: String,
        /// The sizes that are made.
        sizes: String,
    },
    /// A size that the table does not know.
    #[error(transparent)]
    Size(#[from] SizeError),
}

/// Weight of a zone that the size is chosen by, of one that it also promises to fit, and of any other.
const WEIGHTS: [f32; 3] = [1.0, 0.2, 0.1];

/// A runner-up less probable than this is not named.
const WORTH_NAMING: f32 = 0.05;

/// A size less probable than this is not sure: one shopper in five would be sent to the rail again.
pub const SURE: f32 = 0.8;

/// A tape measurement is advised only if it raises the largest probability by at least this.
const LEAST_TAPE_GAIN: f32 = 0.02;

/// Recommends the size of a garment for a measured person.
pub fn recommend(measured: &Measurements, offer: &Offer) -> Result<Recommendation, RecommendError> {
    judge(measured, offer, None)
}

/// Judges a size that the person insists on.
pub fn evaluate(measured: &Measurements, offer: &Offer, size: &str) -> Result<Recommendation, RecommendError> {
    judge(measured, offer, Some(size))
}

/// A zone to judge by: its weight, comfortable range, and the body there.
struct ScoredZone {
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
    let SizeProbabilities { penalty, share } = SizeProbabilities::of(&zones, offer.sizes);
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
    let sizes = offer.sizes.iter().zip(&share);
    let sizes: Vec<_> = sizes.map(|(s, &p)| SizeProbability { size: s.code.clone(), probability: p }).collect();
    let uncertain = share.iter().all(|&p| p < SURE);
    let tape = if uncertain { tape(&zones, offer.sizes, &share) } else { None };
    Ok(Recommendation {
        garment: offer.garment.to_owned(),
        size: offer.sizes[chosen].code.clone(),
        probability: share[chosen],
        verdict: sentences::verdict(&sizes, [chosen, best], tape.as_ref()),
        sizes,
        uncertain,
        tape,
        zones: zones.iter().filter_map(|z| sentences::fit(z, &offer.sizes[chosen])).collect(),
        runner_up,
        note: sentences::note(measured, offer, &zones),
    })
}

/// The girth whose exact knowledge makes the choice surest, the first of equals; `None` where none is worth a tape.
fn tape(zones: &[ScoredZone], sizes: &[MadeSize], share: &[f32]) -> Option<TapeAdvice> {
    let now = share.iter().copied().fold(0.0, f32::max);
    let mut best: Option<(Zone, f32)> = None;
    for (i, zone) in zones.iter().enumerate() {
        let then = probability::once_known(zones, sizes, i);
        if then > now + LEAST_TAPE_GAIN && best.is_none_or(|(_, other)| then > other) {
            best = Some((zone.ease.zone, then));
        }
    }
    best.map(|(zone, probability)| TapeAdvice { zone, probability, sentence: sentences::tape(zone, now, probability) })
}

fn runner_up(share: &[f32], best: usize) -> Option<usize> {
    (0..share.len()).filter(|&i| i != best).max_by(|&a, &b| share[a].total_cmp(&share[b]).then(b.cmp(&a)))
}

/// The zones that garment and ease ranges share, primary ones first.
fn zones(measured: &Measurements, offer: &Offer) -> Result<Vec<ScoredZone>, RecommendError> {
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
    let mut zones: Vec<ScoredZone> = offer
        .ease
        .iter()
        .filter(|e| first.zones.iter().any(|z| z.zone == e.zone))
        .map(|&ease| ScoredZone {
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
