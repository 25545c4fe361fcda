//! The run itself: the loop on its threads, and this one, which empties the queues.

use std::thread;
use std::time::Duration;

use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;
use toile_base::garment::Garment;
use toile_base::limits::STEP_HZ;
use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::event::{Event, EventKind};
use toile_engine::frame_loop::physics_thread::WorldScene;
use toile_engine::frame_loop::quality_control::QUALITY_LEVELS;
use toile_engine::frame_loop::queue::{Capacity, Sender};
use toile_engine::frame_loop::recording::Entry;
use toile_engine::frame_loop::render_thread::RenderThread;
use toile_engine::frame_loop::sensor_thread::{FrameSource, Playback, SourceFrame};
use toile_engine::frame_loop::thread_roles::RolePlacement;
use toile_engine::meter::{INTAKE, Meter, PERIOD_NS, STAGES, STEP_BUDGET_US};
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot, World};
use toile_fitting::live::assembly::{LoopOptions, LoopParts, LoopQueues, PhysicsLoop, SensorLoop};
use toile_fitting::live::depth_camera::CameraFeed;
use toile_fitting::live::lateness::{LatenessAttribution, ThreadAccount};
use toile_fitting::live::live_loop::LiveLoop;
use toile_fitting::live::report::{Quantiles, QueueUse, ThreadPlacement};
use toile_fitting::live::scene_changer::DressedScene;

use super::error::LatencyError;
use super::load::LoadThreads;
use super::renderer::{LatencyRenderer, OwnPictureFigures, OwnPictureParts};
use super::report::{Goal, Latency, LatencyStage, QualityFigures};
use super::{capacity, jitter};

/// Time before the meters begin (s): caches fill, memory is touched for the first time.
const WARM_UP_S: u64 = 1;
const WARM_UP_STEPS: u64 = WARM_UP_S * STEP_HZ as u64;

/// What filtering a sensor frame may take (us): measured at 60 to 80, on the core that it shares with the cloth's second worker.
const FILTER_US: u64 = 100;

/// Longest time for which the machine's own jitter is measured (s).
const MOST_JITTER_S: u32 = 10;

/// A snapshot is to be there so soon after a sensor frame's arrival, at the 99th percentile (us).
const SNAPSHOT_US: f64 = 12_000.0;

/// The same where the joints are fitted to the depth of a live camera (us): following a person takes 6 to 12 ms.
const CAMERA_SNAPSHOT_US: f64 = 30_000.0;

/// A picture is to be there so soon after a sensor frame's arrival (us): what 75 ms from motion to light leave beside a sensor of
/// 20 ms and a display of 17 ms (Waltemate et al. 2016).
const PICTURE_US: f64 = 38_000.0;

/// The shopper's own picture is drawn so soon after its stamp (us).
const OWN_PICTURE_US: f64 = 75_000.0;

/// Most changes of quality that are reported one by one.
const MOST_CHANGES: usize = 100;

/// Time between two looks at the queues: they hold seconds.
const LOOK: Duration = Duration::from_millis(20);

/// Options of a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LatencyOptions {
    /// Length of the run (s), after a first second.
    pub seconds: u32,
    /// Threads of load beside the loop.
    pub load: usize,
    /// Quality level on which the run is held; `None` leaves it to quality control.
    pub level: Option<u8>,
}

/// Where the joints come from.
pub enum LatencySource<'a> {
    /// A session's joints as the sensor gave them, played forth and back.
    Played(&'a [Joints]),
    /// A live depth camera.
    Camera(CameraFeed),
}

/// The same as the sensor thread reads it.
enum RunningSource {
    Played(Playback),
    Camera(CameraFeed),
}

impl FrameSource for RunningSource {
    fn next_ns(&self) -> Option<u64> {
        match self {
            Self::Played(playback) => playback.next_ns(),
            Self::Camera(camera) => camera.next_ns(),
        }
    }

    fn read(&mut self) -> Option<SourceFrame> {
        match self {
            Self::Played(playback) => playback.read(),
            Self::Camera(camera) => camera.read(),
        }
    }
}

