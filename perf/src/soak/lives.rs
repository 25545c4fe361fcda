//! Lives: the loop's own, each with what the soak does to it and asks of it: it stalls when the script says so, its allocations are
//! counted, and it tells what it did.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;

use toile_engine::clock::Clock;
use toile_engine::frame::Snapshot;
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::event::NoCounters;
use toile_engine::frame_loop::physics_thread::{FrameScene, Scene};
use toile_engine::frame_loop::queue::Sender;
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::frame_loop::sensor_thread::{FrameSource, SensorThread};
use toile_engine::meter::PERIOD_NS;
use toile_fitting::live::assembly::{PhysicsLoop, RenderLoop};
use toile_fitting::live::running::Restart;

use super::script::{Kind, Script};

/// Allocations of the calling thread so far.
pub type Allocations = fn() -> u64;

/// Signs that wait to be looked at: three seconds of all lives.
pub const SIGNS: usize = 1_024;

/// The name of the bound, as warnings give it.
pub const SIGNS_NAME: &str = "SIGNS (perf/src/soak/lives.rs)";

/// Time between two looks of a dead life at whether it is to live again (ns).
const DEAD_NS: u64 = 5_000_000;

/// Every so many vertices of the skin are looked at in a picture; the garments all.
const SKIN_STEP: usize = 4;

/// What a life did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sign {
    /// A step.
    Step(Stepped),
    /// A picture was taken at a time, of a snapshot of another (ns).
    Picture([u64; 2]),
    /// The recorder had nothing left to write (ns).
    Wrote(u64),
    /// The front took a turn (ns).
    Front(u64),
    /// The front began to try broken garments, and was through with them (ns).
    Refused([u64; 2]),
}

/// A step as it was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepped {
    /// When it was due, and when it was published (ns).
    pub scheduled_ns: u64,
    /// See above.
    pub ended_ns: u64,
    /// When the newest sensor frame in it was taken (ns).
    pub seen_ns: u64,
    /// Mean distance of its joints from the shopper's (m); none where nobody is there.
    pub off_m: Option<f32>,
    /// Numbers of the published state that are none.
    pub nonfinite: u64,
    /// Whether a garment was rolled back or kept its last places.
    pub rolled_back: bool,
    /// Speed of the fastest particle (m/s).
    pub fastest_m_s: f32,
}

impl Stepped {
    /// Whether it was published within its period.
    pub fn in_time(&self) -> bool {
        self.ended_ns - self.scheduled_ns <= PERIOD_NS
    }

    /// Whether the solver gave what can be shown.
    pub fn is_sound(&self) -> bool {
        self.nonfinite == 0 && !self.rolled_back
    }
}

/// A life that can be asked what it did in its last turn.
pub trait Telling: ThreadLoop {
    /// What it did, if there is something to tell.
    fn sign(&mut self) -> Option<Sign>;
}

/// A life under the script.
#[derive(Debug)]
pub struct Lived<T, C> {
    /// The life.
    pub life: T,
    /// Allocations in its turns.
    pub allocations: u64,
    clock: C,
    /// When it does nothing (ns on the loop's clock).
    stalls: Box<[[u64; 2]]>,
    count: Option<Allocations>,
    signs: Sender<Sign>,
}

/// What every life needs besides itself.
#[derive(Debug, Clone)]
pub struct Ground<C> {
    /// The script.
    pub script: Arc<Script>,
    /// The loop's clock.
    pub clock: C,
    /// When the run begins (ns).
    pub origin_ns: u64,
    /// Counts allocations.
    pub count: Option<Allocations>,
}

impl<T, C: Clock + Clone> Lived<T, C> {
    /// A life that stalls as a kind says. At load.
    pub fn new(life: T, stall: Kind, ground: &Ground<C>, signs: Sender<Sign>) -> Self {
        let at = |ns: u64| ground.origin_ns + ns;
        let stalls = ground.script.faults_of(stall).map(|f| [at(f.from_ns), at(f.until_ns)]).collect();
        Self { life, allocations: 0, clock: ground.clock.clone(), stalls, count: ground.count, signs }
    }
}

