//! The one assembly of the loop: sensor, physics and renderer, joined by the latest value, bounded queues and a handover of scenes.
//! The kiosk, the latency benchmark and the soak test run this one. They differ in the source, the renderer, the clock, and
//! the wrappers that a test puts around the three loops.

use std::sync::Arc;

use glam::Vec3;
use toile_engine::clock::Clock;
use toile_engine::frame_loop::event::{CounterSource, EVENTS, EVENTS_NAME, Event};
use toile_engine::frame_loop::handover::handover;
use toile_engine::frame_loop::physics_thread::{LoopScene, PhysicsOutputs, PhysicsThread};
use toile_engine::frame_loop::queue::{Capacity, Receiver, Sender, bounded};
use toile_engine::frame_loop::recording::Entry;
use toile_engine::frame_loop::render_thread::{RenderThread, Renderer};
use toile_engine::frame_loop::sensor_thread::{
    FrameSource, OBSERVED, OBSERVED_NAME, ObservedFrame, SensorFrame, SensorThread,
};
use toile_engine::triple_buffer::TripleBuffer;
use toile_engine::world::Snapshot;
use toile_sensors::filter::JointFilter;

use super::live_scene::{LiveScene, STEP_REPORTS, STEP_REPORTS_NAME, SceneHandover, StepReport, WatchedRenderer};
use super::running::Loops;
use super::scene_changer::DressedScene;
use super::watchdog::Progress;

/// Parts that the loop is started with.
pub struct LoopParts<S, E: Renderer, F, A> {
    /// The dressed body that is shown first.
    pub first: DressedScene<S, E::Outfit>,
    /// The renderer, which knows the outfit of the first already: that of `first` is what it leaves in its place.
    pub renderer: E,
    /// Source of sensor frames.
    pub source: F,
    /// What the system counts of the physics thread.
    pub account: A,
    /// Recorder of what a replay needs, if it is kept.
    pub recording: Option<Sender<Entry>>,
}

/// How the loop runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LoopOptions {
    /// When the first step is due (ns on the loop's clock).
    pub begin_ns: u64,
    /// Steps after which the meters begin.
    pub warm_up_steps: u64,
    /// When the meters of sensor and renderer begin (ns on the loop's clock).
    pub metered_from_ns: u64,
    /// A quality level that the run is held on; `None` leaves the level to quality control.
    pub held_level: Option<u8>,
}

/// The sensor thread's loop.
pub type SensorLoop<F, C> = SensorThread<F, JointFilter, C>;

/// The physics thread's loop.
pub type PhysicsLoop<S, C, A> = PhysicsThread<LiveScene<S>, C, A>;

/// The render thread's loop.
pub type RenderLoop<E, C> = WatchedRenderer<E, C>;

/// The ends of the queues that the owner of the loop empties.
#[derive(Debug)]
pub struct LoopQueues {
    /// Events of the loop.
    pub events: Receiver<Event>,
    /// A report of each step.
    pub step_reports: Receiver<StepReport>,
    /// What the sensor saw, as it came and filtered.
    pub frames: Receiver<ObservedFrame>,
    /// Counts of steps and pictures, for the watchdog.
    pub progress: Arc<Progress>,
}

impl LoopQueues {
    /// How full the queues were.
    pub fn capacities(&self) -> [Capacity; 3] {
        [self.events.capacity(), self.step_reports.capacity(), self.frames.capacity()]
    }
}

/// The three loops of an assembly.
pub type AssembledLoops<S, E, F, A, C> = Loops<SensorLoop<F, C>, PhysicsLoop<S, C, A>, RenderLoop<E, C>>;

/// The loop, joined and not started.
pub struct Assembly<S, E: Renderer, F, A, C> {
    /// The three loops, to be run by threads or one after the other.
    pub loops: AssembledLoops<S, E, F, A, C>,
    /// Queues of what the threads report.
    pub queues: LoopQueues,
    /// How scenes are changed.
    pub handover: SceneHandover<S, E::Outfit>,
}

/// Joins the parts. All storage is allocated here.
pub fn assemble<S, E, F, A, C>(parts: LoopParts<S, E, F, A>, clock: &C, options: LoopOptions) -> Assembly<S, E, F, A, C>
where
    S: LoopScene,
    E: Renderer,
    F: FrameSource,
    A: CounterSource,
    C: Clock + Clone,
{
    let LoopParts { first, renderer, source, account, recording } = parts;
    let LoopOptions { begin_ns, warm_up_steps, metered_from_ns, held_level } = options;
    let progress = Arc::new(Progress::default());
    let (event_sender, events) = bounded(EVENTS_NAME, EVENTS);
    let (report_sender, step_reports) = bounded(STEP_REPORTS_NAME, STEP_REPORTS);
    let (observer, frames) = bounded(OBSERVED_NAME, OBSERVED);
    let ((scenes, next_scene), (views, next_view)) = (handover(), handover());
    let TripleBuffer { writer, reader: seen } = TripleBuffer::new(&SensorFrame::default());
    let sensor = SensorThread::new(source, JointFilter::default(), clock.clone(), writer)
        .metering_from(metered_from_ns)
        .observed_by(observer);
    let scene = LiveScene::new(first.scene, first.still).reporting(report_sender, progress.clone());
    let outputs = PhysicsOutputs { events: event_sender, recording };
    let physics = PhysicsThread::new(scene, clock.clone(), begin_ns, seen, outputs, account)
        .changing(next_scene)
        .warming_up(warm_up_steps);
    let physics = match held_level {
        Some(level) => physics.held_on(level),
        None => physics,
    };
    let render = RenderThread::new(renderer, clock.clone(), begin_ns, first.reader)
        .changing(next_view)
        .metering_from(metered_from_ns);
    let render = WatchedRenderer::new(render, progress.clone());
    Assembly {
        loops: Loops { sensor, physics, render },
        queues: LoopQueues { events, step_reports, frames, progress },
        handover: SceneHandover { scenes, views },
    }
}

/// A renderer without a display: takes what it would be handed, the body and the garments in the order of their meshes.
#[derive(Debug, Default)]
pub struct HeadlessRenderer {
    body: [Vec<Vec3>; 2],
    garments: Vec<Vec<Vec3>>,
}

impl HeadlessRenderer {
    /// One that allocates nothing while it sees a scene like that of this snapshot.
    pub fn sized_for(snapshot: &Snapshot) -> Self {
        let mut renderer = Self::default();
        renderer.draw(snapshot);
        renderer
    }
}

impl Renderer for HeadlessRenderer {
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
