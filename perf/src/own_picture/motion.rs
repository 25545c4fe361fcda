//! What the people do: stand, walk across, cross their arms before the garment.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec3};
use toile_assets::scene::shopper;
use toile_base::frame::Joints;
use toile_base::skeleton::{Joint, Pose, Skeleton};
use toile_engine::body::JointFrames;

/// Time in which they stand still first, and in which they begin to move (s).
const STILL_S: f32 = 1.2;
const BEGIN_S: f32 = 0.7;

/// How fast they walk (m/s), how far to each side (m), how many steps a second.
const SPEED: f32 = 1.0;
const ASIDE: f32 = 0.5;
const STEPS_HZ: f32 = 0.9;

toile_base::named! {
    /// Motion of the shopper.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum OwnMotion {
        /// They stand, and breathe.
        Rest = "at rest",
        /// They walk to and fro across the picture at 1 m/s.
        Walk = "walking at 1 m/s",
        /// They cross their arms before the chest, and sway.
        Crossed = "arms crossed",
        /// They put their hands behind their back, and sway.
        Behind = "hands behind the back",
    }
}

impl OwnMotion {
    /// A word for it in names of files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Walk => "walk",
            Self::Crossed => "crossed",
            Self::Behind => "behind",
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
            Self::Crossed | Self::Behind => pose.root.x += 0.02 * share * (TAU * 0.4 * since).sin(),
        }
        let frames = JointFrames::new(skeleton, &pose);
        let mut joints = Joints::seen(time_ns, frames.position);
        match self {
            Self::Crossed => lead_arms(&mut joints, skeleton, share, &CROSSED),
            Self::Behind => lead_arms(&mut joints, skeleton, share, &BEHIND),
            Self::Rest | Self::Walk => {}
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

/// Ways of upper arm, forearm and hand of a left arm, left towards its own side, and of the right one.
type ArmWays = [[[f32; 3]; 3]; 2];

/// Upper arms hang, forearms lie across the chest, the right one before the left.
const CROSSED: ArmWays = [
    [[0.22, -0.9, 0.36], [-0.85, 0.05, 0.42], [-0.97, 0.05, -0.08]],
    [[0.22, -0.9, 0.36], [-0.85, 0.18, 0.62], [-0.97, 0.18, -0.08]],
];

/// Upper arms hang backwards, forearms lie behind the loins, one hand on the other.
const BEHIND: ArmWays = [
    [[0.2, -0.93, -0.3], [-0.72, -0.3, -0.6], [-0.95, -0.2, -0.1]],
    [[0.2, -0.93, -0.3], [-0.72, -0.2, -0.68], [-0.95, -0.2, -0.1]],
];

/// From hanging to these ways, by a share.
fn lead_arms(joints: &mut Joints, skeleton: &Skeleton, share: f32, arms: &ArmWays) {
    use Joint::*;
    let left = [LeftShoulder, LeftElbow, LeftWrist, LeftHand];
    let right = [RightShoulder, RightElbow, RightWrist, RightHand];
    for (([shoulder, elbow, wrist, hand], side), ways) in [(left, 1.0_f32), (right, -1.0)].into_iter().zip(arms) {
        let way = |at: usize| Vec3::from_array(ways[at]) * Vec3::new(side, 1.0, 1.0);
        let ways = [(shoulder, elbow, way(0)), (elbow, wrist, way(1)), (wrist, hand, way(2))];
        let hung =
            ways.map(|(from, to, _)| (joints.at(to).position - joints.at(from).position).normalize_or(Vec3::NEG_Y));
        let mut at = joints.at(shoulder).position;
        for ((_, joint, way), hung) in ways.into_iter().zip(hung) {
            // In directions, so that no limb changes its length.
            let turn = Quat::from_rotation_arc(hung, way.normalize());
            at += Quat::IDENTITY.slerp(turn, share) * hung * skeleton.offset(joint).length();
            joints.at_mut(joint).position = at;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::body::{Measures, Sex};

    #[test]
    fn walking_keeps_its_speed_and_limb_lengths() {
        let body = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
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
        // Behind the back: nearer to the middle than the hips, and farther back than the trunk is thick.
        let behind = OwnMotion::Behind.joints(skeleton, 4.0, 0);
        for hand in [Joint::LeftHand, Joint::RightHand] {
            let (hand, spine) = (behind.at(hand).position, behind.at(Joint::Spine).position);
            assert!((hand.x - spine.x).abs() < 0.15 && hand.z < spine.z - 0.1, "{hand} {spine}");
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
