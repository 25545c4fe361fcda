//! Measuring by the body fit: the shape over all frames of a second, and its measures by virtual tape.

use toile_assets::body::shape::{BodyShape, SHAPES, Shapes};
use toile_assets::body::{En, Fitted, Readings};
use toile_assets::sizes::Population;
use toile_base::body::{Measures, Sex};
use toile_base::frame::DepthFrame;
use toile_base::mesh::vertex_normals;
use toile_base::skeleton::Pose;

use super::body_fit::BodyFit;
use super::options::FitOptions;
use crate::correlated::Correlated;
use crate::estimate::Estimate;

/// Most frames of the first second: at 30 Hz (Gultepe 2013, section 6.4).
pub const FRAMES: usize = 30;

/// A measure that the body fit takes. Levels and definitions are those of EN 13402-1 and ISO 8559-1 ([`En`]), and one
/// of our own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FittedMeasure {
    /// One measure of the standard.
    Standard(En),
    /// Length of the torso: height of the 7th cervical vertebra less the inside leg height.
    Torso,
}

/// A measure's name in reports, its definition, and the limit of ISO 20685 for the mean error (m).
pub type MeasureRow = (&'static str, FittedMeasure, f32);

/// All measures that are taken.
pub const MEASURES: [MeasureRow; 11] = [
    ("stature", FittedMeasure::Standard(En::Stature), 4e-3),
    ("shoulder_breadth", FittedMeasure::Standard(En::ShoulderBreadth), 4e-3),
    ("arm_length", FittedMeasure::Standard(En::ArmLength), 5e-3),
    ("leg_length", FittedMeasure::Standard(En::InsideLegHeight), 5e-3),
    ("torso_length", FittedMeasure::Torso, 5e-3),
    ("neck_girth", FittedMeasure::Standard(En::NeckGirth), 4e-3),
    ("chest_girth", FittedMeasure::Standard(En::BustGirth), 9e-3),
    ("underbust_girth", FittedMeasure::Standard(En::UnderbustGirth), 9e-3),
    ("waist_girth", FittedMeasure::Standard(En::WaistGirth), 9e-3),
    ("hip_girth", FittedMeasure::Standard(En::HipGirth), 9e-3),
    ("thigh_girth", FittedMeasure::Standard(En::ThighGirth), 4e-3),
];

impl FittedMeasure {
    /// Whether it counts from the floor up, and is taken as the shopper stands.
    pub const fn is_height(self) -> bool {
        matches!(self, Self::Standard(En::Stature | En::InsideLegHeight) | Self::Torso)
    }

    /// Reads it off a body (m).
    pub fn of(self, readings: &Readings) -> f32 {
        match self {
            Self::Standard(measure) => readings.of(measure),
            Self::Torso => readings.of(En::CervicalHeight) - readings.of(En::InsideLegHeight),
        }
    }
}

/// Error from body shapes that the model cannot represent, and from what two people call by one name (m), in the order of
/// [`MEASURES`]: what errors have beside what the fit itself states, so that 68 of 100 lie within one standard deviation, over people
/// of two families before two cameras (docs/measuring.md, "Stated errors").
const FRONT_ERROR: [f32; MEASURES.len()] =
    [0.0055, 0.0095, 0.013, 0.028, 0.0185, 0.016, 0.021, 0.0265, 0.027, 0.0215, 0.017];

/// The same where the shopper was seen from all sides.
const TURNED_ERROR: [f32; MEASURES.len()] =
    [0.0045, 0.003, 0.006, 0.0335, 0.0265, 0.024, 0.022, 0.014, 0.0175, 0.0125, 0.016];

/// Error that is added to what the fit itself states (m), in the order of [`MEASURES`]: from the front, or from all sides.
pub const fn model_error(turned: bool) -> &'static [f32; MEASURES.len()] {
    if turned { &TURNED_ERROR } else { &FRONT_ERROR }
}

/// The measures from the fit of one second.
#[derive(Debug, Clone)]
pub struct FittedMeasures {
    /// The estimates, in the order of [`MEASURES`].
    pub measures: [Estimate; MEASURES.len()],
    /// The same with what their errors have in common.
    pub all: Correlated<{ MEASURES.len() }>,
    /// Probability that the body is a woman's, 0 to 1.
    pub woman: f32,
    /// The body of the likelier sex, with the surface that was seen.
    pub body: Fitted,
    /// Its pose in the last frame.
    pub pose: Pose,
    /// Frames that were fitted.
    pub frames: usize,
    /// Whether the shopper turned, and was seen from all sides.
    pub turned: bool,
    /// Root mean square distance of the surface from the body's, in the last frame (m).
    pub off: f32,
    /// Fraction of the visible surface that the body explains, in the last frame.
    pub explained: f32,
}

impl FittedMeasures {
    /// One measure by its name in [`MEASURES`].
    pub fn named(&self, name: &str) -> Option<Estimate> {
        MEASURES.iter().zip(&self.measures).find(|(taken, _)| taken.0 == name).map(|(_, estimate)| *estimate)
    }
}

