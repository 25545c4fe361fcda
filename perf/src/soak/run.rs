//! Puts the loops together and runs them, one after the other on a simulated clock or each on its thread.

use std::fs::File;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use toile_base::clock::SECOND_NS;
use toile_engine::clock::{Clock, SimClock};
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::physics_thread::WorldScene;
use toile_engine::frame_loop::queue::{Capacity, bounded};
use toile_engine::frame_loop::recording::{ENTRIES, ENTRIES_NAME, Entry};
use toile_engine::frame_loop::simulate::{MAX_SIMULATED, simulate};
use toile_engine::frame_loop::thread_roles::{self, RolePlacement, ThreadRole};
use toile_engine::frame_loop::threads::{self, Stop};
use toile_engine::meter::PERIOD_NS;
use toile_fitting::heap::HeapProbe;
use toile_fitting::live::assembly::{Assembly, LoopOptions, LoopParts, LoopQueues, SensorLoop, assemble};
use toile_fitting::live::lateness::ThreadAccount;
use toile_fitting::live::running::{EndedLoops, Loops, RunningLoop};
use toile_fitting::live::scene_changer::DressedScene;

use super::camera::ScenarioCamera;
use super::depth_camera::{self, CameraLoop, SoakSource};
use super::error::SoakError;
use super::fault_kind::FaultKind;
use super::fault_monitor::{FaultMonitor, JumpClock, JumpableClock};
use super::observed_loops::{
    Allocations, CheckingRenderer, OBSERVATIONS, OBSERVATIONS_NAME, Observation, ObservedPhysics, ObservedRender,
    RestartableRender, RunContext, ScriptedLoop,
};
use super::options::{SoakCamera, SoakOptions};
use super::recorder::RecorderLoop;
use super::scenario::Scenario;
use super::scene_loop::SceneLoop;
use super::scene_maker::SceneMaker;

/// Time between two looks at what the process holds (ns): simulated, and in real time.
const SAMPLE_NS: [u64; 2] = [60 * SECOND_NS, 5 * SECOND_NS];

/// Length of the slices between which progress is reported (ns).
const SLICE_NS: u64 = 300 * SECOND_NS;

/// Time between two turns of the fault monitor in real time.
const WATCH: Duration = Duration::from_millis(5);

/// What the program lends to a run.
pub struct SoakTools<'a> {
    /// Reads how much of the heap is in use.
    pub heap: HeapProbe,
    /// Counts the allocations of the calling thread.
    pub count: Option<Allocations>,
    /// Where the run is recorded.
    pub file: Option<File>,
    /// The begin of a recording.
    pub header: Vec<u8>,
    /// Is handed the flight recorder before the first step, to save it should something die.
    pub keep: &'a dyn Fn(&Arc<FlightRecorder>),
    /// Is given how far the run is (s).
    pub progress: &'a dyn Fn(u64),
    /// The physics thread panics after so long (ns): to see what a crash leaves.
    pub crash_ns: Option<u64>,
}

/// What a run came to.
pub struct SoakRun {
    /// What was to happen.
    pub scenario: Arc<Scenario>,
    /// Steps that were taken.
    pub steps: u64,
    /// Steps that were not published in their period, or dropped.
    pub missed: u64,
    /// A hash over the hashes of the states of all steps.
    pub hash: u64,
    /// Allocations in the turns of sensor, physics and renderer.
    pub allocations: Option<[u64; 3]>,
    /// Positions, bones and normals of published states and pictures that are not finite.
    pub nonfinite: u64,
    /// Scenes that were handed over.
    pub changes: u64,
    /// Sensor frames: published, with a stamp that was not believed, no newer than the one before.
    pub frames: [u64; 3],
    /// Pictures, and times that the renderer was restarted.
    pub pictures: [u64; 2],
    /// Writes of the recording that the disk refused, and bytes written.
    pub disk: [u64; 2],
    /// Broken garments refused and accepted.
    pub broken: [u64; 2],
    /// What the fault monitor found.
    pub(super) monitor: MonitorFindings,
    /// How full every queue was.
    pub capacities: Vec<Capacity>,
    /// Where the threads ran.
    pub threads: Vec<RolePlacement>,
    /// What deserves attention.
    pub warnings: Vec<String>,
    /// Time that it took (s).
    pub wall_s: f64,
}

