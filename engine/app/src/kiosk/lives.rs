//! The loop's three lives with a stage between them, and the ends of their queues that the service holds.

use std::io;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use glam::Vec3;
use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame::Snapshot;
use toile_engine::frame_loop::event::{EVENTS, EVENTS_NAME, Event};
use toile_engine::frame_loop::handover::{HandoverSender, handover};
use toile_engine::frame_loop::physics_thread::{PhysicsOutputs, PhysicsThread, Scene};
use toile_engine::frame_loop::queue::{Capacity, Receiver, Sender, bounded};
use toile_engine::frame_loop::recording::Entry;
use toile_engine::frame_loop::render_thread::{RenderThread, Renderer, SceneView};
use toile_engine::frame_loop::sensor_thread::{SensorFrame, SensorThread};
use toile_engine::frame_loop::thread_roles::{Placement, ThreadRole};
use toile_engine::frame_loop::threads::{self, LoopThread, Stop};
use toile_engine::meter::PERIOD_NS;
use toile_engine::triple_buffer::TripleBuffer;
use toile_perf::latency::ThreadAccount;
use toile_sensors::frame::Joints;

use super::change::Act;
use super::source::{FRAMES, FRAMES_NAME, Feed, Tapped};
use super::stage::{BEATS, BEATS_NAME, Beat, Stage, Watching};
use super::watchdog::Pulse;

/// Longest that lives are waited for when they are to end: a picture that a busy processor draws; the others take a fifth of a
/// second.
const LONGEST_END: Duration = Duration::from_secs(3);

/// Who is there when the loop begins.
pub struct Cast<S, E: Renderer> {
    /// The mannequin.
    pub first: Act<S, E::Outfit>,
    /// Who makes pictures, with the mannequin's outfit on already: that of `first` is what it leaves in its place.
    pub renderer: E,
    /// What the sensor reads.
    pub feed: Feed,
    /// Where what a replay needs goes, where somebody keeps it.
    pub recording: Option<Sender<Entry>>,
}

/// The service's ends of the stage.
pub struct Doors<S, O> {
    /// To physics.
    pub scenes: HandoverSender<Stage<S>>,
    /// To render.
    pub views: HandoverSender<SceneView<O>>,
}

/// The lives on their threads.
pub struct Lives<S, E: Renderer> {
    clock: RealClock,
    stop: Stop,
    sensor: LoopThread<SensorThread<Tapped, RealClock>>,
    physics: LoopThread<PhysicsThread<Stage<S>, RealClock, ThreadAccount>>,
    render: LoopThread<Watching<E>>,
    /// What happened.
    pub events: Receiver<Event>,
    /// What each step came to.
    pub beats: Receiver<Beat>,
    /// What the sensor saw, unfiltered.
    pub frames: Receiver<Joints>,
    /// What the watchdog looks at.
    pub pulse: Arc<Pulse>,
}

/// The lives, when they have ended; none is one that did not end in time.
pub struct Ended<S, E: Renderer> {
    /// The sensor's.
    pub sensor: Option<SensorThread<Tapped, RealClock>>,
    /// The physics'.
    pub physics: Option<PhysicsThread<Stage<S>, RealClock, ThreadAccount>>,
    /// The render's.
    pub render: Option<RenderThread<E, RealClock>>,
    /// How full the queues were.
    pub capacities: [Capacity; 3],
}

impl<S: Scene + Send + 'static, E: Renderer + 'static> Lives<S, E> {
    /// Starts them. Also gives the service's ends of the stage.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(cast: Cast<S, E>, clock: RealClock) -> io::Result<(Self, Doors<S, E::Outfit>)> {
        let begin = clock.now_ns() + 2 * PERIOD_NS;
        let pulse = Arc::new(Pulse::default());
        let (tell, events) = bounded(EVENTS_NAME, EVENTS);
        let (beat, beats) = bounded(BEATS_NAME, BEATS);
        let (tap, frames) = bounded(FRAMES_NAME, FRAMES);
        let ((scenes, next), (views, showing)) = (handover(), handover());
        let TripleBuffer { writer, reader: seen } = TripleBuffer::new(&SensorFrame::default());
        let sense = SensorThread::new(Tapped::new(cast.feed, tap), clock, writer);
        let still = cast.first.still();
        let stage = Stage::new(cast.first.scene, still).begin(beat, pulse.clone());
        let outlets = PhysicsOutputs { events: tell, recording: cast.recording };
        let physics = PhysicsThread::new(stage, clock, begin, seen, outlets, ThreadAccount::new()).changing(next);
        let render = RenderThread::new(cast.renderer, clock, begin, cast.first.reader).changing(showing);
        let watching = Watching::new(render, pulse.clone());
        let stop = Stop::default();
        let lives = Self {
            sensor: threads::start(ThreadRole::Sensor, sense, clock, &stop)?,
            physics: threads::start(ThreadRole::Physics, physics, clock, &stop)?,
            render: threads::start(ThreadRole::Render, watching, clock, &stop)?,
            clock,
            stop,
            events,
            beats,
            frames,
            pulse,
        };
        Ok((lives, Doors { scenes, views }))
    }

    /// The places that the threads got. Once.
    pub fn placements(&self) -> Vec<Placement> {
        [self.sensor.placement(), self.physics.placement(), self.render.placement()].into_iter().flatten().collect()
    }

    /// The time on the loop's clock (ns).
    pub fn now_ns(&self) -> u64 {
        self.clock.now_ns()
    }

    /// The first life that has ended, which none does by itself.
    pub fn over(&self) -> Option<ThreadRole> {
        let ended = [
            (ThreadRole::Sensor, self.sensor.is_over()),
            (ThreadRole::Physics, self.physics.is_over()),
            (ThreadRole::Render, self.render.is_over()),
        ];
        ended.into_iter().find_map(|(role, over)| over.then_some(role))
    }

    /// Ends them, and waits for a bounded time: one that hangs is left to the end of the program.
    pub fn end(self) -> Ended<S, E> {
        self.stop.now();
        let end = Instant::now() + LONGEST_END;
        while Instant::now() < end && !(self.sensor.is_over() && self.physics.is_over() && self.render.is_over()) {
            thread::sleep(Duration::from_millis(1));
        }
        Ended {
            sensor: ended(self.sensor),
            physics: ended(self.physics),
            render: ended(self.render).map(|watching| watching.render),
            capacities: [self.events.capacity(), self.beats.capacity(), self.frames.capacity()],
        }
    }
}

fn ended<T>(life: LoopThread<T>) -> Option<T> {
    if life.is_over() { life.join() } else { None }
}

/// A display that is not there: takes what it would be handed, the body and the garments in the order of their meshes.
#[derive(Debug, Default)]
pub struct Headless {
    body: [Vec<Vec3>; 2],
    garments: Vec<Vec<Vec3>>,
}

impl Renderer for Headless {
    type Outfit = ();

    fn set_outfit(&mut self, _outfit: &mut ()) {}

    fn draw(&mut self, snapshot: &Snapshot) {
        let [positions, normals] = &mut self.body;
        for column in [&mut *positions, &mut *normals] {
            column.resize(snapshot.skin.vertices(), Vec3::ZERO);
        }
        snapshot.skin.read(positions, normals);
        self.garments.resize_with(snapshot.garments.len(), Vec::new);
        for (to, from) in self.garments.iter_mut().zip(&snapshot.garments) {
            to.clear();
            to.extend_from_slice(from);
        }
    }
}