/// Frames after which the less likely sex is dropped, if it is ruled out.
const DECIDING: usize = 6;

/// Difference of the deviances that rules one sex out: a likelihood ratio of 20,000.
const RULED_OUT: f64 = 20.0;

/// What the evidence for a sex counts, bare and clothed: a body of either sex that the model cannot have errs as much as the sexes differ,
/// and clothes hide most of that.
const EVIDENCE: [f64; 2] = [0.5, 0.1];

/// A sex that is less likely than this after the first second takes no part in what follows: a hundredth moves no measure by a millimetre.
const UNLIKELY: f64 = 0.01;

/// One sex's fit of all frames.
struct SexFit {
    fit: BodyFit,
    off: f32,
    explained: f32,
    turned: bool,
}

impl SexFit {
    fn new(sex: Sex, options: FitOptions) -> Self {
        Self { fit: BodyFit::new(sex, options), off: 0.0, explained: 0.0, turned: false }
    }

    /// Follows a shopper who may turn after the first second, and goes back to that second where they did not turn all round.
    fn follow_turn(&mut self, frames: &[DepthFrame]) {
        let (front, seen) = (self.fit.mark(), (self.off, self.explained));
        self.push(frames);
        self.turned = self.fit.seen_from_all_sides();
        if !self.turned {
            self.fit.go_back_to(front);
            (self.off, self.explained) = seen;
        }
    }

    fn push(&mut self, frames: &[DepthFrame]) {
        for frame in frames {
            let seen = self.fit.push(frame);
            if seen.found {
                (self.off, self.explained) = (seen.off, seen.explained);
            }
        }
    }

    /// Deviance: twice the negative logarithm of the model evidence; the greatest number where no frame was fitted.
    fn deviance(&self) -> f64 {
        let (cost, frames) = self.fit.cost;
        if frames == 0 { f64::MAX } else { cost / frames as f64 + self.fit.shape_filter.deviance() }
    }
}

/// Longest time that counts as the first second (ns), in which a shopper stands before they may turn.
const FIRST_SECOND_NS: u64 = 1_000_000_000;

/// Measures the shopper in frames that hold nothing but them: from the first second, and where they turn all round afterwards, from
/// all sides. `None` if no body fits.
pub fn measure(frames: &[DepthFrame], population: Population, options: FitOptions) -> Option<FittedMeasures> {
    let sexes: &[Sex] = match population {
        Population::Women => &[Sex::Female],
        Population::Men => &[Sex::Male],
        Population::Mixed => &[Sex::Female, Sex::Male],
    };
    let begun = frames.first()?.time_ns;
    let second = frames.iter().take_while(|f| f.time_ns.saturating_sub(begun) < FIRST_SECOND_NS).count();
    let (front, after) = frames.split_at(second.min(FRAMES));
    let (first, rest) = front.split_at(front.len().min(DECIDING));
    let mut tries: Vec<(Sex, SexFit)> = sexes.iter().map(|&s| (s, SexFit::new(s, options))).collect();
    tries.iter_mut().for_each(|(_, t)| t.push(first));
    let counts = EVIDENCE[usize::from(options.clothed)];
    let ahead = tries.iter().map(|(_, t)| t.deviance()).fold(f64::MAX, f64::min);
    tries.retain(|(_, t)| counts * (t.deviance() - ahead) < RULED_OUT);
    tries.iter_mut().for_each(|(_, t)| t.push(rest));
    tries.retain(|(_, t)| t.deviance() < f64::MAX);
    let least = tries.iter().map(|t| t.1.deviance()).fold(f64::MAX, f64::min);
    let weight = |t: &SexFit| (-0.5 * counts * (t.deviance() - least)).exp();
    let all: f64 = tries.iter().map(|t| weight(&t.1)).sum();
    tries.retain(|(_, t)| weight(t) / all > UNLIKELY);
    // The shares of those who stay are one again.
    let weights: Vec<f64> = tries.iter().map(|t| weight(&t.1)).collect();
    let whole: f64 = weights.iter().sum();
    let mut seen: Vec<SexMeasures> = Vec::new();
    for ((sex, mut fit), weight) in tries.into_iter().zip(weights) {
        fit.follow_turn(after);
        seen.push(fit.closely(sex, (weight / whole) as f32, frames)?);
    }
    let turned = seen.iter().all(|s| s.turned);
    let parts: Vec<_> = seen.iter().map(|s| (s.share, s.measures)).collect();
    let all = with_model_error(Correlated::mixed(&parts), turned, options.clothed);
    let woman = seen.iter().find(|s| s.sex == Sex::Female).map_or(0.0, |s| s.share);
    let best = seen.into_iter().max_by(|a, b| a.share.total_cmp(&b.share))?;
    let SexMeasures { body, pose, frames, off, explained, .. } = best;
    Some(FittedMeasures { measures: all.estimates(), all, woman, body, pose, frames, turned, off, explained })
}

