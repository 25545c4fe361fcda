//! The study: people drawn from the survey, seen, measured in both ways, compared with what the tape reads on them.

use std::f32::consts::TAU;
use std::path::PathBuf;

use serde::Serialize;
use toile_assets::body::BodyError;
use toile_assets::sizes::Population;
use toile_base::body::Sex;
use toile_base::frame::DepthFrame;
use toile_base::numeric::random::SplitMix64;
use toile_base::numeric::statistics::quantile;
use toile_base::skeleton::Joint;
use toile_fitting::timing::OnCore;
use toile_track::estimate::Estimate;
use toile_track::fit::measuring::{self, FittedMeasures, MEASURES, model_error};
use toile_track::fit::{self, BodyFit};
use toile_track::point_cloud::PersonFinder;

use super::makehuman::{FamilyError, SurveyRanges, makehuman_person};
use super::person::{GIVEN, survey_person};
use super::sensor::{NoiseModel, Sensor, StudyCamera};
use super::sizing::{SizeAgreement, sizes};
use super::standing::{JointPositions, Moment, StudyPerson, TapeMeasures};
use super::surfaces::PersonSurfaces;
use crate::ansur::{Survey, SurveyError, chosen};

/// Whose bodies are studied.
#[derive(Debug, Clone, PartialEq)]
pub enum Family {
    /// People of the survey in the parametric body's own mesh, each with sections that it does not have.
    Survey,
    /// MakeHuman's base mesh with its targets mixed at random, out of a folder of its files.
    Makehuman(PathBuf),
}

impl Family {
    /// The word for reports.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Survey => "survey",
            Self::Makehuman(_) => "makehuman",
        }
    }

    /// What its cameras' noise is like.
    const fn noise(&self) -> NoiseModel {
        match self {
            Self::Survey => NoiseModel::First,
            Self::Makehuman(_) => NoiseModel::Second,
        }
    }
}

/// Why a study cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum MeasuringError {
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
    /// The second family.
    #[error(transparent)]
    Family(#[from] FamilyError),
}

/// Options of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuringOptions {
    /// Whose bodies they are.
    pub family: Family,
    /// People of each sex: drawn from each file of the survey.
    pub people: usize,
    /// Frames that each is measured from.
    pub frames: usize,
    /// Seed of the people drawn, and of how they stand.
    pub seed: u64,
    /// The camera that they are measured with.
    pub sensor: Sensor,
    /// Whether they turn all round after that, and are measured once more.
    pub turn: bool,
    /// Whether each person's surfaces are kept, to be drawn.
    pub surfaces: bool,
}

/// What one way of measuring gave of one person, in the order of [`MEASURES`]; `None` where it takes no such measure.
pub type Estimates = [Option<Estimate>; MEASURES.len()];

/// One person: what is true, and what was measured.
#[derive(Debug, Clone)]
pub struct MeasuredPerson {
    /// Sex that the survey states.
    pub sex: Sex,
    /// Distance from the camera (m).
    pub distance: f32,
    /// What the tape reads, in the order of [`MEASURES`] (m).
    pub truth: TapeMeasures,
    /// By the body fit; nothing where no body was found.
    pub fit: Estimates,
    /// By the body fit once they have turned all round; nothing where they did not.
    pub turned: Estimates,
    /// Frames that were looked at, and those in which no other person was seen.
    pub frames: [usize; 2],
    /// How likely the fit took them for a woman.
    pub woman: Option<f32>,
    /// The surfaces, if they are asked for and can be had.
    pub surfaces: Option<PersonSurfaces>,
    /// Time of measuring from the front, and from front and turn together, all of it after the last frame (s).
    times: [f32; 2],
    /// Each frame followed: its time and that of its stages (s), how far off the surface and the joints are (m).
    followed: Vec<[f32; 7]>,
    /// Time of the first frame (s).
    start: Option<f32>,
}

