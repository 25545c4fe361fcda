//! The size that fits: by the primary measures of the garment's kind (EN 13402-2), with the ease and a verdict for
//! each zone, never a bare label.
//!
//! The body is uncertain, so each size is judged on many bodies drawn from the measurement's errors: the size whose
//! mean penalty is least is recommended, and every size has the share of bodies that it suits best as its probability.
//! Where no size is sure, the measure is named whose exact knowledge would make the choice surest.

mod feel;
mod offer;
mod probability;
mod recommendation;
mod scored_zone;
mod sentences;

use toile_assets::sizes::SizeError;

use crate::estimate::Estimate;
use crate::measure::{Measurements, Source};
use probability::{SizeProbabilities, least};
use scored_zone::{ScoredZone, WORTH_NAMING};

pub use feel::Feel;
pub use offer::{EaseRange, MadeSize, Offer, Zone, ZoneGirth};
pub use probability::{OFF_MIDDLE, TIGHT_TO_LOOSE};
pub use recommendation::{Recommendation, RunnerUp, SURE, SizeProbability, TapeAdvice, Verdict, ZoneFit};
pub use scored_zone::WEIGHTS;

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

/// A tape measurement is advised only if it raises the largest probability by at least this.
const LEAST_TAPE_GAIN: f32 = 0.02;

/// Beside joints, which show no surface, only a tape states a girth as surely as this (m).
const TAKEN: f32 = 0.010;

/// Recommends the size of a garment for a measured person.
pub fn recommend(measured: &Measurements, offer: &Offer) -> Result<Recommendation, RecommendError> {
    judge(measured, offer, None)
}

/// Judges a size that the person insists on.
pub fn evaluate(measured: &Measurements, offer: &Offer, size: &str) -> Result<Recommendation, RecommendError> {
    judge(measured, offer, Some(size))
}

/// Judges a garment that there is in one size, the first of the offer; the table need not know it.
///
/// # Errors
/// A kind that the table does not know, no size or zone to judge by.
pub fn judge_only(measured: &Measurements, offer: &Offer) -> Result<Recommendation, RecommendError> {
    let scored = zones(measured, offer)?;
    let only = &offer.sizes[0];
    let zones: Vec<ZoneFit> = scored.iter().filter_map(|z| sentences::fit(z, only)).collect();
    Ok(Recommendation {
        garment: offer.garment.to_owned(),
        size: only.code.clone(),
        best: only.code.clone(),
        probability: 1.0,
        sizes: vec![SizeProbability { size: only.code.clone(), probability: 1.0 }],
        uncertain: false,
        girth_to_take: None,
        verdict: sentences::only(only, &zones),
        zones,
        runner_up: None,
        note: sentences::unseen(measured, scored[0].ease.zone),
    })
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
    let fits: Vec<ZoneFit> = zones.iter().filter_map(|z| sentences::fit(z, &offer.sizes[chosen])).collect();
    let uncertain = share.iter().all(|&p| p < SURE);
    let girth_to_take = if uncertain { girth_to_take(&zones, offer.sizes, &share) } else { None };
    Ok(Recommendation {
        garment: offer.garment.to_owned(),
        size: offer.sizes[chosen].code.clone(),
        best: offer.sizes[best].code.clone(),
        probability: share[chosen],
        verdict: sentences::verdict(&sizes, [chosen, best], girth_to_take.as_ref(), &fits),
        sizes,
        uncertain,
        girth_to_take,
        zones: fits,
        runner_up,
        note: sentences::note(measured, offer, &zones),
    })
}

/// The girth whose exact knowledge makes the choice surest, the first of equals; `None` where none is worth a tape.
fn girth_to_take(zones: &[ScoredZone], sizes: &[MadeSize], share: &[f32]) -> Option<TapeAdvice> {
    let now = share.iter().copied().fold(0.0, f32::max);
    let mut best: Option<(Zone, f32)> = None;
    for (i, zone) in zones.iter().enumerate() {
        let then = probability::once_known(zones, sizes, i);
        if then > now + LEAST_TAPE_GAIN && best.is_none_or(|(_, other)| then > other) {
            best = Some((zone.ease.zone, then));
        }
    }
    best.map(|(zone, probability)| TapeAdvice {
        zone,
        probability,
        sentence: sentences::girth_to_take(zone, now, probability),
    })
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
    let guessed = |taken: Option<Estimate>| match measured.source {
        Source::Joints => taken.is_none_or(|t| t.sigma > TAKEN),
        Source::Depth | Source::Both => taken.is_none(),
    };
    let taken = &measured.measures;
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
            guessed: guessed(match ease.zone {
                Zone::Chest => taken.chest_girth,
                Zone::Waist => taken.waist_girth,
                Zone::Hip => taken.hip_girth,
            }),
        })
        .collect();
    zones.sort_by_key(|z| rank(z.ease.zone));
    match zones.first() {
        Some(z) if designation.primary.contains(&z.ease.zone) => Ok(zones),
        _ => Err(nothing("girth and ease at the zone that its size is chosen by")),
    }
}
