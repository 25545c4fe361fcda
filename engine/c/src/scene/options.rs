//! Options of dressing and motion.

use toile_sdk::glam::Vec3;
use toile_sdk::{DressOptions, Motion as SdkMotion, Quality as SdkQuality, Wind};

use crate::border::{In, Text};
use crate::failure::{Failure, Result};
use crate::joints::JointFrame;

/// How a body moves.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// It stands, arms beside the hips.
    Standing = 0,
    /// It sits, hips and knees at right angles.
    Sitting = 1,
    /// It stands as the one frame of joints is; toile_scene_step_to moves it on.
    Joints = 2,
    /// It follows the frames of joints at their own times, such as toile_track_frames lends.
    Track = 3,
}

/// Tested settings of the cloth.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quality {
    /// TOILE_QUALITY_SHOP.
    Default = 0,
    /// For many bodies or slow machines.
    Draft = 1,
    /// For a mirror in a shop.
    Shop = 2,
    /// For pictures.
    Fine = 3,
}

/// Air that moves.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct MovingAir {
    /// Velocity along x, y, z (m/s), each at most 1000.
    pub velocity: [f32; 3],
    /// Drag (1), 0 to 100.
    pub drag: f32,
    /// Lift (1), 0 to 100.
    pub lift: f32,
}

/// How a body is dressed. Zeros throughout, { 0 }, are the defaults: it stands, quality shop, still air, nothing tucked in.
#[repr(C)]
#[derive(Debug)]
pub struct Dressing {
    /// A toile_motion.
    pub motion: i32,
    /// A toile_quality.
    pub quality: i32,
    /// Threads that share a step, 1 or 2, which give the same bits; 0 is the default.
    pub workers: u32,
    /// Frames of joints, of TOILE_MOTION_JOINTS one; null of other motions but TOILE_MOTION_TRACK.
    pub joints: In<JointFrame>,
    /// How many.
    pub joint_frames: usize,
    /// Air that moves; null is still air.
    pub wind: In<MovingAir>,
    /// Names of garments that are tucked into the next one under them that has a waistband; null is none.
    pub tuck: In<Text>,
    /// How many.
    pub tuck_count: usize,
}

const MOTIONS: [Motion; 4] = [Motion::Standing, Motion::Sitting, Motion::Joints, Motion::Track];

/// A quality by its number.
pub fn quality(number: i32) -> Result<SdkQuality> {
    let all = [
        (Quality::Default, SdkQuality::default()),
        (Quality::Draft, SdkQuality::Draft),
        (Quality::Shop, SdkQuality::Shop),
        (Quality::Fine, SdkQuality::Fine),
    ];
    let found = all.into_iter().find(|(own, _)| *own as i32 == number);
    found
        .map(|(_, quality)| quality)
        .ok_or_else(|| Failure::usage(format!("{number} is no quality; give one of toile_quality")))
}

/// Names of garments that are tucked in.
pub fn tucked(names: &In<Text>, count: usize) -> Result<Vec<String>> {
    let each = names.slice(count, "names of garments to tuck in")?.iter();
    each.map(|name| Ok(name.of("name of a garment to tuck in")?.to_owned())).collect()
}

impl Dressing {
    /// The options as the SDK has them.
    pub fn options(&self) -> Result<DressOptions> {
        let frames = self.joints.slice(self.joint_frames, "joints")?;
        let (motion, count) = (MOTIONS.into_iter().find(|motion| *motion as i32 == self.motion), frames.len());
        let motion =
            motion.ok_or_else(|| Failure::usage(format!("{} is no motion; give one of toile_motion", self.motion)))?;
        let motion = match (motion, frames) {
            (Motion::Standing, []) => SdkMotion::Standing,
            (Motion::Sitting, []) => SdkMotion::Sitting,
            (Motion::Standing | Motion::Sitting, _) => {
                return Err(Failure::usage(format!(
                    "{count} frames of joints are given for a body that stands or sits; give none, or another motion"
                )));
            }
            (Motion::Joints, [one]) => SdkMotion::Joints(Box::new(one.into())),
            (Motion::Joints, _) => {
                return Err(Failure::usage(format!(
                    "TOILE_MOTION_JOINTS takes one frame of joints, and {count} are given"
                )));
            }
            (Motion::Track, _) => SdkMotion::Track(frames.iter().map(Into::into).collect()),
        };
        let defaults = DressOptions::default();
        Ok(DressOptions {
            motion,
            quality: quality(self.quality)?,
            workers: if self.workers == 0 { defaults.workers } else { self.workers as usize },
            wind: self.wind.optional("wind")?.map(|wind| Wind {
                velocity: Vec3::from_array(wind.velocity),
                drag: wind.drag,
                lift: wind.lift,
            }),
            tuck: tucked(&self.tuck, self.tuck_count)?,
        })
    }
}
