//! The shopper measured, and a body of these measures. There is one way to measure: by the body fitted to their depth where one fits, by the
//! proportions of their joints otherwise.
//!
//! The caller gives the sex whose proportions apply, or the fit finds it. Garments do not decide it, so that the same session gives the same
//! measures with all garments.

use serde::{Deserialize, Serialize};
use toile_assets::body::BodyError;
use toile_assets::sizes::Population;
use toile_base::body::{Body, Measures as BodyMeasures, Sex};
use toile_base::frame::Joints;
use toile_base::skeleton::Joint;
use toile_sensors::source::Session;
use toile_track::child::child_odds;
use toile_track::estimate::Estimate;
use toile_track::fit::measuring::{FittedMeasures, MEASURES};
use toile_track::measure::{self, Measurements, Source};
use toile_track::measures::{Hint, Measures};
use toile_track::tape_readings::{self, BodyEstimate, TapeReadings};

use super::depth::DepthSurface;
use super::session;
use crate::FittingError;

/// The fit is believed to know a shopper's sex where it is this sure (probability): otherwise both sexes' proportions count.
const SURE_OF_SEX: f32 = 0.95;

/// Said of a session without joints.
pub const FROM_DEPTH: &str = "there are no joints: the body was fitted to the depth, and its joints are shown";

/// Shares of the way from the measured body to an average one of the same stature that are tried in turn.
const TOWARDS_AVERAGE: [f32; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];

/// How far a measure that is read off an imported mesh is believed (m): its levels are found, not felt.
const READ_OFF: f32 = 0.01;

/// Facts of a shopper that are known before the measuring.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "FactsText", into = "FactsText")]
pub struct ShopperFacts {
    /// The sex whose proportions apply, if it is known.
    pub sex: Option<Sex>,
    /// Whether they are a child, where that is known; it is estimated otherwise, and changes no measure.
    pub child: Option<bool>,
    /// Whether they wear everyday clothes, which the body lies beneath; otherwise tight ones.
    pub clothed: bool,
    /// Whether they sit: nothing is taken from legs and hips, which a chair hides.
    pub seated: bool,
    /// Measures that they took by tape.
    pub tape: TapeReadings,
    /// Time of the session up to which the depth of a turn counts (ns): the end of the part that was played. The first second always counts.
    pub until_ns: u64,
}

impl Default for ShopperFacts {
    fn default() -> Self {
        Self { sex: None, child: None, clothed: true, seated: false, tape: TapeReadings::default(), until_ns: u64::MAX }
    }
}

/// Facts of a shopper in words and numbers, as a request is written.
#[derive(Serialize, Deserialize)]
struct FactsText {
    sex: Option<String>,
    child: Option<bool>,
    clothed: bool,
    seated: bool,
    tape_m: Vec<(String, f32)>,
    until_ns: u64,
}

impl From<ShopperFacts> for FactsText {
    fn from(facts: ShopperFacts) -> Self {
        let ShopperFacts { sex, child, clothed, seated, tape, until_ns } = facts;
        let tape_m = tape.given().map(|(index, metres)| (MEASURES[index].0.to_owned(), metres)).collect();
        Self { sex: sex.map(|sex| sex.name().to_owned()), child, clothed, seated, tape_m, until_ns }
    }
}

impl TryFrom<FactsText> for ShopperFacts {
    type Error = String;

    fn try_from(text: FactsText) -> Result<Self, String> {
        let FactsText { sex, child, clothed, seated, tape_m, until_ns } = text;
        let mut tape = TapeReadings::default();
        for (name, metres) in &tape_m {
            let index = MEASURES.iter().position(|measure| measure.0 == name);
            let index = index.ok_or_else(|| format!("no measure is named {name}"))?;
            tape = tape.with(index, *metres).map_err(|why| why.to_string())?;
        }
        Ok(Self { sex: sex.as_deref().map(sex_of).transpose()?, child, clothed, seated, tape, until_ns })
    }
}

