//! The second family of people: MakeHuman's base mesh `hm08` with its macro and measure targets mixed at random.
//!
//! Nothing of it is shared with the parametric body that measures: another mesh, other proportions, other sections. A
//! mixture is kept where its stature, mass and ratios lie within the survey's ranges; what is true of it is read by a
//! tape on its own surface, by the definitions of EN 13402-1 and ISO 8559-1 at landmarks of that mesh.

use std::ops::RangeInclusive;
use std::path::Path;

use glam::{Quat, Vec2, Vec3};
use toile_assets::body::tape::{girth, hull, perimeter, slice};
use toile_assets::import::avatar::{AvatarError, ImportOptions};
use toile_assets::import::makehuman::{self, MakehumanOptions};
use toile_base::body::{Body, Region, Sex};
use toile_base::numeric::random::SplitMix64;
use toile_base::numeric::statistics::quantile;
use toile_base::skeleton::{Joint, Pose};
use toile_track::fit::measuring::MEASURES;

use super::standing::{Breathing, StandingMotion, StudyPerson, TapeMeasures};
use crate::ansur::{Survey, SurveyError};

/// Landmarks of `hm08`: vertices, which every target moves along. Those that come in pairs are the left side's.
mod landmark {
    /// 7th cervical vertebra.
    pub const CERVICALE: usize = 857;
    /// Front of the neck, 2 cm below the Adam's apple.
    pub const NECK_FRONT: usize = 809;
    /// Tip of the shoulder blade.
    pub const ACROMION: usize = 8_274;
    /// Bust point, left; the chest is taped at its height.
    pub const BUST_POINT: usize = 8_455;
    /// Just below the breast.
    pub const UNDERBUST: usize = 8_540;
    /// Front of the natural waistline, at .622 of the base's stature.
    pub const WAIST: usize = 4_106;
    /// Navel, where the survey tapes the waist.
    pub const OMPHALION: usize = 4_115;
    /// Between the legs: the lowest of these.
    pub const CROTCH: [usize; 5] = [4_372, 4_374, 4_375, 4_376, 6_431];
}

/// Pairs of measure targets that are mixed, and how strongly (standard deviation of the share).
const MEASURE_TARGETS: [(&str, f32); 17] = [
    ("bust-circ", 0.35),
    ("underbust-circ", 0.30),
    ("waist-circ", 0.40),
    ("hips-circ", 0.35),
    ("thigh-circ", 0.30),
    ("knee-circ", 0.30),
    ("calf-circ", 0.30),
    ("neck-circ", 0.30),
    ("neck-height", 0.20),
    ("upperarm-circ", 0.30),
    ("shoulder-dist", 0.30),
    ("frontchest-dist", 0.30),
    ("napetowaist-dist", 0.25),
    ("waisttohip-dist", 0.25),
    ("upperleg-height", 0.25),
    ("lowerleg-height", 0.25),
    ("upperarm-length", 0.25),
];

/// The ancestries that MakeHuman's macro targets are named after; a person is a mixture of all.
const ANCESTRIES: [&str; 3] = ["african", "asian", "caucasian"];

/// Mass of a litre of body (kg): fat and lean together, lungs half full.
const DENSITY: f32 = 1.01;

/// Mixtures that are tried for one person.
const TRIES: usize = 60;

/// Quantiles of the survey between which a person's proportions lie: 98 of 100 people do.
const WITHIN: [f64; 2] = [0.01, 0.99];

/// Why the second family cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum FamilyError {
    /// A folder that cannot be read, or holds no base mesh hm08.
    #[error(transparent)]
    Folder(#[from] AvatarError),
    /// The survey that says how people are.
    #[error(transparent)]
    Survey(#[from] SurveyError),
    /// No mixture is like a person of the survey.
    #[error(
        "none of {TRIES} mixtures of MakeHuman's targets has the proportions of a person in the survey; give its own files"
    )]
    NoMatch,
}

/// What people of one sex are like: the ranges that mixtures are kept within.
#[derive(Debug, Clone)]
pub struct SurveyRanges {
    /// Whose they are.
    pub sex: Sex,
    ranges: [RangeInclusive<f32>; PROPORTIONS.len()],
}

