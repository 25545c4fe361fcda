//! Sources of the sensor's thread: a recording played round after round with an empty pause in between, or a live sender.

use std::fmt;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;

use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, Joints};
use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::sensor_thread::{DepthImage, FrameSource, SourceFrame};
use toile_sensors::source::Session;
use toile_sensors::source::vmc::VmcReceiver;

use super::depth_camera::CameraFeed;

/// Time between two frames in which no person is in view (ns): a camera of 30 Hz.
const EMPTY_NS: u64 = SECOND_NS / 30;

/// Time between two looks for messages (ns): half a step, so that none waits for longer.
const LOOK_NS: u64 = SECOND_NS / 240;

/// Repeated sessions of a recording: it is played, no person is in view for a pause, it is played again. The first round begins after
/// a pause too.
#[derive(Debug, Clone)]
pub struct RepeatedSession {
    frames: Box<[SourceFrame]>,
    origin_ns: u64,
    /// Frames of a pause.
    empty: u64,
    /// Length of a pause and of a round, pause and recording (ns).
    pause_ns: u64,
    round_ns: u64,
    next: u64,
}

impl RepeatedSession {
    /// Of a recording, with the depth of about the time of each frame, from this time on (ns), for ever.
    pub fn of(session: &Arc<Session>, origin_ns: u64, pause_ns: u64) -> Self {
        let frame = |joints: &Joints| {
            let index = depth_at(session, joints.time_ns);
            let image = |index| Arc::new(RecordedDepth { session: session.clone(), index }) as Arc<dyn DepthImage>;
            SourceFrame { depth: index.map(image), ..SourceFrame::from(*joints) }
        };
        Self::new(session.joints.iter().map(frame).collect(), origin_ns, pause_ns)
    }

    /// From this time on (ns), for ever.
    pub fn new(mut frames: Box<[SourceFrame]>, origin_ns: u64, pause_ns: u64) -> Self {
        let first = frames.first().map_or(0, |f| f.joints.time_ns);
        frames.iter_mut().for_each(|f| f.joints.time_ns -= first);
        let empty = pause_ns / EMPTY_NS;
        let pause_ns = empty * EMPTY_NS;
        let round_ns = pause_ns + frames.last().map_or(0, |f| f.joints.time_ns) + EMPTY_NS;
        Self { frames, origin_ns, empty, pause_ns, round_ns, next: 0 }
    }

    /// The frame at a place of the endless sequence, its place among the recorded ones, and its time (ns).
    fn place(&self, at: u64) -> (Option<&SourceFrame>, u64) {
        let count = self.empty + self.frames.len() as u64;
        let (round, i) = (at / count, at % count);
        let begin = self.origin_ns + round * self.round_ns;
        match i.checked_sub(self.empty).and_then(|i| self.frames.get(i as usize)) {
            Some(frame) => (Some(frame), begin + self.pause_ns + frame.joints.time_ns),
            None => (None, begin + i * EMPTY_NS),
        }
    }

    fn frame(&self, at: u64) -> SourceFrame {
        match self.place(at) {
            (Some(frame), time_ns) => SourceFrame { joints: Joints { time_ns, ..frame.joints }, ..frame.clone() },
            (None, time_ns) => Joints::absent(time_ns).into(),
        }
    }
}

/// Farthest that depth may be from the joints that it is shown with (ns): half of a frame of 30 Hz.
const SAME_MOMENT_NS: u64 = SECOND_NS / 60;

/// The depth image of a session at about this time.
fn depth_at(session: &Session, time_ns: u64) -> Option<usize> {
    let after = session.depth.partition_point(|depth| depth.time_ns < time_ns);
    let near = |i: &usize| session.depth.get(*i).is_some_and(|d| d.time_ns.abs_diff(time_ns) <= SAME_MOMENT_NS);
    [after.wrapping_sub(1), after].into_iter().filter(near).min_by_key(|i| session.depth[*i].time_ns.abs_diff(time_ns))
}

/// One depth image of a recording, which is held as a whole.
#[derive(Clone)]
struct RecordedDepth {
    session: Arc<Session>,
    index: usize,
}

