//! Tests of the pose: what joints show, the skeleton does, whatever its proportions, and never by a jump.

mod habits;
mod recordings;

use glam::{EulerRot, Quat, Vec3};
use proptest::prelude::*;
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::skeleton::{BONES, JOINTS, Joint, Pose, Skeleton, TWISTS, Twist};

use super::kinematics::{JointFrames, palette, swing_twist};
use super::smooth::{LIMB_SPEED, rotation_vector};
use super::{Poser, ground, limits};

/// Rest pose with the arms 45 degrees down, of a person `scale` times 1.7 m tall with legs `legs` times as long.
pub fn skeleton(scale: f32, legs: f32) -> Skeleton {
    let hip = 0.9 * legs;
    let half = [
        (Joint::LeftClavicle, [0.02, 0.42, 0.02]),
        (Joint::LeftShoulder, [0.17, 0.44, -0.01]),
        (Joint::LeftElbow, [0.36, 0.24, -0.02]),
        (Joint::LeftWrist, [0.54, 0.06, 0.01]),
        (Joint::LeftHand, [0.60, 0.0, 0.03]),
    ];
    let middle = [
        (Joint::Pelvis, [0.0, 0.04, 0.0]),
        (Joint::Spine, [0.0, 0.14, 0.0]),
        (Joint::Chest, [0.0, 0.28, -0.01]),
        (Joint::Neck, [0.0, 0.50, -0.02]),
        (Joint::Head, [0.0, 0.58, 0.01]),
    ];
    let mut rest = [Vec3::ZERO; JOINTS];
    let mut put = |joint: Joint, p: Vec3| {
        rest[joint.index()] = p * scale;
        rest[joint.mirror().index()] = p.with_x(if joint.mirror() == joint { 0.0 } else { -p.x }) * scale;
    };
    for (joint, p) in half.into_iter().chain(middle) {
        put(joint, Vec3::from_array(p) + Vec3::Y * hip);
    }
    put(Joint::LeftHip, Vec3::new(0.09, hip, 0.0));
    put(Joint::LeftKnee, Vec3::new(0.10, hip * 0.54, 0.01));
    put(Joint::LeftAnkle, Vec3::new(0.11, 0.08, -0.02));
    put(Joint::LeftToe, Vec3::new(0.14, 0.02, 0.12));
    Skeleton { rest }
}

/// What a perfect sensor shows of a pose.
pub fn seen(skeleton: &Skeleton, pose: &Pose) -> Joints {
    let frames = JointFrames::new(skeleton, pose);
    Joints::seen(0, frames.position)
}

/// A pose standing with its lowest point on the floor, lifted by `rise`.
pub fn standing(skeleton: &Skeleton, rise: f32, turns: &[(Joint, [f32; 3])]) -> Pose {
    let mut pose = Pose::rest(skeleton);
    for (joint, [x, y, z]) in turns {
        pose.local[joint.index()] = Quat::from_euler(EulerRot::YXZ, y.to_radians(), x.to_radians(), z.to_radians());
    }
    pose.root = Vec3::new(0.3, 0.0, 2.0);
    pose.root.y = rise - ground::lowest(skeleton, &JointFrames::new(skeleton, &pose));
    pose
}

/// Test poses: name, rise, rotations in degrees (flexion about x, turn about y, side about z).
fn poses(skeleton: &Skeleton) -> Vec<(&'static str, Pose)> {
    use Joint::*;
    let both = |joint: Joint, r: [f32; 3]| [(joint, r), (joint.mirror(), [r[0], -r[1], -r[2]])];
    let pose = |turns: &[&[(Joint, [f32; 3])]]| standing(skeleton, 0.0, &turns.concat());
    vec![
        ("rest", pose(&[])),
        ("arms up", pose(&[&both(LeftShoulder, [0.0, 0.0, 125.0]), &both(LeftClavicle, [0.0, 0.0, 15.0])])),
        ("arms down", pose(&[&both(LeftShoulder, [0.0, 0.0, -38.0])])),
        ("arms forward, bent", pose(&[&both(LeftShoulder, [0.0, -70.0, 20.0]), &both(LeftElbow, [0.0, -50.0, 20.0])])),
        (
            "deep squat",
            pose(&[
                &both(LeftHip, [-100.0, 20.0, 0.0]),
                &both(LeftKnee, [120.0, 0.0, 0.0]),
                &both(LeftAnkle, [-20.0, 0.0, 0.0]),
                &[(Spine, [15.0, 0.0, 0.0]), (Chest, [15.0, 0.0, 0.0])],
            ]),
        ),
        (
            "step",
            pose(&[
                &[(LeftHip, [-35.0, 0.0, 0.0]), (LeftKnee, [30.0, 0.0, 0.0]), (LeftAnkle, [5.0, 0.0, 0.0])],
                &[(RightHip, [10.0, 0.0, 0.0]), (RightKnee, [10.0, 0.0, 0.0]), (RightAnkle, [-20.0, 0.0, 0.0])],
            ]),
        ),
        ("turned left", pose(&[&[(Pelvis, [0.0, 90.0, 0.0])]])),
        (
            "turned about, bowing",
            pose(&[&[
                (Pelvis, [10.0, 180.0, 0.0]),
                (LeftHip, [-10.0, 0.0, 0.0]),
                (RightHip, [-10.0, 0.0, 0.0]),
                (Spine, [20.0, 0.0, 0.0]),
                (Chest, [20.0, 0.0, 0.0]),
            ]]),
        ),
        ("twisted", pose(&[&[(Spine, [0.0, 18.0, 8.0]), (Chest, [0.0, 18.0, 8.0]), (Neck, [10.0, 0.0, 10.0])]])),
    ]
}

