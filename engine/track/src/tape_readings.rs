//! Measures that were taken by tape: read from words, checked, and merged with the measured ones.

use std::sync::LazyLock;

use toile_assets::body::shape::Shapes;
use toile_assets::sizes::Population;
use toile_base::body::Sex;

use crate::correlated::Correlated;
use crate::estimate::Estimate;
use crate::fit::measuring::{MEASURES, covariance_of};

/// All measures of a body, with what their errors have in common, in the order of [`MEASURES`].
pub type BodyEstimate = Correlated<{ MEASURES.len() }>;

/// Standard deviation of a tape in untrained hands (m): ISO 20685 allows trained ones 4 to 9 mm.
const TAPE: f32 = 0.005;

/// A measure by tape farther from the value expected by the others than this many standard deviations is refused.
const FARTHEST_SIGMAS: f32 = 5.0;

/// A measure by tape farther from the camera's than this many standard deviations of both is said to be.
const APART: f32 = 3.0;

/// Words for measures beside their names without `_girth`, `_breadth` and `_length`.
const WORDS: [(&str, &str); 8] = [
    ("height", "stature"),
    ("shoulders", "shoulder_breadth"),
    ("bust", "chest_girth"),
    ("hips", "hip_girth"),
    ("inseam", "leg_length"),
    ("inside_leg", "leg_length"),
    ("seat", "hip_girth"),
    ("collar", "neck_girth"),
];

/// Units by the words for them, and their length (m); without one it is millimetres.
const UNITS: [(&str, f32); 6] =
    [("mm", 1e-3), ("cm", 1e-2), ("in", 0.0254), ("inch", 0.0254), ("\"", 0.0254), ("m", 1.0)];

/// Standard deviations that people of the survey stray by: within them a measure by tape is taken for its unit's, and beyond them
/// it is refused.
pub(crate) const MOST_SIGMAS: f32 = 6.0;

/// Why a measure by tape is refused; each message says what and the cure.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TapeError {
    /// No `name=value`.
    #[error("`{0}` is no measure; write it as chest=912 (millimetres), chest=91.2cm or chest=36in")]
    Form(String),
    /// An unknown name.
    #[error("there is no measure `{name}`; there are {names}")]
    Name {
        /// What was given.
        name: String,
        /// The names that exist.
        names: String,
    },
    /// A length outside of people's range.
    #[error("no person's {measure} is {given_mm:.0} mm: people's lie between {low_mm:.0} and {high_mm:.0} mm{cure}")]
    Unit {
        /// The measure.
        measure: &'static str,
        /// What was given (mm).
        given_mm: f32,
        /// The least that people have (mm).
        low_mm: f32,
        /// The most that people have (mm).
        high_mm: f32,
        /// What was probably meant.
        cure: String,
    },
    /// Two of them that no person has together.
    #[error(
        "a {measure} of {given_mm:.0} mm does not go with the other measures by tape: with these it is {expected_mm:.0} mm, give \
         or take {sigma_mm:.0}; take it again, or leave one out"
    )]
    Contradiction {
        /// The measure that stands out most.
        measure: &'static str,
        /// What was given (mm).
        given_mm: f32,
        /// What the others let expect (mm).
        expected_mm: f32,
        /// Its standard deviation (mm).
        sigma_mm: f32,
    },
}

/// Measures taken by tape, at most one of each.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TapeReadings {
    /// In the order of [`MEASURES`] (m).
    values: [Option<f32>; MEASURES.len()],
}

/// A measure's name as people say it.
fn plain(name: &str) -> String {
    name.replace('_', " ")
}

fn index_of(word: &str) -> Result<usize, TapeError> {
    let word = word.trim().to_lowercase().replace([' ', '-'], "_");
    let named = WORDS.iter().find(|w| w.0 == word).map_or(word.as_str(), |w| w.1);
    let short = |name: &str| ["_girth", "_breadth", "_length"].iter().any(|end| name.strip_suffix(end) == Some(named));
    MEASURES
        .iter()
        .position(|m| m.0 == named || short(m.0))
        .ok_or_else(|| TapeError::Name { name: word.clone(), names: MEASURES.map(|m| m.0).join(", ") })
}

