//! A judged size: the fit of each zone, the probability of each size, and the advice where none is sure.

use super::feel::Feel;
use super::offer::Zone;

toile_base::named! {
    /// How a zone fits.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Verdict {
        /// Less ease than is comfortable.
        Tight = "tight",
        /// As much ease as is comfortable.
        Good = "good",
        /// More ease than is comfortable.
        Loose = "loose",
        /// The body was not seen there: its girth is guessed from the stature and the shoulders.
        Unknown = "unknown",
    }
}

/// The fit at one zone.
#[derive(Debug, Clone, PartialEq)]
pub struct ZoneFit {
    /// Where the girth is taken.
    pub zone: Zone,
    /// Whether the size is chosen by this zone.
    pub primary: bool,
    /// Garment less body (m).
    pub ease: f32,
    /// Standard deviation of the ease (m): that of the body's measure.
    pub sigma: f32,
    /// Whether it is comfortable.
    pub verdict: Verdict,
    /// How it feels, in one of seven words; none where the body was not seen there.
    pub feel: Option<Feel>,
    /// How it may feel too: what the ease less or more its error comes to, where that is comfortable when this is not or the
    /// other way round.
    pub perhaps: Option<Feel>,
    /// -1 (loose) .. 1 (tight), within half of it where the zone is comfortable: the fit map's scale; none where the body was
    /// not seen there.
    pub tightness: Option<f32>,
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
    /// Code of the size that is recommended: the same, unless the person insists on another.
    pub best: String,
    /// Probability that this size suits this person best, given the errors of the measures.
    pub probability: f32,
    /// All sizes that are made, smallest first; the probabilities sum to 1.
    pub sizes: Vec<SizeProbability>,
    /// Whether no size is as probable as [`SURE`].
    pub uncertain: bool,
    /// The measure to take by tape, where that is so and a tape would help.
    pub girth_to_take: Option<TapeAdvice>,
    /// The recommendation in sentences: how sure the size is, what else may fit, what to do about it.
    pub verdict: String,
    /// Fit by zone, the primary ones first.
    pub zones: Vec<ZoneFit>,
    /// The next best size, if it may be the better one at all.
    pub runner_up: Option<RunnerUp>,
    /// Set where no size is made for this person, or guesses stand for measures: a sentence.
    pub note: Option<String>,
}

/// A size less probable than this is not sure: one shopper in five would be sent to the rail again.
pub const SURE: f32 = 0.8;
