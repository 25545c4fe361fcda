//! The sensor thread. A frame comes, is filtered, and is published as the latest.

use std::fmt::Debug;
use std::sync::Arc;

use toile_base::filter::Filter;
use toile_base::frame::{DepthFrame, Joints};

use super::ThreadLoop;
use super::queue::Sender;
use crate::clock::Clock;
use crate::meter::Meter;
use crate::triple_buffer::Writer;

/// Capacity of the queue of frames for the sensor's observer: two seconds at 30 Hz.
pub const OBSERVED: usize = 64;

/// Name of this capacity in reports and warnings.
pub const OBSERVED_NAME: &str = "OBSERVED (queue of sensor frames to observe)";

/// A depth image that is shared and not copied on its way: a camera's own, or one of a recording that is held as a whole.
pub trait DepthImage: Debug + Send + Sync {
    /// The depth image itself (mm).
    fn frame(&self) -> &DepthFrame;
}

impl DepthImage for DepthFrame {
    fn frame(&self) -> &DepthFrame {
        self
    }
}

/// What a sensor gives at a moment: joints with the hands' states, and depth of about the same time where it has any.
#[derive(Debug, Clone)]
pub struct SourceFrame {
    /// The joints as the sensor has them, stamped on the loop's clock.
    pub joints: Joints,
    /// The depth image, shared: nothing is copied on its way.
    pub depth: Option<Arc<dyn DepthImage>>,
    /// People whom the sensor sees besides, and whether one of them is nearer.
    pub others: (u8, bool),
    /// When the frame came to the machine (ns), where that was before it was read; none takes it as it is read.
    pub arrived_ns: Option<u64>,
}

impl From<Joints> for SourceFrame {
    /// A frame of a sensor without depth.
    fn from(joints: Joints) -> Self {
        Self { joints, depth: None, others: (0, false), arrived_ns: None }
    }
}

/// A frame as the sensor thread took it, for an observer of the sensor beside the physics. It was filtered once, for both.
#[derive(Debug, Clone)]
pub struct ObservedFrame {
    /// The joints as the sensor had them, with a stamp that can be believed: what measures are taken from.
    pub raw: Joints,
    /// The same after the filter, as the physics has them.
    pub filtered: Joints,
    /// The depth image, where there is one.
    pub depth: Option<Arc<dyn DepthImage>>,
    /// People whom the sensor sees besides, and whether one of them is nearer.
    pub others: (u8, bool),
}

/// Where raw frames come from: a camera, a recording, a generator of faults.
pub trait FrameSource: Send {
    /// When the next frame arrives at the earliest, on the loop's clock (ns); none where there are no more.
    fn next_ns(&self) -> Option<u64>;

    /// The frame that has arrived, stamped on the loop's clock; none where nothing is there after all.
    fn read(&mut self) -> Option<SourceFrame>;
}

/// A recording played in time, again and again: each frame arrives at the time that is its stamp.
#[derive(Debug, Clone)]
pub struct Playback {
    frames: Box<[Joints]>,
    /// Length of a round (ns).
    round_ns: u64,
    origin_ns: u64,
    next: u64,
    rounds: u64,
}

impl Playback {
    /// From this time on (ns), for so many rounds. From the end of a round the next one goes back the way it came, so
    /// that the body never jumps.
    pub fn new(frames: &[Joints], origin_ns: u64, rounds: u64) -> Self {
        let first = frames.first().map_or(0, |f| f.time_ns);
        let frames: Box<[Joints]> = frames.iter().map(|f| Joints { time_ns: f.time_ns - first, ..*f }).collect();
        let last = frames.last().map_or(0, |f| f.time_ns);
        // The time between the last frame of a round and the first of the next.
        let gap = (last / (frames.len() as u64).max(2)).max(1);
        Self { frames, round_ns: last + gap, origin_ns, next: 0, rounds }
    }

    /// The frame at a place of the endless sequence: its number and its time from the origin (ns).
    fn place(&self, at: u64) -> Option<(usize, u64)> {
        let count = self.frames.len() as u64;
        let (round, i) = (at.checked_div(count)?, at.checked_rem(count)?);
        if round >= self.rounds {
            return None;
        }
        let back = round % 2 == 1;
        let i = if back { count - 1 - i } else { i } as usize;
        let within = self.frames[i].time_ns;
        let last = self.frames[count as usize - 1].time_ns;
        Some((i, round * self.round_ns + if back { last - within } else { within }))
    }
}

impl FrameSource for Playback {
    fn next_ns(&self) -> Option<u64> {
        self.place(self.next).map(|(_, ns)| self.origin_ns + ns)
    }

    fn read(&mut self) -> Option<SourceFrame> {
        let (i, ns) = self.place(self.next)?;
        self.next += 1;
        Some(Joints { time_ns: self.origin_ns + ns, ..self.frames[i] }.into())
    }
}

/// A stamp that lies so far ahead of its frame's arrival is that of a clock that jumped (ns). Believing it would
/// have every later frame look old.
pub const AHEAD_NS: u64 = 20_000_000;

/// A stamp that lies so far behind its frame's arrival is one too (ns).
pub const BEHIND_NS: u64 = 1_000_000_000;

/// A filtered frame on its way to the physics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorFrame {
    /// The filtered joints, stamped on the loop's clock.
    pub joints: Joints,
    /// When the frame arrived here (ns).
    pub arrived_ns: u64,
    /// Its number, from 1; 0 is none yet.
    pub number: u64,
}

impl Default for SensorFrame {
    fn default() -> Self {
        Self { joints: Joints::absent(0), arrived_ns: 0, number: 0 }
    }
}

