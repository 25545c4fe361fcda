//! A recording brought into our world: levelled, its floor at y = 0, the shopper near x = z = 0.
//!
//! Joints alone say how a camera was tilted: a standing person's neck is above the middle of their feet, and the spine
//! is upright, in the median of the recording. Where a tracker has no neck, its chest or head does as well.

use glam::{Quat, Vec3};
use toile_base::numeric::statistics::{median_of, quantile_of};
use toile_base::skeleton::Joint;

use crate::error::{FilePlace, ReaderFault};
use toile_base::frame::Joints;

/// Tilt below which a recording is left as it is (rad): 4 degrees, the lean of a relaxed stance.
const SMALLEST_TILT: f32 = 4.0 * std::f32::consts::PI / 180.0;

/// Tilt above which the evidence is not a standing person (rad): 50 degrees.
const LARGEST_TILT: f32 = 50.0 * std::f32::consts::PI / 180.0;

/// Height of the ankle's centre above the floor (m): 0.04 of the stature (Drillis and Contini 1966: 0.039) and a sole.
const ANKLE_HEIGHT: f32 = 0.08;

/// Height of the ball of the foot above the floor (m): half its thickness, and a sole.
const TOE_HEIGHT: f32 = 0.03;

/// Hip height over the length from pelvis to chest: 0.53 over 0.33 of the stature with the Kinect's joints.
const LEG_OVER_TORSO: f32 = 1.6;

/// Fraction of frames that must show a foot before the floor is taken from the feet.
const FEET_SEEN: f32 = 0.1;

/// Fraction of frames whose lower foot lies below the floor: half of the frames of a standing person, a quarter to
/// allow for jumps.
const STANDING: f64 = 0.25;

const LEGS: [[Joint; 4]; 2] = [
    [Joint::LeftHip, Joint::LeftKnee, Joint::LeftAnkle, Joint::LeftToe],
    [Joint::RightHip, Joint::RightKnee, Joint::RightAnkle, Joint::RightToe],
];

/// Levels, puts the floor under the feet and centres at the median pelvis; `frames` have world axes already.
pub(super) fn to_world(frames: &mut [Joints], notes: &mut Vec<String>) -> Result<(), ReaderFault> {
    if !frames.iter().any(|f| f.joints.iter().any(|j| j.is_believed())) {
        let cure = "record again with the shopper in full view";
        return Err(ReaderFault::new(FilePlace::Whole, "no joint is believed in any frame", cure));
    }
    level(frames, notes);
    stand(frames, notes);
    Ok(())
}

/// Puts the floor under the feet and centres at the median pelvis, the axes unchanged.
pub(super) fn stand(frames: &mut [Joints], notes: &mut Vec<String>) {
    let centre = centre(frames);
    let floor = floor(frames, notes);
    for joint in frames.iter_mut().flat_map(|f| f.joints.iter_mut()).filter(|j| j.confidence > 0.0) {
        joint.position -= Vec3::new(centre.x, floor, centre.z);
    }
}

fn level(frames: &mut [Joints], notes: &mut Vec<String>) {
    let Some(up) = upright(frames) else {
        notes.push("the camera's tilt is unknown (too few joints seen) and taken as none".to_owned());
        return;
    };
    let tilt = up.angle_between(Vec3::Y);
    if tilt < SMALLEST_TILT {
        return;
    }
    let degrees = tilt.to_degrees();
    if tilt > LARGEST_TILT {
        notes.push(format!(
            "the body is {degrees:.0} degrees from upright, which no camera tilt explains: left as it is"
        ));
        return;
    }
    notes.push(format!("the camera was tilted by {degrees:.0} degrees (from spine and feet): levelled"));
    let turn = Quat::from_rotation_arc(up, Vec3::Y);
    for joint in frames.iter_mut().flat_map(|f| f.joints.iter_mut()).filter(|j| j.confidence > 0.0) {
        joint.position = turn * joint.position;
    }
}

/// The median direction of a standing body, unit length: the mean of pelvis to neck and feet to neck.
fn upright(frames: &[Joints]) -> Option<Vec3> {
    let spine = median_direction(frames, |f| Some(top(f)? - f.believed(Joint::Pelvis)?))?;
    let body = median_direction(frames, |f| Some(top(f)? - middle_of_feet(f)?));
    Some((spine + body.unwrap_or(spine)).normalize())
}

/// The neck, or what is nearest to it.
fn top(frame: &Joints) -> Option<Vec3> {
    [Joint::Neck, Joint::Chest, Joint::Head].into_iter().find_map(|joint| frame.believed(joint))
}

