//! What the people do: stand, walk across, cross their arms before the garment.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec3};
use toile_assets::scene::shopper;
use toile_assets::skeleton::{Joint, Pose, Skeleton};
use toile_engine::body::JointFrames;
use toile_sensors::frame::Joints;

/// Time in which they stand still first, and in which they begin to move (s).
const STILL_S: f32 = 1.2;
const BEGIN_S: f32 = 0.7;

/// How fast they walk (m/s), how far to each side (m), how many steps a second.
const SPEED: f32 = 1.0;
const ASIDE: f32 = 0.5;
const STEPS_HZ: f32 = 0.9;

toile_assets::named! {
    /// What somebody does.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum OwnMotion {
        /// They stand, and breathe.
        Rest = "at rest",
        /// They walk to and fro across the picture at 1 m/s.
        Walk = "walking at 1 m/s",
        /// They cross their arms before the chest, and sway.
        Crossed = "arms crossed",
    }
}

impl OwnMotion {
    /// A word for it in names of files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Walk => "walk",
            Self::Crossed => "crossed",
        }
    }

    /// Where the joints are at a time (s).
    pub fn joints(self, skeleton: &Skeleton, seconds: f32, time_ns: u64) -> Joints {
        let since = (seconds - STILL_S).max(0.0);
        let share = (since / BEGIN_S).min(1.0);
        let share = share * share * (3.0 - 2.0 * share);
        // The shopper stands still until 1.6 s, and breathes.
        let mut pose = shopper(skeleton, seconds.min(1.5));
        pose.local[Joint::Chest.index()] = Quat::from_rotation_x(0.01 * (TAU * 0.3 * seconds).sin());
        match self {
            Self::Rest => {}
            Self::Walk => walk(&mut pose, skeleton, share, since),
            Self::Crossed => pose.root.x += 0.02 * share * (TAU * 0.4 * since).sin(),
        }
        let frames = JointFrames::new(skeleton, &pose);
        let mut joints = Joints::seen(time_ns, frames.position);
        if self == Self::Crossed {
            cross(&mut joints, skeleton, share);
        }
        joints
    }
}

/// To and fro: a triangle of time whose corners are round.
fn walk(pose: &mut Pose, skeleton: &Skeleton, share: f32, since: f32) {
    let phase = TAU * STEPS_HZ * since;
    for (side, hip, knee, shoulder) in [
        (0.0, Joint::LeftHip, Joint::LeftKnee, Joint::LeftShoulder),
        (PI, Joint::RightHip, Joint::RightKnee, Joint::RightShoulder),
    ] {
        let rise = share * (phase + side).sin().max(0.0);
        let turn = |pose: &mut Pose, joint: Joint, angle: f32| {
            pose.local[joint.index()] = Quat::from_rotation_x(angle) * pose.local[joint.index()];
        };
        turn(pose, hip, -0.4 * rise);
        turn(pose, knee, 0.7 * rise);
        turn(pose, shoulder, 0.35 * share * (phase + side).sin());
    }
    // asin(sin) is a triangle; a little less of the sine rounds its corners.
    let round = (TAU * SPEED * since / (4.0 * ASIDE)).sin() * 0.985;
    let start = (since / BEGIN_S).min(1.0);
    pose.root.x += start * ASIDE * round.asin() / (0.5 * PI);
    let own = JointFrames::new(skeleton, pose);
    let low = |joint: Joint| own.at(joint).y - skeleton.at(joint).y;
    pose.root.y -= low(Joint::LeftAnkle).min(low(Joint::RightAnkle));
}

/// Upper arms hang, forearms lie across the chest, the right one before the left.
fn cross(joints: &mut Joints, skeleton: &Skeleton, share: f32) {
    use Joint::*;
    let arms = [
        ([LeftShoulder, LeftElbow, LeftWrist, LeftHand], 1.0_f32, [0.05, 0.42]),
        ([RightShoulder, RightElbow, RightWrist, RightHand], -1.0, [0.18, 0.62]),
    ];
    for ([shoulder, elbow, wrist, hand], side, [rise, ahead]) in arms {
        let ways = [
            (shoulder, elbow, Vec3::new(0.22 * side, -0.9, 0.36)),
            (elbow, wrist, Vec3::new(-0.85 * side, rise, ahead)),
            (wrist, hand, Vec3::new(-0.97 * side, rise, -0.08)),
        ];
        let hung =
            ways.map(|(from, to, _)| (joints.at(to).position - joints.at(from).position).normalize_or(Vec3::NEG_Y));
        let mut at = joints.at(shoulder).position;
        for ((_, joint, way), hung) in ways.into_iter().zip(hung) {
            // From hanging to crossed in directions, so that no limb changes its length.
            let turn = Quat::from_rotation_arc(hung, way.normalize());
            at += Quat::IDENTITY.slerp(turn, share) * hung * skeleton.offset(joint).length();
            joints.at_mut(joint).position = at;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_assets::body::{Body, Measures, Sex};

    #[test]
    fn whoever_walks_walks_at_a_metre_a_second_and_no_limb_changes_its_length() {
        let body = Body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
        let skeleton = &body.skeleton;
        for motion in OwnMotion::ALL {
            let (mut fastest, mut before) = (0.0_f32, motion.joints(skeleton, 2.0, 0));
            for step in 1..240 {
                let now = motion.joints(skeleton, 2.0 + step as f32 / 120.0, 0);
                let speed = |joint: Joint| now.at(joint).position.distance(before.at(joint).position) * 120.0;
                fastest = fastest.max(speed(Joint::Pelvis));
                for (a, b) in [(Joint::LeftElbow, Joint::LeftWrist), (Joint::RightHip, Joint::RightKnee)] {
                    let length = now.at(a).position.distance(now.at(b).position);
                    assert!((length - skeleton.offset(b).length()).abs() < 1e-3, "{motion:?}");
                }
                before = now;
            }
            assert_eq!((0.9..1.2).contains(&fastest), motion == OwnMotion::Walk, "{motion:?}: {fastest}");
        }
        // Crossed: each hand on the other side, before the chest.
        let crossed = OwnMotion::Crossed.joints(skeleton, 4.0, 0);
        let [left, right, chest] = [Joint::LeftHand, Joint::RightHand, Joint::Chest].map(|j| crossed.at(j).position);
        assert!(
            left.x < chest.x && right.x > chest.x && left.z > chest.z + 0.1 && right.z > left.z,
            "{left} {right} {chest}"
        );
    }
}