/// The sex of a name.
///
/// # Errors
/// Any other name.
fn sex_of(name: &str) -> Result<Sex, String> {
    Sex::ALL.into_iter().find(|sex| sex.name() == name).ok_or_else(|| format!("{name} is neither female nor male"))
}

/// A sex by its name.
pub(super) mod sex_name {
    use super::*;

    pub fn serialize<S: serde::Serializer>(sex: &Sex, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(sex.name())
    }

    pub fn deserialize<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Sex, D::Error> {
        sex_of(&String::deserialize(from)?).map_err(serde::de::Error::custom)
    }
}

/// A shopper who was measured.
#[derive(Debug, Clone)]
pub struct MeasuredSubject {
    /// The best that is known: every report, size and body follows from it.
    pub best: Measurements,
    /// All that the body fit gives, where there is depth and a body fits it.
    pub fitted: Option<FittedMeasures>,
    /// The shopper's surface; empty without depth.
    pub surface: DepthSurface,
    /// The population whose proportions stand in for measures that were not seen.
    pub population: Population,
    /// How likely they are a child, 0 to 1; `None` without a stature.
    pub child: Option<f32>,
    /// Whether all that is known of them comes from depth: there were no joints, and no measures by tape.
    depth_alone: bool,
}

impl MeasuredSubject {
    /// The sex of the body to show: as given or measured; otherwise the sex that the garments are made for, and female if they are made for both.
    pub fn sex(&self, garments: Population) -> Sex {
        sex(self.population, garments)
    }

    /// The body to dress, and a sentence about it where there is one: the body fitted to the depth where there was nothing else, otherwise one
    /// that is built to the measures.
    ///
    /// # Errors
    /// As [`build_body`].
    pub fn wearer(&self, garments: Population) -> Result<(Body, Option<String>), FittingError> {
        if let Some(fitted) = self.fitted.as_ref().filter(|_| self.depth_alone) {
            return Ok((fitted.body.body.clone(), None));
        }
        let sex = self.sex(garments);
        build_body(sex, &self.best, Population::from(Some(sex)))
    }
}

/// The sex of the body to show for a shopper of this population, in garments that are made for that one.
pub fn sex(shopper: Population, garments: Population) -> Sex {
    let known = if shopper == Population::Mixed { garments } else { shopper };
    if known == Population::Men { Sex::Male } else { Sex::Female }
}

/// Measures the person who stands or sits in a session.
///
/// # Errors
/// A session without a person who can be measured.
pub fn measure(session: &Session, facts: ShopperFacts) -> Result<MeasuredSubject, FittingError> {
    if facts.seated {
        return seated(session, facts);
    }
    let surface = DepthSurface::until(session, facts.until_ns);
    let fitted = surface.measure(Population::from(facts.sex), facts.clothed);
    let population = population(facts.sex, fitted.as_ref());
    let best = match &fitted {
        Some(fitted) => by_fit(session, &surface, fitted),
        None if session.joints.is_empty() => return Err(surface.refusal(session)),
        None => Measurements {
            valid_pixels: surface.pixels,
            people: surface.people.max(1),
            ..by_proportions(&session.joints, session.raw_scale_known, population)?
        },
    };
    let mut best = with_tape(best, fitted.as_ref().map(|f| &f.all), population, &facts.tape);
    let child = child(&best, facts);
    best.notes.extend(child.filter(|odds| *odds >= 0.5).map(child_note));
    let depth_alone = session.joints.is_empty() && facts.tape.is_empty();
    Ok(MeasuredSubject { best, fitted, surface, population, child, depth_alone })
}

/// The filtered joints of a session from the moment on at which the shopper can be dressed. Without joints the fitted body is followed
/// through the depth.
///
/// # Errors
/// A session in which no person can be followed.
pub fn track(session: &Session, measured: &MeasuredSubject) -> Result<Vec<Joints>, FittingError> {
    if !session.joints.is_empty() {
        return session::standing(session);
    }
    let mut followed = session.clone();
    add_joints(&mut followed, measured)?;
    session::standing(&followed)
}

