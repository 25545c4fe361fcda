//! Motions whose truth is known, and what a sensor shows of them at 30 Hz.

use glam::{Quat, Vec3};
use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::{JOINTS, Joint, Pose, Skeleton};
use toile_engine::body::JointFrames;
use toile_sensors::source::synthetic::JointNoise;

/// Frames a second.
pub const HZ: f32 = 30.0;

/// A motion: the truth at any time (s).
pub type JointMotion<'a> = dyn Fn(f32) -> Joints + 'a;

/// The truth and what is seen of it, frame by frame.
pub struct NoisyMotion {
    /// The joints as they really are.
    pub truth: Vec<Joints>,
    /// As the sensor shows it.
    pub seen: Vec<Joints>,
}

/// Time of a frame (ns).
pub fn time_ns(frame: usize) -> u64 {
    (frame as u64 * SECOND_NS).div_ceil(HZ as u64)
}

/// What is seen under noise of `sigma` (m) on each axis, without dropouts.
pub fn under_noise(motion: &JointMotion, seconds: f32, sigma: f32, seed: u64) -> NoisyMotion {
    let mut rng = SplitMix64::new(seed);
    see(motion, seconds, |truth| {
        let mut seen = *truth;
        for joint in seen.joints.iter_mut().filter(|j| j.confidence > 0.0) {
            joint.position += Vec3::new(rng.gaussian(), rng.gaussian(), rng.gaussian()) * sigma;
        }
        seen
    })
}

/// What a Kinect shows: jitter, and hands and feet that are lost for some frames.
pub fn by_kinect(motion: &JointMotion, seconds: f32, seed: u64) -> NoisyMotion {
    let mut noise = JointNoise::new(seed);
    see(motion, seconds, |truth| noise.apply(truth))
}

fn see(motion: &JointMotion, seconds: f32, mut show: impl FnMut(&Joints) -> Joints) -> NoisyMotion {
    let truth: Vec<Joints> =
        (0..(seconds * HZ) as usize).map(|i| Joints { time_ns: time_ns(i), ..motion(i as f32 / HZ) }).collect();
    let seen = truth.iter().map(&mut show).collect();
    NoisyMotion { truth, seen }
}

/// A person who stands still.
pub fn still(body: &Skeleton) -> impl Fn(f32) -> Joints + '_ {
    move |_| all(body.rest)
}

/// A minimum-jerk reach of 0.5 m to the left in 0.6 s, from 2 s on, by the whole body: each joint does it alike.
pub fn step(body: &Skeleton) -> impl Fn(f32) -> Joints + '_ {
    move |t| {
        let x = reach(t);
        all(body.rest.map(|p| p + Vec3::X * x))
    }
}

/// How far the reach is at a time (m).
pub fn reach(t: f32) -> f32 {
    let s = ((t - 2.0) / 0.6).clamp(0.0, 1.0);
    0.5 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}

/// A raised left arm whose forearm waves once a second by 35 degrees each way, from 1 s on.
pub fn wave(body: &Skeleton) -> impl Fn(f32) -> Joints + '_ {
    move |t| {
        let begun = (t - 1.0).clamp(0.0, 1.0);
        let swing = 35.0_f32.to_radians() * begun * (std::f32::consts::TAU * (t - 1.0)).sin();
        let mut pose = Pose::rest(body);
        pose.local[Joint::LeftShoulder.index()] = Quat::from_rotation_z(0.6);
        pose.local[Joint::LeftElbow.index()] = Quat::from_rotation_z(0.9 + swing);
        all(JointFrames::new(body, &pose).position)
    }
}

fn all(at: [Vec3; JOINTS]) -> Joints {
    Joints::seen(0, at)
}
