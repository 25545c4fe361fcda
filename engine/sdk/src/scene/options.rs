//! Options of dressing and motion.

use toile_assets::scene_file::Wind;
use toile_base::frame::Joints;
use toile_base::limits::MAX_GARMENTS;
use toile_base::skeleton::Skeleton;
use toile_engine::cloth::{self, Quality, Settings};
use toile_fitting::dress::session;
use toile_fitting::wearing::poses;

use crate::error::{Error, Result};

/// How a body moves.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub enum Motion {
    /// It stands, arms beside the hips.
    #[default]
    Standing,
    /// It sits, hips and knees at right angles.
    Sitting,
    /// It stands as these joints are; [`Scene::step_to`](crate::Scene::step_to) moves it on.
    Joints(Box<Joints>),
    /// It follows frames of joints at their own times, such as [`Recording::track`](crate::Recording::track) gives: a step knows
    /// the frames that have come by then, as in real time.
    Track(Vec<Joints>),
}

/// How a body is dressed. Build it with `..Default::default()`: fields may be added.
#[derive(Debug, Clone, PartialEq)]
pub struct DressOptions {
    /// How the body moves.
    pub motion: Motion,
    /// Tested settings of the cloth.
    pub quality: Quality,
    /// Threads that share a step, 1 or 2; both give the same bits.
    pub workers: usize,
    /// Air that moves.
    pub wind: Option<Wind>,
    /// Names of garments that are tucked into the next one under them that has a waistband.
    pub tuck: Vec<String>,
}

impl Default for DressOptions {
    fn default() -> Self {
        let Settings { quality, workers, .. } = Settings::default();
        Self { motion: Motion::default(), quality, workers, wind: None, tuck: Vec::new() }
    }
}

impl DressOptions {
    /// The engine's settings.
    pub(super) fn settings(&self) -> Result<Settings> {
        if !(1..=2).contains(&self.workers) {
            return Err(Error::input(format!("a step cannot be shared by {} workers; give 1 or 2", self.workers)));
        }
        let wind = self.wind.map(|w| cloth::Wind { velocity: w.velocity.into(), drag: w.drag, lift: w.lift });
        let settings = Settings { quality: self.quality, workers: self.workers, wind, ..Settings::default() };
        if settings.sound() != settings {
            return Err(Error::input(
                "such a wind there is not: give a velocity of at most 1000 m/s along each axis, and a drag and a lift of 0 to 100",
            ));
        }
        Ok(settings)
    }
}

/// That a body can wear so many.
pub(super) fn check_count(count: usize) -> Result<()> {
    if count <= MAX_GARMENTS {
        return Ok(());
    }
    Err(Error::input(format!(
        "{count} garments are given, and a body wears at most {MAX_GARMENTS} at once; leave some out"
    )))
}

/// The joints that a body is dressed in.
pub(super) fn first_joints(motion: &Motion, skeleton: &Skeleton) -> Result<Joints> {
    match motion {
        Motion::Standing => Ok(poses::joints(skeleton, &poses::arms_down(skeleton))),
        Motion::Sitting => Ok(poses::joints(skeleton, &poses::sitting(skeleton))),
        Motion::Joints(joints) => checked(joints).copied(),
        Motion::Track(track) => {
            let Some(first) = track.first() else {
                return Err(Error::input("the track has no frame; give one at least, or let the body stand"));
            };
            if let Some(at) = track.windows(2).position(|pair| pair[1].time_ns <= pair[0].time_ns) {
                let at = at + 1;
                return Err(Error::input(format!(
                    "frame {at} of the track is not later than the one before it; sort them by time"
                )));
            }
            track.iter().enumerate().try_for_each(|(at, joints)| match joints.is_valid() {
                true => Ok(()),
                false => Err(Error::input(format!("frame {at} of the track: {NOT_VALID}"))),
            })?;
            checked(first).copied()
        }
    }
}

/// What is wrong with joints that are no sensor's.
const NOT_VALID: &str =
    "a joint is not finite, or its confidence not within 0 to 1; give joints that were not seen a confidence of 0";

/// Joints in which a body can be.
pub(super) fn checked(joints: &Joints) -> Result<&Joints> {
    if !joints.is_valid() {
        return Err(Error::input(NOT_VALID));
    }
    if !session::is_present(joints) {
        return Err(Error::input(
            "these joints give no pose: pelvis and both hips have to be seen (confidence 0.5 or more)",
        ));
    }
    Ok(joints)
}