/// What the fault monitor found.
pub(super) struct MonitorFindings {
    pub outcomes: Vec<super::fault_monitor::FaultOutcome>,
    pub steps: super::fault_monitor::StepTotals,
    pub samples: Vec<super::memory::MemorySample>,
}

/// The loops, before they run.
struct SoakLoops<C: Clock> {
    /// The depth camera on the simulated clock, where there is one.
    camera: Option<CameraLoop<C>>,
    sensor: ScriptedLoop<SensorLoop<SoakSource<C>, C>, C>,
    physics: ScriptedLoop<ObservedPhysics<C>, C>,
    render: ScriptedLoop<ObservedRender<C>, C>,
    recorder: ScriptedLoop<RecorderLoop<C>, C>,
    scenes: ScriptedLoop<SceneLoop<C>, C>,
    monitor: FaultMonitor<C>,
    queues: LoopQueues,
    flight_recorder: Arc<FlightRecorder>,
    worker: Option<RolePlacement>,
}

/// Runs it.
///
/// # Errors
/// Too many faults, a first scene that cannot be made, and a thread that ends before its time.
pub fn run(options: &SoakOptions, tools: &SoakTools<'_>) -> Result<SoakRun, SoakError> {
    let scenario = Arc::new(Scenario::write(options.plan)?);
    let (origin, begun) = (options.uptime_hours * 3_600 * SECOND_NS, Instant::now());
    let ran = if options.real_time {
        let clock = JumpClock::starting_at(origin);
        real(SoakLoops::new(options, scenario, &clock, tools)?, options, tools)
    } else {
        let clock = SimClock::starting_at(origin);
        Ok(simulated(SoakLoops::new(options, scenario, &clock, tools)?, &clock, options, tools))
    };
    ran.map(|ran| SoakRun { wall_s: begun.elapsed().as_secs_f64(), ..ran })
}

