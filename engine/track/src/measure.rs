//! The measures of the person before the sensor, each with its error: from one second of joints, or from a body that was fitted to depth.

use toile_assets::sizes::{Population, SizeBody};
use toile_base::frame::Joints;

use crate::anthropometry::{self, regressions};
use crate::estimate::Estimate;
use crate::joints;
use crate::measures::{Hint, Measures};

/// Joints that are averaged: those within one second of the first believed frame (ns).
const ONE_SECOND_NS: u64 = 1_000_000_000;

/// Fewest frames of joints that make a measurement: below it one bad frame is a third of the evidence.
pub const FEWEST_JOINT_FRAMES: usize = 3;

/// Where the measures come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// From the body fit, in a session without joints.
    Depth,
    /// From the proportions of joints: without depth, or where no body fits it.
    Joints,
    /// From the body fit, in a session that also has joints.
    Both,
}

/// The measures of a person, with their source.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurements {
    /// The measures taken.
    pub measures: Measures,
    /// Depth pixels on the person, median over the frames; 0 without depth.
    pub valid_pixels: usize,
    /// People in view, median over the depth frames; 1 with joints only.
    pub people: usize,
    /// Frames that were averaged: depth frames where a body was fitted, joints otherwise.
    pub frames: usize,
    /// Where the measures come from.
    pub source: Source,
    /// Sentences about guessed or assumed measures.
    pub notes: Vec<String>,
}

/// Why nothing could be measured; each message says what, where, and the cure.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeasureError {
    /// Neither depth nor joints.
    #[error(
        "the session holds neither a depth frame nor joints; record at least one second of a person standing before \
         the sensor."
    )]
    Empty,
    /// Depth without a person.
    #[error(
        "no person is in view in any of the {frames} depth frames; stand upright before the camera, 1.2 to 3.5 m away, \
         head and shoulders in the picture."
    )]
    NoPerson {
        /// Frames that were looked at.
        frames: usize,
    },
    /// A person, but beyond what can be measured.
    #[error(
        "the person stands {distance:.1} m from the camera, where its depth is too coarse to measure; come closer \
         than {limit:.1} m."
    )]
    TooFar {
        /// Distance from the camera (m).
        distance: f32,
        /// Farthest that is measured (m).
        limit: f32,
    },
    /// Joints without a believed body.
    #[error(
        "only {got} of {frames} frames of joints show a trunk that can be believed and {need} are needed; stand \
         facing the sensor for a second with head, shoulders and hips in view."
    )]
    TooFewFrames {
        /// Frames with measures that are believed.
        got: usize,
        /// Frames that were looked at.
        frames: usize,
        /// Frames that are needed.
        need: usize,
    },
}

/// Measures a person by the proportions of their joints in the first believed second.
///
/// # Errors
/// [`MeasureError::TooFewFrames`].
pub fn by_proportions(joints: &[Joints], hint: &Hint) -> Result<Measurements, MeasureError> {
    let mut believed = joints.iter().filter(|f| joints::is_believed(f)).peekable();
    let start = believed.peek().map_or(0, |f| f.time_ns);
    let second: Vec<Joints> = believed.take_while(|f| f.time_ns - start <= ONE_SECOND_NS).copied().collect();
    let too_few = MeasureError::TooFewFrames { got: second.len(), frames: joints.len(), need: FEWEST_JOINT_FRAMES };
    if second.len() < FEWEST_JOINT_FRAMES {
        return Err(too_few);
    }
    let measures = joints::measures(&second, hint).ok_or(too_few)?;
    let mut notes =
        vec!["Girths are guessed from stature and shoulders, because no body was fitted to depth.".to_owned()];
    if !hint.scale_known {
        notes.push("The recording has no unit: the stature is assumed.".to_owned());
    }
    Ok(Measurements { measures, valid_pixels: 0, people: 1, frames: second.len(), source: Source::Joints, notes })
}

impl Measurements {
    /// Five lengths to build a body from: what was measured, and for the rest what a body of that stature and those
    /// shoulders has on average (then with the regression's sigma). In order: stature, shoulder breadth, chest, waist, hip.
    pub fn completed(&self, population: Population) -> [Estimate; 5] {
        let m = &self.measures;
        let regressions = regressions(population);
        let stature = m.stature.unwrap_or(anthropometry::stature(population));
        let shoulder = m.shoulder_breadth.unwrap_or_else(|| regressions.shoulder.at(stature, Estimate::new(0.0, 0.0)));
        [
            stature,
            shoulder,
            m.chest_girth.unwrap_or_else(|| regressions.chest.at(stature, shoulder)),
            m.waist_girth.unwrap_or_else(|| regressions.waist.at(stature, shoulder)),
            m.hip_girth.unwrap_or_else(|| regressions.hip.at(stature, shoulder)),
        ]
    }

    /// [`Measurements::completed`] without the errors.
    pub fn body(&self, population: Population) -> SizeBody {
        let [stature, shoulder_breadth, chest_girth, waist_girth, hip_girth] =
            self.completed(population).map(|e| e.value);
        SizeBody { stature, shoulder_breadth, chest_girth, waist_girth, hip_girth }
    }
}