/// What people of either sex have, before any of them is seen. Reading it off the bodies takes a moment, once.
pub fn population(population: Population) -> BodyEstimate {
    fn of(sex: Sex) -> BodyEstimate {
        let shapes = Shapes::of(sex);
        covariance_of(shapes, shapes.mean(), &shapes.covariance())
    }
    static WOMEN: LazyLock<BodyEstimate> = LazyLock::new(|| of(Sex::Female));
    static MEN: LazyLock<BodyEstimate> = LazyLock::new(|| of(Sex::Male));
    match population {
        Population::Women => *WOMEN,
        Population::Men => *MEN,
        Population::Mixed => Correlated::mixed(&[(0.5, *WOMEN), (0.5, *MEN)]),
    }
}

impl TapeReadings {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.values.iter().all(Option::is_none)
    }

    /// What was taken: the place of each in [`MEASURES`], and its length (m).
    pub fn given(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.values.iter().enumerate().filter_map(|(i, v)| Some((i, (*v)?)))
    }

    /// What was taken of one measure, by its place in [`MEASURES`] (m).
    pub fn at(&self, index: usize) -> Option<f32> {
        self.values.get(index).copied().flatten()
    }

    /// The stature that was taken (m).
    pub fn stature(&self) -> Option<f32> {
        MEASURES.iter().position(|measure| measure.0 == "stature").and_then(|index| self.at(index))
    }

    /// The same without one of them, by its place in [`MEASURES`].
    #[must_use]
    pub fn without(mut self, index: usize) -> Self {
        self.values[index] = None;
        self
    }

    /// Adds a measure by its place in [`MEASURES`] (m).
    ///
    /// # Errors
    /// A length outside of people's range.
    pub fn with(mut self, index: usize, value: f32) -> Result<Self, TapeError> {
        let all = population(Population::Mixed);
        let ranges = |index: usize| {
            let Estimate { value, sigma } = all.at(index);
            value - MOST_SIGMAS * sigma..value + MOST_SIGMAS * sigma
        };
        let range = ranges(index);
        if !range.contains(&value) {
            let meant = |by: f32| range.contains(&(value * by));
            let cure = match value {
                _ if meant(10.0) => "; were centimetres meant? write them as chest=91.2cm",
                _ if meant(25.4) => "; were inches meant? write them as chest=36in",
                _ if meant(1000.0) => "; were metres meant? write them as stature=1.75m",
                _ => "; take it again",
            };
            return Err(TapeError::Unit {
                measure: MEASURES[index].0,
                given_mm: value * 1e3,
                low_mm: range.start * 1e3,
                high_mm: range.end * 1e3,
                cure: cure.to_owned(),
            });
        }
        self.values[index] = Some(value);
        Ok(self)
    }

    /// Adds a measure in words, `chest=912` (mm), `chest=91.2cm` or `chest=36in`.
    ///
    /// # Errors
    /// Words that are no measure, or a length outside of people's range.
    pub fn and(self, words: &str) -> Result<Self, TapeError> {
        let form = || TapeError::Form(words.to_owned());
        let (name, length) = words.split_once('=').ok_or_else(form)?;
        let index = index_of(name)?;
        let length = length.trim().to_lowercase();
        let digits = length.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(length.len());
        let (number, unit) = length.split_at(digits);
        let number: f32 = number.parse().map_err(|_| form())?;
        let metres = match unit.trim() {
            "" => 1e-3,
            unit => UNITS.iter().find(|u| u.0 == unit).ok_or_else(form)?.1,
        };
        self.with(index, number * metres)
    }

    /// All measures in words, checked against one another.
    ///
    /// # Errors
    /// As [`TapeReadings::and`], and measures that no person has together.
    pub fn of<S: AsRef<str>>(words: &[S]) -> Result<Self, TapeError> {
        let tape = words.iter().try_fold(Self::default(), |tape, w| tape.and(w.as_ref()))?;
        tape.check()?;
        Ok(tape)
    }

    /// Checks each measure against what all others let expect of either sex.
    ///
    /// # Errors
    /// The measure that stands out most, if no person has it.
    pub fn check(&self) -> Result<(), TapeError> {
        let mut worst: Option<(f32, TapeError)> = None;
        for (index, value) in self.given() {
            let expected = [Population::Women, Population::Men].map(|p| {
                let others = self.given().filter(|(i, _)| *i != index);
                others.fold(population(p), |all, (i, v)| all.observed(i, Estimate::new(v, TAPE))).at(index)
            });
            let off = |e: &Estimate| (value - e.value).abs() / e.sigma;
            let nearest = if off(&expected[0]) < off(&expected[1]) { expected[0] } else { expected[1] };
            if off(&nearest) > FARTHEST_SIGMAS && worst.as_ref().is_none_or(|w| off(&nearest) > w.0) {
                let error = TapeError::Contradiction {
                    measure: MEASURES[index].0,
                    given_mm: value * 1e3,
                    expected_mm: nearest.value * 1e3,
                    sigma_mm: nearest.sigma * 1e3,
                };
                worst = Some((off(&nearest), error));
            }
        }
        worst.map_or(Ok(()), |w| Err(w.1))
    }

    /// What is known of a body once all that was taken by tape is laid over what was measured, and a sentence for each measure in which the
    /// two disagree.
    pub fn over(&self, measured: &BodyEstimate) -> (BodyEstimate, Vec<String>) {
        let mut notes = Vec::new();
        for (index, value) in self.given() {
            let seen = measured.at(index);
            if (value - seen.value).abs() > APART * seen.sigma.hypot(TAPE) {
                notes.push(format!(
                    "The {} by tape is {:.0} mm, where the camera sees {:.0} mm, give or take {:.0}: the tape is believed; take it again \
                     if in doubt.",
                    plain(MEASURES[index].0),
                    value * 1e3,
                    seen.value * 1e3,
                    seen.sigma * 1e3
                ));
            }
        }
        (self.given().fold(*measured, |all, (i, v)| all.observed(i, Estimate::new(v, TAPE))), notes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn index(name: &str) -> usize {
        MEASURES.iter().position(|m| m.0 == name).unwrap()
    }

    #[test]
    fn all_eleven_are_read_in_every_unit() {
        for (name, _, _) in MEASURES {
            let mean = population(Population::Mixed).mean[index(name)];
            let tape = TapeReadings::of(&[format!("{name}={:.1}", mean * 1e3)]).unwrap();
            assert!((tape.given().next().unwrap().1 - mean).abs() < 1e-4, "{name}");
        }
        let of = |words: &str| TapeReadings::of(&[words]).unwrap().given().next().unwrap();
        let chest = index("chest_girth");
        for words in ["chest=912", "bust=91.2cm", "chest_girth=0.912m", "Chest = 912 mm"] {
            let (i, v) = of(words);
            assert!(i == chest && (v - 0.912).abs() < 1e-5, "{words}: {v}");
        }
        assert!((of("waist=30in").1 - 0.762).abs() < 1e-5);
        assert_eq!(of("inseam=800").0, index("leg_length"));
    }

    #[test]
    fn what_is_no_measure_is_refused_with_its_cure() {
        let refused = |words: &[&str]| TapeReadings::of(words).unwrap_err().to_string();
        assert!(refused(&["chest"]).contains("chest=912"));
        assert!(refused(&["tail=300"]).contains("chest_girth"));
        assert!(refused(&["chest=91.2"]).contains("centimetres"));
        assert!(refused(&["chest=36"]).contains("inches"));
        assert!(refused(&["stature=1.75"]).contains("metres"));
        assert!(refused(&["chest=912km"]).contains("chest=912"));
        let apart = refused(&["chest=800", "underbust=1150"]);
        assert!(apart.contains("does not go with"), "{apart}");
    }

    #[test]
    fn a_chest_told_makes_the_waist_surer_and_a_disagreement_is_said() {
        let before = population(Population::Women);
        let chest = index("chest_girth");
        let tape = TapeReadings::default().with(chest, before.mean[chest] + 0.10).unwrap();
        let (after, notes) = tape.over(&before);
        let waist = index("waist_girth");
        assert!(after.mean[waist] > before.mean[waist] + 0.03);
        assert!(after.at(waist).sigma < 0.8 * before.at(waist).sigma);
        assert!(after.at(chest).sigma <= TAPE && notes.is_empty());
        let sure = before.observed(chest, Estimate::new(before.mean[chest], 0.01));
        assert_eq!(tape.over(&sure).1.len(), 1);
    }
}