/// How one measure agrees over the people.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MeasuringAgreement {
    /// Name of the measure.
    pub measure: &'static str,
    /// People for whom it was taken.
    pub taken: usize,
    /// The limit of ISO 20685 for the mean error (mm).
    pub limit_mm: f64,
    /// Mean error (mm).
    pub bias_mm: f64,
    /// The 95 % interval of the mean error: 1.96 standard errors either way (mm).
    pub interval_mm: [f64; 2],
    /// Mean absolute error (mm).
    pub mean_absolute_mm: f64,
    /// The same over the measure itself (%).
    pub mean_absolute_percent: f64,
    /// 95th percentile of the absolute error (mm).
    pub p95_mm: f64,
    /// Mean stated standard deviation (mm).
    pub sigma_mm: f64,
    /// Share of errors within one stated standard deviation.
    pub within_one_sigma: f64,
    /// Share of errors within two stated standard deviations.
    pub within_two_sigma: f64,
    /// Whether the interval lies inside the limit.
    pub pass: bool,
}

/// What following people costs, frame by frame, at how good a fit.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Following {
    /// Frames followed, without those in which a person is found anew.
    pub frames: usize,
    /// Median and 95th percentile of the time that a frame has a core for (ms).
    pub frame_ms: [f64; 2],
    /// Median time of reading the picture, of posing and matching, of adding up, of solving (ms), other work on the
    /// machine included.
    pub stages_ms: [f64; 4],
    /// Median time to find a person anew (ms).
    pub start_ms: f64,
    /// Mean root mean square distance of the surface from the body's (mm).
    pub off_mm: f64,
    /// Root mean square distance of the joints from the true ones, the hands' and the toes' left out (mm).
    pub joints_mm: f64,
    /// Median time of measuring from the front, and from the front and a turn together, both sexes tried, if all of it is done after
    /// the last frame (ms).
    pub measure_ms: [f64; 2],
}

/// What a study found.
#[derive(Debug, Clone, Serialize)]
pub struct MeasuringStudy {
    /// Whose bodies they are: `survey` or `makehuman`.
    pub family: &'static str,
    /// Name of the camera.
    pub sensor: &'static str,
    /// People who were rendered.
    pub people: usize,
    /// Frames that each is measured from.
    pub frames: usize,
    /// People in whom no body was found.
    pub lost: usize,
    /// Share of people whose sex the fit took for the likelier one.
    pub sex_right: f64,
    /// The body fit frame by frame, as it follows people.
    pub following: Following,
    /// By the body fit.
    pub fit: Vec<MeasuringAgreement>,
    /// By the body fit once they have turned all round; empty where they did not.
    pub turned: Vec<MeasuringAgreement>,
    /// Share of the frames in which no other person was seen.
    pub alone: f64,
    /// Sizes recommended from the front, and once they have turned.
    pub sizes: [SizeAgreement; 2],
    /// Errors with what the fit itself states, from the front and turned, by measure.
    #[serde(skip)]
    stated: [Vec<Vec<StatedError>>; 2],
}

/// One error, and what the fit states by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatedError {
    /// Measured less true (mm).
    pub error_mm: f64,
    /// Standard deviation that the fit states, without what is added for bodies that it cannot represent (mm).
    pub own_mm: f64,
}

impl MeasuringStudy {
    /// All errors of the fit, from the front or turned, in the order of [`MEASURES`].
    pub fn stated(&self, turned: bool) -> &[Vec<StatedError>] {
        &self.stated[usize::from(turned)]
    }
}

