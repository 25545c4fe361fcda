//! The initial pose of the fit: a person standing about facing the camera, each arm in one of a few candidate poses.

use glam::{Quat, Vec3};
use toile_assets::body::shape::Shapes;
use toile_assets::body::{En, Wanted};
use toile_base::numeric::statistics::quantile_of;
use toile_base::skeleton::{JOINTS, Joint};

use super::depth_cells::DepthCells;
use super::joint_angles::hanging;
use super::posed_body::{BodyModel, FitState};

/// Half the depth of a pelvis (m).
const HALF_PELVIS: f32 = 0.10;

/// Half of what a head and its hair are wide (m).
const HEAD_REACH: f32 = 0.16;

/// Statures accepted from the image's height (m).
const STATURES: std::ops::Range<f32> = 1.35..2.15;

/// Heights between which the pelvis is sought, as fractions of stature.
const HIPS: [f32; 2] = [0.44, 0.60];

/// A candidate pose of an arm (rad): angle from the vertical, bend of the elbow, rotation of the whole arm about the
/// vertical (inwards positive) and about itself (forearm upwards positive).
#[derive(Debug, Clone, Copy)]
pub struct ArmPose {
    out: f32,
    bend: f32,
    inwards: f32,
    twist: f32,
}

const fn arm(out: f32, bend: f32, inwards: f32, twist: f32) -> ArmPose {
    ArmPose { out, bend, inwards, twist }
}

/// Hanging a little out, well out, a hand on the hip, a hand before the chest, stretched aside, a forearm ahead, a
/// forearm hanging from a raised elbow, one upright above it, a hand beside the shoulder, an arm raised, one that points ahead.
pub const ARMS: [ArmPose; 11] = [
    arm(0.25, 0.1, 0.0, 0.0),
    arm(0.7, 0.1, 0.0, 0.0),
    arm(0.6, 1.6, 1.2, 0.0),
    arm(0.2, 1.9, 0.5, 0.0),
    arm(1.5, 0.1, 0.0, 0.0),
    arm(0.3, 1.4, -0.1, 0.0),
    arm(1.4, 1.4, 0.0, -1.4),
    arm(1.4, 1.5, 0.0, 1.4),
    arm(0.5, 2.0, -0.7, 0.0),
    arm(2.3, 0.3, 0.0, 0.0),
    arm(1.5, 0.1, 1.4, 0.0),
];

/// Sets an arm of a state to a candidate pose.
pub fn set_arm(model: &BodyModel, state: &mut FitState, shoulder: Joint, arm: ArmPose) {
    let rest = model.shapes.skeleton(&state.shape);
    let left = shoulder == Joint::LeftShoulder;
    let elbow = if left { Joint::LeftElbow } else { Joint::RightElbow };
    let wrist = if left { Joint::LeftWrist } else { Joint::RightWrist };
    let side = if left { -1.0 } else { 1.0 };
    let along = (rest.at(elbow) - rest.at(shoulder)).normalize_or(Vec3::NEG_Y);
    let down = Quat::from_rotation_z(hanging(&rest, shoulder, arm.out));
    let twist = Quat::from_axis_angle(along, side * arm.twist);
    state.local[shoulder.index()] = Quat::from_rotation_y(side * arm.inwards) * down * twist;
    state.local[wrist.index()] = Quat::IDENTITY;
    if let Some(turn) = model.joint_angles.iter().find(|t| t.joint == elbow) {
        state.local[elbow.index()] = Quat::from_axis_angle(turn.axis, turn.range[0] + 10f32.to_radians() + arm.bend);
    }
}

