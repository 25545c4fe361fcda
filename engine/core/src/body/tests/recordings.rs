//! Tests of the pose on recordings of real sensors, found through `TOILE_DATA`: drops, bursts, inferred joints, wobbling
//! bones and wrong feet are all in them, and none of it may show as a jump.

use glam::Vec3;
use toile_base::clock::{ns_to_ticks, ticks_to_ns};
use toile_base::frame::Joints;
use toile_base::limits::{CONFIDENCE_GATE, STEP_SECONDS};
use toile_base::numeric::statistics;
use toile_base::skeleton::{JOINTS, Joint, Pose};
use toile_sensors::filter::JointFilter;
use toile_sensors::sample::sample;
use toile_sensors::source::{OpenOptions, open};

use super::{LIMBS, skeleton};
use crate::body::kinematics::JointFrames;
use crate::body::smooth::{LIMB_SPEED, rotation_vector};
use crate::body::{Poser, ground};

const KINECT: [&str; 5] = [
    "skeleton/kinectron-kinect2/recorded_skeleton.json",
    "skeleton/labanotation-kinect2/Ges01_wavehand.csv",
    "skeleton/labanotation-kinect2/Ges02_balancinghands.csv",
    "skeleton/labanotation-kinect2/Ges03_drawlines.csv",
    "skeleton/labanotation-kinect2/joints.csv",
];

const MOCAP: [&str; 5] = [
    "mocap/cmu/14_14.bvh",
    "mocap/animated-drawings/jumping.bvh",
    "mocap/animated-drawings/wave_hello.bvh",
    "mocap/animated-drawings/dab.bvh",
    "mocap/animated-drawings/zombie.bvh",
];

/// How joints reach the pose: the latest frame, as from a live sensor, or a recording sampled between its frames.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Feed {
    Latest,
    Sampled,
}

/// What was seen over one recording.
#[derive(Debug, Default)]
struct Figures {
    /// Turns of all joints in all steps (rad/s), and how much each changed since the step before.
    speed: Vec<f32>,
    change: Vec<f32>,
    /// Angle between our limbs and the ones seen (degrees): mostly the lag of smoothing.
    error: Vec<f32>,
    /// Level speed (m/s) of our soles on the floor, and of the ankles that the sensor shows meanwhile.
    slide: Vec<f32>,
    seen_slide: Vec<f32>,
    /// Lowest point of the soles in each step (m).
    sole: Vec<f32>,
    /// Greatest step of the root (m).
    root_step: f32,
}

fn quantile(values: &mut [f32], share: f64) -> f32 {
    statistics::quantile(values, share).unwrap_or(0.0)
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len().max(1) as f32
}

fn filtered(file: &str, data: &std::path::Path) -> Vec<Joints> {
    let session = open(&data.join(file), &OpenOptions::default()).expect("a recording of the test data");
    let mut filter = JointFilter::default();
    session.joints.iter().map(|j| filter.push(j)).collect()
}

/// Poses a whole recording at 120 Hz.
fn watch(track: &[Joints], feed: Feed) -> Figures {
    let ours = skeleton(1.0, 1.0);
    let mut poser = Poser::new(&ours);
    let mut figures = Figures::default();
    let mut last: Option<(Joints, Pose, [Vec3; JOINTS])> = None;
    for tick in 0..ns_to_ticks(track.last().map_or(0, |f| f.time_ns)) {
        let time = ticks_to_ns(tick);
        let joints = match feed {
            Feed::Latest => track[track.partition_point(|f| f.time_ns <= time).max(1) - 1],
            Feed::Sampled => sample(track, time).unwrap(),
        };
        let pose = poser.pose(&joints, STEP_SECONDS);
        assert!(pose.root.is_finite() && pose.local.iter().all(|q| q.is_finite()), "tick {tick}");
        let mut turns = [Vec3::ZERO; JOINTS];
        if let Some((seen, before, turned)) = &last {
            for (i, turn) in turns.iter_mut().enumerate() {
                *turn = rotation_vector(pose.local[i] * before.local[i].inverse()) / STEP_SECONDS;
                figures.speed.push(turn.length());
                figures.change.push(turn.distance(turned[i]));
            }
            let ours = [before, &pose].map(|p| JointFrames::new(&ours, p));
            figures.root_step = figures.root_step.max(pose.root.distance(before.root));
            figures.look(&ours, [seen, &joints]);
        }
        last = Some((joints, pose, turns));
    }
    figures
}