/// Middle of both feet, between ankles and toes, where all four are seen.
fn middle_of_feet(frame: &Joints) -> Option<Vec3> {
    let mut sum = Vec3::ZERO;
    for [_, _, ankle, toe] in LEGS {
        sum += frame.believed(ankle)? + frame.believed(toe)?;
    }
    Some(sum * 0.25)
}

fn median_direction(frames: &[Joints], direction: impl Fn(&Joints) -> Option<Vec3>) -> Option<Vec3> {
    let all: Vec<Vec3> = frames.iter().filter_map(direction).filter_map(Vec3::try_normalize).collect();
    if all.len() * 10 < frames.len() {
        return None;
    }
    let axis = |k: usize| median_of(all.iter().map(|d| d[k]));
    Vec3::new(axis(0)?, axis(1)?, axis(2)?).try_normalize()
}

/// Height of the floor (m): beneath the feet where they are seen, else a leg's length beneath the hips.
fn floor(frames: &[Joints], notes: &mut Vec<String>) -> f32 {
    let feet: Vec<f32> = frames.iter().filter_map(lowest_sole).collect();
    if feet.len() as f32 >= FEET_SEEN * frames.len() as f32
        && let Some(floor) = quantile_of(feet, STANDING)
    {
        return floor;
    }
    let hips = median_of(frames.iter().filter_map(hip_height));
    let (leg, how) = leg_length(frames);
    if let (Some(hips), Some(leg)) = (hips, leg) {
        notes.push(format!("the feet are not seen: the floor is put {leg:.2} m below the hips, from {how}"));
        return hips - leg;
    }
    let lowest = frames.iter().flat_map(|f| f.joints.iter()).filter(|j| j.is_believed()).map(|j| j.position.y);
    notes.push("neither feet nor hips are seen: the floor is put under the lowest joint".to_owned());
    quantile_of(lowest, 0.05).unwrap_or(0.0)
}

/// Where the floor would be under the lowest believed foot joint of a frame (m).
fn lowest_sole(frame: &Joints) -> Option<f32> {
    let mut lowest: Option<f32> = None;
    for [_, _, ankle, toe] in LEGS {
        for (joint, height) in [(ankle, ANKLE_HEIGHT), (toe, TOE_HEIGHT)] {
            if let Some(p) = frame.believed(joint) {
                lowest = Some(lowest.map_or(p.y - height, |y| y.min(p.y - height)));
            }
        }
    }
    lowest
}

fn hip_height(frame: &Joints) -> Option<f32> {
    let hips = [Joint::LeftHip, Joint::RightHip, Joint::Pelvis];
    let seen: Vec<f32> = hips.iter().filter_map(|j| frame.believed(*j)).map(|p| p.y).collect();
    (!seen.is_empty()).then(|| seen.iter().sum::<f32>() / seen.len() as f32)
}

/// Hip to floor (m): thigh and shin as the sensor inferred them where that is a plausible leg for the torso, else by
/// proportion.
fn leg_length(frames: &[Joints]) -> (Option<f32>, &'static str) {
    let torso = median_of(frames.iter().filter_map(|f| length(f, Joint::Pelvis, Joint::Chest)));
    let bone = |from, to| median_of(frames.iter().filter_map(|f| length(f, from, to)));
    let [[hip, knee, ankle, _], _] = LEGS;
    let inferred = bone(hip, knee).zip(bone(knee, ankle)).map(|(thigh, shin)| thigh + shin + ANKLE_HEIGHT);
    match (inferred, torso) {
        (Some(leg), Some(torso)) if (1.2..2.0).contains(&(leg / torso)) => {
            (Some(leg), "the leg that the sensor inferred")
        }
        (Some(leg), None) => (Some(leg), "the leg that the sensor inferred"),
        (_, Some(torso)) => (Some(torso * LEG_OVER_TORSO), "the torso's length"),
        (None, None) => (None, ""),
    }
}

/// Distance of two joints that are at least inferred (m).
fn length(frame: &Joints, from: Joint, to: Joint) -> Option<f32> {
    let (a, b) = (frame.at(from), frame.at(to));
    (a.confidence > 0.0 && b.confidence > 0.0).then(|| a.position.distance(b.position))
}

/// Median of the pelvis, or of all joints where it is never seen (m).
fn centre(frames: &[Joints]) -> Vec3 {
    let pelvis: Vec<Vec3> = frames.iter().filter_map(|f| f.believed(Joint::Pelvis)).collect();
    let believed = || frames.iter().flat_map(|f| f.joints.iter()).filter(|j| j.is_believed()).map(|j| j.position);
    let all = if pelvis.is_empty() { believed().collect() } else { pelvis };
    let axis = |k: usize| median_of(all.iter().map(|p| p[k])).unwrap_or(0.0);
    Vec3::new(axis(0), 0.0, axis(2))
}