impl<C: JumpableClock + Clone + Send + Sync + 'static> SoakLoops<C> {
    fn new(
        options: &SoakOptions,
        scenario: Arc<Scenario>,
        clock: &C,
        tools: &SoakTools<'_>,
    ) -> Result<Self, SoakError> {
        let mut scene_maker = SceneMaker::new(scenario.clone());
        let (frame, reader) = scene_maker.make(0)?;
        let (frame, worker) = if options.workers > 1 {
            let (crew, worker) = threads::worker_pool(options.workers, ThreadRole::Physics)
                .map_err(toile_engine::world::WorldError::from)?;
            (frame.with_workers(crew), worker)
        } else {
            (frame, None)
        };
        // Making the first scene took its time.
        let origin_ns = clock.now_ns() + 4 * PERIOD_NS;
        let context = RunContext { scenario: scenario.clone(), clock: clock.clone(), origin_ns, count: tools.count };
        let (recording, entries) = bounded(ENTRIES_NAME, ENTRIES);
        let scene = WorldScene::new(frame);
        let first = DressedScene { scene, reader, outfit: (), still: None, note: None, number: None };
        let (source, camera, watch) = match (options.plan.camera, options.real_time) {
            (SoakCamera::Joints, _) => {
                (SoakSource::Joints(ScenarioCamera::new(scenario.clone(), clock.clone(), origin_ns)), None, None)
            }
            (SoakCamera::Depth, false) => {
                let (camera, source, watch) = depth_camera::simulated(&scenario, clock, origin_ns)?;
                (source, Some(camera), Some(watch))
            }
            (SoakCamera::Depth, true) => {
                let (source, watch) = depth_camera::live(&scenario, clock, origin_ns)?;
                (source, None, Some(watch))
            }
        };
        let renderer = CheckingRenderer::default();
        let parts = LoopParts { first, renderer, source, account: ThreadAccount::new(), recording: Some(recording) };
        let assembly = assemble(parts, clock, LoopOptions { begin_ns: origin_ns, ..LoopOptions::default() });
        let Assembly { loops, queues, handover } = assembly;
        let mut stepping = ObservedPhysics::new(loops.physics, scenario, origin_ns);
        stepping.crash_at(tools.crash_ns.map(|ns| origin_ns + ns));
        let flight_recorder = Arc::new(FlightRecorder::new(tools.header.clone(), entries));
        let file = tools.file.as_ref().map(File::try_clone).transpose()?;
        let mut recorder = RecorderLoop::new(context.clone(), flight_recorder.clone(), file, &tools.header);
        let first = Entry::Changed { number: 0, afresh: true };
        flight_recorder.keep(&first);
        recorder.take(&first);
        (tools.keep)(&flight_recorder);
        let mut observations = Vec::new();
        let mut queue = || {
            let (to, from) = bounded::<Observation>(OBSERVATIONS_NAME, OBSERVATIONS);
            observations.push(from);
            to
        };
        let sensor = ScriptedLoop::new(loops.sensor, FaultKind::SensorStall, &context, queue());
        let physics = ScriptedLoop::new(stepping, FaultKind::PhysicsStall, &context, queue());
        let render =
            ScriptedLoop::new(ObservedRender::new(loops.render, &context), FaultKind::RenderStall, &context, queue());
        let recorder = ScriptedLoop::new(recorder, FaultKind::RecorderStall, &context, queue());
        let scenes = SceneLoop::new(context.clone(), scene_maker, handover);
        let scenes = ScriptedLoop::new(scenes, FaultKind::SceneStall, &context, queue());
        let every = SAMPLE_NS[usize::from(options.real_time)];
        let mut monitor = FaultMonitor::new(context, observations, tools.heap, every);
        monitor.camera = watch;
        Ok(Self { camera, sensor, physics, render, recorder, scenes, monitor, queues, flight_recorder, worker })
    }

    /// What they came to, once they have ended.
    fn ended(mut self, threads: Vec<RolePlacement>) -> SoakRun {
        self.recorder.inner.look();
        self.monitor.close();
        let count = self.monitor.context().count;
        let (sense, stepping, showing) = (&self.sensor.inner, &self.physics.inner, &self.render.inner);
        let gauges = &stepping.physics.gauges;
        // The fullest of the queues of observations stands for all.
        let observations = self.monitor.capacities().reduce(|a, b| Capacity {
            high_water: a.high_water.max(b.high_water),
            lost: a.lost + b.lost,
            ..a
        });
        let mut capacities = vec![self.queues.events.capacity(), self.flight_recorder.capacity()];
        capacities.extend(observations);
        let mut warnings: Vec<String> = capacities.iter().filter_map(Capacity::warning).collect();
        warnings.extend(self.recorder.inner.trouble.clone());
        warnings.extend(self.scenes.inner.trouble.clone());
        warnings.extend(threads.iter().flat_map(|t| t.refused.clone()));
        let steps = self.monitor.steps;
        SoakRun {
            scenario: self.monitor.context().scenario.clone(),
            steps: stepping.physics.ticks(),
            missed: gauges.missed + gauges.dropped,
            hash: self.recorder.inner.hash,
            allocations: count.map(|_| [self.sensor.allocations, self.physics.allocations, self.render.allocations]),
            nonfinite: steps.nonfinite + showing.render.render.renderer.nonfinite,
            changes: self.scenes.inner.changes(),
            frames: [sense.frames(), sense.restamped, sense.stale],
            pictures: [showing.render.render.pictures, self.monitor.revived],
            disk: [self.recorder.inner.refused, self.recorder.inner.written],
            broken: [self.scenes.inner.refused, self.scenes.inner.accepted],
            monitor: MonitorFindings { outcomes: self.monitor.outcomes, steps, samples: self.monitor.samples },
            capacities,
            threads,
            warnings,
            wall_s: 0.0,
        }
    }
}

