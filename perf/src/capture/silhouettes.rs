//! Bodies from silhouettes, against people whose measures are known: of the survey and of another family, before calibrated cameras.
//!
//! What is rendered is not what the fit assumes: bodies have sections that the parametric body cannot have or are another mesh
//! altogether, they stand as they like and face anywhere, cameras are not quite as they say, and masks are black and white.

use std::f64::consts::TAU;
use std::path::PathBuf;

use glam::{DMat3, DQuat, DVec3, Vec3};
use serde::Serialize;
use thiserror::Error;
use toile_assets::body::tape::girth;
use toile_base::body::{Levels, Sex};
use toile_base::numeric::random::SplitMix64;
use toile_base::numeric::statistics::quantile;
use toile_capture::body::{SilhouetteBody, SilhouetteOptions, SilhouetteView, measure, overlay_png};
use toile_capture::error::CaptureError;
use toile_pose::depth_buffer::DepthBuffer;
use toile_sensors::calibration::{CalibratedCamera, CameraParameters};
use toile_sensors::masks::Mask;
use toile_track::fit::measuring::MEASURES;

use crate::ansur::{StudyError, Survey, chosen};
use crate::measuring::{
    FamilyError, GIVEN, Moment, StudyPerson, SurveyRanges, TapeMeasures, makehuman_person, survey_person,
};

/// The goal: mean absolute error of girths (mm).
pub const GIRTH_MM: f64 = 8.0;

/// Size (px) and focal length (px) of a camera, its height and distance (m).
const SIZE: [u32; 2] = [1080, 1440];
const FOCAL: f64 = 1_500.0;
const HEIGHT: f64 = 1.2;
const DISTANCE: [f64; 2] = [2.6, 3.0];

/// How far a calibration is off: focal length (relative), principal point (px), place (m) and direction (rad).
const OFF: [f64; 4] = [0.001, 0.4, 0.0015, 0.0006];

/// Noise of a segmenter: standard deviation of the coverage at which a pixel becomes the person's.
const RAGGED: f32 = 0.2;

/// What is studied.
#[derive(Debug, Clone, PartialEq)]
pub struct SilhouetteStudyOptions {
    /// MakeHuman's files, for the other family; absent for people of the survey.
    pub makehuman: Option<PathBuf>,
    /// People of each sex.
    pub people: usize,
    /// Cameras around them.
    pub cameras: usize,
    /// Whether cameras stand evenly all round, an even number of them in opposite pairs; else no two are opposite.
    pub opposite: bool,
    /// Which people, and how they stand.
    pub seed: u64,
    /// Whether each person's silhouettes are drawn with the body that was found.
    pub pictures: bool,
}

/// Why a study cannot be made.
#[derive(Debug, Error)]
pub enum SilhouetteStudyError {
    /// The survey's people.
    #[error(transparent)]
    Survey(#[from] StudyError),
    /// The second family.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// A person whom no body fits.
    #[error(transparent)]
    Capture(#[from] CaptureError),
}

/// How one measure agrees over the people.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SilhouetteAgreement {
    /// Its name.
    pub measure: &'static str,
    /// People for whom it is known.
    pub people: usize,
    /// Mean error (mm).
    pub bias_mm: f64,
    /// Mean absolute error (mm).
    pub mean_absolute_mm: f64,
    /// 95th percentile of the absolute error (mm).
    pub p95_mm: f64,
    /// Mean stated standard deviation (mm).
    pub sigma_mm: f64,
    /// Mean of the squared error over the stated variance: 1 where it is honest.
    pub chi_square: f64,
    /// The standard deviation that would have to be added to what the fit states by itself for that to be 1 (mm).
    pub missing_mm: f64,
    /// Share of errors within one and two standard deviations.
    pub within: [f64; 2],
}

/// What a study found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SilhouetteStudy {
    /// `survey` or `makehuman`.
    pub family: &'static str,
    /// Cameras around each person.
    pub cameras: usize,
    /// Whether they stood evenly all round, an even number of them in opposite pairs.
    pub opposite: bool,
    /// People, and those whom no body fits.
    pub people: usize,
    /// People whom no body fitted.
    pub lost: usize,
    /// Share of the people whose sex was found.
    pub sex_right: f64,
    /// Mean share that drawing and silhouettes have in common.
    pub agreement: f64,
    /// Mean time of one person, both sexes tried (s).
    pub seconds: f64,
    /// Mean absolute error of the girths, of all together (mm).
    pub girths_mm: f64,
    /// Mean absolute difference of the two surfaces' girths at chest, underbust, waist and hip, both taken at the heights at which the fit
    /// has them (mm): what the surface errs, without where the tape is laid.
    pub same_height_mm: f64,
    /// Mean of the squared error over the stated variance, all measures together.
    pub chi_square: f64,
    /// Measure by measure.
    pub measures: Vec<SilhouetteAgreement>,
}

