//! Fit of a size at each zone, as a shopper reads it, with its reason.

use toile_assets::sizes::{Girth, Population};
use toile_fitting::dress::measured;
use toile_fitting::dress::offer::GarmentOffer;
use toile_track::estimate::Estimate;
use toile_track::fit::measuring::MEASURES;
use toile_track::measure::{Measurements, Source};
use toile_track::recommend::{Feel, MadeSize, Recommendation, Verdict};
use toile_track::tape_readings::{BodyEstimate, TapeReadings};

use super::measure_entry::OwnMeasure;
use super::texts::TextKey;
use super::wardrobe::WardrobeItem;
use crate::error::KioskError;

toile_base::named! {
    /// A part of the body that is measured, from the top down.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum BodyPart {
        /// From the floor to the top of the head.
        Stature,
        /// The breadth of the shoulders.
        Shoulders,
        /// The girth of the chest.
        Chest,
        /// The girth of the waist.
        Waist,
        /// The girth of the hip.
        Hip,
        /// The length of the legs.
        Legs,
    }
}

impl BodyPart {
    /// Key of its name in the pages' texts.
    pub const fn word(self) -> TextKey {
        match self {
            Self::Stature => TextKey::PartStature,
            Self::Shoulders => TextKey::PartShoulders,
            Self::Chest => TextKey::PartChest,
            Self::Waist => TextKey::PartWaist,
            Self::Hip => TextKey::PartHip,
            Self::Legs => TextKey::PartLegs,
        }
    }
}

impl From<BodyPart> for OwnMeasure {
    fn from(part: BodyPart) -> Self {
        match part {
            BodyPart::Stature => Self::Stature,
            BodyPart::Shoulders => Self::Shoulders,
            BodyPart::Chest => Self::Chest,
            BodyPart::Waist => Self::Waist,
            BodyPart::Hip => Self::Hip,
            BodyPart::Legs => Self::Leg,
        }
    }
}

impl From<Girth> for BodyPart {
    fn from(girth: Girth) -> Self {
        match girth {
            Girth::Chest => Self::Chest,
            Girth::Waist => Self::Waist,
            Girth::Hip => Self::Hip,
        }
    }
}

/// How far a measure is to be believed, and why.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeasureBasis {
    /// They took it by tape.
    Taped,
    /// It was taken from the body's surface.
    Seen,
    /// It follows from the length of bones, which is all that joints tell.
    Bones,
    /// It could not be seen: what such a body has on average.
    Guessed,
}

/// What was measured of a person.
#[derive(Debug, Clone, PartialEq)]
pub struct VisitorMeasures {
    /// The measures that were taken, with those by tape laid over them.
    pub measured: Measurements,
    /// The same as the camera saw them, and what the body fit says where there is one.
    seen: Measurements,
    fit: Option<BodyEstimate>,
    /// Measures by tape.
    tape: TapeReadings,
    /// What could not be seen, from the top down.
    pub missing: Vec<BodyPart>,
    /// Whether they sat when they were measured.
    pub seated: bool,
    /// How many measures are known.
    pub count: u32,
    /// Whose proportions apply where something was not seen.
    pub population: Population,
}

impl VisitorMeasures {
    /// Of a person measured seated or standing; what is missing is found out.
    pub fn new(measured: Measurements, seated: bool) -> Self {
        Self {
            missing: missing(&measured),
            count: count(&measured),
            seen: measured.clone(),
            measured,
            fit: None,
            tape: TapeReadings::default(),
            seated,
            population: Population::Mixed,
        }
    }

    /// The same with whose proportions apply, and with all that the body fit says where a body fits.
    #[must_use]
    pub fn with_fit(self, population: Population, fit: Option<BodyEstimate>) -> Self {
        let count = if fit.is_some() { MEASURES.len() as u32 } else { self.count };
        Self { population, fit, count, ..self }
    }

    /// What is known once these measures by tape, and no others, are laid over what the camera saw.
    #[must_use]
    pub fn with_tape(&self, tape: &TapeReadings) -> Self {
        if *tape == self.tape {
            return self.clone();
        }
        let measured = measured::with_tape(self.seen.clone(), self.fit.as_ref(), self.population, tape);
        // What follows from a measure by tape is a guess as before.
        let untaken = |part: &BodyPart| tape.at(OwnMeasure::from(*part).index()).is_none();
        let missing = missing(&self.seen).into_iter().filter(untaken).collect();
        let seen = if self.fit.is_some() { MEASURES.len() as u32 } else { count(&self.seen) };
        let count = seen.max(count(&measured));
        Self { measured, missing, count, tape: *tape, ..self.clone() }
    }

