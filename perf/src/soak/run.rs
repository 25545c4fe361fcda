//! Run: puts the lives together and lets them live, one after the other on a simulated clock or each on its thread.

use std::fs::File;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use toile_engine::clock::{Clock, SimClock};
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::event::NoCounters;
use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::physics_thread::FrameScene;
use toile_engine::frame_loop::queue::{Capacity, bounded};
use toile_engine::frame_loop::recording::{ENTRIES, ENTRIES_NAME, Entry};
use toile_engine::frame_loop::simulate::simulate;
use toile_engine::frame_loop::thread_roles::Placement;
use toile_engine::frame_loop::threads::{self, Stop};
use toile_engine::meter::PERIOD_NS;
use toile_fitting::live::assembly::{Assembly, LoopOptions, LoopParts, LoopQueues, SensorLoop, assemble};
use toile_fitting::live::running::{EndedLoops, Loops, RunningLoop};
use toile_fitting::live::scene_changer::DressedScene;
use toile_sensors::clock::SECOND_NS;

use super::camera::Camera;
use super::company::Company;
use super::front::Front;
use super::lives::{Allocations, Eyewitness, Ground, Lived, Mortal, SIGNS, SIGNS_NAME, Showing, Sign, Stepping};
use super::recorder::Recorder;
use super::script::{Kind, Script};
use super::watch::{JumpClock, Jumping, Watch};
use super::{Options, SoakError};
use toile_fitting::heap::HeapProbe;

/// Time between two looks at what the process holds (ns): simulated, and in real time.
const SAMPLE_NS: [u64; 2] = [60 * SECOND_NS, 5 * SECOND_NS];

/// Length of the slices between which progress is told (ns).
const SLICE_NS: u64 = 300 * SECOND_NS;

/// Time between two turns of the watch in real time.
const WATCH: Duration = Duration::from_millis(5);

/// What the program lends to a run.
pub struct Tools<'a> {
    /// Reads the heap.
    pub heap: HeapProbe,
    /// Counts the allocations of the calling thread.
    pub count: Option<Allocations>,
    /// Where the run is recorded.
    pub file: Option<File>,
    /// The begin of a recording.
    pub header: Vec<u8>,
    /// Is handed the black box before the first step, to save it should something die.
    pub keep: &'a dyn Fn(&Arc<FlightRecorder>),
    /// Is told how far the run is (s).
    pub progress: &'a dyn Fn(u64),
    /// The physics thread panics after so long (ns): to see what a crash leaves.
    pub crash_ns: Option<u64>,
}

/// What the lives came to.
pub struct Ran {
    /// What happened by plan.
    pub script: Arc<Script>,
    /// Steps, those that were not published in their period or dropped, and a hash over the hashes of their states.
    pub steps: u64,
    /// See above.
    pub missed: u64,
    /// See above.
    pub hash: u64,
    /// Allocations in the turns of sensor, physics and renderer.
    pub allocations: Option<[u64; 3]>,
    /// Numbers of published states and pictures that are none.
    pub nonfinite: u64,
    /// Scenes that were handed over.
    pub changes: u64,
    /// Sensor frames: published, with a stamp that was not believed, no newer than the one before.
    pub frames: [u64; 3],
    /// Pictures, and times that the renderer was made to live again.
    pub pictures: [u64; 2],
    /// Writes of the recording that the disk refused, and bytes written.
    pub disk: [u64; 2],
    /// Broken garments refused and accepted.
    pub broken: [u64; 2],
    /// What the watch saw.
    pub(super) watch: Seen,
    /// How full every queue was.
    pub capacities: Vec<Capacity>,
    /// Where the threads ran.
    pub threads: Vec<Placement>,
    /// What deserves attention.
    pub warnings: Vec<String>,
    /// Time that it took (s).
    pub wall_s: f64,
}

/// What the watch saw.
pub(super) struct Seen {
    pub outcomes: Vec<super::watch::Outcome>,
    pub steps: super::watch::Steps,
    pub samples: Vec<super::memory::Sample>,
}

/// The lives, before they live.
struct Lives<C: Clock> {
    sensor: Lived<SensorLoop<Camera<C>, C>, C>,
    physics: Lived<Stepping<C>, C>,
    render: Lived<Showing<C>, C>,
    recorder: Lived<Recorder<C>, C>,
    front: Lived<Front<C>, C>,
    watch: Watch<C>,
    queues: LoopQueues,
    black_box: Arc<FlightRecorder>,
    worker: Option<Placement>,
}