/// One person who was measured: truth and what was found.
struct SilhouetteCase {
    truth: TapeMeasures,
    sex: Sex,
    found: Option<SilhouetteBody>,
    /// Mean absolute difference of girths at the same heights (m), where a body was found.
    same_height: f32,
    seconds: f64,
}

/// Measures people of each survey's sex; `progress` is called after each, with a PNG file where pictures are asked for.
///
/// # Errors
/// A file that is no survey, files that are not MakeHuman's, a person outside of all ranges.
pub fn study(
    surveys: &[Survey],
    options: &SilhouetteStudyOptions,
    progress: &mut dyn FnMut(Option<Vec<u8>>),
) -> Result<SilhouetteStudy, SilhouetteStudyError> {
    let mut cases = Vec::new();
    for survey in surveys {
        for (person, mut rng) in people(survey, options)? {
            let (case, picture) = seen(&person, options, &mut rng);
            cases.push(case);
            progress(picture);
        }
    }
    Ok(summed(&cases, options))
}

/// People of a survey's sex, each with the random numbers of how they stand.
pub(super) fn people(
    survey: &Survey,
    options: &SilhouetteStudyOptions,
) -> Result<Vec<(StudyPerson, SplitMix64)>, SilhouetteStudyError> {
    let sex = survey.sex().map_err(StudyError::from)?;
    let rng = |k: usize| SplitMix64::new(options.seed ^ ((k as u64) << 20) ^ u64::from(sex == Sex::Male) ^ 0x51_10e7);
    let mut all = Vec::new();
    if let Some(folder) = &options.makehuman {
        let ranges = SurveyRanges::of(survey).map_err(StudyError::from)?;
        for k in 0..options.people {
            let mut rng = rng(k);
            all.push((makehuman_person(folder, &ranges, &mut rng)?, rng));
        }
        return Ok(all);
    }
    let columns: Result<Vec<Vec<f64>>, _> = GIVEN.iter().map(|g| survey.column(g.1)).collect();
    let columns = columns.map_err(StudyError::from)?;
    for row in chosen(survey.people(), options.people, options.seed) {
        let metres = std::array::from_fn(|k| (columns[k][row] * 1e-3) as f32);
        let mut rng = rng(row);
        let person =
            survey_person(sex, &metres, &mut rng).map_err(|source| StudyError::Person { line: row + 2, source })?;
        all.push((person, rng));
    }
    Ok(all)
}

/// The person of a study, seen and measured.
fn seen(
    person: &StudyPerson,
    options: &SilhouetteStudyOptions,
    rng: &mut SplitMix64,
) -> (SilhouetteCase, Option<Vec<u8>>) {
    let rig = rig(options, rng);
    let masks = masks(person, &rig, rng);
    let views: Vec<SilhouetteView> =
        rig.iter().zip(&masks).map(|((said, _), mask)| SilhouetteView { camera: said, mask }).collect();
    let begun = std::time::Instant::now();
    let found = measure(&views, &SilhouetteOptions::default()).ok();
    let seconds = begun.elapsed().as_secs_f64();
    let shown = found.as_ref().filter(|_| options.pictures);
    let picture = shown.and_then(|f| overlay_png(&views, &f.standing, &f.body.body.mesh.triangles).ok());
    let same_height = found.as_ref().map_or(0.0, |f| same_height(person, f));
    (SilhouetteCase { truth: person.truth, sex: person.sex, found, same_height, seconds }, picture)
}