impl<T: Telling, C: Clock> ThreadLoop for Lived<T, C> {
    fn run_due(&mut self) -> Option<u64> {
        let now = self.clock.now_ns();
        let begun = self.stalls.partition_point(|[from, _]| *from <= now);
        if let Some([_, until]) = self.stalls[..begun].last().filter(|[_, until]| now < *until) {
            return Some(*until);
        }
        let before = self.count.map(|count| count());
        let next = self.life.run_due();
        if let Some((count, before)) = self.count.zip(before) {
            self.allocations += count() - before;
        }
        if let Some(sign) = self.life.sign() {
            self.signs.push(sign);
        }
        next
    }
}

impl<S: FrameSource, C: Clock> Telling for SensorThread<S, C> {
    fn sign(&mut self) -> Option<Sign> {
        None
    }
}

/// The physics, looked at behind each step.
#[derive(Debug)]
pub struct Stepping<C> {
    /// The loop's own.
    pub physics: PhysicsLoop<FrameScene, C, NoCounters>,
    script: Arc<Script>,
    origin_ns: u64,
    ticks: u64,
    troubles: [u64; 2],
    crash_ns: Option<u64>,
    /// When garments are spoilt (ns), and how many times they were.
    upsets: Box<[u64]>,
    upset: usize,
}

impl<C: Clock> Stepping<C> {
    /// At load.
    pub fn new(physics: PhysicsLoop<FrameScene, C, NoCounters>, script: Arc<Script>, origin_ns: u64) -> Self {
        let troubles = physics.stepper.scene.troubles();
        let upsets = script.faults_of(Kind::ClothUpset).map(|f| origin_ns + f.from_ns).collect();
        Self { troubles, physics, script, origin_ns, ticks: 0, crash_ns: None, upsets, upset: 0 }
    }

    /// Panics at a time (ns), to see what a crash leaves.
    pub fn crash_at(&mut self, at_ns: Option<u64>) {
        self.crash_ns = at_ns;
    }

    /// Mean distance of a step's joints from where the shopper is at its end (m).
    fn off(&self, scheduled_ns: u64) -> Option<f32> {
        let now = (scheduled_ns + PERIOD_NS).saturating_sub(self.origin_ns);
        let at = self.script.visit_at(now)?.joints(now);
        let joints = self.physics.stepper.joints_for(scheduled_ns).joints;
        let sum: f32 = joints.iter().zip(&at).map(|(joint, at)| joint.position.distance(*at)).sum();
        Some(sum / at.len() as f32)
    }
}

/// Numbers of what a frame publishes that are none.
fn nonfinite(scene: &FrameScene) -> u64 {
    let pose = scene.frame.pose();
    let bones = pose.local.iter().filter(|q| !q.is_finite()).count() + usize::from(!pose.root.is_finite());
    let cloths = scene.frame.cloths().iter();
    (bones + cloths.map(|c| c.positions.iter().filter(|p| !p.is_finite()).count()).sum::<usize>()) as u64
}

/// Speed of the fastest particle (m/s); one that is no number is faster than all.
fn fastest(scene: &FrameScene) -> f32 {
    let cloths = scene.frame.cloths().iter();
    let squares = cloths.flat_map(|cloth| (0..cloth.positions.len()).map(|i| cloth.velocity(i).length_squared()));
    squares.fold(0.0f32, |most, square| if square <= most { most } else { square }).sqrt()
}

impl<C: Clock> ThreadLoop for Stepping<C> {
    fn run_due(&mut self) -> Option<u64> {
        let crashes = self.crash_ns.is_some_and(|at| self.physics.taken().scheduled_ns >= at);
        assert!(!crashes, "the crash that --crash-after asked for");
        if self.upsets.get(self.upset).is_some_and(|at| *at <= self.physics.now_ns()) {
            self.physics.inject_fault(self.script.plan.seed.wrapping_add(self.upset as u64));
            self.upset += 1;
        }
        self.physics.run_due()
    }
}

