//! Jitter, lag and overshoot of a filtered track.

use glam::Vec3;
use toile_base::filter::Filter;
use toile_base::frame::Joints;
use toile_base::numeric::statistics::quantile;
use toile_base::skeleton::{Joint, Skeleton};
use toile_fitting::timing;
use toile_sensors::sample::sample;
use toile_sensors::source::Session;

use super::motions::{self, HZ, NoisyMotion};
use super::{FilterRow, RecordedFigures, rows};

/// The joint that is looked at: the end of the longest chain.
const HAND: Joint = Joint::LeftHand;

/// Noise of the reference on each axis (m).
const SIGMA: f32 = 0.005;

/// Runs whose figures are averaged.
const SEEDS: u64 = 8;

/// Delays that are tried (ms).
const DELAYS: std::ops::Range<i32> = -100..250;

/// Speed (m/s) up to which a recorded hand rests.
const SLOW: f32 = 0.1;

/// Measures one filter on all motions and recordings.
pub fn row(name: &str, body: &Skeleton, sessions: &[Session]) -> FilterRow {
    let fresh = || rows::filter(name, body).expect("a row of the table");
    let mean = |of: &dyn Fn(u64) -> f64| (0..SEEDS).map(of).sum::<f64>() / SEEDS as f64;
    let step = |seed| {
        let seen = motions::under_noise(&motions::step(body), 6.0, SIGMA, seed);
        let track = run(&mut *fresh(), &seen.seen);
        (seen, track)
    };
    let wave = |seed| {
        let seen = motions::by_kinect(&motions::wave(body), 12.0, 100 + seed);
        let track = run(&mut *fresh(), &seen.seen);
        (seen, track)
    };
    FilterRow {
        name: name.to_owned(),
        still_jitter_mm: mean(&|seed| {
            let seen = motions::under_noise(&motions::still(body), 6.0, SIGMA, seed);
            still_jitter(&seen, &run(&mut *fresh(), &seen.seen))
        }),
        step_lag_ms: mean(&|seed| lag(&step(seed), 1.9..2.9).0),
        step_overshoot_mm: mean(&|seed| {
            let (seen, track) = step(seed);
            let end = seen.truth[seen.truth.len() - 1].at(HAND).position.x;
            let far = track.iter().map(|f| f.at(HAND).position.x).fold(f32::MIN, f32::max);
            f64::from(far - end) * 1e3
        }),
        wave_lag_ms: mean(&|seed| lag(&wave(seed), 2.0..11.5).0),
        wave_error_mm: mean(&|seed| lag(&wave(seed), 2.0..11.5).1),
        bone_mm: mean(&|seed| bone(&wave(seed).1)),
        recorded: sessions.iter().map(|session| recorded(session, &mut *fresh())).collect(),
        us: cost(&wave(0).0, &mut *fresh()),
    }
}

/// A filtered track.
fn run(filter: &mut dyn Filter, seen: &[Joints]) -> Vec<Joints> {
    seen.iter().map(|frame| filter.push(frame)).collect()
}

/// Time a frame (us).
fn cost(seen: &NoisyMotion, filter: &mut dyn Filter) -> f64 {
    let us = timing::median_us(|| {
        filter.reset();
        seen.seen.iter().for_each(|frame| {
            std::hint::black_box(filter.push(frame));
        });
    });
    us / seen.seen.len() as f64
}

/// Deviation from the truth along an axis, once the filter has settled (mm).
fn still_jitter(seen: &NoisyMotion, track: &[Joints]) -> f64 {
    let off: Vec<Vec3> =
        seen.truth.iter().zip(track).skip(30).map(|(t, f)| f.at(HAND).position - t.at(HAND).position).collect();
    // What stays is an offset, of bones that are locked to another length, and no jitter.
    let mean = off.iter().sum::<Vec3>() / off.len() as f32;
    rms(off.iter().map(|o| (*o - mean).length() / 3.0_f32.sqrt()))
}

