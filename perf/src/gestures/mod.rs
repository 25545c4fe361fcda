//! How well gestures are recognised: simulated shoppers of many sizes, distances and speeds, who gesture and who do not.
//!
//! Sequences run through the default joint filter as in the mirror. Events of the right kind are counted as hits, a
//! gesture without one as a miss, every other event as false.

mod hands;
mod motion;
mod person;
mod table;

use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;
use toile_base::numeric::random::SplitMix64;
use toile_sensors::filter::JointFilter;
use toile_track::gesture::{GestureEvent, Gestures};

use motion::GestureMotion;
use person::{Shopper, Tracker};

pub use hands::{GripRow, HandPose, grips, held_up};
pub use motion::Act;
pub use table::GestureStudy;

/// What is varied between the rows of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GestureConditions {
    /// Distance of the shopper from the camera (m).
    pub distance: f32,
    /// Frames a second.
    pub rate: f32,
    /// Chance that a frame is lost.
    pub dropped: f32,
    /// Size of the shopper next to a grown-up.
    pub scale: f32,
}

impl Default for GestureConditions {
    fn default() -> Self {
        Self { distance: 2.0, rate: 30.0, dropped: 0.03, scale: 1.0 }
    }
}

/// How often an act was recognised.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct GestureCount {
    /// Sequences that were tried.
    pub sequences: u32,
    /// Sequences that gave the right event.
    pub hits: u32,
    /// Events that were not right.
    pub wrong: u32,
    /// Time watched (s).
    pub seconds: f32,
}

impl GestureCount {
    /// Part of the gestures that were missed.
    pub fn miss_rate(&self) -> f32 {
        1.0 - self.hits as f32 / self.sequences.max(1) as f32
    }

    /// Wrong events a minute.
    pub fn wrong_per_minute(&self) -> f32 {
        60.0 * self.wrong as f32 / self.seconds.max(1.0)
    }

    /// The sum of both counts.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            sequences: self.sequences + other.sequences,
            hits: self.hits + other.hits,
            wrong: self.wrong + other.wrong,
            seconds: self.seconds + other.seconds,
        }
    }
}

/// The joints of a random shopper who does something, filtered; the same seed gives the same bits.
pub fn sequence(act: Act, conditions: &GestureConditions, seed: u64) -> Vec<Joints> {
    let mut rng = SplitMix64::new(seed);
    let person = Shopper::new(&mut rng, conditions.scale);
    let motion = GestureMotion::new(act, &mut rng);
    let mut tracker = Tracker::new(&mut rng, conditions.distance);
    let facing = 0.15 * rng.gaussian();
    let mut filter = JointFilter::default();
    let step_ns = (SECOND_NS as f32 / conditions.rate) as u64;
    let frames = (motion.seconds() * conditions.rate) as u64;
    let mut last_ns = 0;
    (0..frames)
        .filter_map(|frame| {
            let time_ns = frame * step_ns;
            let (wrists, place, turn) = motion.at(time_ns as f32 * 1e-9);
            let mut truth = person.joints(place, facing + turn, wrists);
            truth.time_ns = time_ns;
            let seen = tracker.see(&truth, (time_ns - last_ns) as f32 * 1e-9);
            last_ns = time_ns;
            (rng.uniform() >= conditions.dropped).then(|| filter.push(&seen))
        })
        .collect()
}

/// The events of a sequence.
pub fn events(frames: &[Joints]) -> Vec<GestureEvent> {
    let mut gestures = Gestures::new();
    frames.iter().flat_map(|f| gestures.push(f, None)).flatten().collect()
}

/// Runs an act so many times.
pub fn count(act: Act, conditions: &GestureConditions, sequences: u32, seed: u64) -> GestureCount {
    let mut count = GestureCount { sequences, ..GestureCount::default() };
    for i in 0..sequences {
        let frames = sequence(act, conditions, seed + u64::from(i));
        let found = events(&frames);
        let right = found.iter().any(|e| Some(e.gesture) == act.wanted());
        count.hits += u32::from(right);
        count.wrong += found.len() as u32 - u32::from(right);
        count.seconds += frames.last().map_or(0.0, |f| f.time_ns as f32 * 1e-9);
    }
    count
}
