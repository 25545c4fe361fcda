//! A shopper seen in depth: the body fitted to their surface gives measures, a body and, where there are none, joints.

use glam::{Affine3A, Vec3};
use toile_assets::sizes::Population;
use toile_base::body::{Body, Sex};
use toile_base::frame::{DepthFrame, Joints};
use toile_base::mesh::SkinWeights;
use toile_base::numeric::statistics::median_of;
use toile_base::skeleton::{BONES, Pose};
use toile_engine::body::palette;
use toile_sensors::source::Session;
use toile_track::fit::measuring::FRAMES;
use toile_track::fit::measuring::{self, FittedMeasures};
use toile_track::fit::{FitOptions, tracker};
use toile_track::measure::MeasureError;
use toile_track::point_cloud::{FARTHEST, PersonCloud, PersonFinder};

use crate::FittingError;

/// Longest that is looked at for a turn after the first second, and how far apart its frames are taken (ns): a slow turn takes six
/// seconds, and in a fifteenth of one it goes on by four degrees.
pub const TURN_NS: u64 = 12_000_000_000;
/// Least time between two frames of a turn (ns).
pub const APART_NS: u64 = 60_000_000;

/// The shopper's surface, and the floor below it.
#[derive(Debug, Clone)]
pub struct DepthSurface {
    /// The frames of the first second, and the same with nothing in them but the shopper.
    pub frames: Vec<(DepthFrame, DepthFrame)>,
    /// Frames of the next seconds, in which the shopper may turn, with nothing in them but the shopper.
    pub after: Vec<DepthFrame>,
    /// Height of the floor (m); `None` where the picture cuts the shopper off above it.
    pub ground: Option<f32>,
    /// Depth pixels on the shopper, median over the frames of the first second.
    pub pixels: usize,
    /// People in view, median over the same frames.
    pub people: usize,
    /// Distance of a person who stands too far away to be measured (m).
    pub too_far: Option<f32>,
}

impl DepthSurface {
    /// The shopper in the frames of the first second, and in those of a turn.
    pub fn of(session: &Session) -> Self {
        Self::until(session, u64::MAX)
    }

    /// The same with the turn up to a time of the session (ns).
    pub fn until(session: &Session, until_ns: u64) -> Self {
        let (mut cut, mut frames, mut after) = (0, Vec::new(), Vec::new());
        let (mut pixels, mut people, mut too_far) = (Vec::new(), Vec::new(), None);
        let mut finder = PersonFinder::default();
        let mut next = 0;
        for (i, frame) in session.depth.iter().enumerate() {
            if i < FRAMES {
                let view = finder.push(frame);
                too_far = too_far.or(view.too_far);
                let Some(alone) = view.alone else { continue };
                if let Some(cloud) = PersonCloud::of(&alone) {
                    cut += usize::from(cloud.cut_below);
                    pixels.push(cloud.points.len() as f32);
                    people.push(view.people as f32);
                }
                next = frame.time_ns + APART_NS;
                frames.push((frame.clone(), alone));
            } else if frame.time_ns.saturating_sub(session.depth[0].time_ns) > TURN_NS || frame.time_ns > until_ns {
                break;
            } else if frame.time_ns >= next {
                next = frame.time_ns + APART_NS;
                after.extend(finder.push(frame).alone);
            }
        }
        let ground = (2 * cut < frames.len()).then_some(0.0);
        let median = |counts: Vec<f32>| median_of(counts).unwrap_or(0.0);
        let (pixels, people) = (median(pixels) as usize, median(people).round() as usize);
        Self { frames, after, ground, pixels, people, too_far }
    }

    /// The error for a session in whose depth no body fits.
    pub fn refusal(&self, session: &Session) -> FittingError {
        if self.frames.is_empty() {
            let frames = session.depth.len().min(FRAMES);
            return FittingError::input(match self.too_far {
                Some(distance) => MeasureError::TooFar { distance, limit: FARTHEST },
                None if frames == 0 => MeasureError::Empty,
                None => MeasureError::NoPerson { frames },
            });
        }
        FittingError::Input(format!(
            "no body fits the depth of session {}; record a person who stands alone, facing the camera, arms slightly out",
            session.name
        ))
    }

    /// How a body is fitted to it.
    pub fn options(&self, clothed: bool) -> FitOptions {
        FitOptions { ground: self.ground, clothed, ..FitOptions::MEASURING }
    }

    /// Measures the shopper by the body fit; `None` if no body fits.
    pub fn measure(&self, population: Population, clothed: bool) -> Option<FittedMeasures> {
        if self.frames.is_empty() {
            return None;
        }
        let alone: Vec<DepthFrame> = self.frames.iter().map(|(_, alone)| alone).chain(&self.after).cloned().collect();
        measuring::measure(&alone, population, self.options(clothed))
    }

    /// Joints of all of a session's depth frames: the fitted body is followed through them.
    pub fn follow(&self, session: &Session, fitted: &FittedMeasures) -> Vec<Joints> {
        let sex = if fitted.woman > 0.5 { Sex::Female } else { Sex::Male };
        tracker::track(&session.depth, sex, FitOptions { ground: self.ground, ..FitOptions::LIVE })
    }
}

/// The posed surface of a body (m) `[vertices]`.
pub fn posed(body: &Body, pose: &Pose) -> Vec<Vec3> {
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(&body.skeleton, pose, &mut bones);
    let skinned = |(p, weights): (&Vec3, &SkinWeights)| {
        weights.iter().map(|(bone, w)| w * bones[bone as usize].transform_point3(*p)).sum::<Vec3>()
    };
    body.mesh.positions.iter().zip(&body.weights).map(skinned).collect()
}
