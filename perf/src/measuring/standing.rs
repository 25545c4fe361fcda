//! A person who stands before a camera: a body with weights, how they stand, and how they move while they do.

use std::f32::consts::TAU;

use glam::{Affine3A, Quat, Vec3};
use toile_base::body::{Body, Region, Sex};
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::{BONES, JOINTS, Joint, Pose};
use toile_engine::body::{JointFrames, palette};
use toile_track::fit::measuring::MEASURES;

/// Where the joints are at one moment, world (m).
pub type JointPositions = [Vec3; JOINTS];

/// What a tape reads on a person, in the order of [`MEASURES`] (m); `None` where their mesh has no landmark for it.
pub type TapeMeasures = [Option<f32>; MEASURES.len()];

/// How a person moves while they stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum StandingMotion {
    /// Each frame has a sway of its own, as if frames lay seconds apart; without breathing.
    Independent,
    /// Sway that wanders slowly, and a chest that breathes.
    Breathing(Breathing),
}

/// A slow sway and a breath, each a sine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Breathing {
    /// Breaths a second (Hz) and where the first frame is in one (rad).
    pub rate: [f32; 2],
    /// How far the skin of the chest moves out of its mean (m).
    pub depth: f32,
    /// Sways a second of the trunk's joints (Hz).
    pub sway: f32,
}

/// A moment at which a person is seen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moment {
    /// Time since the first frame (s).
    pub time: f32,
    /// How far the person has turned about the vertical through the origin (rad).
    pub turned: f32,
}

/// A person who can stand before a camera.
pub struct StudyPerson {
    /// Sex of the person, by which the survey's ranges were chosen.
    pub sex: Sex,
    /// What the tape reads on their surface at rest.
    pub truth: TapeMeasures,
    pub(super) body: Body,
    pub(super) pose: Pose,
    pub(super) motion: StandingMotion,
}

/// What sways, and by how much (rad): a standing person's middle wanders by some millimetres in a second, their hands by
/// some more.
const SWAYS: [(Joint, f32); 7] = [
    (Joint::Pelvis, 0.006),
    (Joint::Spine, 0.004),
    (Joint::Neck, 0.015),
    (Joint::LeftShoulder, 0.015),
    (Joint::RightShoulder, 0.015),
    (Joint::LeftElbow, 0.010),
    (Joint::RightElbow, 0.010),
];

/// How far the feet's middle wanders on the floor (m).
const WANDER: f32 = 0.006;

impl StudyPerson {
    /// Triangles of the surface.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.body.mesh.triangles
    }

    /// The surface of the swaying person at one moment, feet on the floor (m) `[vertices]`.
    /// Gives where their joints are.
    pub fn stand(&self, moment: Moment, rng: &mut SplitMix64, positions: &mut Vec<Vec3>) -> JointPositions {
        let mut pose = self.pose;
        for (k, (joint, by)) in SWAYS.into_iter().enumerate() {
            let turn = match self.motion {
                StandingMotion::Independent => Vec3::new(rng.gaussian(), rng.gaussian(), rng.gaussian()),
                StandingMotion::Breathing(b) => {
                    let phase =
                        |axis: usize| TAU * b.sway * moment.time * (1.0 + 0.3 * axis as f32) + (k * 7 + axis) as f32;
                    1.4 * Vec3::new(phase(0).sin(), phase(1).sin(), phase(2).sin())
                }
            };
            pose.local[joint.index()] = Quat::from_scaled_axis(turn * by) * pose.local[joint.index()];
        }
        pose.root += match self.motion {
            StandingMotion::Independent => Vec3::new(rng.gaussian(), 0.0, rng.gaussian()) * WANDER,
            StandingMotion::Breathing(b) => {
                let phase = TAU * b.sway * moment.time;
                Vec3::new(phase.sin(), 0.0, (0.7 * phase + 2.0).sin()) * WANDER
            }
        };
        on_both_feet(&self.body, &mut pose);
        self.skinned(&pose, moment, positions)
    }

    /// The surface in a pose, its lowest point on the floor, and where its joints are.
    fn skinned(&self, pose: &Pose, moment: Moment, positions: &mut Vec<Vec3>) -> JointPositions {
        let mut bones = [Affine3A::IDENTITY; BONES];
        palette(&self.body.skeleton, pose, &mut bones);
        let breath = self.breath(moment.time);
        let rest = self.body.mesh.positions.iter().zip(&self.body.normals).zip(&self.body.regions);
        positions.clear();
        positions.extend(rest.zip(&self.body.weights).map(|(((p, normal), region), weights)| {
            let out = if *region == Region::Torso { self.chest_share(p.y) * breath } else { 0.0 };
            let p = *p + *normal * out;
            weights.iter().map(|(bone, w)| w * bones[bone as usize].transform_point3(p)).sum::<Vec3>()
        }));
        let lowest = positions.iter().map(|p| p.y).fold(f32::MAX, f32::min);
        let turned = Quat::from_rotation_y(moment.turned);
        positions.iter_mut().for_each(|p| *p = turned * (*p - Vec3::Y * lowest));
        JointFrames::new(&self.body.skeleton, pose).position.map(|p| turned * (p - Vec3::Y * lowest))
    }

    /// How far the breath moves the chest's skin at a time (m).
    fn breath(&self, time: f32) -> f32 {
        match self.motion {
            StandingMotion::Independent => 0.0,
            StandingMotion::Breathing(b) => b.depth * (TAU * b.rate[0] * time + b.rate[1]).sin(),
        }
    }

    /// How much of a breath shows at a height of the trunk, 0 to 1: most of it between waist and armpits.
    fn chest_share(&self, y: f32) -> f32 {
        let s = &self.body.skeleton;
        let (low, high) = (s.at(Joint::Pelvis).y, s.at(Joint::Neck).y);
        let up = ((y - low) / (high - low)).clamp(0.0, 1.0);
        (up * std::f32::consts::PI).sin().powi(2)
    }
}

/// Lays both soles flat and level, as standing people have them: ankles turn, and the hips tilt where one leg reaches
/// lower than the other.
fn on_both_feet(body: &Body, pose: &mut Pose) {
    for _ in 0..3 {
        let frames = JointFrames::new(&body.skeleton, pose);
        for (ankle, knee) in [(Joint::LeftAnkle, Joint::LeftKnee), (Joint::RightAnkle, Joint::RightKnee)] {
            let foot = frames.rotation[ankle.index()];
            let level = Quat::from_rotation_arc(foot * Vec3::Y, Vec3::Y) * foot;
            pose.local[ankle.index()] = frames.rotation[knee.index()].inverse() * level;
        }
        let [left, right] = [Joint::LeftAnkle, Joint::RightAnkle].map(|j| frames.position[j.index()]);
        let tilt = Quat::from_rotation_z(-(left.y - right.y) / (left.x - right.x).max(0.05));
        pose.local[Joint::Pelvis.index()] = tilt * pose.local[Joint::Pelvis.index()];
    }
}