impl Figures {
    /// Compares two following steps of ours with what was seen in them.
    fn look(&mut self, ours: &[JointFrames; 2], seen: [&Joints; 2]) {
        for (a, b) in LIMBS {
            let (p, q) = (seen[1].at(a), seen[1].at(b));
            if p.confidence.min(q.confidence) >= CONFIDENCE_GATE {
                let ours = ours[1].at(b) - ours[1].at(a);
                self.error.push(ours.angle_between(q.position - p.position).to_degrees());
            }
        }
        let rest = skeleton(1.0, 1.0);
        let soles = ours.each_ref().map(|frames| ground::soles(&rest, frames));
        for (foot, ankle) in [Joint::LeftAnkle, Joint::RightAnkle].into_iter().enumerate() {
            let balls = [soles[0][foot][1], soles[1][foot][1]];
            if balls.iter().all(|b| b.y < 0.01) {
                let level = |from: Vec3, to: Vec3| (to - from).with_y(0.0).length() / STEP_SECONDS;
                self.slide.push(level(balls[0], balls[1]));
                self.seen_slide.push(level(seen[0].at(ankle).position, seen[1].at(ankle).position));
            }
        }
        self.sole.push(soles[1].iter().flatten().map(|p| p.y).fold(f32::INFINITY, f32::min));
    }

    /// Share of steps in which both feet are off the floor by more than a centimetre.
    fn air(&self) -> f32 {
        self.sole.iter().filter(|y| **y > 0.01).count() as f32 / self.sole.len() as f32
    }

    fn print(&mut self, file: &str, feed: Feed) {
        eprintln!(
            "{file} {feed:?}: turn p99 {:.1} max {:.1} rad/s, change a step p99 {:.2} max {:.1} rad/s, limbs p50 {:.1} \
             p95 {:.1} degrees, slide {:.3} (seen {:.3}) m/s, in the air {:.1} %, lowest {:.1} mm, root step {:.0} mm",
            quantile(&mut self.speed, 0.99),
            quantile(&mut self.speed, 1.0),
            quantile(&mut self.change, 0.99),
            quantile(&mut self.change, 1.0),
            quantile(&mut self.error, 0.5),
            quantile(&mut self.error, 0.95),
            mean(&self.slide),
            mean(&self.seen_slide),
            100.0 * self.air(),
            1e3 * quantile(&mut self.sole, 0.0),
            1e3 * self.root_step,
        );
    }
}

#[test]
fn recordings_are_followed_without_jumps_slides_or_feet_in_the_floor() {
    let Some(data) = crate::recordings::folder() else { return };
    for file in KINECT.into_iter().chain(MOCAP) {
        let track = filtered(file, &data);
        for feed in [Feed::Latest, Feed::Sampled] {
            let mut figures = watch(&track, feed);
            figures.print(file, feed);
            assert!(quantile(&mut figures.speed, 1.0) <= LIMB_SPEED * 1.01, "{file}: a jump");
            assert!(quantile(&mut figures.change, 0.99) < 6.0, "{file}: jerks");
            assert!(figures.root_step < 0.06, "{file}: the root jumps by {} m", figures.root_step);
            assert!(quantile(&mut figures.sole, 0.0) > -1e-3, "{file}: a foot is in the floor");
            assert!(quantile(&mut figures.error, 0.5) < 10.0, "{file}: limbs are not followed");
            let (slide, seen) = (mean(&figures.slide), mean(&figures.seen_slide));
            assert!(slide < 1.5 * seen + 0.02, "{file}: feet slide at {slide} m/s, seen {seen}");
        }
    }
}

#[test]
fn who_stands_in_a_recording_stands_and_who_jumps_leaves_the_floor() {
    let Some(data) = crate::recordings::folder() else { return };
    let air = |file| watch(&filtered(file, &data), Feed::Latest).air();
    for file in &KINECT[1..4] {
        assert_eq!(air(*file), 0.0, "{file}");
    }
    assert_eq!(air("mocap/animated-drawings/wave_hello.bvh"), 0.0);
    assert!(air("mocap/animated-drawings/jumping.bvh") > 0.05);
}