/// The delay at which a track fits the truth best within a time (ms), and the 99th percentile of its error then (mm).
fn lag((seen, track): &(NoisyMotion, Vec<Joints>), within: std::ops::Range<f32>) -> (f64, f64) {
    let frames = || (0..track.len()).filter(|i| within.contains(&(*i as f32 / HZ)));
    let errors = |delay: i32| -> Vec<f32> {
        let at = |i: usize| track[i].time_ns.saturating_add_signed(-i64::from(delay) * 1_000_000);
        let truth = |i| sample(&seen.truth, at(i)).map_or(Vec3::ZERO, |f| f.at(HAND).position);
        frames().map(|i| track[i].at(HAND).position.distance(truth(i))).collect()
    };
    let cost = |delay: i32| errors(delay).iter().map(|e| e * e).sum::<f32>();
    let best = DELAYS.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap_or(0);
    let mut errors = errors(best);
    (f64::from(best), f64::from(quantile(&mut errors, 0.99).unwrap_or(0.0)) * 1e3)
}

/// Deviation of the forearm's length (mm).
fn bone(track: &[Joints]) -> f64 {
    let lengths: Vec<f32> = track
        .iter()
        .skip(60)
        .map(|f| f.at(Joint::LeftWrist).position.distance(f.at(Joint::LeftElbow).position))
        .collect();
    let mean = lengths.iter().sum::<f32>() / lengths.len() as f32;
    rms(lengths.iter().map(|l| l - mean))
}

fn rms(values: impl Iterator<Item = f32>) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for value in values {
        sum += f64::from(value) * f64::from(value);
        count += 1;
    }
    (sum / f64::from(count.max(1))).sqrt() * 1e3
}

/// A recorded right wrist, whose hand waves in the recordings: its jitter about its own smooth course while it is slow, and its
/// delay against the raw hand's smooth course.
fn recorded(session: &Session, filter: &mut dyn Filter) -> RecordedFigures {
    const WAVING: Joint = Joint::RightWrist;
    let course = |track: &[Joints]| -> Vec<Vec3> { track.iter().map(|f| f.at(WAVING).position).collect() };
    let (raw, out) = (course(&session.joints), course(&run(filter, &session.joints)));
    let (truth, own) = (smooth(&raw), smooth(&out));
    let seconds: Vec<f32> = session.joints.iter().map(|f| f.time_ns as f32 * 1e-9).collect();
    let slow = |i: &usize| truth[i + 1].distance(truth[i - 1]) / (seconds[i + 1] - seconds[i - 1]) < SLOW;
    let inner = || REACH + 1..raw.len().saturating_sub(REACH + 1);
    let jitter = rms(inner().filter(slow).map(|i| out[i].distance(own[i]) / 3.0_f32.sqrt()));
    let cost = |delay: i32| -> f32 {
        inner().map(|i| out[i].distance_squared(between(&seconds, &truth, seconds[i] - delay as f32 * 1e-3))).sum()
    };
    let lag = DELAYS.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap_or(0);
    RecordedFigures { name: session.name.clone(), jitter_mm: jitter, lag_ms: f64::from(lag) }
}

/// Frames to each side that a smooth course is taken from.
const REACH: usize = 3;

/// A course without its jitter and without delay: each point from the parabola through seven (Savitzky and Golay 1964).
fn smooth(course: &[Vec3]) -> Vec<Vec3> {
    const WEIGHTS: [f32; 2 * REACH + 1] = [-2.0, 3.0, 6.0, 7.0, 6.0, 3.0, -2.0];
    let point = |i: usize| match course.get(i.wrapping_sub(REACH)..=i + REACH) {
        Some(near) => near.iter().zip(WEIGHTS).map(|(p, w)| *p * w).sum::<Vec3>() / 21.0,
        None => course[i],
    };
    (0..course.len()).map(point).collect()
}

/// A course at a time, linear between its points.
fn between(seconds: &[f32], course: &[Vec3], at: f32) -> Vec3 {
    let after = seconds.partition_point(|s| *s <= at).clamp(1, seconds.len() - 1);
    let t = (at - seconds[after - 1]) / (seconds[after] - seconds[after - 1]);
    course[after - 1].lerp(course[after], t.clamp(0.0, 1.0))
}