/// Mean absolute difference of girths of the trunk (m), both read where the found body has its levels.
fn same_height(person: &StudyPerson, found: &SilhouetteBody) -> f32 {
    let body = &found.body.body;
    let Levels { chest, underbust, waist, hip, .. } = body.levels;
    let heights = [chest, underbust, waist, hip];
    heights.iter().map(|h| (girth(body, *h) - person.girth(*h)).abs()).sum::<f32>() / heights.len() as f32
}

/// Cameras all round, each as it is said to be and as it is.
pub(super) fn rig(options: &SilhouetteStudyOptions, rng: &mut SplitMix64) -> Vec<(CalibratedCamera, CalibratedCamera)> {
    let about = f64::from(rng.uniform()) * TAU;
    let cameras = options.cameras;
    // Opposite cameras see the same outline. So half a turn is shared out, and every other camera looks from the other side.
    let angle = |k: usize| match options.opposite {
        true => TAU * k as f64 / cameras as f64,
        false => 0.5 * TAU * (k as f64 / cameras as f64 + (k % 2) as f64),
    };
    let spread = |rng: &mut SplitMix64, by: f64| by * f64::from(rng.gaussian());
    (0..cameras)
        .map(|k| {
            let angle = about + angle(k) + spread(rng, 0.05);
            let far = DISTANCE[0] + (DISTANCE[1] - DISTANCE[0]) * f64::from(rng.uniform());
            let from = DVec3::new(far * angle.sin(), HEIGHT + spread(rng, 0.05), far * angle.cos());
            let ahead = (DVec3::new(0.0, 0.88, 0.0) - from).normalize();
            let right = ahead.cross(DVec3::Y).normalize();
            let rotation = DMat3::from_cols(right, ahead.cross(right), ahead).transpose();
            let middle = SIZE.map(|s| f64::from(s) / 2.0 - 0.5);
            let camera = |focal: f64, [cx, cy]: [f64; 2], rotation: DMat3, from: DVec3| {
                let given = CameraParameters {
                    size: SIZE.map(f64::from),
                    matrix: [[focal, 0.0, cx], [0.0, focal, cy], [0.0, 0.0, 1.0]],
                    distortion: Vec::new(),
                    rotation,
                    translation: -(rotation * from),
                };
                CalibratedCamera::new(&format!("cam{}", k + 1), &given).expect("it is a camera")
            };
            let turn = DVec3::new(spread(rng, OFF[3]), spread(rng, OFF[3]), spread(rng, OFF[3]));
            let moved = DVec3::new(spread(rng, OFF[2]), spread(rng, OFF[2]), spread(rng, OFF[2]));
            let real = camera(
                FOCAL * (1.0 + spread(rng, OFF[0])),
                middle.map(|c| c + spread(rng, OFF[1])),
                DMat3::from_quat(DQuat::from_scaled_axis(turn)) * rotation,
                from + moved,
            );
            (camera(FOCAL, middle, rotation, from), real)
        })
        .collect()
}

/// The masks of a person who stands and faces any direction.
fn masks(person: &StudyPerson, rig: &[(CalibratedCamera, CalibratedCamera)], rng: &mut SplitMix64) -> Vec<Mask> {
    let mut positions = Vec::new();
    let facing = rng.uniform() * std::f32::consts::TAU;
    person.stand(Moment { time: 0.0, turned: facing }, rng, &mut positions);
    segmented(person, &positions, rig, rng)
}