/// Runs it.
///
/// # Errors
/// Too many faults, a first scene that cannot be made, and a thread that ends before its time.
pub fn run(options: &Options, tools: &Tools<'_>) -> Result<Ran, SoakError> {
    let script = Arc::new(Script::write(options.plan)?);
    let (origin, begun) = (options.uptime_hours * 3_600 * SECOND_NS, Instant::now());
    let ran = if options.real_time {
        let clock = JumpClock::starting_at(origin);
        real(Lives::new(options, script, clock, tools)?, options, tools)
    } else {
        let clock = SimClock::starting_at(origin);
        Ok(simulated(Lives::new(options, script, clock.clone(), tools)?, &clock, options, tools))
    };
    ran.map(|ran| Ran { wall_s: begun.elapsed().as_secs_f64(), ..ran })
}

impl<C: Jumping + Clone + Send> Lives<C> {
    fn new(options: &Options, script: Arc<Script>, clock: C, tools: &Tools<'_>) -> Result<Self, SoakError> {
        let mut company = Company::new(script.clone());
        let (frame, reader) = company.make(0)?;
        let (frame, worker) = if options.workers > 1 {
            let (crew, worker) =
                threads::worker_pool(options.workers).map_err(toile_engine::frame::FrameError::from)?;
            (frame.with_workers(crew), worker)
        } else {
            (frame, None)
        };
        // Making the first scene took its time.
        let origin_ns = clock.now_ns() + 4 * PERIOD_NS;
        let ground = Ground { script: script.clone(), clock: clock.clone(), origin_ns, count: tools.count };
        let (recording, entries) = bounded(ENTRIES_NAME, ENTRIES);
        let scene = FrameScene::new(frame);
        let first = DressedScene { scene, reader, outfit: (), still: None, note: None, number: None };
        let source = Camera::new(script.clone(), clock.clone(), origin_ns);
        let renderer = Eyewitness::default();
        let parts = LoopParts { first, renderer, source, account: NoCounters, recording: Some(recording) };
        let assembly = assemble(parts, &clock, LoopOptions { begin_ns: origin_ns, ..LoopOptions::default() });
        let Assembly { loops, queues, handover } = assembly;
        let mut stepping = Stepping::new(loops.physics, script, origin_ns);
        stepping.crash_at(tools.crash_ns.map(|ns| origin_ns + ns));
        let black_box = Arc::new(FlightRecorder::new(tools.header.clone(), entries));
        let file = tools.file.as_ref().map(File::try_clone).transpose()?;
        let mut recorder = Recorder::new(ground.clone(), black_box.clone(), file, &tools.header);
        let first = Entry::Changed { number: 0, afresh: true };
        black_box.keep(&first);
        recorder.take(&first);
        (tools.keep)(&black_box);
        let mut signs = Vec::new();
        let mut told = || {
            let (to, from) = bounded::<Sign>(SIGNS_NAME, SIGNS);
            signs.push(from);
            to
        };
        let sensor = Lived::new(loops.sensor, Kind::SensorStall, &ground, told());
        let physics = Lived::new(stepping, Kind::PhysicsStall, &ground, told());
        let render = Lived::new(Showing::new(loops.render, &ground), Kind::RenderStall, &ground, told());
        let recorder = Lived::new(recorder, Kind::RecorderStall, &ground, told());
        let front = Front::new(ground.clone(), company, handover);
        let front = Lived::new(front, Kind::FrontStall, &ground, told());
        let every = SAMPLE_NS[usize::from(options.real_time)];
        let watch = Watch::new(ground, signs, tools.heap, every);
        Ok(Self { sensor, physics, render, recorder, front, watch, queues, black_box, worker })
    }