/// What the fit of one sex's body says.
struct SexMeasures {
    sex: Sex,
    /// How likely it is, 0 to 1.
    share: f32,
    measures: Correlated<{ MEASURES.len() }>,
    body: Fitted,
    pose: Pose,
    frames: usize,
    turned: bool,
    off: f32,
    explained: f32,
}

impl SexFit {
    /// Looks at all frames once more, and lays the tape on the surface that was seen.
    fn closely(mut self, sex: Sex, share: f32, frames: &[DepthFrame]) -> Option<SexMeasures> {
        let shapes = Shapes::of(sex);
        let count = self.fit.frames();
        let seen = self.fit.look_closer(frames)?;
        let [rest, standing] = [&seen.rest, &seen.standing].map(|surface| shapes.read_surface(surface));
        let (shape, covariance) = self.fit.shape_filter.estimate();
        let mut measures = covariance_of(shapes, &shape, &covariance);
        for (measure, (_, kind, _)) in measures.mean.iter_mut().zip(MEASURES) {
            *measure = kind.of(if kind.is_height() { &standing } else { &rest });
        }
        let mut body = shapes.body(&seen.shape);
        body.body.mesh.positions = seen.rest;
        vertex_normals(&body.body.mesh.positions, &body.body.mesh.triangles, &mut body.body.normals);
        body.body.measures = Measures {
            stature: rest.of(En::Stature),
            shoulder_breadth: rest.of(En::ShoulderBreadth),
            chest_girth: rest.of(En::BustGirth),
            waist_girth: rest.of(En::WaistGirth),
            hip_girth: rest.of(En::HipGirth),
        };
        body.readings = rest;
        Some(SexMeasures {
            sex,
            share,
            measures,
            body,
            pose: self.fit.last_pose()?,
            frames: count,
            turned: self.turned,
            off: self.off,
            explained: self.explained,
        })
    }
}

/// All measures of a shape, and what their errors have in common where its parameters have this covariance, in the order of
/// [`MEASURES`].
pub fn covariance_of(
    shapes: &Shapes,
    shape: &BodyShape,
    covariance: &[BodyShape; SHAPES],
) -> Correlated<{ MEASURES.len() }> {
    let read = shapes.read(shape);
    let rows: [BodyShape; MEASURES.len()] = MEASURES.map(|(_, kind, _)| match kind {
        FittedMeasure::Standard(measure) => *read.row(measure),
        FittedMeasure::Torso => {
            let [top, bottom] = [En::CervicalHeight, En::InsideLegHeight].map(|m| read.row(m));
            std::array::from_fn(|k| top[k] - bottom[k])
        }
    });
    let pair = |a: &BodyShape, b: &BodyShape| {
        let terms = (0..SHAPES).map(|i| a[i] * (0..SHAPES).map(|j| covariance[i][j] * b[j]).sum::<f64>());
        terms.sum::<f64>() as f32
    };
    Correlated {
        mean: MEASURES.map(|(_, kind, _)| kind.of(&read.readings)),
        covariance: std::array::from_fn(|i| std::array::from_fn(|j| pair(&rows[i], &rows[j]))),
    }
}

/// What clothes add to it (m), in the order of [`MEASURES`]: how far everyday ones stand off the skin cannot be seen from outside. The fit
/// follows the inner side of what it sees; a loose T-shirt lies 5 mm farther off or nearer than it thinks, which is 35 mm of girth.
const CLOTHES_ERROR: [f32; MEASURES.len()] =
    [0.006, 0.006, 0.008, 0.008, 0.008, 0.010, 0.035, 0.030, 0.030, 0.028, 0.018];

/// How much of the added error the girths of the trunk have in common: who is too broad at the chest for the model is so at the hip.
const TOGETHER: f32 = 0.4;

/// Adds the error that [`model_error`] states, and that of clothes.
fn with_model_error(
    mut measured: Correlated<{ MEASURES.len() }>,
    turned: bool,
    clothed: bool,
) -> Correlated<{ MEASURES.len() }> {
    let unlike = model_error(turned);
    let clothes = if clothed { CLOTHES_ERROR } else { [0.0; MEASURES.len()] };
    let more: [f32; MEASURES.len()] = std::array::from_fn(|i| unlike[i].hypot(clothes[i]));
    let is_trunk = |i: usize| {
        use En::{BustGirth, HipGirth, UnderbustGirth, WaistGirth};
        matches!(MEASURES[i].1, FittedMeasure::Standard(BustGirth | UnderbustGirth | WaistGirth | HipGirth))
    };
    for i in 0..MEASURES.len() {
        for j in 0..MEASURES.len() {
            let share = match i == j {
                true => 1.0,
                false if is_trunk(i) && is_trunk(j) => TOGETHER,
                false => 0.0,
            };
            measured.covariance[i][j] += share * more[i] * more[j];
        }
    }
    measured
}