/// What is run: a shopper, dressed, and how they moved.
pub struct LatencyInputs<'a> {
    /// The frame, dressed; its worker pool is of the workers that are asked for.
    pub frame: World,
    /// Where its snapshots come out.
    pub reader: Reader<Snapshot>,
    /// Where the joints come from.
    pub source: LatencySource<'a>,
    /// The loop's clock, which a camera stamps its frames by.
    pub clock: RealClock,
    /// Where the pool's helper runs.
    pub worker: Option<RolePlacement>,
    /// What the shopper's own picture is drawn from, where it is drawn.
    pub own: Option<OwnPictureParts>,
    /// Where what a replay needs goes.
    pub recording: Sender<Entry>,
}

/// What came out of the queues.
#[derive(Debug, Default)]
struct LoopEvents {
    late: LatenessAttribution,
    changes: Vec<[u64; 3]>,
    sentences: Vec<String>,
}

impl LoopEvents {
    fn take(&mut self, event: &Event) {
        self.late.take(event);
        match event.what {
            EventKind::Quality(change) if self.changes.len() < MOST_CHANGES => {
                self.changes.push([event.tick, u64::from(change.from), u64::from(change.to)]);
            }
            EventKind::Quality(_) => {}
            EventKind::SensorLost => self.note(event, "no sensor frame had come for half a second"),
            EventKind::SensorBack => self.note(event, "the sensor came back"),
            EventKind::Broken => self.note(event, "a worker panicked and the garments kept their places"),
            EventKind::Changed(_) | EventKind::Missed(_) | EventKind::Waited(_) | EventKind::Dropped(_) => {}
            EventKind::RolledBack => self.note(event, "a garment ended with NaN or infinity and was rolled back"),
        }
    }

    fn note(&mut self, event: &Event, what: &str) {
        if self.sentences.len() < MOST_CHANGES {
            self.sentences.push(format!("step {}: {what}", event.tick));
        }
    }
}

/// The loop while it runs, with a renderer that only takes what it would draw.
struct MeteredLoop {
    live: LiveLoop<WorldScene, LatencyRenderer, RunningSource>,
    metered_ns: u64,
}

/// The loop when it has ended.
struct EndedRun {
    sensor: SensorLoop<RunningSource, RealClock>,
    physics: PhysicsLoop<WorldScene, RealClock, ThreadAccount>,
    render: RenderThread<LatencyRenderer, RealClock>,
    queues: [Capacity; 2],
}

impl MeteredLoop {
    fn start(inputs: LatencyInputs<'_>, options: &LatencyOptions) -> Result<Self, LatencyError> {
        let LatencyInputs { frame, mut reader, source, clock, recording, own, .. } = inputs;
        let begin_ns = clock.now_ns() + 10 * PERIOD_NS;
        let metered_ns = begin_ns + WARM_UP_S * SECOND_NS;
        let renderer = LatencyRenderer::new(reader.latest(), own, clock, metered_ns);
        let scene = WorldScene::new(frame);
        let first = DressedScene { scene, reader, outfit: (), still: None, note: None, number: None };
        let source = match source {
            LatencySource::Played(joints) => RunningSource::Played(Playback::new(joints, begin_ns, u64::MAX)),
            LatencySource::Camera(camera) => RunningSource::Camera(camera),
        };
        let parts = LoopParts { first, renderer, source, account: ThreadAccount::new(), recording: Some(recording) };
        let options = LoopOptions {
            begin_ns,
            warm_up_steps: WARM_UP_STEPS,
            metered_from_ns: metered_ns,
            held_level: options.level,
        };
        let (live, _handover) = LiveLoop::start(parts, clock, options)?;
        Ok(Self { live, metered_ns })
    }