impl fmt::Debug for RecordedDepth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "depth image {} of {}", self.index, self.session.name)
    }
}

impl DepthImage for RecordedDepth {
    fn frame(&self) -> &DepthFrame {
        &self.session.depth[self.index]
    }
}

/// A live sender of Virtual Motion Capture messages.
#[derive(Debug)]
pub struct LiveSender {
    receiver: VmcReceiver,
    clock: RealClock,
    next_ns: u64,
}

/// A recording or a live sender.
#[derive(Debug)]
pub enum Feed {
    /// A recording, played again and again.
    Played(RepeatedSession),
    /// A sender of joints over the network (VMC).
    Live(Box<LiveSender>),
    /// A live depth camera.
    Camera(CameraFeed),
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

impl FrameSource for Feed {
    fn next_ns(&self) -> Option<u64> {
        Some(match self {
            Self::Played(session) => session.place(session.next).1,
            Self::Live(live) => live.next_ns,
            Self::Camera(camera) => return camera.next_ns(),
        })
    }

    fn read(&mut self) -> Option<SourceFrame> {
        match self {
            Self::Played(session) => {
                let frame = session.frame(session.next);
                session.next += 1;
                Some(frame)
            }
            Self::Live(live) => {
                let now = live.clock.now_ns();
                live.next_ns = now + LOOK_NS;
                // Stamped as it arrives: a sender's own clock is seconds off after some days. A broken socket gives
                // nothing, which the loop tells as a lost sensor.
                live.receiver.poll(now).ok().flatten().map(|joints| Joints { time_ns: now, ..joints }.into())
            }
            Self::Camera(camera) => camera.read(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::frame::Intrinsics;
    use toile_base::skeleton::Joint;

    #[test]
    fn a_recording_repeats_with_empty_pauses() {
        let mut frames = [500, 500 + EMPTY_NS].map(Joints::absent);
        frames.iter_mut().for_each(|frame| frame.at_mut(Joint::Pelvis).confidence = 1.0);
        let mut feed =
            Feed::Played(RepeatedSession::new(frames.map(SourceFrame::from).into(), 1_000, 2 * EMPTY_NS + 7));
        let mut frames_read = Vec::new();
        for _ in 0..9 {
            let due = feed.next_ns().unwrap();
            let frame = feed.read().unwrap().joints;
            assert_eq!(frame.time_ns, due);
            frames_read.push(((due - 1_000) / EMPTY_NS, frame.at(Joint::Pelvis).is_believed()));
        }
        let there = |i: u64| i % 4 >= 2;
        assert_eq!(
            frames_read,
            (0..9).map(|i| (i, there(i))).collect::<Vec<_>>(),
            "every 33 ms, two of four with a person"
        );
    }

    #[test]
    fn a_pause_of_nothing_plays_on() {
        let frames = [0, EMPTY_NS].map(Joints::absent);
        let mut feed = Feed::Played(RepeatedSession::new(frames.map(SourceFrame::from).into(), 0, 0));
        let times: Vec<u64> = (0..4).map(|_| feed.read().unwrap().joints.time_ns).collect();
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

    #[test]
    fn depth_comes_with_the_joints_of_its_moment() {
        let depth = |time_ns: u64| DepthFrame {
            time_ns,
            intrinsics: Intrinsics { width: 1, height: 1, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0 },
            camera_to_world: glam::Affine3A::IDENTITY,
            depth_mm: Box::new([0]),
        };
        let session = Arc::new(Session {
            joints: [0, 33, 66, 100].map(|ms| Joints::absent(ms * 1_000_000)).to_vec(),
            depth: [3, 70].map(|ms| depth(ms * 1_000_000)).to_vec(),
            ..Session::default()
        });
        let mut feed = Feed::Played(RepeatedSession::of(&session, 0, 0));
        let seen: Vec<Option<u64>> =
            (0..4).map(|_| feed.read().unwrap().depth.map(|d| d.frame().time_ns / 1_000_000)).collect();
        assert_eq!(seen, [Some(3), None, Some(70), None]);
    }
}