impl<C: Clock> Telling for Stepping<C> {
    fn sign(&mut self) -> Option<Sign> {
        if self.physics.ticks() == self.ticks {
            return None;
        }
        self.ticks = self.physics.ticks();
        let (taken, stepper) = (self.physics.taken(), &self.physics.stepper);
        let troubles = stepper.scene.troubles();
        // Those of a scene that was just handed over are less.
        let before = std::mem::replace(&mut self.troubles, troubles);
        Some(Sign::Step(Stepped {
            scheduled_ns: taken.scheduled_ns,
            ended_ns: taken.ended_ns,
            seen_ns: stepper.seen_ns(),
            off_m: self.off(taken.scheduled_ns),
            nonfinite: nonfinite(stepper.scene.scene()),
            rolled_back: troubles[0] > before[0] || troubles[1] > before[1],
            fastest_m_s: fastest(stepper.scene.scene()),
        }))
    }
}

/// Who looks at pictures.
#[derive(Debug, Default)]
pub struct Eyewitness {
    /// Numbers of the snapshots that are none.
    pub nonfinite: u64,
    published_ns: u64,
}

impl Renderer for Eyewitness {
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

/// The renderer, who dies when the script says so.
pub struct Showing<C> {
    /// The loop's own.
    pub render: RenderLoop<Eyewitness, C>,
    clock: C,
    deaths: Box<[u64]>,
    next: usize,
    pictures: u64,
}

impl<C: Clock + Clone> Showing<C> {
    /// At load.
    pub fn new(render: RenderLoop<Eyewitness, C>, ground: &Ground<C>) -> Self {
        let deaths = ground.script.faults_of(Kind::RenderDeath).map(|f| ground.origin_ns + f.from_ns).collect();
        Self { render, clock: ground.clock.clone(), deaths, next: 0, pictures: 0 }
    }
}

impl<C: Clock + Clone> Restart for Showing<C> {
    fn restarted(self) -> Self {
        Self { render: self.render.restarted(), ..self }
    }
}

impl<C: Clock> ThreadLoop for Showing<C> {
    fn run_due(&mut self) -> Option<u64> {
        let now = self.clock.now_ns();
        if self.deaths.get(self.next).is_some_and(|at| *at <= now) {
            self.next += 1;
            // Past the hook, which would take it for a fault of the program's own.
            resume_unwind(Box::new("a death of the script"));
        }
        self.render.run_due()
    }
}

impl<C: Clock> Telling for Showing<C> {
    fn sign(&mut self) -> Option<Sign> {
        let render = &self.render.render;
        let news = render.pictures > self.pictures;
        self.pictures = render.pictures;
        news.then(|| Sign::Picture([self.clock.now_ns(), render.renderer.published_ns]))
    }
}

impl<C: Clock + Clone> Restart for Lived<Showing<C>, C> {
    fn restarted(self) -> Self {
        Self { life: self.life.restarted(), ..self }
    }
}

/// Whether the renderer lives, where there is no thread to ask.
#[derive(Debug, Default)]
pub struct Pulse {
    /// It has died.
    pub dead: AtomicBool,
    /// It is to live again.
    pub revive: AtomicBool,
}

/// The renderer on the simulated clock: a panic ends it until somebody has it begin again.
pub struct Mortal<C> {
    /// It; none for the moment in which it begins again.
    pub lived: Option<Lived<Showing<C>, C>>,
    /// What the watch sees of it. Relaxed: one thread plays all parts.
    pub pulse: Arc<Pulse>,
    clock: C,
}

impl<C: Clock + Clone> Mortal<C> {
    /// At load.
    pub fn new(lived: Lived<Showing<C>, C>, clock: C) -> Self {
        Self { lived: Some(lived), pulse: Arc::default(), clock }
    }
}

impl<C: Clock + Clone> ThreadLoop for Mortal<C> {
    fn run_due(&mut self) -> Option<u64> {
        if self.pulse.dead.load(Relaxed) {
            if !self.pulse.revive.swap(false, Relaxed) {
                return Some(self.clock.now_ns() + DEAD_NS);
            }
            self.lived = self.lived.take().map(Restart::restarted);
            self.pulse.dead.store(false, Relaxed);
        }
        let lived = self.lived.as_mut()?;
        match catch_unwind(AssertUnwindSafe(|| lived.run_due())) {
            Ok(next) => next,
            Err(_) => {
                self.pulse.dead.store(true, Relaxed);
                Some(self.clock.now_ns() + DEAD_NS)
            }
        }
    }
}
