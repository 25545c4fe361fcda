//! Tests of systematic errors of a sensor: they are learned, and the person's own motion is kept.

use glam::{Quat, Vec3};
use toile_base::frame::Joints;
use toile_base::skeleton::{Joint, Pose};

use super::{hold, seen, skeleton, standing};
use crate::body::kinematics::JointFrames;
use crate::body::smooth::rotation_vector;
use crate::body::{Poser, ground};

/// Turns the toes of what is seen about their ankles, the left one by `outwards` degrees and the right one mirrored.
fn turn_toes(joints: &mut Joints, outwards: f32) {
    for (ankle, toe, sign) in [(Joint::LeftAnkle, Joint::LeftToe, 1.0), (Joint::RightAnkle, Joint::RightToe, -1.0)] {
        let at = joints.at(ankle).position;
        let foot = &mut joints.joints[toe.index()].position;
        *foot = at + Quat::from_rotation_y((sign * outwards).to_radians()) * (*foot - at);
    }
}

#[test]
fn feet_that_a_sensor_turns_in_stand_straight_and_one_turned_foot_stays_turned() {
    let ours = skeleton(1.0, 1.0);
    let shown = seen(&ours, &standing(&ours, 0.0, &[]));
    let mut pigeon = shown;
    turn_toes(&mut pigeon, -20.0);
    let mut poser = Poser::new(&ours);
    let heading = |pose: &Pose, side: usize| {
        let sole = ground::soles(&ours, &JointFrames::new(&ours, pose))[side];
        let rest = ground::soles(&ours, &JointFrames::new(&ours, &Pose::rest(&ours)))[side];
        (sole[1] - sole[0]).angle_between(rest[1] - rest[0]).to_degrees()
    };
    let straight = hold(&mut poser, &pigeon, 1.0);
    assert!(heading(&straight, 0) < 1.0 && heading(&straight, 1) < 1.0, "{} degrees", heading(&straight, 0));
    let toe = Joint::LeftToe.index();
    let mut one = pigeon;
    turn_toes(&mut one, 30.0);
    one.joints[Joint::RightToe.index()] = pigeon.joints[Joint::RightToe.index()];
    assert!(one.joints[toe] != pigeon.joints[toe]);
    let turned = hold(&mut poser, &one, 1.5);
    assert!(heading(&turned, 0) > 20.0, "the left foot is turned by {} degrees", heading(&turned, 0));
    assert!(heading(&turned, 1) < 8.0, "the right foot is turned by {} degrees", heading(&turned, 1));
}

#[test]
fn a_sensors_habit_to_bow_is_learned_and_a_nod_is_not() {
    let ours = skeleton(1.0, 1.0);
    let bowed = |degrees: f32| {
        let mut joints = seen(&ours, &standing(&ours, 0.0, &[]));
        let neck = joints.at(Joint::Neck).position;
        let head = &mut joints.joints[Joint::Head.index()].position;
        *head = neck + Quat::from_rotation_x(degrees.to_radians()) * (*head - neck);
        joints
    };
    let mut poser = Poser::new(&ours);
    let pitch = |pose: &Pose| rotation_vector(pose.local[Joint::Neck.index()]).x.to_degrees();
    let at_ease = hold(&mut poser, &bowed(-25.0), 2.0);
    assert!(pitch(&at_ease).abs() < 1.0, "the neck leans by {} degrees", pitch(&at_ease));
    let nod = hold(&mut poser, &bowed(0.0), 0.3);
    assert!((pitch(&nod) - 25.0).abs() < 4.0, "the nod is {} degrees", pitch(&nod));
}

#[test]
fn standing_feet_stay_while_the_hips_wobble() {
    let ours = skeleton(1.0, 1.0);
    let still = seen(&ours, &standing(&ours, 0.0, &[]));
    let mut poser = Poser::new(&ours);
    let mut last: Option<[Vec3; 2]> = None;
    let mut path = 0.0;
    for tick in 0..240 {
        let mut joints = still;
        let wobble = Vec3::new(0.03 * (tick as f32 * 0.1).sin(), 0.0, 0.02 * (tick as f32 * 0.13).cos());
        for joint in [Joint::Pelvis, Joint::LeftHip, Joint::RightHip] {
            joints.joints[joint.index()].position += wobble;
        }
        let frames = JointFrames::new(&ours, &poser.pose(&joints, 1.0 / 120.0));
        let feet = ground::soles(&ours, &frames).map(|sole| sole[1]);
        if let Some(last) = last.replace(feet) {
            path += (feet[0] - last[0]).with_y(0.0).length();
        }
    }
    assert!(path < 0.05, "a standing foot slid {path} m while the hips swung over 40 cm in 2 s");
}

#[test]
fn arms_stay_beside_a_body_that_is_wider_than_the_one_seen() {
    use crate::cone::{RestSphere, RoundCone};
    let ours = skeleton(1.0, 1.0);
    let hip = |x: f32| RestSphere { bone: 0, centre: Vec3::new(x, 0.88, 0.0), radius: 0.2 };
    let waist = |x: f32| RestSphere { bone: 1, centre: Vec3::new(x, 1.2, 0.0), radius: 0.12 };
    let spheres = [hip(0.08), hip(-0.08), waist(0.06), waist(-0.06)];
    let capsules = [[0, 1], [2, 3], [0, 2], [1, 3]];
    let hanging = seen(&ours, &standing(&ours, 0.0, &[(Joint::LeftShoulder, [0.0, 0.0, -44.0])]));
    let free = hold(&mut Poser::new(&ours), &hanging, 1.0);
    let clear = hold(&mut Poser::new(&ours).keeping_clear(&spheres, &capsules), &hanging, 1.0);
    let depth = |pose: &Pose| {
        let frames = JointFrames::new(&ours, pose);
        let at = |s: &RestSphere| {
            let i = usize::from(s.bone);
            frames.position[i] + frames.rotation[i] * (s.centre - ours.rest[i])
        };
        let cone = |[a, b]: [usize; 2]| RoundCone::new(at(&spheres[a]), 0.2, at(&spheres[b]), 0.2);
        cone([0, 1]).distance(frames.at(Joint::LeftWrist)).0
    };
    assert!(depth(&free) < 0.0, "the hand must be inside the hip to begin with: {}", depth(&free));
    assert!(depth(&clear) > 0.03, "the wrist is {} m from the hip", depth(&clear));
    let right = Joint::RightShoulder.index();
    assert_eq!(free.local[right], clear.local[right], "the other arm is beside the body anyway");
}