    /// How a girth was obtained: seen, from bones, or guessed.
    pub fn basis(&self, zone: Girth) -> MeasureBasis {
        if self.tape.at(OwnMeasure::from(zone).index()).is_some() {
            MeasureBasis::Taped
        } else if self.missing.contains(&zone.into()) {
            MeasureBasis::Guessed
        } else if self.measured.source == Source::Joints {
            MeasureBasis::Bones
        } else {
            MeasureBasis::Seen
        }
    }

    /// Whether the girth of each zone is unknown, in the order of `Girth::ALL`. It is then a guess, and so would be any fit there.
    pub fn unknown(&self) -> [bool; 3] {
        Girth::ALL.map(|zone| self.is_unknown(zone))
    }

    fn is_unknown(&self, zone: Girth) -> bool {
        matches!(self.basis(zone), MeasureBasis::Bones | MeasureBasis::Guessed)
    }
}

/// What was not measured, from the top down.
fn missing(measured: &Measurements) -> Vec<BodyPart> {
    let m = &measured.measures;
    let taken = [m.stature, m.shoulder_breadth, m.chest_girth, m.waist_girth, m.hip_girth, m.inseam];
    let lacks = |(part, taken): (BodyPart, Option<Estimate>)| taken.is_none().then_some(part);
    BodyPart::ALL.into_iter().zip(taken).filter_map(lacks).collect()
}

/// How many measures were taken.
fn count(measured: &Measurements) -> u32 {
    measured.measures.named().iter().filter(|(_, taken)| taken.is_some()).count() as u32
}

/// Key of a feel's name in the pages' texts.
pub const fn feel_word(feel: Feel) -> TextKey {
    match feel {
        Feel::TooTight => TextKey::FeelTooTight,
        Feel::Tight => TextKey::FeelTight,
        Feel::Snug => TextKey::FeelSnug,
        Feel::Right => TextKey::FeelRight,
        Feel::Roomy => TextKey::FeelRoomy,
        Feel::Loose => TextKey::FeelLoose,
        Feel::TooLoose => TextKey::FeelTooLoose,
    }
}

/// The fit at one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneFit {
    /// The girth at which it was judged.
    pub zone: Girth,
    /// Whether the size is chosen by this zone.
    pub primary: bool,
    /// How the zone feels, in one of seven words; none where the body was not seen there.
    pub feel: Option<Feel>,
    /// How it may feel too: what the ease less or more its error comes to, where that is comfortable when this is not or the
    /// other way round.
    pub perhaps: Option<Feel>,
    /// Garment less body and the standard deviation of that (m).
    pub ease: Estimate,
    /// Girth of the body (m).
    pub body: Estimate,
    /// Girth of the garment (m).
    pub garment_m: f32,
    /// Least and most ease that is comfortable (m).
    pub comfort_m: [f32; 2],
    /// -1 (loose) .. 1 (tight), within half of it where the zone is comfortable; none where the body was not seen there.
    pub tightness: Option<f32>,
}

/// How a size sits.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeFit {
    /// Place of the size among those that are made.
    pub size: usize,
    /// Place of the size that fits best.
    pub best: usize,
    /// Place of the size that may fit as well, or else lies beside this one.
    pub other: Option<usize>,
    /// Probability that the size is the best for this person, given the errors of the measures.
    pub probability: f32,
    /// The zone to take by tape, where no size is sure and a tape would help.
    pub girth_to_take: Option<Girth>,
    /// The zones, those that the size is chosen by first.
    pub zones: Vec<ZoneFit>,
    /// Set where the primary girth lies outside of what is made.
    pub outside: Option<OutOfRange>,
    /// Whether there are several sizes to choose from.
    pub choice: SizeChoice,
}

/// Number of sizes to choose from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SizeChoice {
    /// Several sizes.
    Several,
    /// One size: how it fits is known.
    One,
    /// A garment that says nothing of its size: it is shown as it was made.
    Unknown,
}

impl SizeFit {
    /// Whether it is comfortable wherever that is known.
    pub fn is_comfortable(&self) -> bool {
        self.zones.iter().filter_map(|zone| zone.feel).all(Feel::is_comfortable)
    }

    /// Of a garment that says nothing of its size.
    const fn unknown() -> Self {
        Self {
            size: 0,
            best: 0,
            other: None,
            probability: 1.0,
            girth_to_take: None,
            zones: Vec::new(),
            outside: None,
            choice: SizeChoice::Unknown,
        }
    }

    /// Whether how some zone fits is not known.
    pub fn has_unknown(&self) -> bool {
        self.zones.iter().any(|zone| zone.feel.is_none())
    }
}

/// A body for which no size is made: the nearest is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutOfRange {
    /// The body is smaller than the smallest size is meant for.
    Smaller,
    /// The body is larger than the largest size is meant for.
    Larger,
}