/// Measures `options.people` random people of each survey, without repeats; `progress` is called after each.
///
/// # Errors
/// A file that is no survey, or a person outside of all ranges.
pub fn study(
    surveys: &[Survey],
    options: &MeasuringOptions,
    progress: &mut dyn FnMut(&MeasuredPerson),
) -> Result<MeasuringStudy, MeasuringError> {
    let mut cases = Vec::new();
    let mut add = |person: &StudyPerson, rng: &mut SplitMix64| {
        let case = measured(person, options, rng);
        progress(&case);
        cases.push(case);
    };
    for survey in surveys {
        let sex = survey.sex()?;
        let seed = |k: usize| options.seed ^ ((k as u64) << 20) ^ u64::from(sex == Sex::Male);
        match &options.family {
            Family::Survey => {
                let columns: Vec<Vec<f64>> = GIVEN.iter().map(|g| survey.column(g.1)).collect::<Result<_, _>>()?;
                for row in chosen(survey.people(), options.people, options.seed) {
                    let metres = std::array::from_fn(|k| (columns[k][row] * 1e-3) as f32);
                    let mut rng = SplitMix64::new(seed(row));
                    let person = survey_person(sex, &metres, &mut rng)
                        .map_err(|source| MeasuringError::Person { line: row + 2, source })?;
                    add(&person, &mut rng);
                }
            }
            Family::Makehuman(folder) => {
                let ranges = SurveyRanges::of(survey)?;
                for k in 0..options.people {
                    let mut rng = SplitMix64::new(seed(k) ^ SECOND);
                    let person = makehuman_person(folder, &ranges, &mut rng)?;
                    add(&person, &mut rng);
                }
            }
        }
    }
    Ok(summed(&cases, options))
}

/// Parts the second family's random numbers from the first's.
const SECOND: u64 = 0x5ec0_4dfa_3117_0000;

/// Time from frame to frame (s).
const FRAME_S: f32 = 1.0 / 30.0;

/// Time of a slow turn (s), and its frames: fifteen a second.
const TURN_S: f32 = 6.0;
const TURN_FRAMES: usize = 90;

/// When the turn begins (s): after the first second.
const TURN_AFTER_S: f32 = 1.0;

/// The moments of the first second, and those of a turn after it.
fn moments(options: &MeasuringOptions) -> Vec<Moment> {
    let front = (0..options.frames).map(|i| Moment { time: i as f32 * FRAME_S, turned: 0.0 });
    let turn = (0..TURN_FRAMES * usize::from(options.turn)).map(|i| {
        let share = i as f32 / TURN_FRAMES as f32;
        Moment { time: TURN_AFTER_S.max(options.frames as f32 * FRAME_S) + TURN_S * share, turned: TAU * share }
    });
    front.chain(turn).collect()
}

fn measured(person: &StudyPerson, options: &MeasuringOptions, rng: &mut SplitMix64) -> MeasuredPerson {
    let sight = StudyCamera::new(options.sensor, options.family.noise(), rng);
    let moments = moments(options);
    let frames = sight.frames(person, &moments, rng);
    let mut finder = PersonFinder::default();
    let (mut alone, mut single) = (Vec::with_capacity(frames.len()), 0);
    for (frame, truth) in &frames {
        let seen = finder.push(frame);
        single += usize::from(seen.people <= 1);
        alone.extend(seen.alone.map(|a| (a, *truth)));
    }
    let only: Vec<DepthFrame> = alone.iter().map(|a| a.0.clone()).collect();
    let count = [frames.len(), single];
    let mut frames: Vec<DepthFrame> = frames.into_iter().map(|f| f.0).collect();
    frames.truncate(options.frames);
    let bare = fit::FitOptions { clothed: false, ..fit::FitOptions::MEASURING };
    let taken = |frames: &[DepthFrame]| {
        let watch = OnCore::begin();
        let fitted = measuring::measure(frames, Population::Mixed, bare);
        (fitted, watch.elapsed().as_secs_f32())
    };
    let (fitted, front_s) = taken(&only[..only.len().min(options.frames)]);
    let (turned, turned_s) = if options.turn { taken(&only) } else { (None, 0.0) };
    let turned = turned.filter(|f| f.turned);
    let ends = [options.frames.saturating_sub(1), moments.len().saturating_sub(1)].map(|i| moments[i]);
    let surfaces = fitted.as_ref().filter(|_| options.surfaces);
    let surfaces =
        surfaces.and_then(|f| PersonSurfaces::new(person, (f, ends[0]), turned.as_ref().map(|t| (t, ends[1]))));
    let estimates = |f: &FittedMeasures| f.measures.map(Some);
    let (start, followed) = follow(person, &alone);
    MeasuredPerson {
        start,
        followed,
        sex: person.sex,
        distance: sight.distance,
        truth: person.truth,
        fit: fitted.as_ref().map_or([None; MEASURES.len()], estimates),
        turned: turned.as_ref().map_or([None; MEASURES.len()], estimates),
        frames: count,
        woman: fitted.map(|f| f.woman),
        surfaces,
        times: [front_s, turned_s],
    }
}

