//! Random people of the survey, each built as a body from eight of their measures, and how well and how fast.

use std::time::Instant;

use serde::Serialize;
use thiserror::Error;
use toile_assets::body::{Ansur, BodyError, Fitted, Vocabulary, Wanted, sound};
use toile_base::body::{Body, Sex};
use toile_base::mesh::Mesh;
use toile_base::numeric::statistics::quantile;

use super::survey::{Survey, SurveyError};
use crate::random::CaseRandom;

/// The measures that each person is built from, the survey's name for them, and the error allowed by ISO 20685 (m):
/// heights, breadths and small girths 4 mm, large girths 9 mm. A sleeve is several bones long: it is held to the 4 mm, too.
pub const GIVEN: [(Ansur, &str, f32); 8] = [
    (Ansur::Stature, "stature", 4e-3),
    (Ansur::NeckCircumference, "neckcircumference", 4e-3),
    (Ansur::ChestCircumference, "chestcircumference", 9e-3),
    (Ansur::WaistCircumferenceOmphalion, "waistcircumference", 9e-3),
    (Ansur::ButtockCircumference, "buttockcircumference", 9e-3),
    (Ansur::CrotchHeight, "crotchheight", 4e-3),
    (Ansur::SleeveLengthSpineWrist, "sleevelengthspinewrist", 4e-3),
    (Ansur::BiacromialBreadth, "biacromialbreadth", 4e-3),
];

/// Measures that are not given, but follow from those that are: held against the person's own.
const FOLLOWING: [(Ansur, &str); 8] = [
    (Ansur::CervicaleHeight, "cervicaleheight"),
    (Ansur::WaistHeightOmphalion, "waistheightomphalion"),
    (Ansur::KneeHeightMidpatella, "kneeheightmidpatella"),
    (Ansur::ThighCircumference, "thighcircumference"),
    (Ansur::CalfCircumference, "calfcircumference"),
    (Ansur::WristCircumference, "wristcircumference"),
    (Ansur::HipBreadth, "hipbreadth"),
    (Ansur::WaistBackLengthOmphalion, "waistbacklength"),
];

/// Roughness over the base body's at which a body counts as looking wrong.
pub const TOO_ROUGH: f32 = 1.10;

/// Time in which a body has to be made (ms): a shopper does not notice it.
pub const QUICK_MS: f64 = 20.0;

/// Why there is no study.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StudyError {
    /// The survey's file cannot be read.
    #[error(transparent)]
    Survey(#[from] SurveyError),
    /// A person whose measures are outside of what bodies are built for.
    #[error("the survey's line {line}: {source}")]
    Person {
        /// The line, from 1.
        line: usize,
        /// Which measure is outside of which range.
        source: BodyError,
    },
    /// The file has no people.
    #[error("the survey has no people: give a file of ANSUR II with one person a line")]
    Empty,
}

/// Median, 95th percentile and greatest of some figures.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Median: half of the people are below.
    pub median: f64,
    /// 95 % are at or below.
    pub p95: f64,
    /// 99 % are at or below.
    pub p99: f64,
    /// Maximum: no person is above.
    pub max: f64,
}

/// How one measure came out over the people.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasureErrors {
    /// What it is called.
    pub measure: &'static str,
    /// Whether the bodies were built to it; else it was expected from the others.
    pub given: bool,
    /// The limit (mm), of given ones.
    pub limit_mm: Option<f64>,
    /// Mean error, with its sign (mm).
    pub bias_mm: f64,
    /// Mean of the error's amount (mm).
    pub mean_mm: f64,
    /// 95th percentile of the amount (mm).
    pub p95_mm: f64,
    /// Greatest amount (mm).
    pub max_mm: f64,
    /// Share of people within the limit.
    pub within: Option<f64>,
}