/// A person of the image's height, upright at the middle of the cells, facing the camera.
pub(super) fn upright(model: &BodyModel, view: &DepthCells, ground: Option<f32>) -> FitState {
    let mut heights: Vec<f32> = view.cells.iter().map(|c| c.point.y).collect();
    heights.sort_unstable_by(f32::total_cmp);
    let bottom = ground.unwrap_or(heights[heights.len() / 200]);
    let middle = |from: f32, to: f32, axis: fn(&Vec3) -> f32| {
        let band = view.cells.iter().filter(|c| (from..to).contains(&c.point.y)).map(|c| axis(&c.point));
        quantile_of(band, 0.5)
    };
    let all = [heights[0], heights[heights.len() - 1] + 1.0];
    let whole =
        Vec3::new(middle(all[0], all[1], |p| p.x).unwrap_or(0.0), 0.0, middle(all[0], all[1], |p| p.z).unwrap_or(0.0));
    let near = |p: &Vec3| (p.x - whole.x).hypot(p.z - whole.z) < HEAD_REACH + HALF_PELVIS;
    let mut above: Vec<f32> = view.cells.iter().map(|c| c.point).filter(near).map(|p| p.y).collect();
    above.sort_unstable_by(f32::total_cmp);
    let top = above.len().checked_sub(3).map_or(heights[heights.len() - 1], |i| above[i]);
    let shape = of_stature(model.shapes, top - bottom);
    let stature = model.shapes.read(&shape).readings.of(En::Stature);
    let band = HIPS.map(|h| top - stature * (1.0 - h));
    let at = |axis: fn(&Vec3) -> f32, or: f32| middle(band[0], band[1], axis).unwrap_or(or);
    let surface = Vec3::new(at(|p| p.x, whole.x), 0.0, at(|p| p.z, whole.z));
    let towards = (view.camera_position() - surface).with_y(0.0).normalize_or(Vec3::Z);
    let pelvis = model.shapes.skeleton(&shape).at(Joint::Pelvis).y;
    let root = (surface - towards * HALF_PELVIS).with_y(top - stature + pelvis);
    let mut state = FitState { root, local: [Quat::IDENTITY; JOINTS], shape };
    state.local[0] = Quat::from_rotation_y(towards.x.atan2(towards.z));
    for shoulder in [Joint::LeftShoulder, Joint::RightShoulder] {
        set_arm(model, &mut state, shoulder, ARMS[0]);
    }
    state
}

/// The mean shape of people of that stature; the mean person where it is no plausible stature.
pub fn of_stature(shapes: &Shapes, height: f32) -> toile_assets::body::shape::BodyShape {
    let wanted = Wanted::<En>::new().with(En::Stature, height);
    if STATURES.contains(&height) { shapes.wanted(&wanted).unwrap_or(*shapes.mean()) } else { *shapes.mean() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::body::Sex;
    use toile_base::skeleton::Pose;

    /// Positions of the wrists relative to the shoulders in one arm pose, the right one's mirrored (m).
    fn hands(way: usize) -> [Vec3; 2] {
        let shapes = Shapes::of(Sex::Male);
        let model = BodyModel::new(shapes, 0.1);
        let mut state = FitState { root: Vec3::ZERO, local: [Quat::IDENTITY; JOINTS], shape: *shapes.mean() };
        let rest = shapes.skeleton(shapes.mean());
        let pairs = [(Joint::LeftShoulder, Joint::LeftWrist), (Joint::RightShoulder, Joint::RightWrist)];
        pairs.map(|(shoulder, wrist)| {
            set_arm(&model, &mut state, shoulder, ARMS[way]);
            let pose = Pose { root: Vec3::ZERO, local: state.local };
            let (mut turned, mut place) = (Quat::IDENTITY, Vec3::ZERO);
            let mut chain = vec![wrist];
            while *chain.last().unwrap() != shoulder {
                chain.push(chain.last().unwrap().parent().unwrap());
            }
            for pair in chain.windows(2).rev() {
                turned *= pose.local[pair[1].index()];
                place += turned * (rest.at(pair[0]) - rest.at(pair[1]));
            }
            if shoulder == Joint::LeftShoulder { place } else { place * Vec3::new(-1.0, 1.0, 1.0) }
        })
    }

    #[test]
    fn both_arms_are_held_alike_and_as_said() {
        for way in 0..ARMS.len() {
            let [left, right] = hands(way);
            assert!(left.distance(right) < 0.02, "{way}: {left} {right}");
        }
        assert!(hands(0)[0].y < -0.4, "hanging");
        assert!(hands(4)[0].x > 0.4, "stretched aside");
        assert!(hands(6)[0].y < -0.15 && hands(6)[0].x > 0.2, "a forearm hanging: {}", hands(6)[0]);
        assert!(hands(7)[0].y > 0.15 && hands(7)[0].x > 0.2, "a forearm upright: {}", hands(7)[0]);
        assert!(hands(9)[0].y > 0.25, "raised");
        assert!(hands(10)[0].z > 0.4 && hands(10)[0].y > -0.2, "pointing ahead: {}", hands(10)[0]);
    }
}