/// Frames of each person through which they are followed: the first finds them.
const FOLLOWED: usize = 10;

/// Follows a person through their first frames, as at 30 Hz.
fn follow(person: &StudyPerson, frames: &[(DepthFrame, JointPositions)]) -> (Option<f32>, Vec<[f32; 7]>) {
    let mut fit = BodyFit::new(person.sex, fit::FitOptions { clothed: false, ..fit::FitOptions::LIVE });
    let (mut start, mut followed) = (None, Vec::new());
    for (frame, truth) in frames.iter().take(FOLLOWED) {
        let watch = OnCore::begin();
        let seen = fit.push(frame);
        let time = watch.elapsed().as_secs_f32();
        if seen.started {
            start = Some(time);
        } else if seen.found {
            let squares = HELD.map(|j| seen.joints.at(j).position.distance_squared(truth[j.index()]));
            let joints = (squares.iter().sum::<f32>() / squares.len() as f32).sqrt();
            let s = fit.times();
            followed.push([time, s.cells, s.correspond, s.equations, s.solve, seen.off, joints]);
        }
    }
    (start, followed)
}

/// Joints that are held against the true ones.
const HELD: [Joint; 14] = [
    Joint::Pelvis,
    Joint::Chest,
    Joint::Neck,
    Joint::Head,
    Joint::LeftShoulder,
    Joint::LeftElbow,
    Joint::LeftWrist,
    Joint::RightShoulder,
    Joint::RightElbow,
    Joint::RightWrist,
    Joint::LeftKnee,
    Joint::LeftAnkle,
    Joint::RightKnee,
    Joint::RightAnkle,
];

fn following(cases: &[MeasuredPerson]) -> Following {
    let all: Vec<&[f32; 7]> = cases.iter().flat_map(|c| &c.followed).collect();
    let rank = |mut figures: Vec<f32>, share: f64| quantile(&mut figures, share).map_or(0.0, |f| f64::from(f) * 1e3);
    let column = |k: usize| all.iter().map(|f| f[k]).collect::<Vec<f32>>();
    let n = all.len().max(1) as f64;
    let squares: f64 = all.iter().map(|f| f64::from(f[6]).powi(2)).sum();
    Following {
        frames: all.len(),
        frame_ms: [rank(column(0), 0.5), rank(column(0), 0.95)],
        stages_ms: [1, 2, 3, 4].map(|k| rank(column(k), 0.5)),
        start_ms: rank(cases.iter().filter_map(|c| c.start).collect(), 0.5),
        off_mm: all.iter().map(|f| f64::from(f[5])).sum::<f64>() / n * 1e3,
        joints_mm: (squares / n).sqrt() * 1e3,
        measure_ms: [0, 1].map(|k| rank(cases.iter().map(|c| c.times[k]).collect(), 0.5)),
    }
}

fn summed(cases: &[MeasuredPerson], options: &MeasuringOptions) -> MeasuringStudy {
    let right = |c: &&MeasuredPerson| c.woman.is_some_and(|w| (w > 0.5) == (c.sex == Sex::Female));
    let found = cases.iter().filter(|c| c.woman.is_some()).count();
    let sum = |count: fn(&MeasuredPerson) -> usize| cases.iter().map(count).sum::<usize>() as f64;
    let share = |part, whole| sum(part) / sum(whole).max(1.0);
    MeasuringStudy {
        family: options.family.name(),
        sensor: options.sensor.name(),
        people: cases.len(),
        frames: options.frames,
        lost: cases.len() - found,
        sex_right: cases.iter().filter(right).count() as f64 / found.max(1) as f64,
        following: following(cases),
        fit: agreements(cases, |c| &c.fit),
        turned: agreements(cases, |c| &c.turned),
        alone: share(|c| c.frames[1], |c| c.frames[0]),
        sizes: [
            sizes(cases.iter().map(|c| (c.sex, &c.truth, &c.fit))),
            sizes(cases.iter().map(|c| (c.sex, &c.truth, &c.turned))),
        ],
        stated: [stated(cases, false, |c| &c.fit), stated(cases, true, |c| &c.turned)],
    }
}