    /// What they came to, when they have ended.
    fn ended(mut self, threads: Vec<Placement>) -> Ran {
        self.recorder.life.look();
        self.watch.close();
        let count = self.watch.ground().count;
        let (sense, stepping, showing) = (&self.sensor.life, &self.physics.life, &self.render.life);
        let gauges = &stepping.physics.gauges;
        // The fullest of the queues of signs stands for all.
        let signs = self.watch.capacities().reduce(|a, b| Capacity {
            high_water: a.high_water.max(b.high_water),
            lost: a.lost + b.lost,
            ..a
        });
        let mut capacities = vec![self.queues.events.capacity(), self.black_box.capacity()];
        capacities.extend(signs);
        let mut warnings: Vec<String> = capacities.iter().filter_map(Capacity::warning).collect();
        warnings.extend(self.recorder.life.trouble.clone());
        warnings.extend(self.front.life.trouble.clone());
        warnings.extend(threads.iter().flat_map(|t| t.refused.clone()));
        let steps = self.watch.steps;
        Ran {
            script: self.watch.ground().script.clone(),
            steps: stepping.physics.ticks(),
            missed: gauges.missed + gauges.dropped,
            hash: self.recorder.life.hash,
            allocations: count.map(|_| [self.sensor.allocations, self.physics.allocations, self.render.allocations]),
            nonfinite: steps.nonfinite + showing.render.render.renderer.nonfinite,
            changes: self.front.life.changes(),
            frames: [sense.frames(), sense.restamped, sense.stale],
            pictures: [showing.render.render.pictures, self.watch.revived],
            disk: [self.recorder.life.refused, self.recorder.life.written],
            broken: [self.front.life.refused, self.front.life.accepted],
            watch: Seen { outcomes: self.watch.outcomes, steps, samples: self.watch.samples },
            capacities,
            threads,
            warnings,
            wall_s: 0.0,
        }
    }
}

/// One after the other.
fn simulated(lives: Lives<SimClock>, clock: &SimClock, options: &Options, tools: &Tools<'_>) -> Ran {
    let Lives { mut sensor, mut physics, render, mut recorder, mut front, mut watch, mut queues, black_box, worker } =
        lives;
    let mut mortal = Mortal::new(render, clock.clone());
    watch.pulse = Some(mortal.pulse.clone());
    let end = watch.ground().origin_ns + options.plan.seconds * SECOND_NS;
    let mut until = watch.ground().origin_ns;
    while until < end {
        until = end.min(until + SLICE_NS);
        let mut emptied = Emptied(&mut queues, clock.clone());
        let all: &mut [&mut dyn ThreadLoop] =
            &mut [&mut sensor, &mut physics, &mut mortal, &mut recorder, &mut front, &mut watch, &mut emptied];
        simulate(clock, all, until);
        (tools.progress)((until - watch.ground().origin_ns) / SECOND_NS);
    }
    let Some(render) = mortal.lived else { unreachable!("it is taken only within a turn") };
    Lives { sensor, physics, render, recorder, front, watch, queues, black_box, worker }.ended(Vec::new())
}

/// Empties the queues, whose readers in a kiosk do not run here.
struct Emptied<'a>(&'a mut LoopQueues, SimClock);

impl ThreadLoop for Emptied<'_> {
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

/// A life beside the loop, on a thread without a role.
fn beside<T: ThreadLoop + Send + 'static>(
    name: &str,
    mut life: T,
    clock: JumpClock,
    stop: Stop,
) -> Result<JoinHandle<T>, SoakError> {
    let live = move || {
        while !stop.is_set() {
            let Some(next) = life.run_due() else { break };
            clock.sleep_until(next.min(clock.now_ns() + SECOND_NS / 20));
        }
        life
    };
    Ok(thread::Builder::new().name(format!("toile-{name}")).spawn(live)?)
}

/// Each on its thread; the watch on this one.
fn real(lives: Lives<JumpClock>, options: &Options, tools: &Tools<'_>) -> Result<Ran, SoakError> {
    let Lives { sensor, physics, render, recorder, front, mut watch, mut queues, black_box, worker } = lives;
    let (clock, stop) = (watch.ground().clock.clone(), Stop::default());
    let mut threads = RunningLoop::start(Loops { sensor, physics, render }, clock.clone())?;
    let recorder = beside("record", recorder, clock.clone(), stop.clone())?;
    let front = beside("front", front, clock.clone(), stop.clone())?;
    let placed: Vec<Placement> = threads.placements().iter().cloned().chain(worker).collect();
    let end = watch.ground().origin_ns + options.plan.seconds * SECOND_NS;
    let mut told = 0;
    while clock.now_ns() < end {
        thread::sleep(WATCH);
        watch.run_due();
        empty(&mut queues);
        if let Some(role) = threads.look()? {
            return Err(SoakError::Died(role.name()));
        }
        watch.revived = threads.revived();
        let seconds = clock.now_ns().saturating_sub(watch.ground().origin_ns) / SECOND_NS;
        if seconds >= told + 60 {
            told = seconds;
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
    let front = front.join().map_err(|_| died("front"))?;
    let lives = Lives { sensor, physics, render, recorder, front, watch, queues, black_box, worker: None };
    Ok(lives.ended(placed))
}