/// What a study of one sex found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyStudy {
    /// `women` or `men`.
    pub people: &'static str,
    /// How many were drawn from the survey.
    pub drawn: usize,
    /// Number of people that it is out of.
    pub of: usize,
    /// Errors, measure by measure.
    pub measures: Vec<MeasureErrors>,
    /// People whose measures no body has together within 2 mm; their nearest body is counted with its errors.
    pub unreachable: usize,
    /// Time of one calibration, the whole body included (ms).
    pub calibration_ms: Spread,
    /// Gauss-Newton steps of a calibration.
    pub steps: Spread,
    /// Roughness of the base body (Ugur 2008, equation 7.2, over the mean edge).
    pub base_roughness: f64,
    /// Roughness over the base body's.
    pub roughness: Spread,
    /// How much the surface's offsets changed against the base, over the mean edge.
    pub unevenness: Spread,
    /// Bodies that are more than [`TOO_ROUGH`] times as rough as the base.
    pub rough: usize,
    /// Bodies that are folded: an edge pierces a triangle that lies within [`sound::FOLDED_WITHIN`] edges along the surface.
    pub folded: usize,
    /// Bodies of which two parts touch and press into each other, such as thighs: no flaw, but reported.
    pub touching: usize,
    /// Share of bodies that look wrong: too rough or folded.
    pub wrong: f64,
}

impl BodyStudy {
    /// Whether every given measure is within its limit for all people, and no body looks wrong.
    pub fn passes(&self) -> bool {
        self.measures.iter().all(|m| m.within.is_none_or(|w| w == 1.0)) && self.wrong == 0.0
    }

    /// Whether 99 of 100 bodies are made within [`QUICK_MS`].
    pub fn is_quick(&self) -> bool {
        self.calibration_ms.p99 <= QUICK_MS
    }
}

/// One person's body and what it took.
struct BuiltBody {
    row: usize,
    fitted: Fitted,
    reached: bool,
    ms: f64,
}

/// Builds `count` random people of a survey file, without repeats; `progress` is called after each.
///
/// # Errors
/// A file that is no survey, or a person outside of all ranges.
pub fn study(survey: &Survey, count: usize, seed: u64, progress: &dyn Fn()) -> Result<BodyStudy, StudyError> {
    let sex = survey.sex()?;
    let columns: Vec<Vec<f64>> = GIVEN.iter().map(|g| survey.column(g.1)).collect::<Result<_, _>>()?;
    if survey.people() == 0 {
        return Err(StudyError::Empty);
    }
    let base = toile_assets::body::drawn(sex);
    let mut built = Vec::new();
    for row in chosen(survey.people(), count, seed) {
        let metres = |k: usize| (columns[k][row] * 1e-3) as f32;
        let wanted = (0..GIVEN.len()).fold(Wanted::new(), |w, k| w.with(GIVEN[k].0, metres(k)));
        let begun = Instant::now();
        let fitted = toile_assets::body::fitted(sex, &wanted);
        let ms = begun.elapsed().as_secs_f64() * 1e3;
        let (fitted, reached) = match fitted {
            Ok(fitted) => (fitted, true),
            Err(BodyError::Unreachable { nearest, .. }) => (*nearest, false),
            Err(source) => return Err(StudyError::Person { line: row + 2, source }),
        };
        built.push(BuiltBody { row, fitted, reached, ms });
        progress();
    }
    let mut measures = Vec::new();
    for ((measure, _, limit), column) in GIVEN.iter().zip(&columns) {
        measures.push(errors(*measure, Some(*limit), column, &built));
    }
    for (measure, name) in FOLLOWING {
        measures.push(errors(measure, None, &survey.column(name)?, &built));
    }
    Ok(looks(sex, &base, survey.people(), measures, &built))
}

/// Which rows are drawn: the first of a shuffle (Fisher and Yates).
pub(crate) fn chosen(people: usize, count: usize, seed: u64) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..people).collect();
    let mut random = CaseRandom::new("ansur", seed);
    let count = count.min(people);
    for i in 0..count {
        let other = i + random.below(people - i);
        rows.swap(i, other);
    }
    rows.truncate(count);
    rows
}