/// What a proportion is taken over.
#[derive(Clone, Copy)]
enum Over {
    /// Nothing: a length (m) or a mass (kg).
    One,
    /// Another column of the survey.
    Column(&'static str, fn(&Proportions) -> f32),
}

/// What is compared with the survey.
struct Proportions {
    stature: f32,
    mass: f32,
    crotch: f32,
    chest: f32,
    navel: f32,
    hip: f32,
    thigh: f32,
    neck: f32,
    shoulders: f32,
}

/// The survey's column, what makes its numbers metres or kilograms, the reading, and what both are taken over.
type ProportionRow = (&'static str, f64, fn(&Proportions) -> f32, Over);

const STATURE: Over = Over::Column("stature", |p| p.stature);
const HIP: Over = Over::Column("buttockcircumference", |p| p.hip);

const PROPORTIONS: [ProportionRow; 11] = [
    ("stature", 1e-3, |p| p.stature, Over::One),
    ("weightkg", 0.1, |p| p.mass, Over::One),
    ("crotchheight", 1e-3, |p| p.crotch, STATURE),
    ("chestcircumference", 1e-3, |p| p.chest, STATURE),
    ("waistcircumference", 1e-3, |p| p.navel, STATURE),
    ("buttockcircumference", 1e-3, |p| p.hip, STATURE),
    ("biacromialbreadth", 1e-3, |p| p.shoulders, STATURE),
    ("chestcircumference", 1e-3, |p| p.chest, HIP),
    ("waistcircumference", 1e-3, |p| p.navel, HIP),
    ("thighcircumference", 1e-3, |p| p.thigh, HIP),
    ("neckcircumference", 1e-3, |p| p.neck, STATURE),
];

impl SurveyRanges {
    /// The ranges of a survey's people.
    ///
    /// # Errors
    /// A column that is missing.
    pub fn of(survey: &Survey) -> Result<Self, SurveyError> {
        let range = |(column, unit, _, over): &ProportionRow| -> Result<RangeInclusive<f32>, SurveyError> {
            let mut values: Vec<f64> = survey.column(column)?.iter().map(|v| v * unit).collect();
            if let Over::Column(name, _) = over {
                values.iter_mut().zip(survey.column(name)?).for_each(|(v, by)| *v /= by * 1e-3);
            }
            let [low, high] = WITHIN.map(|share| quantile(&mut values, share).unwrap_or(0.0) as f32);
            Ok(low..=high)
        };
        let mut ranges = std::array::from_fn(|_| 0.0..=0.0);
        for (to, row) in ranges.iter_mut().zip(&PROPORTIONS) {
            *to = range(row)?;
        }
        Ok(Self { sex: survey.sex()?, ranges })
    }

    /// Whether a body's proportions lie within all ranges.
    fn hold(&self, body: &Proportions) -> bool {
        PROPORTIONS.iter().zip(&self.ranges).all(|((_, _, reading, over), range)| {
            let by = if let Over::Column(_, of) = over { of(body) } else { 1.0 };
            range.contains(&(reading(body) / by))
        })
    }
}

/// Draws a person of MakeHuman's family out of a folder of its files.
///
/// # Errors
/// Files that are not MakeHuman's, or mixtures that are like no person of the survey.
pub fn makehuman_person(
    folder: &Path,
    ranges: &SurveyRanges,
    rng: &mut SplitMix64,
) -> Result<StudyPerson, FamilyError> {
    for _ in 0..TRIES {
        let options = MakehumanOptions { targets: mixture(ranges.sex, rng), ..MakehumanOptions::default() };
        let import = ImportOptions { sex: ranges.sex, ..ImportOptions::default() };
        let body = makehuman::read(folder, &options, &import)?.imported.body;
        if ranges.hold(&proportions(&body)) {
            let truth = truth(&body);
            let (pose, motion) = (standing(&body, rng), breathing(rng));
            return Ok(StudyPerson { sex: ranges.sex, truth, body, pose, motion });
        }
    }
    Err(FamilyError::NoMatch)
}

/// Targets and shares of one person, at random.
fn mixture(sex: Sex, rng: &mut SplitMix64) -> Vec<(String, f32)> {
    let sex = if sex == Sex::Female { "female" } else { "male" };
    let mut targets = Vec::new();
    let weights = ANCESTRIES.map(|_| -rng.uniform().max(1e-6).ln());
    let whole: f32 = weights.iter().sum();
    targets.extend(ANCESTRIES.iter().zip(weights).map(|(a, w)| (format!("{a}-{sex}-young"), w / whole)));
    // Muscle and weight from -1 to 1, as MakeHuman's sliders blend them: linear between its least, mean and greatest.
    let [muscle, weight, height] = [0.45, 0.45, 0.30].map(|s| (s * rng.gaussian()).clamp(-1.0, 1.0));
    let blend = |v: f32, words: [&'static str; 3]| {
        let end = if v < 0.0 { words[0] } else { words[2] };
        [(words[1], 1.0 - v.abs()), (end, v.abs())]
    };
    for (m, by_muscle) in blend(muscle, ["minmuscle", "averagemuscle", "maxmuscle"]) {
        for (w, by_weight) in blend(weight, ["minweight", "averageweight", "maxweight"]) {
            targets.push((format!("universal-{sex}-young-{m}-{w}"), by_muscle * by_weight));
        }
    }
    let end = if height < 0.0 { "minheight" } else { "maxheight" };
    targets.push((format!("{sex}-young-averagemuscle-averageweight-{end}"), height.abs()));
    for (name, spread) in MEASURE_TARGETS {
        let share = (spread * rng.gaussian()).clamp(-1.0, 1.0);
        let end = if share < 0.0 { "decr" } else { "incr" };
        targets.push((format!("measure-{name}-{end}"), share.abs()));
    }
    targets.retain(|(_, share)| *share > 0.0);
    targets
}

/// Height of a landmark over the floor (m).
fn height(body: &Body, vertex: usize) -> f32 {
    body.mesh.positions[vertex].y
}

fn crotch(body: &Body) -> f32 {
    landmark::CROTCH.iter().map(|v| height(body, *v)).fold(f32::MAX, f32::min)
}

/// Height of the buttocks' greatest protrusion (m).
fn buttocks(body: &Body) -> f32 {
    let band = crotch(body)..height(body, landmark::OMPHALION);
    let trunk = body.mesh.positions.iter().zip(&body.regions);
    let kept = trunk.filter(|(p, r)| band.contains(&p.y) && !matches!(r, Region::LeftArm | Region::RightArm));
    kept.min_by(|a, b| a.0.z.total_cmp(&b.0.z)).map_or(0.0, |(p, _)| p.y)
}

/// Greatest girth of the left thigh below the crotch (m).
fn thigh(body: &Body) -> f32 {
    let top = crotch(body);
    let keep = |t: usize| {
        body.mesh.triangles[t].iter().all(|&v| {
            let arm = matches!(body.regions[v as usize], Region::LeftArm | Region::RightArm);
            !arm && body.mesh.positions[v as usize].x > -0.01
        })
    };
    let at = |y: f32| {
        let points: Vec<Vec2> =
            slice(&body.mesh, keep, Vec3::Y * y, Vec3::Y).iter().flatten().map(|p| Vec2::new(p.x, p.z)).collect();
        perimeter(&hull(&points))
    };
    (1..=20).map(|k| at(top - 0.005 * k as f32)).fold(0.0, f32::max)
}

/// Girth of the neck in the plane through its two landmarks (m).
fn neck(body: &Body) -> f32 {
    let [back, front] = [landmark::CERVICALE, landmark::NECK_FRONT].map(|v| body.mesh.positions[v]);
    let (middle, along) = (0.5 * (back + front), (front - back).normalize());
    let normal = along.cross(Vec3::X).normalize();
    let reach = 0.13;
    let keep =
        |t: usize| body.mesh.triangles[t].iter().all(|&v| body.mesh.positions[v as usize].distance(middle) < reach);
    let points: Vec<Vec2> = slice(&body.mesh, keep, middle, normal)
        .iter()
        .flatten()
        .map(|p| Vec2::new((*p - middle).dot(Vec3::X), (*p - middle).dot(along)))
        .collect();
    perimeter(&hull(&points))
}

/// What the tape reads, in the order of [`MEASURES`].
fn truth(body: &Body) -> TapeMeasures {
    let at = |v: usize| girth(body, height(body, v));
    let named = |name: &str| match name {
        "stature" => Some(stature(body)),
        "shoulder_breadth" => Some(2.0 * body.mesh.positions[landmark::ACROMION].x.abs()),
        "leg_length" => Some(crotch(body)),
        "torso_length" => Some(height(body, landmark::CERVICALE) - crotch(body)),
        "neck_girth" => Some(neck(body)),
        "chest_girth" => Some(at(landmark::BUST_POINT)),
        "underbust_girth" => Some(at(landmark::UNDERBUST)),
        "waist_girth" => Some(at(landmark::WAIST)),
        "hip_girth" => Some(girth(body, buttocks(body))),
        "thigh_girth" => Some(thigh(body)),
        // Its arms are bent, and their difference from the survey's bent arm is unknown.
        _ => None,
    };
    MEASURES.map(|(name, _, _)| named(name))
}

fn stature(body: &Body) -> f32 {
    let y = || body.mesh.positions.iter().map(|p| p.y);
    y().fold(0.0, f32::max) - y().fold(f32::MAX, f32::min)
}

fn proportions(body: &Body) -> Proportions {
    Proportions {
        stature: stature(body),
        mass: volume(body) * 1e3 * DENSITY,
        crotch: crotch(body),
        chest: girth(body, height(body, landmark::BUST_POINT)),
        navel: girth(body, height(body, landmark::OMPHALION)),
        hip: girth(body, buttocks(body)),
        thigh: thigh(body),
        neck: neck(body),
        shoulders: 2.0 * body.mesh.positions[landmark::ACROMION].x.abs(),
    }
}

/// Volume within the surface (m3), by the divergence theorem.
fn volume(body: &Body) -> f32 {
    let p = |v: u32| body.mesh.positions[v as usize].as_dvec3();
    let tetrahedra = body.mesh.triangles.iter().map(|&[a, b, c]| p(a).dot(p(b).cross(p(c))) / 6.0);
    tetrahedra.sum::<f64>().abs() as f32
}

/// How a person of this family stands: other habits than the first family's, feet farther apart, hands farther out.
fn standing(body: &Body, rng: &mut SplitMix64) -> Pose {
    let mut pose = Pose::rest(&body.skeleton);
    let mut turn = |joint: Joint, usual: Vec3, spread: Vec3| {
        let by = usual + spread * Vec3::new(rng.gaussian(), rng.gaussian(), rng.gaussian());
        pose.local[joint.index()] = Quat::from_scaled_axis(by);
    };
    turn(Joint::Pelvis, Vec3::ZERO, Vec3::new(0.03, 0.10, 0.01));
    turn(Joint::Spine, Vec3::ZERO, Vec3::new(0.05, 0.04, 0.02));
    turn(Joint::Chest, Vec3::new(0.02, 0.0, 0.0), Vec3::new(0.05, 0.04, 0.02));
    turn(Joint::Neck, Vec3::new(0.05, 0.0, 0.0), Vec3::new(0.08, 0.10, 0.04));
    for (shoulder, elbow, hip, side) in [
        (Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftHip, 1.0),
        (Joint::RightShoulder, Joint::RightElbow, Joint::RightHip, -1.0),
    ] {
        turn(shoulder, Vec3::new(0.0, 0.0, -0.25 * side), Vec3::new(0.10, 0.10, 0.10));
        turn(elbow, Vec3::ZERO, Vec3::new(0.08, 0.08, 0.05));
        turn(hip, Vec3::new(0.0, 0.0, 0.03 * side), Vec3::new(0.02, 0.05, 0.02));
    }
    pose
}

fn breathing(rng: &mut SplitMix64) -> StandingMotion {
    StandingMotion::Breathing(Breathing {
        rate: [0.2 + 0.1 * rng.uniform(), std::f32::consts::TAU * rng.uniform()],
        depth: 0.0006 + 0.0014 * rng.uniform(),
        sway: 0.25 + 0.25 * rng.uniform(),
    })
}