/// All errors of one way with what the fit itself states, by measure.
fn stated(
    cases: &[MeasuredPerson],
    turned: bool,
    way: impl Fn(&MeasuredPerson) -> &Estimates,
) -> Vec<Vec<StatedError>> {
    let of = |i: usize| {
        let added = model_error(turned)[i];
        let pairs = cases.iter().filter_map(|c| Some((way(c)[i]?, c.truth[i]?)));
        let own = |sigma: f32| (sigma * sigma - added * added).max(0.0).sqrt();
        let stated = |(e, truth): (Estimate, f32)| StatedError {
            error_mm: f64::from(e.value - truth) * 1e3,
            own_mm: f64::from(own(e.sigma)) * 1e3,
        };
        pairs.map(stated).collect()
    };
    (0..MEASURES.len()).map(of).collect()
}

fn agreements(cases: &[MeasuredPerson], way: impl Fn(&MeasuredPerson) -> &Estimates) -> Vec<MeasuringAgreement> {
    let all = MEASURES.iter().enumerate().map(|(i, &(measure, _, limit))| {
        let pairs: Vec<(Estimate, f32)> = cases.iter().filter_map(|c| Some((way(c)[i]?, c.truth[i]?))).collect();
        agreement(measure, f64::from(limit) * 1e3, &pairs)
    });
    all.filter(|a| a.taken > 0).collect()
}

fn agreement(measure: &'static str, limit_mm: f64, pairs: &[(Estimate, f32)]) -> MeasuringAgreement {
    let n = pairs.len().max(1) as f64;
    let errors: Vec<f64> = pairs.iter().map(|(e, t)| f64::from(e.value - t) * 1e3).collect();
    let bias = errors.iter().sum::<f64>() / n;
    let variance = errors.iter().map(|e| (e - bias).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    let half = 1.96 * (variance / n).sqrt();
    let mut absolute: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
    let relative: f64 = pairs.iter().zip(&errors).map(|((_, t), e)| e.abs() / f64::from(*t) * 0.1).sum();
    let within = |sigmas: f32| {
        let count = pairs.iter().filter(|(e, t)| (e.value - t).abs() <= sigmas * e.sigma).count();
        count as f64 / n
    };
    let mean = absolute.iter().sum::<f64>() / n;
    MeasuringAgreement {
        measure,
        taken: pairs.len(),
        limit_mm,
        bias_mm: bias,
        interval_mm: [bias - half, bias + half],
        mean_absolute_mm: mean,
        mean_absolute_percent: relative / n,
        p95_mm: quantile(&mut absolute, 0.95).unwrap_or(0.0),
        sigma_mm: pairs.iter().map(|(e, _)| f64::from(e.sigma) * 1e3).sum::<f64>() / n,
        within_one_sigma: within(1.0),
        within_two_sigma: within(2.0),
        pass: pairs.len() > 1 && bias.abs() + half <= limit_mm,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_is_of_the_mean_and_a_pass_needs_all_of_it_inside() {
        let pairs: Vec<(Estimate, f32)> =
            (0..100).map(|i| (Estimate::new(1.0 + 0.001 * (i % 5) as f32, 0.002), 1.0)).collect();
        let a = agreement("stature", 4.0, &pairs);
        assert!((a.bias_mm - 2.0).abs() < 1e-3 && (a.mean_absolute_mm - 2.0).abs() < 1e-3);
        let half = 1.96 * (2.0f64 * 100.0 / 99.0).sqrt() / 10.0;
        assert!((a.interval_mm[1] - 2.0 - half).abs() < 1e-3, "{a:?}");
        assert!(a.pass && !agreement("stature", 2.1, &pairs).pass);
        assert!((a.within_two_sigma - 1.0).abs() < 1e-9 && (a.p95_mm - 4.0).abs() < 1e-3);
        assert!(!agreement("stature", 4.0, &[]).pass, "no people give no agreement");
    }
}