/// The joints of a session that has none: the fitted body is followed through its depth, and a note says so. Does nothing
/// where there are joints.
///
/// # Errors
/// Depth that no body fits.
pub fn add_joints(session: &mut Session, measured: &MeasuredSubject) -> Result<(), FittingError> {
    if !session.joints.is_empty() {
        return Ok(());
    }
    let fitted = measured.fitted.as_ref().ok_or_else(|| measured.surface.refusal(session))?;
    session.joints = measured.surface.follow(session, fitted);
    session.notes.push(FROM_DEPTH.to_owned());
    Ok(())
}

fn seated(session: &Session, facts: ShopperFacts) -> Result<MeasuredSubject, FittingError> {
    if session.joints.is_empty() {
        return Err(FittingError::Input(format!(
            "session {} has no joints, by which a seated person is measured; record joints, or stand",
            session.name
        )));
    }
    let population = Population::from(facts.sex);
    let above: Vec<Joints> = session.joints.iter().map(above_the_chair).collect();
    let mut seen = by_proportions(&above, true, population)?;
    (seen.measures.hip_girth, seen.measures.inseam) = (None, None);
    let surface = DepthSurface::of(&session::of_joints(Vec::new()));
    let best = with_tape(seen, None, population, &facts.tape);
    Ok(MeasuredSubject {
        best,
        fitted: None,
        surface,
        population,
        child: facts.child.map(f32::from),
        depth_alone: false,
    })
}

fn by_proportions(joints: &[Joints], scale_known: bool, population: Population) -> Result<Measurements, FittingError> {
    measure::by_proportions(joints, &Hint { population, scale_known }).map_err(FittingError::input)
}

/// As it is known, or as the stature lets expect.
fn child(best: &Measurements, facts: ShopperFacts) -> Option<f32> {
    let known = facts.child.map(f32::from);
    known.or_else(|| best.measures.stature.map(child_odds))
}

fn child_note(odds: f32) -> String {
    format!(
        "This is probably a child (odds {odds:.2}): bodies and sizes here are adults', so take the measures by tape; if it is an \
         adult, say so."
    )
}

fn population(facts: Option<Sex>, fitted: Option<&FittedMeasures>) -> Population {
    match (facts, fitted) {
        (Some(sex), _) => Population::from(Some(sex)),
        (None, Some(fitted)) if fitted.woman >= SURE_OF_SEX => Population::Women,
        (None, Some(fitted)) if fitted.woman <= 1.0 - SURE_OF_SEX => Population::Men,
        _ => Population::Mixed,
    }
}

/// The best measures once some were taken by tape: all others follow as far as their errors go with these. `all` is the estimate of the body
/// fit, where there is one.
pub fn with_tape(
    best: Measurements,
    all: Option<&BodyEstimate>,
    population: Population,
    tape: &TapeReadings,
) -> Measurements {
    if tape.is_empty() {
        return best;
    }
    let known = all.copied().unwrap_or_else(|| seen(&best, population));
    let (known, sentences) = tape.over(&known);
    let of = |name: &str| MEASURES.iter().position(|m| m.0 == name).map(|i| known.at(i));
    let mut notes = best.notes.clone();
    notes.extend(sentences);
    Measurements { measures: in_words(of), notes, ..best }
}

/// The estimate for people of that population who share the measures that were seen. Girths that were only guessed from the stature are left
/// out, because they add nothing to it.
fn seen(best: &Measurements, population: Population) -> BodyEstimate {
    let all = tape_readings::population(population);
    let measured = best.measures.named();
    let taken = measured.into_iter().filter(|(name, _)| match best.source {
        Source::Joints => matches!(*name, "stature" | "shoulder_breadth"),
        _ => !matches!(*name, "inseam" | "arm_length"),
    });
    taken
        .filter_map(|(name, e)| Some((MEASURES.iter().position(|m| m.0 == name)?, e?)))
        .fold(all, |all, (index, estimate)| all.observed(index, estimate))
}

