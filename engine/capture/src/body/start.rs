//! The automatic start of a fit: from the visual hull or from joints, the way a person faces and how they hold their arms.

use glam::{DVec3, Quat, Vec3};
use toile_base::skeleton::{JOINTS, Joint};
use toile_track::fit::{ARMS, FitState, of_stature, set_arm};

use super::fit::{BodyFitter, COARSE, FINE};
use super::hull::HullShape;

/// Ways of facing that are tried: across the hull's spread, both ways, and along it, for a person who holds both arms ahead; and how
/// far off each is looked for besides (rad), because a hull of few views is spread along its corners.
const FACINGS: usize = 4;
const BESIDE: [f32; 3] = [-0.35, 0.0, 0.35];

/// Starts that are fitted to the end of the coarse stages.
const REFINED: usize = 4;

/// Steps from an upright body towards joints.
const JOINT_STEPS: usize = 25;

/// Confidence from which a joint says which way a person faces.
const BELIEVED: f32 = 0.2;

/// The best start of all that are tried: upright bodies of the hull's height, each way of facing; those that cover the silhouettes
/// best are fitted coarsely, with their arms looked for before, between the stages and after them, and the one that agrees best is taken.
pub(super) fn start(fitter: &mut BodyFitter, hull: &HullShape) -> FitState {
    let mut tried: Vec<(f64, FitState)> = Vec::new();
    for facing in facings(fitter, hull) {
        let state = upright(fitter, hull, facing);
        let state = if fitter.joints.is_empty() { state } else { fitter.towards_joints(&state, JOINT_STEPS) };
        tried.push((fitter.agreement(&state), state));
    }
    tried.sort_by(|a, b| b.0.total_cmp(&a.0));
    tried.truncate(REFINED);
    let mut best: Option<(f64, FitState)> = None;
    for (_, state) in tried {
        let mut state = with_arms(fitter, state);
        for (k, stage) in COARSE.into_iter().enumerate() {
            // The shape stays at first: a body would rather grow short arms than lower them.
            state = fitter.steps(&state, &[stage], k == 0);
            state = with_arms(fitter, state);
        }
        let agreement = fitter.agreement(&state);
        if best.is_none_or(|b| agreement > b.0) {
            best = Some((agreement, state));
        }
    }
    best.map_or_else(|| upright(fitter, hull, Vec3::Z), |b| b.1)
}

/// The ways a person may face: the one that their joints say, or four by the hull.
fn facings(fitter: &BodyFitter, hull: &HullShape) -> Vec<Vec3> {
    let place = |joint: Joint| fitter.joints.iter().find(|p| p.joint == joint && p.confidence > BELIEVED);
    for (left, right) in [(Joint::LeftHip, Joint::RightHip), (Joint::LeftShoulder, Joint::RightShoulder)] {
        if let (Some(left), Some(right)) = (place(left), place(right)) {
            let facing = (left.place - right.place).cross(DVec3::Y).as_vec3();
            return vec![facing.normalize_or(Vec3::Z)];
        }
    }
    let ahead = hull.across.cross(DVec3::Y).as_vec3();
    let quarter = |k: usize| k as f32 * std::f32::consts::FRAC_PI_2;
    let turns = (0..FACINGS).flat_map(|k| BESIDE.map(|by| quarter(k) + by));
    turns.map(|turn| Quat::from_rotation_y(turn) * ahead).collect()
}

/// An upright body of the hull's height, at its middle.
fn upright(fitter: &BodyFitter, hull: &HullShape, facing: Vec3) -> FitState {
    let shapes = fitter.model.shapes;
    let shape = of_stature(shapes, (hull.heights[1] - hull.heights[0]) as f32);
    let pelvis = shapes.skeleton(&shape).at(Joint::Pelvis);
    let root = hull.middle.as_vec3().with_y(hull.heights[0] as f32 + pelvis.y);
    let mut state = FitState { root, local: [Quat::IDENTITY; JOINTS], shape };
    state.local[0] = Quat::from_rotation_y(facing.x.atan2(facing.z));
    for shoulder in [Joint::LeftShoulder, Joint::RightShoulder] {
        set_arm(&fitter.model, &mut state, shoulder, ARMS[0]);
    }
    state
}