pub const LIMBS: [(Joint, Joint); 8] = [
    (Joint::LeftShoulder, Joint::LeftElbow),
    (Joint::LeftElbow, Joint::LeftWrist),
    (Joint::RightShoulder, Joint::RightElbow),
    (Joint::RightElbow, Joint::RightWrist),
    (Joint::LeftHip, Joint::LeftKnee),
    (Joint::LeftKnee, Joint::LeftAnkle),
    (Joint::RightHip, Joint::RightKnee),
    (Joint::RightKnee, Joint::RightAnkle),
];

/// Greatest angle (degrees) between what the limbs of a pose and the joints seen point at, and the limb.
fn worst_limb(skeleton: &Skeleton, pose: &Pose, seen: &Joints) -> (f32, (Joint, Joint)) {
    let frames = JointFrames::new(skeleton, pose);
    LIMBS
        .map(|(a, b)| {
            let ours = (frames.at(b) - frames.at(a)).normalize();
            let theirs = (seen.at(b).position - seen.at(a).position).normalize();
            (ours.cross(theirs).length().atan2(ours.dot(theirs)).to_degrees(), (a, b))
        })
        .into_iter()
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap()
}

/// Lowest sole point (m).
fn sole(skeleton: &Skeleton, pose: &Pose) -> f32 {
    let soles = ground::soles(skeleton, &JointFrames::new(skeleton, pose));
    soles.into_iter().flatten().map(|p| p.y).fold(f32::INFINITY, f32::min)
}

/// Shows `joints` for `seconds` at 120 Hz.
pub fn hold(poser: &mut Poser, joints: &Joints, seconds: f32) -> Pose {
    let mut pose = poser.pose(joints, 1.0 / 120.0);
    for _ in 0..(seconds * 120.0) as usize {
        pose = poser.pose(joints, 1.0 / 120.0);
    }
    pose
}

/// Largest turn of any joint between two poses (rad).
fn largest_turn(a: &Pose, b: &Pose) -> f32 {
    (0..JOINTS).map(|i| rotation_vector(b.local[i] * a.local[i].inverse()).length()).fold(0.0, f32::max)
}

#[test]
fn limbs_point_where_they_are_seen_to_point() {
    let ours = skeleton(1.0, 1.0);
    for (name, pose) in poses(&ours) {
        let joints = seen(&ours, &pose);
        let got = hold(&mut Poser::new(&ours), &joints, 0.5);
        let (angle, limb) = worst_limb(&ours, &got, &joints);
        assert!(angle < 1.0, "{name}: {limb:?} is {angle} degrees off");
        assert!(sole(&ours, &got).abs() < 0.005, "{name}: sole at {} m", sole(&ours, &got));
        let off = got.root.distance(pose.root);
        assert!(off < 0.03, "{name}: root off by {off} m");
    }
}

#[test]
fn other_proportions_point_the_same_way_and_stand_on_the_floor() {
    let ours = skeleton(1.08, 1.1);
    let theirs = skeleton(0.9, 0.95);
    for (name, pose) in poses(&theirs) {
        let joints = seen(&theirs, &pose);
        let got = hold(&mut Poser::new(&ours), &joints, 0.5);
        let (angle, limb) = worst_limb(&ours, &got, &joints);
        assert!(angle < 1.0, "{name}: {limb:?} is {angle} degrees off");
        assert!(sole(&ours, &got).abs() < 0.005, "{name}: sole at {} m", sole(&ours, &got));
    }
}

