//! What moves a dressed body from step to step: a shopper's joints, or the poses of an animation.

use toile_assets::import::avatar::MovingBody;
use toile_base::clock::ticks_to_ns;
use toile_base::frame::Joints;
use toile_base::limits::STEP_HZ;
use toile_base::numeric::statistics;
use toile_base::skeleton::{BONES, Pose};
use toile_engine::body::{JointFrames, palette};
use toile_engine::skin::SkinningJob;
use toile_engine::world::{BLEND, World};
use toile_sensors::source::Session;

use super::player::Player;
use crate::FittingError;

/// Frames a second at which an animation's skin is compared.
const COMPARED_HZ: u32 = 30;

/// A motion on its way to the steps.
#[derive(Debug, Clone)]
pub enum SessionMotion<'a> {
    /// Filtered joints, as a sensor gives them.
    Joints {
        /// The joints.
        track: &'a [Joints],
        /// Where they are played.
        player: Box<Player<'a>>,
    },
    /// Poses, one a step, the first of which the garments are put on in.
    Poses {
        /// The poses.
        poses: &'a [Pose],
        /// How many of them were stepped to.
        next: usize,
    },
}

impl<'a> SessionMotion<'a> {
    /// Of filtered joints, of which there is at least one.
    pub fn of_joints(track: &'a [Joints]) -> Self {
        Self::Joints { track, player: Box::new(Player::new(track)) }
    }

    /// Of poses, of which there are at least two.
    pub fn of_poses(poses: &'a [Pose]) -> Self {
        Self::Poses { poses, next: 1 }
    }

    /// How many steps it has.
    pub fn steps(&self) -> u64 {
        match self {
            Self::Joints { player, .. } => player.steps(),
            Self::Poses { poses, .. } => poses.len().saturating_sub(1) as u64,
        }
    }

    /// Puts the garments on in the first pose.
    pub fn dress(&self, world: &mut World) {
        match self {
            Self::Joints { track, .. } => track.iter().take(1).for_each(|first| world.dress(first)),
            Self::Poses { poses, .. } => poses.iter().take(1).for_each(|first| world.dress_in_pose(first)),
        }
    }

    /// Takes the next step; behind the last pose the body stands.
    pub fn step(&mut self, world: &mut World) {
        match self {
            Self::Joints { player, .. } => world.step(&player.step()),
            Self::Poses { poses, next } => {
                if let Some(pose) = poses.get(*next).or(poses.last()) {
                    world.step_in_pose(pose);
                }
                *next += 1;
            }
        }
    }
}

/// The session that a body shows which moves by itself: its joints, as a sensor without noise or loss would see them.
pub fn session_of(moving: &MovingBody) -> Session {
    let skeleton = &moving.imported.body.skeleton;
    let stride = (STEP_HZ / COMPARED_HZ) as usize;
    let seen =
        |(k, pose): (usize, &Pose)| Joints::seen(ticks_to_ns(k as u64), JointFrames::new(skeleton, pose).position);
    let joints = moving.poses.iter().enumerate().step_by(stride).map(seen).collect();
    Session { name: moving.animation.clone(), joints, raw_scale_known: true, ..Session::default() }
}

/// The same body as it stands at rest for a second: what it is measured by.
pub fn standing_still(moving: &MovingBody) -> Session {
    let rest = moving.imported.body.skeleton.rest;
    let joints =
        (0..=u64::from(COMPARED_HZ)).map(|k| Joints::seen(ticks_to_ns(k * u64::from(STEP_HZ / COMPARED_HZ)), rest));
    Session { name: moving.animation.clone(), joints: joints.collect(), raw_scale_known: true, ..Session::default() }
}

/// How far the skin as the engine moves it is from the skin as its file does, over all vertices of 30 frames a second (m).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SkinDistance {
    /// Mean.
    pub mean: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Most of any vertex in any frame.
    pub max: f64,
}

/// The distance of the engine's skin from the file's own, which is taken in f64 with all of its influences.
///
/// # Errors
/// A body that cannot be skinned.
pub fn skin_distance(moving: &MovingBody) -> Result<SkinDistance, FittingError> {
    let body = &moving.imported.body;
    let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights).map_err(FittingError::input)?;
    let (mut skin, mut bones) = (job.posed(), [glam::Affine3A::IDENTITY; BONES]);
    let mut all: Vec<f64> = Vec::new();
    for k in (0..moving.poses.len()).step_by((STEP_HZ / COMPARED_HZ) as usize) {
        palette(&body.skeleton, &moving.poses[k], &mut bones);
        job.run(BLEND, &bones, &mut skin);
        let apart = |(v, p): (usize, glam::DVec3)| skin.position(v).as_dvec3().distance(p);
        all.extend(moving.surface(k).into_iter().enumerate().map(apart));
    }
    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
    let max = all.iter().copied().fold(0.0, f64::max);
    Ok(SkinDistance { mean, p99: statistics::quantile(&mut all, 0.99).unwrap_or_default(), max })
}
