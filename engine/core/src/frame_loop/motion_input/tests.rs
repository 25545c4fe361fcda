use super::*;
use toile_base::clock::{SECOND_NS, ticks_to_ns};

const MS: u64 = 1_000_000;

/// A reach of half a metre in 0.6 s, from 0.5 s on, as hands do it: least jerk (Flash and Hogan 1985).
fn reach(seconds: f64) -> f64 {
    let t = ((seconds - 0.5) / 0.6).clamp(0.0, 1.0);
    0.5 * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}

fn frame(seen_ns: u64, x: f64) -> Joints {
    let mut joints = Joints::absent(seen_ns);
    joints.joints[7] = TrackedJoint { position: Vec3::new(x as f32, 1.0, 0.2), confidence: 1.0 };
    joints
}

/// When the frames of a sensor are seen, for two seconds: every 33 ms; every 67 ms, each up to 20 ms off, one in five lost.
fn stamps(stutters: bool) -> Vec<u64> {
    if !stutters {
        return (0..60).map(|i| i * SECOND_NS / 30).collect();
    }
    let mut seed = 7u64;
    let mut random = |below: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % below
    };
    let all = (0..30).map(|i| i * SECOND_NS / 15 + random(20 * MS)).collect::<Vec<_>>();
    all.into_iter().enumerate().filter(|(i, _)| *i == 0 || random(5) != 0).map(|(_, ns)| ns).collect()
}

/// The joint at each of 240 steps, seen with a delay of 10 ms.
fn play(stamps: &[u64], truth: impl Fn(f64) -> f64) -> Vec<f64> {
    let (mut intake, mut next) = (MotionInput::default(), 0);
    let mut path = Vec::new();
    for tick in 0..240 {
        let now = ticks_to_ns(tick) + 10 * MS;
        while next < stamps.len() && stamps[next] + 10 * MS <= now {
            intake.take(&frame(stamps[next], truth(stamps[next] as f64 * 1e-9)), now);
            next += 1;
        }
        path.push(f64::from(intake.at(now).joints[7].position.x));
    }
    path
}

/// The largest of the k-th differences of a path, over the k-th power of the step (m/s^k).
fn most(path: &[f64], k: usize) -> f64 {
    let mut rows = path.to_vec();
    (0..k).for_each(|_| rows = rows.windows(2).map(|w| (w[1] - w[0]) * 120.0).collect());
    rows.iter().fold(0.0, |m, x| x.abs().max(m))
}

fn truth_at_steps() -> Vec<f64> {
    (0..240).map(|tick| reach(ticks_to_ns(tick) as f64 * 1e-9 + 0.01)).collect()
}

/// What a body would do that jumps to each frame as it comes.
fn held(stamps: &[u64]) -> Vec<f64> {
    let last = |now: u64| stamps.iter().rev().find(|s| **s + 10 * MS <= now).map_or(0.0, |s| reach(*s as f64 * 1e-9));
    (0..240).map(|tick| last(ticks_to_ns(tick) + 10 * MS)).collect()
}

#[test]
fn a_sensor_of_30_hz_moves_a_joint_smoothly_and_one_that_stutters_too() {
    let truth = truth_at_steps();
    assert!((most(&truth, 3) - 139.0).abs() < 20.0, "a true reach: 60 x 0.5 m / (0.6 s)^3, {}", most(&truth, 3));
    let off = |path: &[f64]| path.iter().zip(&truth).fold(0.0f64, |m, (a, b)| m.max((a - b).abs())) * 1e3;
    for stutters in [false, true] {
        let stamps = stamps(stutters);
        let (path, jumps) = (play(&stamps, reach), held(&stamps));
        let [ours, theirs] = [off(&path), off(&jumps)];
        let [speed, bend, jerk] = [1, 2, 3].map(|k| most(&path, k));
        let [_, _, steps] = [1, 2, 3].map(|k| most(&jumps, k));
        eprintln!(
            "stutters {stutters}: off by {ours:.0} mm, {theirs:.0} if each frame is held; {speed:.1} m/s, {bend:.0} m/s2, \
             jerk {jerk:.0} m/s3, {steps:.0} if each frame is held"
        );
        // A part of what a body would do that jumps to each frame as it comes, and nearer to the truth.
        assert!(jerk < steps / if stutters { 60.0 } else { 40.0 }, "jerk {jerk}");
        assert!(ours < theirs, "{ours} mm");
        assert!(stutters || (jerk < 6_000.0 && ours < 45.0));
    }
}

