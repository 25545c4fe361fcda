//! The JSON of `toile bench gestures`.

use serde::Serialize;
use toile_perf::gestures::{Act, GestureConditions, GestureCount, GestureStudy, GripRow};

/// The body of `toile bench gestures`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GesturesReport {
    /// Sequences of each gesture under each condition.
    pub sequences: u32,
    /// Seed of the first one.
    pub seed: u64,
    /// Time of a frame of joints (us, median).
    pub joints_us: f64,
    /// Time of one hand in a depth frame (us, median).
    pub hand_us: f64,
    /// Gestures, by condition.
    pub gestures: Vec<GestureRow>,
    /// Acts that are no gesture.
    pub others: Vec<OtherRow>,
    /// Hands open and closed, by distance.
    pub hands: Vec<HandRow>,
}

/// One gesture under one condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GestureRow {
    /// Name of the gesture.
    pub gesture: &'static str,
    /// Distance of the shopper (m).
    pub distance_m: f32,
    /// Frames a second.
    pub rate_hz: f32,
    /// Part of the frames that were lost.
    pub dropped: f32,
    /// Size of the shopper next to a grown-up.
    pub scale: f32,
    /// Part of the gestures that were missed.
    pub missed: f32,
    /// Events that were not right.
    pub wrong_events: u32,
}

/// One thing that is no gesture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OtherRow {
    /// What the shopper does.
    pub act: &'static str,
    /// How long it was watched (minutes).
    pub minutes: f32,
    /// Gestures that were reported though none was made.
    pub false_events: u32,
    /// False events a minute.
    pub false_per_minute: f32,
}

/// One pose of the hand at one distance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HandRow {
    /// Name of the hand's pose.
    pub pose: &'static str,
    /// Distance of the shopper (m).
    pub distance_m: f32,
    /// Frames that were classified.
    pub frames: u32,
    /// Frames classified wrongly.
    pub wrong: u32,
    /// Frames in which no hand was found.
    pub unseen: u32,
    /// Changes into the pose.
    pub changes: u32,
    /// Changes that gave no event.
    pub missed: u32,
    /// Events without a change.
    pub false_events: u32,
}

impl GesturesReport {
    /// What a study found, and the times of a frame of joints and of one hand (us).
    pub fn new(study: &GestureStudy, [joints_us, hand_us]: [f64; 2]) -> Self {
        Self {
            sequences: study.sequences,
            seed: study.seed,
            joints_us,
            hand_us,
            gestures: study.gestures.iter().map(gesture).collect(),
            others: study.others.iter().map(other).collect(),
            hands: study.grips.iter().map(hand).collect(),
        }
    }
}

fn gesture((act, c, count): &(Act, GestureConditions, GestureCount)) -> GestureRow {
    GestureRow {
        gesture: act.name(),
        distance_m: c.distance,
        rate_hz: c.rate,
        dropped: c.dropped,
        scale: c.scale,
        missed: count.miss_rate(),
        wrong_events: count.wrong,
    }
}

fn other((act, count): &(Act, GestureCount)) -> OtherRow {
    OtherRow {
        act: act.name(),
        minutes: count.seconds / 60.0,
        false_events: count.wrong,
        false_per_minute: count.wrong_per_minute(),
    }
}

fn hand(row: &GripRow) -> HandRow {
    HandRow {
        pose: row.pose.name(),
        distance_m: row.distance,
        frames: row.frames,
        wrong: row.wrong,
        unseen: row.unseen,
        changes: row.changes,
        missed: row.missed,
        false_events: row.false_events,
    }
}
