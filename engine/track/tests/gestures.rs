//! Gestures of recorded people, and of a shopper whose hand goes a known way.

use glam::{Quat, Vec3};
use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, HandState, Joints, TrackedJoint};
use toile_base::skeleton::Joint::{self, *};
use toile_sensors::filter::JointFilter;
use toile_sensors::source::{OpenOptions, open};
use toile_track::gesture::{Gesture, GestureEvent, Gestures, HandRegion, HandSegmenter, Side};

use crate::recordings;

/// The events of a sequence.
fn events(frames: &[Joints]) -> Vec<GestureEvent> {
    let mut gestures = Gestures::new();
    frames.iter().flat_map(|f| gestures.push(f, None)).flatten().collect()
}

/// The events of a recording, filtered as in the mirror.
fn recorded(folder: &std::path::Path, file: &str) -> (usize, Vec<GestureEvent>) {
    let session = open(&folder.join(file), &OpenOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let mut filter = JointFilter::default();
    let frames: Vec<Joints> = session.joints.iter().map(|f| filter.push(f)).collect();
    (frames.len(), events(&frames))
}

/// Recordings without a gesture at the mirror: jumping, dabbing, walking like a zombie, jumping jacks, bends and
/// squats, arms raised to the sides; two wave, which is no gesture of ours, and one weighs with both hands.
const NO_GESTURE: [(&str, usize); 9] = [
    ("skeleton/labanotation-kinect2/joints.csv", 371),
    ("skeleton/labanotation-kinect2/Ges01_wavehand.csv", 154),
    ("skeleton/labanotation-kinect2/Ges02_balancinghands.csv", 161),
    ("skeleton/kinectron-kinect2/recorded_skeleton.json", 285),
    ("mocap/animated-drawings/jumping.bvh", 654),
    ("mocap/animated-drawings/wave_hello.bvh", 839),
    ("mocap/animated-drawings/dab.bvh", 339),
    ("mocap/animated-drawings/zombie.bvh", 779),
    ("mocap/cmu/14_14.bvh", 4653),
];

#[test]
fn recordings_without_gestures_give_no_event() {
    let Some(root) = recordings::folder() else { return };
    for (file, frames) in NO_GESTURE {
        let (seen, found) = recorded(&root, file);
        assert!(seen * 10 > frames * 9, "{file}: {seen} frames");
        assert_eq!(found, [], "{file}");
    }
}

/// A person draws lines into the air with the right hand: each long straight stroke counts as a swipe.
#[test]
fn lines_drawn_into_the_air_are_swipes() {
    let Some(root) = recordings::folder() else { return };
    let (_, found) = recorded(&root, "skeleton/labanotation-kinect2/Ges03_drawlines.csv");
    assert!((1..=4).contains(&found.len()), "{found:?}");
    assert!(found.iter().all(|e| e.gesture == Gesture::SwipeRight && e.side == Side::Right), "{found:?}");
}

/// Hands in real depth frames, marked by eye: file, palm and elbow (px), whether the hand is open.
const MARKED: [(&str, [f32; 2], [f32; 2], bool); 15] = [
    ("1028894671", [109.0, 368.0], [160.0, 330.0], false),
    ("1028894671", [506.0, 328.0], [430.0, 320.0], false),
    ("1038901490", [108.0, 418.0], [120.0, 290.0], false),
    ("1038901490", [515.0, 102.0], [540.0, 230.0], false),
    ("1045879925", [98.0, 125.0], [110.0, 260.0], false),
    ("1045879925", [505.0, 96.0], [530.0, 250.0], false),
    ("1051883281", [70.0, 51.0], [140.0, 160.0], false),
    ("1051883281", [546.0, 51.0], [450.0, 170.0], false),
    ("1058893191", [126.0, 216.0], [120.0, 300.0], false),
    ("1058893191", [492.0, 190.0], [524.0, 276.0], false),
    ("1064898470", [99.0, 417.0], [116.0, 290.0], false),
    ("1064898470", [510.0, 389.0], [520.0, 285.0], false),
    ("1078881076", [146.0, 330.0], [190.0, 280.0], false),
    ("1078881076", [462.0, 302.0], [410.0, 286.0], false),
    ("1399145206", [470.0, 179.0], [390.0, 275.0], true),
];

/// World point at a pixel, the median of the depths about it.
fn marked(frame: &DepthFrame, [u, v]: [f32; 2]) -> Vec3 {
    let mut points: Vec<Vec3> = (-8..=8)
        .flat_map(|dv| (-8..=8).map(move |du| (du, dv)))
        .filter_map(|(du, dv)| frame.point((u as i32 + du) as u32, (v as i32 + dv) as u32))
        .collect();
    points.sort_by(|a, b| a.z.total_cmp(&b.z));
    points[points.len() / 2]
}

/// The depth frame of a marked hand, and the region of the hand.
fn marked_hand(
    root: &std::path::Path,
    (number, palm, elbow, _): (&str, [f32; 2], [f32; 2], bool),
) -> (DepthFrame, HandRegion) {
    let file = root.join(format!("depth/skeltrack/depth-data-{number}.u16le"));
    let session = open(&file, &OpenOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let frame = session.depth[0].clone();
    let [palm, elbow] = [palm, elbow].map(|p| marked(&frame, p));
    // A man of average size.
    let length = 0.193;
    let along = (palm - elbow).normalize();
    (frame, HandRegion { palm, wrist: Some(palm - along * 0.3 * length), along, length })
}

#[test]
fn open_and_closed_hands_in_real_frames() {
    let Some(root) = recordings::folder() else { return };
    let mut segmenter = HandSegmenter::new();
    for hand in MARKED {
        let (frame, region) = marked_hand(&root, hand);
        let shape = segmenter.shape(&frame, &region).unwrap();
        assert_eq!(shape.openness() > 0.5, hand.3, "{} at {}: {shape:?}", hand.0, region.palm);
    }
}

/// Regions that are off the hand, and frames without depth, give no hand; the right region gives the same after them.
#[test]
fn no_hand_outside_of_the_picture() {
    let Some(root) = recordings::folder() else { return };
    let (frame, region) = marked_hand(&root, MARKED[14]);
    let mut segmenter = HandSegmenter::new();
    let shape = segmenter.shape(&frame, &region).unwrap();
    let place = |camera: Vec3| frame.camera_to_world.transform_point3(camera);
    let away = HandRegion { palm: place(Vec3::new(9.0, 0.0, 1.0)), wrist: None, ..region };
    assert_eq!(segmenter.shape(&frame, &away), None, "beside the picture");
    let behind = HandRegion { palm: place(Vec3::NEG_Z), wrist: None, ..region };
    assert_eq!(segmenter.shape(&frame, &behind), None, "behind the camera");
    let nowhere = HandRegion { palm: Vec3::splat(f32::NAN), ..region };
    assert_eq!(segmenter.shape(&frame, &nowhere), None, "no finite place");
    let empty = DepthFrame { depth_mm: vec![0; frame.depth_mm.len()].into(), ..frame.clone() };
    assert_eq!(segmenter.shape(&empty, &region), None, "no depth");
    assert_eq!(segmenter.shape(&frame, &region), Some(shape), "what was seen before leaves no trace");
}

/// Where a right wrist is at a time (s): arm lengths to the left, up and forward of the middle of the shoulders.
type Keyframe = (f32, Vec3);

/// A hanging right wrist.
const HANGING: Vec3 = Vec3::new(-0.42, -0.92, 0.08);

/// Lengths of the shopper's upper arm and forearm (m), which add up to the unit of all places, and half of the shoulders' distance.
const UPPER_ARM: f32 = 0.33;
const FOREARM: f32 = 0.27;
const SHOULDER: f32 = 0.18;

/// Elbow and wrist (m) of an arm whose wrist is to be at `target`; the elbow hangs down and out.
fn reach(shoulder: Vec3, target: Vec3) -> [Vec3; 2] {
    let way = target - shoulder;
    let along = way.normalize();
    let length = way.length().min(0.995 * (UPPER_ARM + FOREARM));
    let x = (UPPER_ARM * UPPER_ARM - FOREARM * FOREARM + length * length) / (2.0 * length);
    let bend = (UPPER_ARM * UPPER_ARM - x * x).max(0.0).sqrt();
    let out = Vec3::new(0.6 * shoulder.x.signum(), -1.0, 0.01);
    let out = (out - along * out.dot(along)).normalize();
    [shoulder + along * x + out * bend, shoulder + along * length]
}

/// The joints of a shopper who faces the mirror, so many frames a second. The right wrist goes from keyframe to keyframe with minimum
/// jerk, and the left arm hangs.
fn sequence(keys: &[Keyframe], rate: f32) -> Vec<Joints> {
    let wrist = |time: f32| {
        let after = keys.partition_point(|k| k.0 <= time).clamp(1, keys.len() - 1);
        let [(from, a), (to, b)] = [keys[after - 1], keys[after]];
        let t = ((time - from) / (to - from)).clamp(0.0, 1.0);
        a.lerp(b, t * t * t * (10.0 - 15.0 * t + 6.0 * t * t))
    };
    let frame = |number: usize| {
        let time = number as f32 / rate;
        let mut joints = Joints::absent((f64::from(time) * SECOND_NS as f64) as u64);
        let mut put = |joint: Joint, position: Vec3| *joints.at_mut(joint) = TrackedJoint { position, confidence: 1.0 };
        let arms = [[LeftShoulder, LeftElbow, LeftWrist], [RightShoulder, RightElbow, RightWrist]];
        let wrists = [HANGING * Vec3::new(-1.0, 1.0, 1.0), wrist(time)];
        let neck = Vec3::Y * 1.4;
        put(Head, neck + Vec3::Y * 0.3);
        for ((arm, side), place) in arms.into_iter().zip([1.0, -1.0]).zip(wrists) {
            let shoulder = Vec3::X * (side * SHOULDER);
            let [elbow, wrist] = reach(shoulder, place * (UPPER_ARM + FOREARM));
            arm.into_iter().zip([shoulder, elbow, wrist]).for_each(|(joint, p)| put(joint, neck + p));
        }
        joints
    };
    (0..(keys[keys.len() - 1].0 * rate) as usize).map(frame).collect()
}

/// A stroke of 0.4 s between two places, the hand still for half a second before and after.
fn stroke(from: Vec3, to: Vec3) -> [Keyframe; 8] {
    [(0.0, HANGING), (1.0, HANGING), (1.6, from), (2.1, from), (2.5, to), (3.0, to), (3.6, HANGING), (4.4, HANGING)]
}

/// The ways of the right hand that are gestures.
fn gestures() -> [(Gesture, Vec<Keyframe>); 4] {
    let v = Vec3::new;
    let held = v(-0.3, 0.0, 0.9);
    let confirm = vec![(0.0, HANGING), (1.0, HANGING), (1.6, held), (3.4, held), (4.0, HANGING), (4.8, HANGING)];
    [
        (Gesture::SwipeLeft, stroke(v(-0.55, -0.1, 0.55), v(0.25, -0.1, 0.55)).to_vec()),
        (Gesture::SwipeRight, stroke(v(0.1, -0.1, 0.6), v(-0.7, -0.1, 0.6)).to_vec()),
        (Gesture::SwipeUp, stroke(v(-0.3, -0.45, 0.55), v(-0.3, 0.35, 0.55)).to_vec()),
        (Gesture::Confirm, confirm),
    ]
}

#[test]
fn gestures_are_recognised_at_every_rate() {
    for (gesture, keys) in gestures() {
        for rate in [15.0, 20.0, 30.0, 60.0, 100.0] {
            let found = events(&sequence(&keys, rate));
            assert_eq!(
                found.iter().map(|e| (e.gesture, e.side)).collect::<Vec<_>>(),
                [(gesture, Side::Right)],
                "{rate} Hz"
            );
        }
    }
}

#[test]
fn waves_and_slow_strokes_are_no_gestures() {
    let v = Vec3::new;
    let [from, to] = [v(-0.55, -0.1, 0.55), v(0.25, -0.1, 0.55)];
    let begin = [(0.0, HANGING), (1.0, HANGING)];
    let [end, rest] = [(5.0, HANGING), (5.8, HANGING)];
    let slow = [&begin[..], &[(1.6, from), (2.1, from), (3.3, to), (3.8, to), end, rest]].concat();
    assert_eq!(events(&sequence(&slow, 30.0)), [], "1.2 s for a stroke");
    let turns = [v(-0.8, 0.2, 0.4), v(-0.3, 0.2, 0.4)];
    let wave = (0..10).map(|k| (1.6 + 0.3 * k as f32, turns[k % 2]));
    let wave: Vec<Keyframe> = begin.into_iter().chain(wave).chain([end, rest]).collect();
    assert_eq!(events(&sequence(&wave, 30.0)), [], "waving");
    let back = [&begin[..], &[(1.6, from), (2.1, from), (2.5, to), (2.8, to), (3.2, from), (3.8, from), end, rest]];
    assert_eq!(events(&sequence(&back.concat(), 30.0)).len(), 1, "the way back");
}

/// The frames of a swipe to the left, and its event.
fn swipe() -> (Vec<Joints>, Vec<GestureEvent>) {
    let frames = sequence(&gestures()[0].1, 30.0);
    let found = events(&frames);
    (frames, found)
}

/// A sensor that tells hands apart itself needs no depth image: the hand that is held up closes.
#[test]
fn a_hand_reported_closed_is_closed() {
    let mut frames = sequence(&gestures()[3].1, 30.0);
    let [held] = events(&frames)[..] else { panic!("one event") };
    let closes_ns = held.time_ns - 500_000_000;
    for frame in &mut frames {
        let state = if frame.time_ns < closes_ns { HandState::Open } else { HandState::Closed };
        frame.hands[usize::from(held.side == Side::Right)] = state;
    }
    let found = events(&frames);
    let [closed, confirmed] = found[..] else { panic!("{found:?}") };
    assert_eq!((closed.gesture, closed.side, confirmed), (Gesture::Closed, held.side, held));
    assert!((closes_ns..closes_ns + 300_000_000).contains(&closed.time_ns), "{closed:?}");
}

fn moved(frames: &[Joints], by: impl Fn(Vec3) -> Vec3) -> Vec<Joints> {
    let mut frames = frames.to_vec();
    frames.iter_mut().flat_map(|f| &mut f.joints).for_each(|j| j.position = by(j.position));
    frames
}

#[test]
fn place_turn_and_size_do_not_matter() {
    let (frames, found) = swipe();
    let turn = Quat::from_rotation_y(0.35);
    assert_eq!(events(&moved(&frames, |p| p + Vec3::new(0.7, 0.0, -1.4))), found);
    assert_eq!(events(&moved(&frames, |p| turn * p)), found);
    for scale in [0.8, 1.2] {
        assert_eq!(events(&moved(&frames, |p| p * scale)), found, "{scale}");
    }
}

#[test]
fn the_mirror_image_swipes_the_other_way() {
    let (frames, found) = swipe();
    let mut mirrored = moved(&frames, |p| p * Vec3::new(-1.0, 1.0, 1.0));
    for frame in &mut mirrored {
        let joints = frame.joints;
        Joint::ALL.into_iter().for_each(|j| *frame.at_mut(j.mirror()) = joints[j.index()]);
    }
    let [event] = events(&mirrored)[..] else { panic!("one event") };
    assert_eq!((event.time_ns, event.gesture), (found[0].time_ns, Gesture::SwipeRight));
    assert_ne!(event.side, found[0].side);
}

#[test]
fn a_reset_forgets_all() {
    let (frames, found) = swipe();
    let mut gestures = Gestures::new();
    let mut run = || -> Vec<GestureEvent> {
        gestures.reset();
        frames.iter().flat_map(|f| gestures.push(f, None)).flatten().collect()
    };
    assert_eq!(run(), found);
    assert_eq!(run(), found);
}

/// Times that stand still, run back or leap, joints at infinity and joints that are not there: no panic, no event.
#[test]
fn bad_frames_are_passed_over() {
    let mut gestures = Gestures::new();
    let mut bad = Joints::absent(0);
    for (i, time_ns) in [0, 0, 5_000_000, u64::MAX, 3, u64::MAX - 1].into_iter().enumerate() {
        bad.time_ns = time_ns;
        for (k, joint) in bad.joints.iter_mut().enumerate() {
            let place = [f32::INFINITY, f32::NAN, 0.0, 1e30, -1e30, f32::MAX][(i + k) % 6];
            *joint = TrackedJoint { position: Vec3::splat(place), confidence: 1.0 };
        }
        assert_eq!(gestures.push(&bad, None), [None; 4]);
    }
    // And a shopper who comes after all that is seen.
    let (frames, found) = swipe();
    gestures.reset();
    assert_eq!(frames.iter().flat_map(|f| gestures.push(f, None)).flatten().collect::<Vec<_>>(), found);
}
