//! What the sensor's thread reads: a recording played round after round with nobody there in between, or a live sender.

use std::io;
use std::net::SocketAddr;

use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::queue::Sender;
use toile_engine::frame_loop::sensor_thread::JointSource;
use toile_sensors::clock::SECOND_NS;
use toile_sensors::frame::Joints;
use toile_sensors::source::vmc::VmcReceiver;

/// Frames that wait to be looked at by the service: two seconds of 30 Hz.
pub const FRAMES: usize = 64;

/// The name of the bound, as warnings give it.
pub const FRAMES_NAME: &str = "FRAMES (engine/fitting/src/live/source.rs)";

/// Time between two frames in which nobody is seen (ns): a camera of 30 Hz.
const EMPTY_NS: u64 = SECOND_NS / 30;

/// Time between two looks for messages (ns): half a step, so that none waits for longer.
const LOOK_NS: u64 = SECOND_NS / 240;

/// Visits of a recording: it is played, nobody is seen for a while, it is played again. The first visit begins after a
/// pause too.
#[derive(Debug, Clone)]
pub struct Visits {
    frames: Box<[Joints]>,
    origin_ns: u64,
    /// Frames of a pause.
    empty: u64,
    /// Length of a pause and of a round, pause and recording (ns).
    pause_ns: u64,
    round_ns: u64,
    next: u64,
}

impl Visits {
    /// From this time on (ns), for ever.
    pub fn new(frames: &[Joints], origin_ns: u64, pause_ns: u64) -> Self {
        let first = frames.first().map_or(0, |f| f.time_ns);
        let frames: Box<[Joints]> = frames.iter().map(|f| Joints { time_ns: f.time_ns - first, ..*f }).collect();
        let empty = pause_ns / EMPTY_NS;
        let pause_ns = empty * EMPTY_NS;
        let round_ns = pause_ns + frames.last().map_or(0, |f| f.time_ns) + EMPTY_NS;
        Self { frames, origin_ns, empty, pause_ns, round_ns, next: 0 }
    }

    /// The frame at a place of the endless sequence.
    fn place(&self, at: u64) -> Joints {
        let count = self.empty + self.frames.len() as u64;
        let (round, i) = (at / count, at % count);
        let begin = self.origin_ns + round * self.round_ns;
        match i.checked_sub(self.empty).and_then(|i| self.frames.get(i as usize)) {
            Some(frame) => Joints { time_ns: begin + self.pause_ns + frame.time_ns, ..*frame },
            None => Joints::absent(begin + i * EMPTY_NS),
        }
    }
}

/// A live sender of Virtual Motion Capture messages.
#[derive(Debug)]
pub struct LiveSender {
    receiver: VmcReceiver,
    clock: RealClock,
    next_ns: u64,
}

/// Either of them.
#[derive(Debug)]
pub enum Feed {
    /// A recording.
    Played(Visits),
    /// A sender.
    Live(Box<LiveSender>),
}

impl Feed {
    /// Listens at an address.
    ///
    /// # Errors
    /// Where the address cannot be bound.
    pub fn listen(address: SocketAddr, clock: RealClock) -> io::Result<Self> {
        let receiver = VmcReceiver::bind(address)?;
        Ok(Self::Live(Box::new(LiveSender { receiver, clock, next_ns: clock.now_ns() })))
    }
}

impl JointSource for Feed {
    fn next_ns(&self) -> Option<u64> {
        Some(match self {
            Self::Played(visits) => visits.place(visits.next).time_ns,
            Self::Live(live) => live.next_ns,
        })
    }

    fn read(&mut self) -> Option<Joints> {
        match self {
            Self::Played(visits) => {
                let frame = visits.place(visits.next);
                visits.next += 1;
                Some(frame)
            }
            Self::Live(live) => {
                let now = live.clock.now_ns();
                live.next_ns = now + LOOK_NS;
                // Stamped as it arrives: a sender's own clock is seconds off after some days. A broken socket gives
                // nothing, which the loop tells as a lost sensor.
                live.receiver.poll(now).ok().flatten().map(|joints| Joints { time_ns: now, ..joints })
            }
        }
    }
}

/// A source whose frames somebody else looks at too, as they come: unfiltered.
#[derive(Debug)]
pub struct Tapped<F> {
    feed: F,
    tap: Sender<Joints>,
}

impl<F> Tapped<F> {
    /// Each frame of the feed is also pushed there.
    pub fn new(feed: F, tap: Sender<Joints>) -> Self {
        Self { feed, tap }
    }
}

impl<F: JointSource> JointSource for Tapped<F> {
    fn next_ns(&self) -> Option<u64> {
        self.feed.next_ns()
    }

    fn read(&mut self) -> Option<Joints> {
        let frame = self.feed.read()?;
        self.tap.push(frame);
        Some(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_assets::skeleton::Joint;

    #[test]
    fn a_recording_comes_again_and_again_and_nobody_is_there_between() {
        let mut frames = [500, 500 + EMPTY_NS].map(Joints::absent);
        frames.iter_mut().for_each(|frame| frame.at_mut(Joint::Pelvis).confidence = 1.0);
        let mut feed = Feed::Played(Visits::new(&frames, 1_000, 2 * EMPTY_NS + 7));
        let mut told = Vec::new();
        for _ in 0..9 {
            let due = feed.next_ns().unwrap();
            let frame = feed.read().unwrap();
            assert_eq!(frame.time_ns, due);
            told.push(((due - 1_000) / EMPTY_NS, frame.at(Joint::Pelvis).is_believed()));
        }
        let there = |i: u64| i % 4 >= 2;
        assert_eq!(told, (0..9).map(|i| (i, there(i))).collect::<Vec<_>>(), "every 33 ms, two of four with somebody");
    }

    #[test]
    fn a_pause_of_nothing_plays_on() {
        let frames = [0, EMPTY_NS].map(Joints::absent);
        let mut feed = Feed::Played(Visits::new(&frames, 0, 0));
        let times: Vec<u64> = (0..4).map(|_| feed.read().unwrap().time_ns).collect();
        assert_eq!(times, [0, EMPTY_NS, 2 * EMPTY_NS, 3 * EMPTY_NS]);
    }

    #[test]
    fn who_sends_nothing_is_asked_again_half_a_step_later() {
        let clock = RealClock::default();
        let mut feed = Feed::listen(SocketAddr::from(([127, 0, 0, 1], 0)), clock).unwrap();
        let due = feed.next_ns().unwrap();
        clock.sleep_until(due);
        assert!(feed.read().is_none());
        assert!(feed.next_ns().unwrap() >= due + LOOK_NS);
    }
}
