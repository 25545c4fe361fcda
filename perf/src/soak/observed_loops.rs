//! The loop's own threads, each with what the soak does to it and asks of it: it stalls when the scenario says so, its
//! allocations are counted, and it reports what it did.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;

use toile_base::filter::Filter;
use toile_engine::clock::Clock;
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::physics_thread::{LoopScene, WorldScene};
use toile_engine::frame_loop::queue::Sender;
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::frame_loop::sensor_thread::{FrameSource, SensorThread};
use toile_engine::meter::PERIOD_NS;
use toile_engine::world::Snapshot;
use toile_fitting::live::assembly::{PhysicsLoop, RenderLoop};
use toile_fitting::live::lateness::ThreadAccount;
use toile_fitting::live::running::Restart;

use super::fault_kind::FaultKind;
use super::scenario::Scenario;

/// Allocations of the calling thread so far.
pub type Allocations = fn() -> u64;

/// Observations that wait to be looked at: three seconds of all loops.
pub const OBSERVATIONS: usize = 1_024;

/// Name of this capacity in reports and warnings.
pub const OBSERVATIONS_NAME: &str = "OBSERVATIONS (queue of what the loops did)";

/// Time between two looks of a dead renderer at whether it is to begin again (ns).
const DEAD_NS: u64 = 5_000_000;

/// Every so many vertices of the skin are looked at in a picture; the garments all.
const SKIN_STEP: usize = 4;

/// What a loop did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Observation {
    /// A step was taken.
    Step(ObservedStep),
    /// A picture was taken at a time, of a snapshot of another (ns).
    Picture([u64; 2]),
    /// The recorder had nothing left to write (ns).
    Wrote(u64),
    /// The thread that makes scenes took a turn (ns).
    SceneMaker(u64),
    /// It began to try broken garments, and was through with them (ns).
    Refused([u64; 2]),
}

/// A step as it was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObservedStep {
    /// When it was due (ns).
    pub scheduled_ns: u64,
    /// When it was published (ns).
    pub ended_ns: u64,
    /// When the newest sensor frame in it was taken (ns).
    pub seen_ns: u64,
    /// Mean distance of its joints from the shopper's (m); `None` without a shopper.
    pub off_m: Option<f32>,
    /// Positions and bones of the published state that are not finite.
    pub nonfinite: u64,
    /// Whether a garment was rolled back or kept its last places.
    pub rolled_back: bool,
    /// Speed of the fastest particle (m/s).
    pub fastest_m_s: f32,
}

impl ObservedStep {
    /// Whether it was published within its period.
    pub fn in_time(&self) -> bool {
        self.ended_ns - self.scheduled_ns <= PERIOD_NS
    }

    /// Whether the solver gave what can be shown.
    pub fn is_sound(&self) -> bool {
        self.nonfinite == 0 && !self.rolled_back
    }
}

/// A loop that reports what it did in its last turn.
pub trait ObservedLoop: ThreadLoop {
    /// What it did, if there is something to report.
    fn observation(&mut self) -> Option<Observation>;
}

/// A loop under the scenario.
#[derive(Debug)]
pub struct ScriptedLoop<T, C> {
    /// The loop that is scripted.
    pub inner: T,
    /// Allocations in its turns.
    pub allocations: u64,
    clock: C,
    /// When it does nothing (ns on the loop's clock).
    stalls: Box<[[u64; 2]]>,
    count: Option<Allocations>,
    observations: Sender<Observation>,
}

/// What every loop needs besides itself.
#[derive(Debug, Clone)]
pub struct RunContext<C> {
    /// What happens in the run, and when.
    pub scenario: Arc<Scenario>,
    /// The loop's clock.
    pub clock: C,
    /// When the run begins (ns).
    pub origin_ns: u64,
    /// Counter of allocations; none where they are not counted.
    pub count: Option<Allocations>,
}

impl<T, C: Clock + Clone> ScriptedLoop<T, C> {
    /// A loop that stalls as a kind says. At load.
    pub fn new(inner: T, stall: FaultKind, context: &RunContext<C>, observations: Sender<Observation>) -> Self {
        let at = |ns: u64| context.origin_ns + ns;
        let stalls = context.scenario.faults_of(stall).map(|f| [at(f.from_ns), at(f.until_ns)]).collect();
        Self { inner, allocations: 0, clock: context.clock.clone(), stalls, count: context.count, observations }
    }
}