fn errors(measure: Ansur, limit: Option<f32>, column: &[f64], built: &[BuiltBody]) -> MeasureErrors {
    let off: Vec<f64> = built.iter().map(|b| f64::from(b.fitted.readings.of(measure)) * 1e3 - column[b.row]).collect();
    let n = off.len().max(1) as f64;
    let amounts = spread(off.iter().map(|e| e.abs()).collect());
    let limit_mm = limit.map(|l| f64::from(l) * 1e3);
    MeasureErrors {
        measure: measure.name(),
        given: limit.is_some(),
        limit_mm,
        bias_mm: off.iter().sum::<f64>() / n,
        mean_mm: off.iter().map(|e| e.abs()).sum::<f64>() / n,
        p95_mm: amounts.p95,
        max_mm: amounts.max,
        within: limit_mm.map(|l| off.iter().filter(|e| e.abs() <= l).count() as f64 / n),
    }
}

fn looks(sex: Sex, base: &Body, of: usize, measures: Vec<MeasureErrors>, built: &[BuiltBody]) -> BodyStudy {
    let base_roughness = sound::roughness(&base.mesh);
    let rough = |b: &BuiltBody| sound::roughness(&b.fitted.body.mesh) / base_roughness;
    let roughness: Vec<f32> = built.iter().map(rough).collect();
    let crossed: Vec<[bool; 2]> = built.iter().map(|b| crossed(&b.fitted.body.mesh)).collect();
    let wrong = roughness.iter().zip(&crossed).filter(|(r, [folded, _])| **r > TOO_ROUGH || *folded).count();
    let of_all = |f: &dyn Fn(&BuiltBody) -> f64| spread(built.iter().map(f).collect());
    BodyStudy {
        people: if sex == Sex::Female { "women" } else { "men" },
        drawn: built.len(),
        of,
        measures,
        unreachable: built.iter().filter(|b| !b.reached).count(),
        calibration_ms: of_all(&|b| b.ms),
        steps: of_all(&|b| b.fitted.steps as f64),
        base_roughness: f64::from(base_roughness),
        roughness: spread(roughness.iter().map(|&r| f64::from(r)).collect()),
        unevenness: of_all(&|b| f64::from(sound::unevenness(&b.fitted.body.mesh, &base.mesh))),
        rough: roughness.iter().filter(|r| **r > TOO_ROUGH).count(),
        folded: crossed.iter().filter(|c| c[0]).count(),
        touching: crossed.iter().filter(|c| c[1]).count(),
        wrong: wrong as f64 / built.len().max(1) as f64,
    }
}

/// Whether a surface is folded, and whether parts of it that lie far apart on it touch.
fn crossed(mesh: &Mesh) -> [bool; 2] {
    let all = sound::crossings(mesh);
    let folds = sound::folds(mesh, &all).len();
    [folds > 0, all.len() > folds]
}

fn spread(mut figures: Vec<f64>) -> Spread {
    let mut at = |share: f64| quantile(&mut figures, share).unwrap_or(0.0);
    Spread { median: at(0.5), p95: at(0.95), p99: at(0.99), max: at(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_person_is_drawn_twice() {
        let mut rows = chosen(100, 60, 7);
        assert_eq!(rows, chosen(100, 60, 7), "by the seed");
        assert_ne!(rows, chosen(100, 60, 8));
        rows.sort_unstable();
        rows.dedup();
        assert_eq!(rows.len(), 60);
        assert_eq!(chosen(5, 60, 7).len(), 5);
    }

    #[test]
    fn spreads_are_read_off_the_sorted_figures() {
        let s = spread((1..=100).rev().map(f64::from).collect());
        assert_eq!((s.median, s.p95, s.p99, s.max), (51.0, 96.0, 100.0, 100.0));
    }
}
