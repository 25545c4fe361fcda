//! The size that fits, and the fit of each of its zones.

use serde::Serialize;
use toile_track::recommend::Recommendation as Judged;

use crate::body::Body;
use crate::error::{Error, Result};
use crate::garment::Garment;

/// How a zone of a garment fits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ZoneFit {
    /// `chest`, `waist` or `hip`.
    pub zone: &'static str,
    /// Whether the size is chosen by this zone.
    pub primary: bool,
    /// Girth of the garment less that of the body (mm).
    pub ease_mm: f64,
    /// Standard deviation of the ease (mm): that of the body's measure.
    pub sigma_mm: f64,
    /// `tight`, `good`, `loose`, or `unknown` where the body was not seen there.
    pub verdict: &'static str,
    /// How it feels, from `too tight` over `right` to `too loose`; none where the body was not seen there.
    pub feel: Option<&'static str>,
    /// -1 (loose) .. 1 (tight), within half of it where the zone is comfortable; none where the body was not seen there.
    pub tightness: Option<f32>,
    /// The same for a person to read.
    pub sentence: String,
}

/// A size with the probability that it suits this person best.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SizeChance {
    /// Code of the size.
    pub size: String,
    /// The probability, given the errors of the measures; those of all sizes sum to 1.
    pub probability: f32,
}

/// Advice to take a girth by tape, where no size is sure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasureAdvice {
    /// The girth to take: `chest`, `waist` or `hip`.
    pub zone: &'static str,
    /// Probability of the most probable size that is to be expected once this girth is known.
    pub probability: f32,
    /// The same for a person to read.
    pub sentence: String,
}

/// A size, judged on a body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Recommendation {
    /// Name of the garment.
    pub garment: String,
    /// Code of the size.
    pub size: String,
    /// Probability that this size suits this person best.
    pub probability: f32,
    /// Every size that is made, smallest first.
    pub sizes: Vec<SizeChance>,
    /// Whether no size is sure.
    pub uncertain: bool,
    /// The measure to take by tape, where that is so and it would help.
    pub advice: Option<MeasureAdvice>,
    /// The recommendation in sentences.
    pub verdict: String,
    /// Fit by zone, the primary ones first.
    pub zones: Vec<ZoneFit>,
    /// The next best size, where it may be the better one.
    pub runner_up: Option<String>,
    /// Set where no size is made for this person, or guesses stand for measures: a sentence.
    pub note: Option<String>,
}

/// The size of a garment that fits a body, or how the one that was asked for does ([`Garment::in_size`]), worn over nothing else.
///
/// # Errors
/// A garment that has no sizes, or cannot be laid on the body.
pub fn recommend(body: &Body, garment: &Garment) -> Result<Recommendation> {
    let judged = garment.source().judge(garment.size(), body.known(), body.shape(), &[])?;
    judged.map(Recommendation::of).ok_or_else(|| {
        Error::input(format!(
            "{} is a mesh without sizes, of which none can be recommended; give its sizes in a TOML file beside it \
             (docs/meshes.md)",
            garment.name()
        ))
    })
}

impl Recommendation {
    pub(crate) fn of(judged: Judged) -> Self {
        let mm = |metres: f32| f64::from(metres) * 1e3;
        let zones = judged.zones.into_iter().map(|fit| ZoneFit {
            zone: fit.zone.name(),
            primary: fit.primary,
            ease_mm: mm(fit.ease),
            sigma_mm: mm(fit.sigma),
            verdict: fit.verdict.name(),
            feel: fit.feel.map(|feel| feel.name()),
            tightness: fit.tightness,
            sentence: fit.sentence,
        });
        let sizes = judged.sizes.into_iter().map(|s| SizeChance { size: s.size, probability: s.probability });
        let advice = judged.girth_to_take.map(|advice| MeasureAdvice {
            zone: advice.zone.name(),
            probability: advice.probability,
            sentence: advice.sentence,
        });
        Self {
            garment: judged.garment,
            size: judged.size,
            probability: judged.probability,
            sizes: sizes.collect(),
            uncertain: judged.uncertain,
            advice,
            verdict: judged.verdict,
            zones: zones.collect(),
            runner_up: judged.runner_up.map(|other| other.size),
            note: judged.note,
        }
    }
}