/// A path through poses, one second each, shown at 30 Hz and posed at 120 Hz; `see` may spoil what is seen. Calls
/// `check` with the poses of two following steps.
fn walk_through(
    skeleton: &Skeleton,
    path: &[Pose],
    mut see: impl FnMut(usize, &mut Joints),
    mut check: impl FnMut(&Pose, &Pose),
) {
    let mut poser = Poser::new(skeleton);
    let mut last = None;
    for frame in 0..(path.len() - 1) * 30 {
        let (a, b) = (&path[frame / 30], &path[frame / 30 + 1]);
        let t = (frame % 30) as f32 / 30.0;
        let mut pose = *a;
        pose.root = a.root.lerp(b.root, t);
        for i in 0..JOINTS {
            pose.local[i] = a.local[i].slerp(b.local[i], t);
        }
        let mut joints = seen(skeleton, &pose);
        see(frame, &mut joints);
        for _ in 0..4 {
            let now = poser.pose(&joints, 1.0 / 120.0);
            if let Some(last) = last.replace(now) {
                check(&last, &now);
            }
        }
    }
}

/// A small generator of our own, so that noise is the same everywhere: uniform in -1..1.
fn noise(state: &mut u64) -> f32 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 40) as f32 / (1 << 23) as f32 - 1.0
}

#[test]
fn nothing_jumps_while_the_person_turns_about_and_joints_flicker() {
    let ours = skeleton(1.0, 1.0);
    let turns = [0.0, 90.0, 180.0, -90.0, 0.0].map(|y| standing(&ours, 0.0, &[(Joint::Pelvis, [0.0, y, 0.0])]));
    let mut state = 7;
    let flicker = |frame: usize, joints: &mut Joints| {
        for (i, joint) in joints.joints.iter_mut().enumerate() {
            joint.position += Vec3::from_array(std::array::from_fn(|_| noise(&mut state))) * 0.02;
            if (frame * 7 + i * 3).is_multiple_of(11) {
                joint.confidence = 0.2;
            }
        }
    };
    let mut largest: f32 = 0.0;
    walk_through(&ours, &turns, flicker, |a, b| largest = largest.max(largest_turn(a, b)));
    assert!(largest <= LIMB_SPEED / 120.0 * 1.001, "{largest} rad in a step");
    assert!(largest > 0.01, "the person turned");
}

#[test]
fn nothing_flips_while_arms_swing_through_straight() {
    use Joint::*;
    let ours = skeleton(1.0, 1.0);
    let hinge = ours.offset(LeftElbow).cross(Vec3::Z).normalize();
    let swing = |bend: f32| {
        let mut pose = standing(&ours, 0.0, &[(LeftShoulder, [0.0, 0.0, -35.0])]);
        pose.local[LeftElbow.index()] = Quat::from_axis_angle(hinge, bend.to_radians());
        pose
    };
    let path = [swing(40.0), swing(0.0), swing(40.0), swing(0.0)];
    let mut state = 3;
    let shake = |_: usize, joints: &mut Joints| {
        for joint in &mut joints.joints {
            joint.position += Vec3::from_array(std::array::from_fn(|_| noise(&mut state))) * 0.003;
        }
    };
    let upper = LeftShoulder.index();
    let mut twisted: f32 = 0.0;
    walk_through(&ours, &path, shake, |_, b| {
        let axis = ours.offset(LeftElbow).normalize();
        let (_, twist) = swing_twist(b.local[upper], axis);
        twisted = twisted.max(super::kinematics::angle_about(twist, axis).abs());
    });
    assert!(twisted.to_degrees() < 20.0, "the upper arm twisted by {} degrees", twisted.to_degrees());
}

#[test]
fn joints_that_are_missing_keep_their_rotation() {
    let ours = skeleton(1.0, 1.0);
    let pose = standing(&ours, 0.0, &[(Joint::LeftShoulder, [0.0, 0.0, 60.0])]);
    let mut poser = Poser::new(&ours);
    let mut joints = seen(&ours, &pose);
    let before = hold(&mut poser, &joints, 0.5);
    for joint in [Joint::LeftElbow, Joint::LeftWrist, Joint::LeftHand, Joint::RightKnee, Joint::RightToe] {
        joints.joints[joint.index()] = TrackedJoint { position: Vec3::NAN, confidence: 0.0 };
    }
    let after = hold(&mut poser, &joints, 0.5);
    assert!(largest_turn(&before, &after) < 0.05, "{} rad", largest_turn(&before, &after));
    assert!(before.root.distance(after.root) < 0.01);
}