#[test]
fn what_moves_steadily_does_not_lag_and_what_stands_does_not_move() {
    let steady = play(&stamps(false), |t| t);
    let at = |tick: usize| ticks_to_ns(tick as u64) as f64 * 1e-9 + 0.01;
    // A tenth of the velocity is not believed at 1 m/s, and some of it fades before the next frame.
    let lags: Vec<f64> = (100..236).map(|i| (at(i) - steady[i]) * 1e3).collect();
    let mean = lags.iter().sum::<f64>() / lags.len() as f64;
    eprintln!("{mean:.1} ms behind on average, {:.1} at most", lags.iter().copied().fold(0.0, f64::max));
    assert!(mean < 10.0 && lags.iter().all(|l| l.abs() < 12.0), "{mean} ms behind on average");
    let still = play(&stamps(true), |_| 0.3);
    assert!(still[5..].iter().all(|x| (x - 0.3).abs() < 1e-6));
}

#[test]
fn the_noise_of_a_sensor_is_hardly_drawn_out() {
    // A filtered joint at rest still moves by some millimetres from frame to frame.
    let mut seed = 3u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((seed >> 40) as f64 / f64::from(1 << 24) - 0.5) * 6e-3
    };
    let frames: Vec<f64> = (0..60).map(|_| noise()).collect();
    let path = play(&stamps(false), |t| frames[(t * 30.0).round() as usize % 60]);
    let spread = |x: &[f64]| (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt() * 1e3;
    eprintln!("noise of {:.2} mm becomes {:.2} mm", spread(&frames), spread(&path[20..]));
    assert!(spread(&path[20..]) < 1.2 * spread(&frames));
}

#[test]
fn a_sensor_that_falls_silent_leaves_the_body_near_where_it_was_and_at_rest() {
    let mut stamps = stamps(false);
    // In the middle of the reach, at full speed: 1.56 m/s.
    stamps.retain(|s| *s <= 800 * MS);
    let path = play(&stamps, reach);
    let last = reach(0.8);
    assert!((path[239] - last).abs() < 1.6 * f64::from(FADE_S), "{} after {last}", path[239]);
    assert!((path[239] - path[230]).abs() < 1e-3, "it still moves");
    let mut intake = MotionInput::default();
    intake.take(&frame(0, 0.0), 0);
    intake.take(&frame(SECOND_NS / 30, 0.1), SECOND_NS / 30);
    // After a silence the next frame is taken as it is.
    intake.take(&frame(3 * SECOND_NS, -1.0), 3 * SECOND_NS);
    assert_eq!(intake.at(3 * SECOND_NS).joints[7].position.x, -1.0);
}

#[test]
fn frames_out_of_order_repeated_absent_or_not_finite_do_no_harm() {
    let mut intake = MotionInput::default();
    assert_eq!(intake.at(5), Joints::absent(5));
    assert!(intake.take(&frame(100 * MS, 0.1), 101 * MS));
    assert!(!intake.take(&frame(100 * MS, 9.0), 102 * MS), "repeated");
    assert!(!intake.take(&frame(50 * MS, 9.0), 103 * MS), "older");
    assert!(intake.take(&frame(133 * MS, f64::NAN), 134 * MS));
    assert_eq!(intake.at(140 * MS).joints[7], TrackedJoint::default(), "absent while it is NaN");
    assert!(intake.take(&Joints::absent(166 * MS), 167 * MS));
    assert!(intake.take(&frame(200 * MS, 0.4), 201 * MS));
    assert_eq!(intake.at(201 * MS).joints[7].position.x, 0.4, "back where it is seen");
    assert!(intake.at(u64::MAX).is_valid(), "however late a step is");
}
