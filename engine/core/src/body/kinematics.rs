//! Forward kinematics: a pose becomes joint frames, and joint frames become the bones that carry skin.
//!
//! In the rest pose every bone's frame is a translation, so the matrix that moves a rest point with its bone is
//! `x -> R (x - rest) + position`. The twist of a limb about its own axis is split (Gultepe 2013, section 4.4.3): the
//! bone at the limb's root keeps the swing alone, the twist bones along it turn with growing shares of the twist, and
//! the joint at the far end with all of it, so that no stretch of skin between two bones bears more than 18 degrees.

use glam::{Affine3A, Mat3A, Quat, Vec3, Vec3A};
use toile_base::numeric::portable;
use toile_base::skeleton::{BONES, JOINTS, Joint, Pose, Skeleton, TWISTS};

/// Where every joint stands and how it is turned, in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointFrames {
    /// Rotation from rest to world `[JOINTS]`.
    pub rotation: [Quat; JOINTS],
    /// World position (m) `[JOINTS]`.
    pub position: [Vec3; JOINTS],
}

impl JointFrames {
    /// Forward kinematics of one pose.
    pub fn new(skeleton: &Skeleton, pose: &Pose) -> Self {
        let mut frames = Self { rotation: pose.local, position: [pose.root; JOINTS] };
        for joint in Joint::ALL {
            let i = joint.index();
            if let Some(parent) = joint.parent().map(Joint::index) {
                let turn = frames.rotation[parent];
                frames.position[i] = frames.position[parent] + portable::turned(turn, skeleton.offset(joint));
                frames.rotation[i] = portable::unit(turn * pose.local[i]);
            }
        }
        frames
    }

    /// World position of one joint (m).
    pub fn at(&self, joint: Joint) -> Vec3 {
        self.position[joint.index()]
    }

    /// Rotation of one joint from rest to world.
    pub fn turn(&self, joint: Joint) -> Quat {
        self.rotation[joint.index()]
    }
}

/// Skin matrices of a pose, `palette[bone] * rest point = world point` (m): the joints', then the twist bones'.
pub fn palette(skeleton: &Skeleton, pose: &Pose, palette: &mut [Affine3A; BONES]) {
    let frames = JointFrames::new(skeleton, pose);
    for (i, bone) in palette.iter_mut().enumerate().take(JOINTS) {
        *bone = skin_matrix(frames.rotation[i], frames.position[i], skeleton.rest[i]);
    }
    for twist in &TWISTS {
        let (root, rest) = (frames.at(twist.from), skeleton.at(twist.from));
        let axis = (skeleton.at(twist.to) - rest).normalize_or_zero();
        let (_, turn) = swing_twist(pose.local[twist.carrier.index()], axis);
        // A ball joint's own rotation holds the twist; a wrist or an ankle turns what lies before it.
        let own = twist.carrier == twist.from;
        let start = if own { frames.turn(twist.from) * turn.inverse() } else { frames.turn(twist.from) };
        let angle = angle_about(turn, axis);
        palette[twist.from.index()] = skin_matrix(start, root, rest);
        for (k, bone) in twist.bones().enumerate() {
            let part = portable::from_scaled_axis(axis * (twist.share(k + 1) * angle));
            // All turn about the limb's axis, on which its root lies.
            palette[bone] = skin_matrix(start * part, root, rest);
        }
    }
}

fn skin_matrix(turn: Quat, position: Vec3, rest: Vec3) -> Affine3A {
    let matrix3 = Mat3A::from_quat(turn);
    Affine3A { matrix3, translation: Vec3A::from(position) - matrix3 * Vec3A::from(rest) }
}

/// Splits a rotation into `swing * twist`: the twist turns about `axis` (unit), the swing about a line across it.
/// Half a turn of pure swing leaves the twist undefined; it is then taken as none.
pub fn swing_twist(turn: Quat, axis: Vec3) -> (Quat, Quat) {
    let along = turn.xyz().dot(axis);
    let length = (along * along + turn.w * turn.w).sqrt();
    if length < 1e-6 {
        return (turn, Quat::IDENTITY);
    }
    let v = axis * (along / length);
    let twist = Quat::from_xyzw(v.x, v.y, v.z, turn.w / length);
    (turn * twist.inverse(), twist)
}

/// Angle (rad, -pi to pi) of a rotation about `axis`, of which the rotation is known to be a twist.
pub fn angle_about(twist: Quat, axis: Vec3) -> f32 {
    let along = twist.xyz().dot(axis);
    2.0 * if twist.w < 0.0 { portable::atan2(-along, -twist.w) } else { portable::atan2(along, twist.w) }
}