#[test]
fn limbs_are_followed_without_collar_bones_neck_and_hands() {
    use Joint::*;
    let ours = skeleton(1.0, 1.0);
    for (name, pose) in poses(&ours) {
        let mut joints = seen(&ours, &pose);
        for joint in [LeftClavicle, RightClavicle, Chest, Neck, LeftHand, RightHand, LeftToe, RightToe] {
            joints.joints[joint.index()].confidence = 0.0;
        }
        let got = hold(&mut Poser::new(&ours), &joints, 0.5);
        let (angle, limb) = worst_limb(&ours, &got, &joints);
        assert!(angle < 1.0, "{name}: {limb:?} is {angle} degrees off");
    }
}

#[test]
fn a_jump_leaves_the_floor_and_lands_on_it() {
    let ours = skeleton(1.0, 1.0);
    let ground = standing(&ours, 0.0, &[]);
    let up = standing(&ours, 0.35, &[(Joint::LeftAnkle, [30.0, 0.0, 0.0]), (Joint::RightAnkle, [30.0, 0.0, 0.0])]);
    let mut poser = Poser::new(&ours);
    hold(&mut poser, &seen(&ours, &ground), 2.0);
    let high = hold(&mut poser, &seen(&ours, &up), 0.4);
    assert!((sole(&ours, &high) - 0.35).abs() < 0.03, "{} m up", sole(&ours, &high));
    let down = hold(&mut poser, &seen(&ours, &ground), 0.6);
    assert!(sole(&ours, &down).abs() < 0.005, "{} m after landing", sole(&ours, &down));
}

#[test]
fn smoothing_does_not_depend_on_the_frame_rate() {
    let ours = skeleton(1.0, 1.0);
    let rest = seen(&ours, &standing(&ours, 0.0, &[]));
    let raised = seen(&ours, &standing(&ours, 0.0, &[(Joint::LeftShoulder, [0.0, 0.0, 40.0])]));
    let after = |hz: usize| {
        let mut poser = Poser::new(&ours);
        poser.pose(&rest, 0.0);
        (0..hz / 10).map(|_| poser.pose(&raised, 1.0 / hz as f32)).last().unwrap()
    };
    let apart = largest_turn(&after(60), &after(240));
    assert!(apart < 0.01, "60 and 240 Hz are {apart} rad apart after 0.1 s");
}

#[test]
fn the_same_joints_give_the_same_bits_and_a_reset_forgets() {
    let ours = skeleton(1.0, 1.0);
    let shown: Vec<Joints> = poses(&ours).iter().map(|(_, p)| seen(&ours, p)).collect();
    let run = |poser: &mut Poser| shown.iter().map(|j| hold(poser, j, 0.1)).last().unwrap();
    let (mut a, mut b) = (Poser::new(&ours), Poser::new(&ours));
    let first = run(&mut a);
    assert_eq!(first, run(&mut b));
    a.reset();
    assert_eq!(first, run(&mut a));
}

#[test]
fn mirrored_joints_give_the_mirrored_pose() {
    use Joint::*;
    let ours = skeleton(1.0, 1.0);
    let pose = standing(
        &ours,
        0.0,
        &[
            (LeftShoulder, [20.0, -40.0, 30.0]),
            (LeftElbow, [0.0, -60.0, 0.0]),
            (RightHip, [-60.0, 0.0, 10.0]),
            (RightKnee, [70.0, 0.0, 0.0]),
        ],
    );
    let joints = seen(&ours, &pose);
    let flip = |v: Vec3| v * Vec3::new(-1.0, 1.0, 1.0);
    let mut mirrored = joints;
    for joint in Joint::ALL {
        let mut other = joints.joints[joint.mirror().index()];
        other.position = flip(other.position);
        mirrored.joints[joint.index()] = other;
    }
    let a = JointFrames::new(&ours, &hold(&mut Poser::new(&ours), &joints, 0.3));
    let b = JointFrames::new(&ours, &hold(&mut Poser::new(&ours), &mirrored, 0.3));
    for joint in Joint::ALL {
        let off = flip(a.at(joint)).distance(b.at(joint.mirror()));
        assert!(off < 1e-4, "{joint:?} off by {off} m");
    }
}