impl<T: ObservedLoop, C: Clock> ThreadLoop for ScriptedLoop<T, C> {
    fn run_due(&mut self) -> Option<u64> {
        let now = self.clock.now_ns();
        let begun = self.stalls.partition_point(|[from, _]| *from <= now);
        if let Some([_, until]) = self.stalls[..begun].last().filter(|[_, until]| now < *until) {
            return Some(*until);
        }
        let before = self.count.map(|count| count());
        let next = self.inner.run_due();
        if let Some((count, before)) = self.count.zip(before) {
            self.allocations += count() - before;
        }
        if let Some(observation) = self.inner.observation() {
            self.observations.push(observation);
        }
        next
    }
}

impl<S: FrameSource, F: Filter, C: Clock> ObservedLoop for SensorThread<S, F, C> {
    fn observation(&mut self) -> Option<Observation> {
        None
    }
}

/// The physics, looked at behind each step.
#[derive(Debug)]
pub struct ObservedPhysics<C> {
    /// The physics loop that is observed.
    pub physics: PhysicsLoop<WorldScene, C, ThreadAccount>,
    scenario: Arc<Scenario>,
    origin_ns: u64,
    ticks: u64,
    fault_counts: [u64; 2],
    crash_ns: Option<u64>,
    /// When garments are spoilt (ns), and how many times they were.
    spoils: Box<[u64]>,
    spoilt: usize,
}

impl<C: Clock> ObservedPhysics<C> {
    /// Observes this loop. Called at load: it allocates.
    pub fn new(physics: PhysicsLoop<WorldScene, C, ThreadAccount>, scenario: Arc<Scenario>, origin_ns: u64) -> Self {
        let fault_counts = physics.stepper.scene.fault_counts();
        let spoils = scenario.faults_of(FaultKind::ClothSpoilt).map(|f| origin_ns + f.from_ns).collect();
        Self { fault_counts, physics, scenario, origin_ns, ticks: 0, crash_ns: None, spoils, spoilt: 0 }
    }

    /// Panics at a time (ns), to see what a crash leaves.
    pub fn crash_at(&mut self, at_ns: Option<u64>) {
        self.crash_ns = at_ns;
    }

    /// Mean distance of a step's joints from where the shopper is at its end (m).
    fn off(&self, scheduled_ns: u64) -> Option<f32> {
        let now = (scheduled_ns + PERIOD_NS).saturating_sub(self.origin_ns);
        let at = self.scenario.visit_at(now)?.joints(now);
        let joints = self.physics.stepper.joints_for(scheduled_ns).joints;
        let sum: f32 = joints.iter().zip(&at).map(|(joint, at)| joint.position.distance(*at)).sum();
        Some(sum / at.len() as f32)
    }
}

/// Positions and bones of what a frame publishes that are not finite.
fn nonfinite(scene: &WorldScene) -> u64 {
    let pose = scene.world.pose();
    let bones = pose.local.iter().filter(|q| !q.is_finite()).count() + usize::from(!pose.root.is_finite());
    let cloths = scene.world.cloths().iter();
    (bones + cloths.map(|c| c.positions.iter().filter(|p| !p.is_finite()).count()).sum::<usize>()) as u64
}

/// Speed of the fastest particle (m/s); NaN is faster than all.
fn fastest(scene: &WorldScene) -> f32 {
    let cloths = scene.world.cloths().iter();
    let squares = cloths.flat_map(|cloth| (0..cloth.positions.len()).map(|i| cloth.velocity(i).length_squared()));
    squares.fold(0.0f32, |most, square| if square <= most { most } else { square }).sqrt()
}

impl<C: Clock> ThreadLoop for ObservedPhysics<C> {
    fn run_due(&mut self) -> Option<u64> {
        let crashes = self.crash_ns.is_some_and(|at| self.physics.taken().scheduled_ns >= at);
        assert!(!crashes, "the crash that --crash-after asked for");
        if self.spoils.get(self.spoilt).is_some_and(|at| *at <= self.physics.now_ns()) {
            self.physics.inject_fault(self.scenario.plan.seed.wrapping_add(self.spoilt as u64));
            self.spoilt += 1;
        }
        self.physics.run_due()
    }
}

impl<C: Clock> ObservedLoop for ObservedPhysics<C> {
    fn observation(&mut self) -> Option<Observation> {
        if self.physics.ticks() == self.ticks {
            return None;
        }
        self.ticks = self.physics.ticks();
        let (taken, stepper) = (self.physics.taken(), &self.physics.stepper);
        let fault_counts = stepper.scene.fault_counts();
        // Those of a scene that was just handed over are less.
        let before = std::mem::replace(&mut self.fault_counts, fault_counts);
        Some(Observation::Step(ObservedStep {
            scheduled_ns: taken.scheduled_ns,
            ended_ns: taken.ended_ns,
            seen_ns: stepper.seen_ns(),
            off_m: self.off(taken.scheduled_ns),
            nonfinite: nonfinite(stepper.scene.scene()),
            rolled_back: fault_counts[0] > before[0] || fault_counts[1] > before[1],
            fastest_m_s: fastest(stepper.scene.scene()),
        }))
    }
}