    /// Lets it run until the end, and hands on what comes out of the queues.
    fn watch(
        mut self,
        seconds: u32,
        events: &mut LoopEvents,
        empty: &mut impl FnMut() -> Capacity,
    ) -> Result<EndedRun, LatencyError> {
        let end = self.metered_ns + u64::from(seconds) * SECOND_NS;
        while self.live.now_ns() < end && self.live.threads.look()?.is_none() {
            thread::sleep(LOOK);
            drain(&mut self.live.queues, events);
            empty();
        }
        let mut queues = self.live.queues;
        let ended = self.live.threads.end();
        let sensor = ended.sensor.ok_or(LatencyError::Died("sensor"))?;
        let physics = ended.physics.ok_or(LatencyError::Died("physics"))?;
        let render = ended.render.ok_or(LatencyError::Died("render"))?.render;
        drain(&mut queues, events);
        Ok(EndedRun { sensor, physics, render, queues: [queues.events.capacity(), empty()] })
    }
}

/// Runs the loop for so long; `empty` is called fifty times a second and at the end, to empty the recording's queue, and says how full it was.
///
/// # Errors
/// Where a thread cannot be started or ends before its time.
pub fn run(
    inputs: LatencyInputs<'_>,
    options: &LatencyOptions,
    mut empty: impl FnMut() -> Capacity,
) -> Result<Latency, LatencyError> {
    let load = LoadThreads::start(options.load)?;
    let jitter = jitter::measure(Duration::from_secs(u64::from(options.seconds.min(MOST_JITTER_S))))?;
    let is_camera = matches!(inputs.source, LatencySource::Camera(_));
    let worker = inputs.worker.clone();
    let running = MeteredLoop::start(inputs, options)?;
    let placements = running.live.threads.placements().iter().cloned().chain(worker);
    let threads: Vec<ThreadPlacement> = placements.map(ThreadPlacement::from).collect();
    let mut events = LoopEvents::default();
    let ended = running.watch(options.seconds, &mut events, &mut empty)?;
    drop(load);
    let snapshot_us = if is_camera { CAMERA_SNAPSHOT_US } else { SNAPSHOT_US };
    Ok(report(&ended, options, threads, events, &jitter, snapshot_us))
}

/// What it comes to.
fn report(
    ended: &EndedRun,
    options: &LatencyOptions,
    threads: Vec<ThreadPlacement>,
    events: LoopEvents,
    jitter: &Meter,
    snapshot_us: f64,
) -> Latency {
    let EndedRun { physics, render, queues, .. } = ended;
    let (gauges, frame) = (&physics.gauges, &physics.stepper.scene.scene().world);
    let stages = stages(ended, jitter, snapshot_us);
    let [step, response] = [&gauges.step, &gauges.response].map(Quantiles::of);
    let [snapshot, total] = [&gauges.reaction, &render.total].map(Quantiles::of);
    let own = render.renderer.figures().map(|(figures, _)| figures);
    let capacities = capacity::capacities(queues, gauges, frame);
    let mut warnings = capacity::warnings(&capacities, frame);
    warnings.extend(threads.iter().flat_map(|t| t.refused.clone()));
    warnings.extend(events.sentences);
    Latency {
        seconds: options.seconds,
        load_threads: options.load,
        workers: frame.settings().workers,
        threads,
        stages_us: stages.iter().map(|s| (s.name, s.us)).collect(),
        stages,
        total_us: total,
        snapshot_us: snapshot,
        step_us: step,
        response_us: response,
        jitter_us: Quantiles::of(jitter),
        steps: gauges.steps,
        deadline_misses: gauges.missed + gauges.dropped,
        dropped: gauges.dropped,
        attributed: events.late.attributed(),
        frames: snapshot.count + gauges.skipped,
        late_frames: later_than(&gauges.reaction, snapshot_us) + gauges.skipped,
        pictures: render.pictures,
        quality: quality(frame, &gauges.level_steps, events.changes),
        goals: goals(snapshot_us, snapshot, total, step, response, own.as_ref()),
        own_picture: own,
        capacities: capacities.into_iter().map(QueueUse::from).collect(),
        warnings,
        state_hash: format!("{:016x}", frame.state_hash()),
    }
}

