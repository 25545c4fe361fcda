//! The measures of the person before the sensor, each with its error, from one second of depth and joints.

use toile_assets::sizes::{Population, SizeBody};
use toile_base::frame::{DepthFrame, Joints};
use toile_base::numeric::statistics::median_of;

use crate::anthropometry::{self, GirthModel, SilhouetteModel, regressions};
use crate::estimate::{Estimate, temporal_mean};
use crate::fit::measuring::{FRAMES, MEASURES};
use crate::joints;
use crate::measures::{Hint, Measures};
use crate::point_cloud::{self, PersonCloud, PersonFinder};
use crate::section::TorsoSection;
use crate::silhouette::{self, SilhouetteReading};
use crate::tape_readings;

/// Joints that are averaged: those within one second of the first believed frame (ns).
const ONE_SECOND_NS: u64 = 1_000_000_000;

/// Fewest frames of joints that make a measurement: below it one bad frame is a third of the evidence.
pub const FEWEST_JOINT_FRAMES: usize = 3;

/// Error of a chest girth that is carried on from below the armpits, because arms or sleeves hide it (m): a third of
/// what chests differ from waists by.
const HIDDEN_CHEST: f32 = 0.04;

/// Where the measures come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// From depth frames alone.
    Depth,
    /// Measured from joints, without depth.
    Joints,
    /// From both, each measure weighted by how sure it is.
    Both,
}

/// What [`measure`] found.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurements {
    /// The measures taken.
    pub measures: Measures,
    /// Depth pixels on the person, median over the frames; 0 without depth.
    pub valid_pixels: usize,
    /// People in view, median over the depth frames; 1 with joints only.
    pub people: usize,
    /// Frames that were averaged: depth frames where there are any, joints otherwise.
    pub frames: usize,
    /// Where the measures come from.
    pub source: Source,
    /// One sentence for each measure that could not be taken, with the reason.
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

/// Measures a person from a session's first believed second: depth, joints or both, fused by inverse variance.
pub fn measure(joints: &[Joints], depth: &[DepthFrame], hint: &Hint) -> Result<Measurements, MeasureError> {
    if joints.is_empty() && depth.is_empty() {
        return Err(MeasureError::Empty);
    }
    let mut left_out = Vec::new();
    let from_depth =
        if depth.is_empty() { None } else { Some(from_depth(depth, hint).map(|m| possible(m, &mut left_out))) };
    let from_joints = if joints.is_empty() { None } else { Some(from_joints(joints, hint)) };
    match (from_depth, from_joints) {
        (Some(Ok(depth)), Some(Ok(joints))) => Ok(Measurements {
            measures: depth.measures.fused(joints.measures),
            source: Source::Both,
            notes: left_out,
            ..depth
        }),
        (Some(Ok(one)), _) => Ok(Measurements { notes: [one.notes, left_out].concat(), ..one }),
        (Some(Err(_)) | None, Some(Ok(one))) => Ok(one),
        (Some(Err(why)), _) | (None, Some(Err(why))) => Err(why),
        (None, None) => Err(MeasureError::Empty),
    }
}

/// Leaves out girths that no person has, and names each in a sentence: arms, a bag or another person were taken with them.
fn possible(mut measured: Measurements, left_out: &mut Vec<String>) -> Measurements {
    let people = tape_readings::population(Population::Mixed);
    let taken = &mut measured.measures;
    let girths = [
        ("chest_girth", &mut taken.chest_girth),
        ("waist_girth", &mut taken.waist_girth),
        ("hip_girth", &mut taken.hip_girth),
    ];
    for (name, girth) in girths {
        let of = MEASURES.iter().position(|m| m.0 == name).map(|i| people.at(i));
        let beyond =
            |(e, of): &(Estimate, Estimate)| (e.value - of.value).abs() > tape_readings::MOST_SIGMAS * of.sigma;
        if let Some((e, _)) = girth.zip(of).filter(beyond) {
            left_out.push(format!(
                "A {} of {:.0} mm is no person's, so it is left out: hold the arms away from the body, and put bags down.",
                tape_readings::plain(name),
                e.value * 1e3
            ));
            *girth = None;
        }
    }
    measured
}

fn from_joints(joints: &[Joints], hint: &Hint) -> Result<Measurements, MeasureError> {
    let mut believed = joints.iter().filter(|f| joints::is_believed(f)).peekable();
    let start = believed.peek().map_or(0, |f| f.time_ns);
    let second: Vec<Joints> = believed.take_while(|f| f.time_ns - start <= ONE_SECOND_NS).copied().collect();
    let too_few = MeasureError::TooFewFrames { got: second.len(), frames: joints.len(), need: FEWEST_JOINT_FRAMES };
    if second.len() < FEWEST_JOINT_FRAMES {
        return Err(too_few);
    }
    let measures = joints::measures(&second, hint).ok_or(too_few)?;
    let mut notes = vec!["There is no depth: girths are guessed from stature and shoulders.".to_owned()];
    if !hint.scale_known {
        notes.push("The recording has no unit: the stature is assumed.".to_owned());
    }
    Ok(Measurements { measures, valid_pixels: 0, people: 1, frames: second.len(), source: Source::Joints, notes })
}

/// The readings of all depth frames, with their pixels and people.
struct SilhouetteReadings {
    readings: Vec<SilhouetteReading>,
    pixels: Vec<f32>,
    people: Vec<f32>,
    distances: Vec<f32>,
}