/// A renderer that looks at what it would draw.
#[derive(Debug, Default)]
pub struct CheckingRenderer {
    /// Positions and normals of the snapshots that are not finite.
    pub nonfinite: u64,
    published_ns: u64,
}

impl Renderer for CheckingRenderer {
    type Outfit = ();

    fn set_outfit(&mut self, _outfit: &mut ()) {}

    fn draw(&mut self, snapshot: &Snapshot) {
        let skin = (0..snapshot.skin.vertices()).step_by(SKIN_STEP);
        let skin = skin.filter(|v| !(snapshot.skin.position(*v).is_finite() && snapshot.skin.normal(*v).is_finite()));
        let garments = snapshot.garments.iter().flatten().filter(|p| !p.is_finite());
        self.nonfinite += (skin.count() + garments.count()) as u64;
        self.published_ns = snapshot.times.published_ns;
    }
}

/// The render thread, which panics when the scenario says so.
pub struct ObservedRender<C> {
    /// The render loop that is observed.
    pub render: RenderLoop<CheckingRenderer, C>,
    clock: C,
    panics: Box<[u64]>,
    next: usize,
    pictures: u64,
}

impl<C: Clock + Clone> ObservedRender<C> {
    /// Observes this loop. Called at load: it allocates.
    pub fn new(render: RenderLoop<CheckingRenderer, C>, context: &RunContext<C>) -> Self {
        let panics =
            context.scenario.faults_of(FaultKind::RenderPanic).map(|f| context.origin_ns + f.from_ns).collect();
        Self { render, clock: context.clock.clone(), panics, next: 0, pictures: 0 }
    }
}

impl<C: Clock + Clone> Restart for ObservedRender<C> {
    fn restarted(self) -> Self {
        Self { render: self.render.restarted(), ..self }
    }
}

impl<C: Clock> ThreadLoop for ObservedRender<C> {
    fn run_due(&mut self) -> Option<u64> {
        let now = self.clock.now_ns();
        if self.panics.get(self.next).is_some_and(|at| *at <= now) {
            self.next += 1;
            // Past the hook, which would take it for a fault of the program's own.
            resume_unwind(Box::new("a panic of the scenario"));
        }
        self.render.run_due()
    }
}

impl<C: Clock> ObservedLoop for ObservedRender<C> {
    fn observation(&mut self) -> Option<Observation> {
        let render = &self.render.render;
        let news = render.pictures > self.pictures;
        self.pictures = render.pictures;
        news.then(|| Observation::Picture([self.clock.now_ns(), render.renderer.published_ns]))
    }
}

impl<C: Clock + Clone> Restart for ScriptedLoop<ObservedRender<C>, C> {
    fn restarted(self) -> Self {
        Self { inner: self.inner.restarted(), ..self }
    }
}

/// Whether the renderer runs, where there is no thread to ask.
#[derive(Debug, Default)]
pub struct RenderHealth {
    /// Whether the loop has panicked.
    pub dead: AtomicBool,
    /// It is to begin again.
    pub revive: AtomicBool,
}

/// The renderer on the simulated clock: a panic ends it until it is begun again.
pub struct RestartableRender<C> {
    /// It; none for the moment in which it begins again.
    pub render: Option<ScriptedLoop<ObservedRender<C>, C>>,
    /// What the watch sees of it. Relaxed: one thread plays all parts.
    pub health: Arc<RenderHealth>,
    clock: C,
}

impl<C: Clock + Clone> RestartableRender<C> {
    /// Makes this loop restartable. Called at load: it allocates.
    pub fn new(render: ScriptedLoop<ObservedRender<C>, C>, clock: C) -> Self {
        Self { render: Some(render), health: Arc::default(), clock }
    }
}

impl<C: Clock + Clone> ThreadLoop for RestartableRender<C> {
    fn run_due(&mut self) -> Option<u64> {
        if self.health.dead.load(Relaxed) {
            if !self.health.revive.swap(false, Relaxed) {
                return Some(self.clock.now_ns() + DEAD_NS);
            }
            self.render = self.render.take().map(Restart::restarted);
            self.health.dead.store(false, Relaxed);
        }
        let render = self.render.as_mut()?;
        match catch_unwind(AssertUnwindSafe(|| render.run_due())) {
            Ok(next) => next,
            Err(_) => {
                self.health.dead.store(true, Relaxed);
                Some(self.clock.now_ns() + DEAD_NS)
            }
        }
    }
}
