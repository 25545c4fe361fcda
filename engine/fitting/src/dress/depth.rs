//! A shopper seen in depth: the body fitted to their surface gives measures, a body and, where there are none, joints.

use glam::{Affine3A, Vec3};
use toile_assets::body::{Body, Sex};
use toile_assets::mesh::SkinWeights;
use toile_assets::sizes::Population;
use toile_assets::skeleton::{BONES, Pose};
use toile_engine::body::palette;
use toile_sensors::frame::{DepthFrame, Joints};
use toile_sensors::source::Session;
use toile_track::fit::measuring::{self, FittedMeasures};
use toile_track::fit::{FitOptions, tracker};
use toile_track::measure::FRAMES;
use toile_track::point_cloud;

/// The shopper's surface, and the floor below it.
#[derive(Debug, Clone)]
pub struct DepthSurface {
    /// The frames of the first second, and the same with nothing in them but the shopper.
    pub frames: Vec<(DepthFrame, DepthFrame)>,
    /// Height of the floor (m); `None` where the picture cuts the shopper off above it.
    pub ground: Option<f32>,
}

impl DepthSurface {
    /// The nearest person of each frame of the first second.
    pub fn of(session: &Session) -> Self {
        let mut cut = 0;
        let mut frames = Vec::new();
        for frame in session.depth.iter().take(FRAMES) {
            if let Some(person) = point_cloud::find_people(frame).people.first() {
                cut += usize::from(person.cut_below);
                frames.push((frame.clone(), person.alone(frame)));
            }
        }
        let ground = (2 * cut < frames.len()).then_some(0.0);
        Self { frames, ground }
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
        let alone: Vec<DepthFrame> = self.frames.iter().map(|(_, alone)| alone.clone()).collect();
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
