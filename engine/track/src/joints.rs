//! Measures from joints alone: lengths of the skeleton, and girths guessed from them.

use toile_base::frame::Joints;
use toile_base::limits::CONFIDENCE_GATE;
use toile_base::skeleton::Joint;
use toile_base::skeleton::Joint::*;

use crate::anthropometry::{regressions, stature};
use crate::estimate::{Estimate, temporal_mean};
use crate::measures::{Hint, Measures};

/// Where one kind of sensor places its joints.
struct JointConvention {
    /// Path from pelvis over spine, chest and neck to the head, as a fraction of stature.
    trunk: f32,
    /// Hip over knee to ankle as a fraction of stature.
    leg: f32,
    /// Breadth between the acromions over the distance of the shoulder joints.
    acromions: f32,
}

/// Sensors without collar bones, the Kinect first: the pelvis at .53 of stature, the head joint in the middle of the
/// head at .935, the leg after Drillis and Contini 1966 (.245 + .246); the shoulder joint a hand's thickness below and
/// inside the acromion.
const KINECT: JointConvention = JointConvention { trunk: 0.405, leg: 0.491, acromions: 1.15 };

/// Skeletons with collar bones: ours, read off the mannequins of `toile_assets::body` (the same for both sexes), whose
/// head joint is where the skull turns on the neck.
const OWN: JointConvention = JointConvention { trunk: 0.354, leg: 0.478, acromions: 1.107 };

/// Relative errors of those factors: sensors and people differ by some centimetres in where a joint is; depth cameras
/// place hips and ankles worse than the spine.
const TRUNK_ERROR: f32 = 0.05;
const LEG_ERROR: f32 = 0.06;
const ACROMIONS_ERROR: f32 = 0.05;

/// A leg longer or shorter than this times the trunk's proportion is a mistracked one.
const LEG_TO_TRUNK: [f32; 2] = [0.85, 1.18];

/// Fewest frames in which a bone must be seen.
const FEWEST: usize = 3;

/// Measures from the frames given; `None` if trunk and shoulders are both unseen.
pub(crate) fn measures(frames: &[Joints], hint: &Hint) -> Option<Measures> {
    let common = stature(hint.population);
    let convention = if length(frames, &[LeftClavicle, RightClavicle]).is_some() { &OWN } else { &KINECT };
    let seen = stature_of(frames, convention);
    let shoulders =
        length(frames, &[LeftShoulder, RightShoulder]).map(|s| scaled(s, convention.acromions, ACROMIONS_ERROR));
    if seen.is_none() && shoulders.is_none() {
        return None;
    }
    let regression = regressions(hint.population);
    let (stature, shoulder) = match (hint.scale_known, seen) {
        // What is measured is drawn towards what people commonly measure, because its error is nearly as large.
        (true, Some(seen)) => (seen.fuse(common), shoulders),
        (true, None) => (common, shoulders),
        // Without a scale only proportions are known: the stature is assumed.
        (false, Some(seen)) => {
            let scale = common.value / seen.value;
            (common, shoulders.map(|s| Estimate::new(s.value * scale, s.sigma * scale).widened(s.value * scale * 0.05)))
        }
        (false, None) => (common, None),
    };
    let usual = regression.shoulder.at(stature, Estimate::new(0.0, 0.0));
    let shoulder = shoulder.map_or(usual, |s| s.fuse(usual));
    Some(Measures {
        stature: Some(stature),
        shoulder_breadth: Some(shoulder),
        chest_girth: Some(regression.chest.at(stature, shoulder)),
        waist_girth: Some(regression.waist.at(stature, shoulder)),
        hip_girth: Some(regression.hip.at(stature, shoulder)),
        inseam: Some(regression.inseam.at(stature, Estimate::new(0.0, 0.0))),
        arm_length: Some(regression.arm.at(stature, Estimate::new(0.0, 0.0))),
    })
}

/// Whether a frame shows enough of a body to be measured: a believed pelvis or chest, and a shoulder or the head.
pub(crate) fn is_believed(frame: &Joints) -> bool {
    let seen = |j: Joint| believed(frame, j);
    (seen(Pelvis) || seen(Chest)) && (seen(Head) || seen(LeftShoulder) || seen(RightShoulder))
}

fn believed(frame: &Joints, joint: Joint) -> bool {
    let j = frame.at(joint);
    j.confidence >= CONFIDENCE_GATE && j.position.is_finite()
}

fn stature_of(frames: &[Joints], convention: &JointConvention) -> Option<Estimate> {
    let trunk =
        length(frames, &[Pelvis, Spine, Chest, Neck, Head]).map(|t| scaled(t, convention.trunk.recip(), TRUNK_ERROR));
    let left = length(frames, &[LeftHip, LeftKnee, LeftAnkle]);
    let right = length(frames, &[RightHip, RightKnee, RightAnkle]);
    let leg = match (left, right) {
        (Some(l), Some(r)) => Some(Estimate::new(0.5 * (l.value + r.value), l.sigma.hypot(r.sigma) * 0.5)),
        (one, other) => one.or(other),
    };
    let leg = leg.map(|l| scaled(l, convention.leg.recip(), LEG_ERROR));
    match (trunk, leg) {
        (Some(t), Some(l)) if (LEG_TO_TRUNK[0]..LEG_TO_TRUNK[1]).contains(&(l.value / t.value)) => Some(t.fuse(l)),
        (Some(t), Some(_) | None) => Some(t),
        (None, l) => l,
    }
}

/// A length times a factor that has a relative error of its own.
fn scaled(length: Estimate, factor: f32, error: f32) -> Estimate {
    Estimate::new(length.value * factor, length.sigma * factor).widened(length.value * factor * error)
}

/// Length of a path over joints, averaged over the frames that show all of it (m).
fn length(frames: &[Joints], path: &[Joint]) -> Option<Estimate> {
    let samples: Vec<f32> = frames
        .iter()
        .filter(|f| path.iter().all(|&j| believed(f, j)))
        .map(|f| path.windows(2).map(|w| f.at(w[0]).position.distance(f.at(w[1]).position)).sum())
        .collect();
    (samples.len() >= FEWEST).then(|| temporal_mean(&samples)).flatten()
}