/// Judges a size of a garment worn over others, or without one the size that fits best.
///
/// # Errors
/// A garment that no size can be named of.
pub fn judge(
    item: &WardrobeItem,
    known: &VisitorMeasures,
    size: Option<usize>,
    beneath: &[GarmentOffer],
) -> Result<SizeFit, KioskError> {
    let Some(offer) = &item.offer else { return Ok(SizeFit::unknown()) };
    let offer = &offer.clone().over(beneath);
    let code = size.and_then(|s| item.sizes.get(s)).map(String::as_str);
    let judged = offer.judge(code, &known.measured)?;
    let place = |code: &str| item.sizes.iter().position(|s| s == code);
    let chosen = place(&judged.size).unwrap_or_default();
    let best = place(&judged.best).unwrap_or(chosen);
    let beside = if chosen + 1 < item.sizes.len() { Some(chosen + 1) } else { chosen.checked_sub(1) };
    let other = judged.runner_up.as_ref().and_then(|r| place(&r.size)).filter(|o| *o != chosen).or(beside);
    let zones: Vec<ZoneFit> = zones(offer, known, &judged);
    Ok(SizeFit {
        size: chosen,
        best,
        other,
        probability: judged.probability,
        girth_to_take: judged.girth_to_take.as_ref().map(|t| t.zone),
        outside: zones.iter().find(|z| z.primary && z.feel.is_some()).and_then(|z| outside(offer, z)),
        choice: if offer.is_single() { SizeChoice::One } else { SizeChoice::Several },
        zones,
    })
}

fn zones(offer: &GarmentOffer, known: &VisitorMeasures, judged: &Recommendation) -> Vec<ZoneFit> {
    let [_, _, chest, waist, hip] = known.measured.completed(offer.table.population);
    let zone = |z: &toile_track::recommend::ZoneFit| {
        let body = match z.zone {
            Girth::Chest => chest,
            Girth::Waist => waist,
            Girth::Hip => hip,
        };
        let comfort_m = offer.comfort(z.zone)?;
        // A girth that was not measured is a guess, though a recommendation may be made from it.
        let known = (z.verdict != Verdict::Unknown && !known.is_unknown(z.zone)).then_some(());
        Some(ZoneFit {
            zone: z.zone,
            primary: z.primary,
            feel: known.and(z.feel),
            perhaps: known.and(z.perhaps),
            ease: Estimate::new(z.ease, z.sigma),
            body,
            garment_m: body.value + z.ease,
            comfort_m,
            tightness: known.and(z.tightness),
        })
    };
    judged.zones.iter().filter_map(zone).collect()
}