/// One after the other.
fn simulated(loops: SoakLoops<SimClock>, clock: &SimClock, options: &SoakOptions, tools: &SoakTools<'_>) -> SoakRun {
    let SoakLoops {
        mut camera,
        mut sensor,
        mut physics,
        render,
        mut recorder,
        mut scenes,
        mut monitor,
        mut queues,
        flight_recorder,
        worker,
    } = loops;
    let mut restartable = RestartableRender::new(render, clock.clone());
    monitor.health = Some(restartable.health.clone());
    let end = monitor.context().origin_ns + options.plan.seconds * SECOND_NS;
    let mut until = monitor.context().origin_ns;
    while until < end {
        until = end.min(until + SLICE_NS);
        let mut emptied = QueueDrain(&mut queues, clock.clone());
        let mut all: Vec<&mut dyn ThreadLoop> = Vec::with_capacity(MAX_SIMULATED);
        all.extend(camera.as_mut().map(|camera| camera as &mut dyn ThreadLoop));
        let others: [&mut dyn ThreadLoop; 7] =
            [&mut sensor, &mut physics, &mut restartable, &mut recorder, &mut scenes, &mut monitor, &mut emptied];
        all.extend(others);
        simulate(clock, &mut all, until);
        (tools.progress)((until - monitor.context().origin_ns) / SECOND_NS);
    }
    let Some(render) = restartable.render else { unreachable!("it is taken only within a turn") };
    SoakLoops { camera, sensor, physics, render, recorder, scenes, monitor, queues, flight_recorder, worker }
        .ended(Vec::new())
}

/// Empties the queues, whose readers in a kiosk do not run here.
struct QueueDrain<'a>(&'a mut LoopQueues, SimClock);

impl ThreadLoop for QueueDrain<'_> {
    fn run_due(&mut self) -> Option<u64> {
        empty(self.0);
        Some(self.1.now_ns() + SECOND_NS / 10)
    }
}

fn empty(queues: &mut LoopQueues) {
    while queues.events.pop().is_some() {}
    while queues.step_reports.pop().is_some() {}
    while queues.frames.pop().is_some() {}
}

/// A loop beside those of the kiosk, placed as a service.
fn beside<T: ThreadLoop + Send + 'static>(
    name: &str,
    mut inner: T,
    clock: JumpClock,
    stop: Stop,
) -> Result<JoinHandle<T>, SoakError> {
    let live = move || {
        thread_roles::apply(ThreadRole::Service);
        while !stop.is_set() {
            let Some(next) = inner.run_due() else { break };
            clock.sleep_until(next.min(clock.now_ns() + SECOND_NS / 20));
        }
        inner
    };
    Ok(thread::Builder::new().name(format!("toile-{name}")).spawn(live)?)
}

/// Each on its thread; the fault monitor on this one.
fn real(loops: SoakLoops<JumpClock>, options: &SoakOptions, tools: &SoakTools<'_>) -> Result<SoakRun, SoakError> {
    let SoakLoops {
        camera: _,
        sensor,
        physics,
        render,
        recorder,
        scenes,
        mut monitor,
        mut queues,
        flight_recorder,
        worker,
    } = loops;
    let (clock, stop) = (monitor.context().clock.clone(), Stop::default());
    let mut threads = RunningLoop::start(Loops { sensor, physics, render }, clock.clone())?;
    let recorder = beside("record", recorder, clock.clone(), stop.clone())?;
    let scenes = beside("scenes", scenes, clock.clone(), stop.clone())?;
    let placed: Vec<RolePlacement> = threads.placements().iter().cloned().chain(worker).collect();
    let end = monitor.context().origin_ns + options.plan.seconds * SECOND_NS;
    let mut reported = 0;
    while clock.now_ns() < end {
        thread::sleep(WATCH);
        monitor.run_due();
        empty(&mut queues);
        if let Some(role) = threads.look()? {
            return Err(SoakError::Died(role.name()));
        }
        monitor.revived = threads.revived();
        let seconds = clock.now_ns().saturating_sub(monitor.context().origin_ns) / SECOND_NS;
        if seconds >= reported + 60 {
            reported = seconds;
            (tools.progress)(seconds);
        }
    }
    stop.now();
    let died = SoakError::Died;
    let EndedLoops { sensor, physics, render } = threads.end();
    let physics = physics.ok_or(died("physics"))?;
    let sensor = sensor.ok_or(died("sensor"))?;
    let render = render.ok_or(died("render"))?;
    let recorder = recorder.join().map_err(|_| died("recorder"))?;
    let scenes = scenes.join().map_err(|_| died("scene"))?;
    let loops = SoakLoops {
        camera: None,
        sensor,
        physics,
        render,
        recorder,
        scenes,
        monitor,
        queues,
        flight_recorder,
        worker: None,
    };
    Ok(loops.ended(placed))
}