/// Each arm in the pose that covers the silhouettes best, one after the other: as it is, or one of those that people hold them in.
pub(super) fn with_arms(fitter: &mut BodyFitter, state: FitState) -> FitState {
    if !fitter.joints.is_empty() {
        return state;
    }
    let mut best = (fitter.agreement(&state), state);
    for shoulder in [Joint::LeftShoulder, Joint::RightShoulder] {
        let from = best.1;
        for arm in ARMS {
            let mut tried = from;
            set_arm(&fitter.model, &mut tried, shoulder, arm);
            let agreement = fitter.agreement(&tried);
            if agreement > best.0 {
                best = (agreement, tried);
            }
        }
    }
    best.1
}

/// The fit of a body that faces another way by so much (rad), upright and of the same shape, arms looked for as at the start.
pub(super) fn turned(fitter: &mut BodyFitter, state: &FitState, by: f32) -> FitState {
    let ahead = state.local[0] * Vec3::Z;
    let mut other = *state;
    other.local = [Quat::IDENTITY; JOINTS];
    other.local[0] = Quat::from_rotation_y(ahead.x.atan2(ahead.z) + by);
    let mut other = with_arms(fitter, other);
    for (k, stage) in COARSE.into_iter().enumerate() {
        other = fitter.steps(&other, &[stage], k == 0);
        other = with_arms(fitter, other);
    }
    fitter.steps(&other, &FINE, false)
}

/// Turns of an upper arm about itself (rad) and bends of its elbow, as shares of what it can, with which a forearm is looked for.
const TWISTS: [f32; 8] = [0.0, 0.8, 1.6, 2.4, 3.2, -0.8, -1.6, -2.4];
const BENDS: [f32; 4] = [0.04, 0.2, 0.45, 0.7];

/// By how much less (share of what is covered) a forearm may agree that is worth a fit of its own: before it, upper arm and shape are
/// still those of the other place.
const WORTH_A_FIT: f64 = 0.01;

/// From where a forearm lies elsewhere: cosine of half a radian.
const ELSEWHERE: f32 = 0.88;

/// Shoulder, elbow and wrist of both sides.
pub(super) const ARM_JOINTS: [[Joint; 3]; 2] = [
    [Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftWrist],
    [Joint::RightShoulder, Joint::RightElbow, Joint::RightWrist],
];

/// The place of one side's forearm, elsewhere about its upper arm as that is, that covers the silhouettes best, if that may be better
/// than where it is: a fit that has found the upper arm alone has the rest folded before or behind the trunk, or onto the upper
/// arm, where no outline calls it back.
pub(super) fn other_forearm(fitter: &mut BodyFitter, state: &FitState, arm: [Joint; 3]) -> Option<FitState> {
    let [shoulder, elbow, wrist] = arm;
    let rest = fitter.model.shapes.skeleton(&state.shape);
    let along = (rest.at(elbow) - rest.at(shoulder)).normalize_or(Vec3::NEG_Y);
    let (axis, [least, most]) =
        fitter.model.joint_angles.iter().find(|t| t.joint == elbow).map(|t| (t.axis, t.range))?;
    let forearm = (rest.at(wrist) - rest.at(elbow)).normalize_or(along);
    let points = |s: &FitState| s.local[shoulder.index()] * (s.local[elbow.index()] * forearm);
    let mut best = (fitter.agreement(state) - WORTH_A_FIT, None);
    for twist in TWISTS {
        for bend in BENDS {
            let mut tried = *state;
            let turned = state.local[shoulder.index()] * Quat::from_axis_angle(along, twist);
            tried.local[shoulder.index()] = turned.normalize();
            tried.local[elbow.index()] = Quat::from_axis_angle(axis, least + (most - least) * bend);
            tried.local[wrist.index()] = Quat::IDENTITY;
            if points(&tried).dot(points(state)) < ELSEWHERE {
                let agreement = fitter.agreement(&tried);
                if agreement > best.0 {
                    best = (agreement, Some(tried));
                }
            }
        }
    }
    best.1
}