/// What the sensor thread runs.
#[derive(Debug)]
pub struct SensorThread<S, F, C> {
    source: S,
    clock: C,
    filter: F,
    writer: Writer<SensorFrame>,
    observer: Option<Sender<ObservedFrame>>,
    count: u64,
    from_ns: u64,
    last_ns: Option<u64>,
    /// Frames whose stamp was that of a clock that had jumped; they count as seen when they arrived.
    pub restamped: u64,
    /// Frames that were no newer than the one before, which are passed over.
    pub stale: u64,
    /// From a frame's arrival to its publication.
    pub filtering: Meter,
}

impl<S: FrameSource, F: Filter, C: Clock> SensorThread<S, F, C> {
    /// Reads `source`, writes frames that `filter` has filtered to `writer`. Called at load: it allocates.
    pub fn new(source: S, filter: F, clock: C, writer: Writer<SensorFrame>) -> Self {
        Self {
            source,
            clock,
            filter,
            writer,
            observer: None,
            count: 0,
            from_ns: 0,
            last_ns: None,
            restamped: 0,
            stale: 0,
            filtering: Meter::new(),
        }
    }

    /// The same, whose meter begins at this time (ns).
    #[must_use]
    pub fn metering_from(self, from_ns: u64) -> Self {
        Self { from_ns, ..self }
    }

    /// The same, whose frames also go to an observer.
    #[must_use]
    pub fn observed_by(self, observer: Sender<ObservedFrame>) -> Self {
        Self { observer: Some(observer), ..self }
    }

    /// A frame with a stamp that can be believed; none where it is no news.
    fn stamped(&mut self, raw: Joints, due: u64) -> Option<Joints> {
        let jumped = raw.time_ns > due.saturating_add(AHEAD_NS) || raw.time_ns.saturating_add(BEHIND_NS) < due;
        self.restamped += u64::from(jumped);
        let time_ns = if jumped { due } else { raw.time_ns };
        if self.last_ns.is_some_and(|last| time_ns <= last) {
            self.stale += 1;
            return None;
        }
        self.last_ns = Some(time_ns);
        Some(Joints { time_ns, ..raw })
    }

    /// Frames published so far.
    pub fn frames(&self) -> u64 {
        self.count
    }
}

impl<S: FrameSource, F: Filter, C: Clock> ThreadLoop for SensorThread<S, F, C> {
    fn run_due(&mut self) -> Option<u64> {
        let due = self.source.next_ns()?;
        if self.clock.now_ns() < due {
            return Some(due);
        }
        if let Some(SourceFrame { joints, depth, others, arrived_ns }) = self.source.read()
            && let Some(raw) = self.stamped(joints, due)
        {
            // It has been here since it was due, however late this thread is: nothing is left out of its latency.
            let arrived_ns = arrived_ns.unwrap_or(due).max(raw.time_ns);
            let joints = self.filter.push(&raw);
            self.count += 1;
            self.writer.publish(SensorFrame { joints, arrived_ns, number: self.count });
            if let Some(observer) = &mut self.observer {
                observer.push(ObservedFrame { raw, filtered: joints, depth, others });
            }
            if arrived_ns >= self.from_ns {
                self.filtering.add(self.clock.now_ns().saturating_sub(arrived_ns));
            }
        }
        self.source.next_ns()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Passes joints on as they come.
    struct Unfiltered;

    impl Filter for Unfiltered {
        fn push(&mut self, frame: &Joints) -> Joints {
            *frame
        }

        fn reset(&mut self) {}
    }

    #[test]
    fn stamps_of_a_clock_that_jumped_and_frames_that_are_no_news_do_not_get_through() {
        const MS: u64 = 1_000_000;
        // When each frame arrives, and its stamp (ms): late, repeated, out of order, from tomorrow, from yesterday.
        let frames = [
            (5_000, 4_980),
            (5_033, 5_013),
            (5_066, 5_013),
            (5_100, 5_000),
            (5_133, 90_000_000),
            (5_166, 12),
            (5_200, 5_180),
        ];
        struct StampedFrames(Vec<(u64, u64)>);
        impl FrameSource for StampedFrames {
            fn next_ns(&self) -> Option<u64> {
                self.0.first().map(|t| t.0 * MS)
            }
            fn read(&mut self) -> Option<SourceFrame> {
                Some(Joints::absent(self.0.remove(0).1 * MS).into())
            }
        }
        let clock = crate::clock::SimClock::default();
        let crate::triple_buffer::TripleBuffer { writer, mut reader } =
            crate::triple_buffer::TripleBuffer::new(&SensorFrame::default());
        let mut sense = SensorThread::new(StampedFrames(frames.to_vec()), Unfiltered, clock.clone(), writer);
        let mut stamps = Vec::new();
        while let Some(due) = sense.source.next_ns() {
            clock.sleep_until(due);
            sense.run_due();
            stamps.extend(reader.news().map(|seen| seen.joints.time_ns / MS));
        }
        assert_eq!(stamps, [4_980, 5_013, 5_133, 5_166, 5_180]);
        assert_eq!((sense.restamped, sense.stale, sense.frames()), (2, 2, 5));
    }

    #[test]
    fn a_recording_is_played_forth_and_back_at_its_own_pace() {
        let frames: Vec<Joints> = [100, 133, 200].map(Joints::absent).to_vec();
        let mut source = Playback::new(&frames, 1_000, 3);
        let mut times = Vec::new();
        while let Some(due) = source.next_ns() {
            let frame = source.read().unwrap().joints;
            assert_eq!(frame.time_ns, due);
            times.push(due - 1_000);
        }
        // The gap between rounds is the mean one.
        assert_eq!(times, [0, 33, 100, 133, 200, 233, 266, 299, 366]);
        assert!(source.read().is_none());
        assert!(Playback::new(&[], 0, 5).next_ns().is_none());
    }
}
