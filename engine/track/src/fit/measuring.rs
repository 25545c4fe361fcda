//! Measuring by the body fit: the shape over all frames of a second, and its measures by virtual tape.

use toile_assets::body::shape::{BodyShape, SHAPES, Shapes};
use toile_assets::body::{En, Fitted, Readings, Sex};
use toile_assets::sizes::Population;
use toile_assets::skeleton::Pose;
use toile_sensors::frame::DepthFrame;

use super::{BodyFit, FitOptions};
use crate::estimate::Estimate;

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
    /// Reads it off a body (m).
    pub fn of(self, readings: &Readings) -> f32 {
        match self {
            Self::Standard(measure) => readings.of(measure),
            Self::Torso => readings.of(En::CervicalHeight) - readings.of(En::InsideLegHeight),
        }
    }
}

/// Error from body shapes that the model cannot represent (m), in the order of [`MEASURES`]: the standard
/// deviation that errors have beside what the fit itself states, over 80 people of another draw than that of docs/measuring.md
/// (`toile bench measure --people 40 --frames 4 --seed 78 --sensor azure`).
const MODEL_ERROR: [f32; MEASURES.len()] =
    [0.0035, 0.002, 0.004, 0.004, 0.004, 0.003, 0.016, 0.015, 0.020, 0.015, 0.007];

/// The measures from the fit of one second.
#[derive(Debug, Clone)]
pub struct FittedMeasures {
    /// The estimates, in the order of [`MEASURES`].
    pub measures: [Estimate; MEASURES.len()],
    /// Probability that the body is a woman's, 0 to 1.
    pub woman: f32,
    /// The fitted body of the likelier sex.
    pub body: Fitted,
    /// Its pose in the last frame.
    pub pose: Pose,
    /// Frames that were fitted.
    pub frames: usize,
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

/// One sex's fit of all frames.
struct SexFit {
    fit: BodyFit,
    off: f32,
    explained: f32,
}

impl SexFit {
    fn new(sex: Sex, options: FitOptions) -> Self {
        Self { fit: BodyFit::new(sex, options), off: 0.0, explained: 0.0 }
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

/// Measures the shopper in frames that hold nothing but them. `None` if no body fits.
pub fn measure(frames: &[DepthFrame], population: Population, options: FitOptions) -> Option<FittedMeasures> {
    let sexes: &[Sex] = match population {
        Population::Women => &[Sex::Female],
        Population::Men => &[Sex::Male],
        Population::Mixed => &[Sex::Female, Sex::Male],
    };
    let (first, rest) = frames.split_at(frames.len().min(DECIDING));
    let mut tries: Vec<(Sex, SexFit)> = sexes.iter().map(|&s| (s, SexFit::new(s, options))).collect();
    tries.iter_mut().for_each(|(_, t)| t.push(first));
    let ahead = tries.iter().map(|(_, t)| t.deviance()).fold(f64::MAX, f64::min);
    tries.retain(|(_, t)| t.deviance() < ahead + RULED_OUT);
    tries.iter_mut().for_each(|(_, t)| t.push(rest));
    tries.retain(|(_, t)| t.deviance() < f64::MAX);
    let least = tries.iter().map(|t| t.1.deviance()).fold(f64::MAX, f64::min);
    let weight = |t: &SexFit| (-0.5 * (t.deviance() - least)).exp();
    let whole: f64 = tries.iter().map(|t| weight(&t.1)).sum();
    let best = tries.iter().min_by(|a, b| a.1.deviance().total_cmp(&b.1.deviance()))?;
    let read: Vec<(f64, [Estimate; MEASURES.len()])> =
        tries.iter().map(|(s, t)| (weight(t) / whole, read(Shapes::of(*s), &t.fit))).collect();
    let measures = std::array::from_fn(|i| mixed(read.iter().map(|(w, m)| (*w as f32, m[i])), MODEL_ERROR[i]));
    let woman = tries.iter().find(|t| t.0 == Sex::Female).map_or(0.0, |t| (weight(&t.1) / whole) as f32);
    let body = Shapes::of(best.0).body(&best.1.fit.shape());
    let SexFit { fit, off, explained } = &best.1;
    let pose = fit.last_pose()?;
    Some(FittedMeasures { measures, woman, body, pose, frames: fit.frames(), off: *off, explained: *explained })
}

/// All measures of one fit.
fn read(shapes: &Shapes, fit: &BodyFit) -> [Estimate; MEASURES.len()] {
    let (shape, covariance) = fit.shape_filter.estimate();
    let read = shapes.read(&shape);
    MEASURES.map(|(_, girth, _)| {
        let row: BodyShape = match girth {
            FittedMeasure::Standard(measure) => *read.row(measure),
            FittedMeasure::Torso => {
                let [top, bottom] = [En::CervicalHeight, En::InsideLegHeight].map(|m| read.row(m));
                std::array::from_fn(|k| top[k] - bottom[k])
            }
        };
        let pair = |i: usize| (0..SHAPES).map(|j| row[i] * covariance[i][j] * row[j]).sum::<f64>();
        let variance: f64 = (0..SHAPES).map(pair).sum();
        Estimate::new(girth.of(&read.readings), variance.max(0.0).sqrt() as f32)
    })
}

/// Mean and standard deviation of a mixture, with an independent error added.
fn mixed(parts: impl Iterator<Item = (f32, Estimate)> + Clone, more: f32) -> Estimate {
    let mean: f32 = parts.clone().map(|(w, e)| w * e.value).sum();
    let variance: f32 = parts.map(|(w, e)| w * (e.sigma * e.sigma + (e.value - mean).powi(2))).sum();
    Estimate::new(mean, (variance + more * more).sqrt())
}