#[test]
fn rest_palette_is_the_identity_and_bones_carry_their_joints() {
    let ours = skeleton(1.0, 1.0);
    let mut bones = [glam::Affine3A::IDENTITY; BONES];
    palette(&ours, &Pose::rest(&ours), &mut bones);
    for (bone, origin) in bones.iter().zip(ours.bone_origins()) {
        assert!(bone.transform_point3(origin).distance(origin) < 1e-6);
    }
    for (name, pose) in poses(&ours) {
        let frames = JointFrames::new(&ours, &pose);
        palette(&ours, &pose, &mut bones);
        for joint in Joint::ALL {
            let off = bones[joint.index()].transform_point3(ours.at(joint)).distance(frames.at(joint));
            assert!(off < 1e-5, "{name}: {joint:?} off by {off} m");
        }
    }
}

#[test]
fn twist_is_shared_along_a_limb_root_bone_none_far_joint_all() {
    let ours = skeleton(1.0, 1.0);
    for twist in &TWISTS {
        let axis = (ours.at(twist.to) - ours.at(twist.from)).normalize();
        let mut pose = Pose::rest(&ours);
        pose.local[twist.carrier.index()] = Quat::from_axis_angle(axis, 80_f32.to_radians());
        let mut matrices = [glam::Affine3A::IDENTITY; BONES];
        palette(&ours, &pose, &mut matrices);
        let across = axis.any_orthonormal_vector();
        let chain = std::iter::once(twist.from.index()).chain(twist.bones()).chain([twist.to.index()]);
        for (k, bone) in chain.enumerate() {
            let turned = matrices[bone].transform_vector3(across);
            let angle = axis.dot(across.cross(turned)).atan2(across.dot(turned)).to_degrees();
            assert!((angle - 80.0 * twist.share(k)).abs() < 0.01, "bone {bone} turned by {angle}");
            let end = matrices[bone].transform_point3(ours.at(twist.to));
            assert!(end.distance(ours.at(twist.to)) < 1e-6, "bone {bone} leaves the axis");
        }
    }
}

#[test]
fn no_stretch_of_a_limb_twists_by_more_than_keeps_its_volume() {
    use Joint::*;
    // What a limb can twist by: the ranges of its joints, and the forearm's as clinics measure it, with 30 to spare.
    let ranges = [
        (LeftElbow, limits::SHOULDER_TWIST.min),
        (LeftWrist, 90.0 + 30.0),
        (LeftKnee, limits::HIP_TWIST.min),
        (LeftAnkle, limits::ANKLE.turn[1]),
    ];
    for (to, degrees) in ranges {
        let stretch = degrees.to_radians().abs() * Twist::towards(to).unwrap().share(1);
        let kept = 1.0 - (1.0 - stretch.cos()) / 3.0;
        assert!(kept >= 0.98, "{to:?} keeps {kept}");
    }
}

/// Any number that memory can hold, and often a plausible one.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![4 => -3.0_f32..3.0, 1 => any::<f32>(), 1 => Just(0.0)]
}

proptest! {
    #[test]
    fn any_joints_give_a_finite_pose_within_limits_that_moves_at_a_bounded_speed(
        numbers in proptest::collection::vec(coordinate(), 4 * JOINTS * 3),
        dt in prop_oneof![Just(1.0_f32 / 120.0), any::<f32>()],
    ) {
        let ours = skeleton(1.0, 1.0);
        let mut poser = Poser::new(&ours);
        let mut last: Option<Pose> = None;
        for frame in numbers.chunks(4 * JOINTS) {
            let mut joints = Joints::absent(0);
            for (joint, n) in joints.joints.iter_mut().zip(frame.chunks(4)) {
                *joint = TrackedJoint { position: Vec3::new(n[0], n[1], n[2]), confidence: n[3].abs() };
            }
            for step in [1.0 / 120.0, dt] {
                let pose = poser.pose(&joints, step);
                prop_assert!(pose.root.is_finite());
                prop_assert!(pose.local.iter().all(|q| q.is_finite() && (q.length() - 1.0).abs() < 1e-3));
                let knee = rotation_vector(pose.local[Joint::LeftKnee.index()]);
                prop_assert!(knee.x.to_degrees() > -30.0 && knee.length().to_degrees() < 165.0, "knee {knee}");
                if let Some(last) = last {
                    let turn = largest_turn(&last, &pose);
                    let limit = LIMB_SPEED * if step.is_finite() { step.clamp(0.0, 1.0) } else { 0.0 };
                    prop_assert!(turn <= limit + 1e-3, "turned {turn} rad in {step} s");
                }
                last = poser.started.then_some(pose);
            }
        }
    }
}