/// The measures of the contract by their names.
fn in_words(of: impl Fn(&str) -> Option<Estimate>) -> Measures {
    Measures {
        stature: of("stature"),
        shoulder_breadth: of("shoulder_breadth"),
        chest_girth: of("chest_girth"),
        waist_girth: of("waist_girth"),
        hip_girth: of("hip_girth"),
        inseam: of("leg_length"),
        arm_length: of("arm_length"),
    }
}

/// The measures of the body fit, with the counts of pixels, people and frames.
fn by_fit(session: &Session, surface: &DepthSurface, fitted: &FittedMeasures) -> Measurements {
    Measurements {
        measures: in_words(|name| fitted.named(name)),
        valid_pixels: surface.pixels,
        people: surface.people,
        frames: surface.frames.len(),
        source: if session.joints.is_empty() { Source::Depth } else { Source::Both },
        notes: Vec::new(),
    }
}

/// A frame without the joints that a chair hides.
fn above_the_chair(frame: &Joints) -> Joints {
    use Joint::*;
    let mut above = *frame;
    for joint in [LeftHip, LeftKnee, LeftAnkle, LeftToe, RightHip, RightKnee, RightAnkle, RightToe] {
        above.at_mut(joint).confidence = 0.0;
    }
    above
}

/// A body of the measured size. Where no body has the measures together (a sensor may err in one of them), the nearest
/// one on the way to the average body of that stature is built, and a sentence says so. Measures that are missing are
/// those of the average of `population`.
///
/// # Errors
/// Measures that not even an average body of that stature has.
pub fn build_body(
    sex: Sex,
    measured: &Measurements,
    population: Population,
) -> Result<(Body, Option<String>), FittingError> {
    let wanted = BodyMeasures::from(measured.body(population));
    let average = scaled(&BodyMeasures::average(sex), wanted.stature);
    let mut refused = None;
    for share in TOWARDS_AVERAGE {
        match toile_assets::body::build(sex, &towards(&wanted, &average, share)) {
            Ok(body) => {
                let note = refused.map(|e: BodyError| {
                    format!("the body shown is {:.0} % of the way to an average one, because {e}", share * 100.0)
                });
                return Ok((body, note));
            }
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    Err(match refused {
        Some(error) => FittingError::input(error),
        None => FittingError::internal("no body was tried"),
    })
}

/// The measures of an imported body in place of the measured shopper's.
pub fn read_off(measured: Measurements, body: &Body) -> Measurements {
    let read = |value: f32| Some(Estimate::new(value, READ_OFF));
    let m = &body.measures;
    let measures = Measures {
        stature: read(m.stature),
        shoulder_breadth: read(m.shoulder_breadth),
        chest_girth: read(m.chest_girth),
        waist_girth: read(m.waist_girth),
        hip_girth: read(m.hip_girth),
        ..measured.measures
    };
    Measurements { measures, ..measured }
}

fn scaled(m: &BodyMeasures, stature: f32) -> BodyMeasures {
    let k = stature / m.stature;
    BodyMeasures {
        stature,
        shoulder_breadth: m.shoulder_breadth * k,
        chest_girth: m.chest_girth * k,
        waist_girth: m.waist_girth * k,
        hip_girth: m.hip_girth * k,
    }
}

fn towards(from: &BodyMeasures, to: &BodyMeasures, share: f32) -> BodyMeasures {
    let mix = |a: f32, b: f32| a + (b - a) * share;
    BodyMeasures {
        stature: from.stature,
        shoulder_breadth: mix(from.shoulder_breadth, to.shoulder_breadth),
        chest_girth: mix(from.chest_girth, to.chest_girth),
        waist_girth: mix(from.waist_girth, to.waist_girth),
        hip_girth: mix(from.hip_girth, to.hip_girth),
    }
}