/// From the sensor to the picture, then the whole of it, then the machine.
fn stages(ended: &EndedRun, jitter: &Meter, snapshot_us: f64) -> Vec<LatencyStage> {
    let EndedRun { sensor, physics, render, .. } = ended;
    let (gauges, meters) = (&physics.gauges, physics.stepper.scene.scene().world.meters());
    let mut stages = vec![
        LatencyStage::of("filter", Some(FILTER_US), &sensor.filtering),
        LatencyStage::of("wait for a step", Some(PERIOD_NS / 1_000), &gauges.wait),
        LatencyStage::of(STAGES[INTAKE].name, Some(STAGES[INTAKE].budget_us), &gauges.intake),
    ];
    let own = STAGES.iter().zip(&meters.stages).skip(INTAKE + 1);
    stages.extend(own.map(|(stage, meter)| LatencyStage::of(stage.name, Some(stage.budget_us), meter)));
    stages.push(LatencyStage::of("step", Some(STEP_BUDGET_US), &gauges.step));
    stages.push(LatencyStage::of("snapshot", Some(snapshot_us as u64), &gauges.reaction));
    stages.push(LatencyStage::of("wait for a picture", None, &render.picture));
    stages.push(LatencyStage::of("picture", None, &render.drawing));
    stages.push(LatencyStage::of("total", Some(PICTURE_US as u64), &render.total));
    if let Some((_, [stamp, drawing])) = render.renderer.figures() {
        stages.push(LatencyStage::of("own picture", None, drawing));
        stages.push(LatencyStage::of("stamp to own picture", Some(OWN_PICTURE_US as u64), stamp));
    }
    stages.push(LatencyStage::of("empty loop", None, jitter));
    stages
}

/// How many times of a meter are longer than this (us).
fn later_than(meter: &Meter, us: f64) -> u64 {
    let late = meter.histogram().iter_recorded().filter(|v| v.value_iterated_to() as f64 * 1e-3 > us);
    late.map(|v| v.count_since_last_iteration()).sum()
}

fn goals(
    snapshot_us: f64,
    snapshot: Quantiles,
    total: Quantiles,
    step: Quantiles,
    response: Quantiles,
    own: Option<&OwnPictureFigures>,
) -> Vec<Goal> {
    let period_us = PERIOD_NS as f64 * 1e-3;
    let own = own.map(|own| Goal::new("own picture after its stamp, p99", OWN_PICTURE_US, own.stamp_us.p99));
    let goals = vec![
        Goal::new("snapshot after a sensor frame's arrival, p99", snapshot_us, snapshot.p99),
        Goal::new("picture after a sensor frame was seen, p99", PICTURE_US, total.p99),
        Goal::new("step, p99.9", 0.5 * period_us, step.p999),
        Goal::new("step, longest", 0.8 * period_us, step.max),
        Goal::new("published after it was due (120 Hz held), p99.9", period_us, response.p999),
    ];
    goals.into_iter().chain(own).collect()
}

/// Empties the queues. What happened before the meters began does not count.
fn drain(queues: &mut LoopQueues, events: &mut LoopEvents) {
    while let Some(event) = queues.events.pop() {
        if event.tick >= WARM_UP_STEPS {
            events.take(&event);
        }
    }
    while queues.step_reports.pop().is_some() {}
    while queues.frames.pop().is_some() {}
}

fn quality(frame: &World, levels: &[u64], changes: Vec<[u64; 3]>) -> QualityFigures {
    let (meters, settings) = (frame.meters(), frame.settings());
    let strain = meters.strain();
    let whole = frame.garments().iter().map(|g| settings.quality.substeps(g.substeps)).max().unwrap_or(0);
    let free = |g: &Garment| g.inverse_mass.iter().filter(|w| **w > 0.0).count();
    QualityFigures {
        name: settings.quality.name(),
        substeps: whole,
        particles: frame.garments().iter().map(Garment::particles).sum(),
        free: frame.garments().iter().map(free).sum(),
        rungs: levels.to_vec(),
        gives_up: QUALITY_LEVELS.iter().map(|r| r.gives_up).collect(),
        changes,
        strain: [strain.mean, strain.p99, strain.max].map(f64::from),
        penetration_mm: f64::from(meters.penetration_max) * 1e3,
        nonfinite: frame.cloths().iter().map(|c| c.events.rolled_back).sum(),
    }
}