fn outside(offer: &GarmentOffer, zone: &ZoneFit) -> Option<OutOfRange> {
    let size = |made: &MadeSize| offer.table.size(&made.code).ok();
    let (first, last) = (offer.sizes.first().and_then(size)?, offer.sizes.last().and_then(size)?);
    match zone.body.value {
        v if v < first.range(zone.zone)[0] => Some(OutOfRange::Smaller),
        v if v > last.range(zone.zone)[1] => Some(OutOfRange::Larger),
        _ => None,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::wardrobe::Wardrobe;
    use super::*;
    use toile_track::measures::Measures;

    /// A woman of 1.70 m with these girths (m), seen in depth.
    pub(crate) fn woman(chest: f32, waist: f32, hip: f32) -> VisitorMeasures {
        let some = |value, sigma| Some(Estimate::new(value, sigma));
        let measures = Measures {
            stature: some(1.70, 0.006),
            shoulder_breadth: some(0.365, 0.008),
            chest_girth: some(chest, 0.01),
            waist_girth: some(waist, 0.01),
            hip_girth: some(hip, 0.01),
            inseam: some(0.78, 0.01),
            arm_length: some(0.58, 0.01),
        };
        let measured = Measurements {
            measures,
            valid_pixels: 20_000,
            people: 1,
            frames: 30,
            source: Source::Depth,
            notes: Vec::new(),
        };
        VisitorMeasures::new(measured, false)
    }

    fn item(name: &str) -> WardrobeItem {
        let wardrobe = Wardrobe::stock().unwrap();
        wardrobe.items[wardrobe.find(name).unwrap()].clone()
    }

    #[test]
    fn a_larger_size_is_nowhere_tighter_and_its_ease_is_that_of_garment_less_body() {
        let (item, known) = (item("wide-leg-trousers"), woman(0.90, 0.74, 0.98));
        let fits: Vec<SizeFit> = (0..item.sizes.len()).map(|s| judge(&item, &known, Some(s), &[]).unwrap()).collect();
        for pair in fits.windows(2) {
            for (small, large) in pair[0].zones.iter().zip(&pair[1].zones) {
                assert!(large.ease.value > small.ease.value && large.tightness <= small.tightness);
                assert!(large.feel >= small.feel);
            }
        }
        for zone in &fits[3].zones {
            assert!((zone.garment_m - zone.body.value - zone.ease.value).abs() < 1e-5);
            assert_eq!(zone.ease.sigma, zone.body.sigma, "the garment is as its file says");
            assert_eq!(zone.tightness.unwrap().abs() <= 0.5, zone.feel.unwrap().is_comfortable(), "{zone:?}");
        }
        let best = judge(&item, &known, None, &[]).unwrap();
        assert!(fits.iter().all(|f| f.best == best.size), "every size knows which would be better");
        assert_ne!(best.other, Some(best.size));
    }

    #[test]
    fn a_body_beyond_the_table_is_told_so() {
        let item = item("strap-dress");
        assert_eq!(judge(&item, &woman(0.60, 0.50, 0.70), None, &[]).unwrap().outside, Some(OutOfRange::Smaller));
        assert_eq!(judge(&item, &woman(1.70, 1.60, 1.70), None, &[]).unwrap().outside, Some(OutOfRange::Larger));
        assert_eq!(judge(&item, &woman(0.90, 0.74, 0.98), None, &[]).unwrap().outside, None);
    }

    #[test]
    fn what_was_not_seen_is_missing_and_only_a_guess() {
        let mut known = woman(0.90, 0.74, 0.98);
        assert!(known.missing.is_empty() && known.basis(Girth::Hip) == MeasureBasis::Seen);
        known.measured.measures.hip_girth = None;
        let known = VisitorMeasures::new(known.measured, true);
        assert_eq!(known.missing, [BodyPart::Hip]);
        assert_eq!((known.basis(Girth::Hip), known.basis(Girth::Waist)), (MeasureBasis::Guessed, MeasureBasis::Seen));
        let fit = judge(&item("wide-leg-trousers"), &known, None, &[]).unwrap();
        let hip = fit.zones.iter().find(|z| z.zone == Girth::Hip).unwrap();
        assert!(hip.ease.sigma > 0.02, "a guess is not sure: {hip:?}");
        assert!((hip.feel, hip.perhaps, hip.tightness) == (None, None, None) && fit.has_unknown(), "{hip:?}");
        assert_eq!(known.unknown(), [false, false, true]);
    }

    #[test]
    fn of_joints_alone_no_girth_is_known_and_a_size_is_a_guess_with_its_odds() {
        let mut known = woman(0.90, 0.74, 0.98);
        known.measured.source = Source::Joints;
        for girth in [
            &mut known.measured.measures.chest_girth,
            &mut known.measured.measures.waist_girth,
            &mut known.measured.measures.hip_girth,
        ] {
            girth.as_mut().unwrap().sigma = 0.06;
        }
        let known = VisitorMeasures::new(known.measured, false);
        let fit = judge(&item("strap-dress"), &known, None, &[]).unwrap();
        assert!(fit.zones.iter().all(|z| z.feel.is_none() && z.perhaps.is_none() && z.tightness.is_none()), "{fit:?}");
        assert!(fit.probability > 0.0 && fit.probability < toile_track::recommend::SURE, "{fit:?}");
        assert_eq!((known.unknown(), fit.outside), ([true; 3], None));
    }

    #[test]
    fn a_measure_by_tape_makes_its_zone_known_moves_the_others_and_is_gone_when_it_is_removed() {
        let mut known = woman(0.90, 0.74, 0.98);
        known.measured.measures.hip_girth = None;
        let before = VisitorMeasures::new(known.measured, true);
        let tape = TapeReadings::default().with(OwnMeasure::Hip.index(), 1.06).unwrap();
        let known = before.with_tape(&tape);
        let hip = known.measured.measures.hip_girth.unwrap();
        assert!((hip.value - 1.06).abs() < 0.005 && hip.sigma < 0.01, "{hip:?}");
        assert_eq!((known.basis(Girth::Hip), known.missing.len()), (MeasureBasis::Taped, 0));
        assert_eq!(known.basis(Girth::Waist), MeasureBasis::Seen);
        let fit = judge(&item("wide-leg-trousers"), &known, None, &[]).unwrap();
        assert!(!fit.has_unknown());
        let sized = |chest: f32| {
            let tape = TapeReadings::default().with(OwnMeasure::Chest.index(), chest).unwrap();
            judge(&item("strap-dress"), &before.with_tape(&tape), None, &[]).unwrap().size
        };
        assert!(sized(0.84) < sized(1.0), "sizes follow");
        assert_eq!(known.with_tape(&TapeReadings::default()), before);
        // A measure that only follows from one by tape is a guess as before.
        let chest = before.with_tape(&TapeReadings::default().with(OwnMeasure::Chest.index(), 0.95).unwrap());
        assert_eq!((chest.basis(Girth::Hip), chest.missing.as_slice()), (MeasureBasis::Guessed, &[BodyPart::Hip][..]));
    }
}