/// What a segmenter makes of a surface in each picture: black and white, ragged at the edge.
pub(super) fn segmented(
    person: &StudyPerson,
    positions: &[Vec3],
    rig: &[(CalibratedCamera, CalibratedCamera)],
    rng: &mut SplitMix64,
) -> Vec<Mask> {
    let positions: Vec<DVec3> = positions.iter().map(|p| p.as_dvec3()).collect();
    let mut take = |(_, camera): &(CalibratedCamera, CalibratedCamera)| {
        let mut buffer = DepthBuffer::new(camera.size, 2.0);
        buffer.draw(camera, &positions, person.triangles());
        let [width, height] = camera.size.map(|s| s as usize);
        let at = |x: usize, y: usize| f32::from(u8::from(buffer.triangle[y * buffer.width + x] != u32::MAX));
        let pixel = |i: usize| {
            let (x, y) = (2 * (i % width), 2 * (i / width));
            let share = (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)) / 4.0;
            let edge = share > 0.0 && share < 1.0;
            let limit = 0.5 + if edge { RAGGED * rng.gaussian() } else { 0.0 };
            f32::from(u8::from(share > limit))
        };
        Mask { width, height, coverage: (0..width * height).map(pixel).collect() }
    };
    rig.iter().map(&mut take).collect()
}

fn summed(cases: &[SilhouetteCase], options: &SilhouetteStudyOptions) -> SilhouetteStudy {
    let found: Vec<(&SilhouetteCase, &SilhouetteBody)> =
        cases.iter().filter_map(|c| Some((c, c.found.as_ref()?))).collect();
    let count = found.len().max(1) as f64;
    let measures: Vec<SilhouetteAgreement> =
        MEASURES.iter().enumerate().map(|(i, m)| agreement(m.0, i, &found)).collect();
    let girths = |m: &&SilhouetteAgreement| m.measure.ends_with("girth");
    let people: usize = measures.iter().map(|m| m.people).sum();
    let right = found.iter().filter(|(c, f)| (f.woman > 0.5) == (c.sex == Sex::Female)).count();
    SilhouetteStudy {
        family: if options.makehuman.is_some() { "makehuman" } else { "survey" },
        cameras: options.cameras,
        opposite: options.opposite,
        people: cases.len(),
        lost: cases.len() - found.len(),
        sex_right: right as f64 / count,
        agreement: found.iter().map(|(_, f)| f.agreement).sum::<f64>() / count,
        seconds: cases.iter().map(|c| c.seconds).sum::<f64>() / cases.len().max(1) as f64,
        girths_mm: {
            let all: Vec<_> = measures.iter().filter(girths).collect();
            all.iter().map(|m| m.mean_absolute_mm).sum::<f64>() / all.len().max(1) as f64
        },
        same_height_mm: found.iter().map(|(c, _)| 1e3 * f64::from(c.same_height)).sum::<f64>() / count,
        chi_square: measures.iter().map(|m| m.chi_square * m.people as f64).sum::<f64>() / people.max(1) as f64,
        measures,
    }
}

fn agreement(measure: &'static str, i: usize, found: &[(&SilhouetteCase, &SilhouetteBody)]) -> SilhouetteAgreement {
    // Error, stated deviation, and the fit's own (mm).
    let rows: Vec<[f64; 3]> = (found.iter())
        .filter_map(|(c, f)| {
            let (e, truth) = (f.measures[i], c.truth[i]?);
            Some([e.value - truth, e.sigma, f.own_sigma[i]].map(|x| 1e3 * f64::from(x)))
        })
        .collect();
    let count = rows.len().max(1) as f64;
    let mean = |of: &dyn Fn(&[f64; 3]) -> f64| rows.iter().map(of).sum::<f64>() / count;
    let mut off: Vec<f64> = rows.iter().map(|r| r[0].abs()).collect();
    let within = |k: f64| mean(&|r| f64::from(u8::from(r[0].abs() <= k * r[1])));
    SilhouetteAgreement {
        measure,
        people: rows.len(),
        bias_mm: mean(&|r| r[0]),
        mean_absolute_mm: mean(&|r| r[0].abs()),
        p95_mm: quantile(&mut off, 0.95).unwrap_or(0.0),
        sigma_mm: mean(&|r| r[1]),
        chi_square: mean(&|r| (r[0] / r[1]).powi(2)),
        missing_mm: (mean(&|r| r[0] * r[0]) - mean(&|r| r[2] * r[2])).max(0.0).sqrt(),
        within: [within(1.0), within(2.0)],
    }
}