fn from_depth(depth: &[DepthFrame], hint: &Hint) -> Result<Measurements, MeasureError> {
    let mut all =
        SilhouetteReadings { readings: Vec::new(), pixels: Vec::new(), people: Vec::new(), distances: Vec::new() };
    let mut too_far = None;
    let mut finder = PersonFinder::default();
    for frame in depth.iter().take(FRAMES) {
        let view = finder.push(frame);
        too_far = too_far.or(view.too_far);
        let Some(cloud) = view.alone.as_ref().and_then(PersonCloud::of) else { continue };
        all.add(&cloud, view.people, silhouette::read(&cloud, &anthropometry::LEVELS, hint.population));
    }
    if all.pixels.is_empty() {
        let frames = depth.len().min(FRAMES);
        return Err(match too_far {
            Some(distance) => MeasureError::TooFar { distance, limit: point_cloud::FARTHEST },
            None => MeasureError::NoPerson { frames },
        });
    }
    let measures = all.measures(hint);
    Ok(Measurements {
        notes: missing(&measures),
        measures,
        valid_pixels: median(&all.pixels) as usize,
        people: median(&all.people).round() as usize,
        frames: all.pixels.len(),
        source: Source::Depth,
    })
}

impl SilhouetteReadings {
    fn add(&mut self, nearest: &PersonCloud, people: usize, reading: Option<SilhouetteReading>) {
        self.pixels.push(nearest.points.len() as f32);
        self.people.push(people as f32);
        self.distances.push(nearest.distance);
        self.readings.extend(reading);
    }

    /// Mean of one parameter over the frames that show it; a third of them must.
    fn mean(&self, parameter: impl Fn(&SilhouetteReading) -> Option<f32>) -> Option<Estimate> {
        let samples: Vec<f32> = self.readings.iter().filter_map(parameter).collect();
        if samples.len() * 3 < self.readings.len() {
            return None;
        }
        temporal_mean(&samples)
    }

    fn measures(&self, hint: &Hint) -> Measures {
        let model = SilhouetteModel::of(hint.population);
        let sensor = anthropometry::sensor_bias(median(&self.distances));
        let stature = self.mean(|r| r.stature).map(|h| h.widened(model.stature).widened(sensor));
        let section = |which: fn(&SilhouetteReading) -> Option<TorsoSection>, model: &GirthModel| {
            let mean = |part: fn(&TorsoSection) -> f32| self.mean(|r| which(r).as_ref().map(part));
            let breadth = mean(|s| s.breadth)?.widened(sensor);
            Some(model.at(breadth, mean(|s| s.arc)?.widened(sensor), mean(|s| s.front)?))
        };
        let hidden = self.readings.iter().filter(|r| r.chest_hidden).count() * 2 > self.readings.len();
        let regressions = regressions(hint.population);
        let nothing = Estimate::new(0.0, 0.0);
        Measures {
            stature,
            shoulder_breadth: self.mean(|r| r.shoulders).map(|s| model.shoulder.at(s.widened(sensor), nothing)),
            chest_girth: section(|r| r.chest, &model.chest).map(|c| if hidden { c.widened(HIDDEN_CHEST) } else { c }),
            waist_girth: section(|r| r.waist, &model.waist),
            hip_girth: section(|r| r.hip, &model.hip),
            inseam: stature.map(|h| regressions.inseam.at(h, nothing)),
            arm_length: stature.map(|h| regressions.arm.at(h, nothing)),
        }
    }
}

/// A sentence for each measure that depth should have given and did not.
fn missing(measures: &Measures) -> Vec<String> {
    let why = [
        (measures.stature, "The stature cannot be taken: the feet are not in the picture."),
        (measures.shoulder_breadth, "The shoulder breadth cannot be taken: the outline of the shoulders is hidden."),
        (measures.chest_girth, "The chest girth cannot be taken: arms or the picture's edge hide the torso's sides."),
        (measures.waist_girth, "The waist girth cannot be taken: arms or the picture's edge hide the torso's sides."),
        (measures.hip_girth, "The hip girth cannot be taken: arms or the picture's edge hide the torso's sides."),
    ];
    why.iter().filter(|(m, _)| m.is_none()).map(|(_, sentence)| (*sentence).to_owned()).collect()
}

/// Median of the samples; 0 of none.
fn median(samples: &[f32]) -> f32 {
    median_of(samples.iter().copied()).unwrap_or(0.0)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_impossible_girth_is_left_out_and_named() {
        let of = |chest: f32| {
            let girth = |m: f32| Some(Estimate::new(m, 0.08));
            let measures = Measures {
                chest_girth: girth(chest),
                waist_girth: girth(0.80),
                hip_girth: girth(1.00),
                ..Measures::default()
            };
            let all = Measurements {
                measures,
                valid_pixels: 1,
                people: 1,
                frames: 1,
                source: Source::Depth,
                notes: Vec::new(),
            };
            let mut left_out = Vec::new();
            (possible(all, &mut left_out), left_out)
        };
        let ((two, named), (one, nothing)) = (of(1.901), of(1.30));
        assert!(two.measures.chest_girth.is_none() && two.measures.waist_girth.is_some());
        assert!(named.len() == 1 && named[0].contains("chest girth of 1901 mm"), "{named:?}");
        assert!(one.measures.chest_girth.is_some() && nothing.is_empty());
    }
}
