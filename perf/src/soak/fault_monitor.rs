//! Injects the faults that no loop brings about itself, looks at what the loops report, and measures how long each fault
//! takes to be over.

use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

use toile_base::clock::SECOND_NS;
use toile_engine::clock::{Clock, RealClock, SimClock};
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::queue::{Capacity, Receiver};
use toile_engine::meter::PERIOD_NS;
use toile_fitting::heap::HeapProbe;
use toile_sensors::source::live::CameraState;
use toile_sensors::source::live::fault_injection::CameraFault;

use super::depth_camera::CameraWatch;
use super::fault_kind::{FaultKind, RecoverySign};
use super::memory::MemorySample;
use super::observed_loops::{Observation, ObservedStep, RenderHealth, RunContext};
use super::scenario::SoakFault;

/// A step follows the shopper whose joints are this far from theirs on average (m): twice what they are at worst while nothing is
/// wrong, which the report says.
const FOLLOWS_M: f32 = 0.08;

/// No particle of cloth that a person moves is faster (m/s): a hand that strikes out reaches this.
const CALM_M_S: f32 = 10.0;

/// A fault that is not over after this time does not count as recovered (ns).
const GIVEN_UP_NS: u64 = 5 * SECOND_NS;

/// Time between two looks (ns): a dead renderer is seen within it.
const LOOK_NS: u64 = 10_000_000;

/// What memory pressure takes (bytes).
const PRESSURE_BYTES: usize = 64 << 20;

/// A clock that can be made to jump ahead.
pub trait JumpableClock: Clock {
    /// Jumps ahead by this much (ns).
    fn jump(&self, ns: u64);
}

impl JumpableClock for SimClock {
    fn jump(&self, ns: u64) {
        self.spend(ns);
    }
}

/// The system's clock, plus what it was made to jump.
#[derive(Debug, Clone)]
pub struct JumpClock {
    real: RealClock,
    ahead: SimClock,
}

impl JumpClock {
    /// One that shows so much now (ns).
    pub fn starting_at(ns: u64) -> Self {
        Self { real: RealClock::starting_at(ns), ahead: SimClock::default() }
    }
}

impl Clock for JumpClock {
    fn now_ns(&self) -> u64 {
        self.real.now_ns() + self.ahead.now_ns()
    }

    fn sleep_until(&self, ns: u64) {
        self.real.sleep_until(ns.saturating_sub(self.ahead.now_ns()));
    }
}

impl JumpableClock for JumpClock {
    fn jump(&self, ns: u64) {
        self.ahead.spend(ns);
    }
}

/// A fault that is over, or was given up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaultOutcome {
    /// What kind of fault it was.
    pub kind: FaultKind,
    /// From its end to what shows that it is over (ns); none where nothing did.
    pub recovered_ns: Option<u64>,
    /// From its begin until the camera was known to see nothing (ns); none where it never was, and of what blinds no camera.
    pub noticed_ns: Option<u64>,
}

/// A fault that is not over.
#[derive(Debug, Clone, Copy)]
struct OpenFault {
    fault: SoakFault,
    /// Whether the broken files were refused.
    refused: bool,
    noticed_ns: Option<u64>,
}

impl OpenFault {
    fn ended(&self, recovered_ns: Option<u64>) -> FaultOutcome {
        FaultOutcome { kind: self.fault.kind, recovered_ns, noticed_ns: self.noticed_ns }
    }
}

/// What steps came to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StepTotals {
    /// Positions and bones of published states that are not finite.
    pub nonfinite: u64,
    /// Steps in a row that were rolled back or not finite, at most.
    pub unsound: u64,
    unsound_now: u64,
    /// Furthest that joints were from the shopper's while nothing was wrong (m).
    pub off_m: f32,
}

/// The fault monitor, a loop of its own.
pub struct FaultMonitor<C> {
    context: RunContext<C>,
    observations: Vec<Receiver<Observation>>,
    heap: HeapProbe,
    /// The next fault of the scenario, and those that are not over.
    next: usize,
    open: Vec<OpenFault>,
    /// What became of those that are.
    pub outcomes: Vec<FaultOutcome>,
    /// What steps came to.
    pub steps: StepTotals,
    /// What the process held, from time to time.
    pub samples: Vec<MemorySample>,
    every_ns: u64,
    sampled_ns: u64,
    pressure: Option<(u64, Vec<u8>)>,
    /// When nothing that was wrong is to be seen any more (ns).
    calm_ns: u64,
    /// The renderer, where there is no thread to ask.
    pub health: Option<Arc<RenderHealth>>,
    /// How often it was restarted.
    pub revived: u64,
    /// Tells how the depth camera stands, where there is one.
    pub camera: Option<CameraWatch>,
}

/// Time after a fault, and after a shopper came, in which joints may be off (ns).
const CALM_NS: u64 = 3 * SECOND_NS;

impl<C: JumpableClock> FaultMonitor<C> {
    /// At load; a sample is taken every so often (ns).
    pub fn new(
        context: RunContext<C>,
        observations: Vec<Receiver<Observation>>,
        heap: HeapProbe,
        every_ns: u64,
    ) -> Self {
        let outcomes = Vec::with_capacity(context.scenario.faults.len());
        let samples = Vec::with_capacity((context.scenario.plan.seconds * SECOND_NS / every_ns) as usize + 2);
        Self {
            observations,
            heap,
            next: 0,
            open: Vec::with_capacity(8),
            outcomes,
            steps: StepTotals::default(),
            samples,
            every_ns,
            sampled_ns: 0,
            pressure: None,
            calm_ns: CALM_NS,
            health: None,
            revived: 0,
            camera: None,
            context,
        }
    }

    /// What all loops have in common.
    pub fn context(&self) -> &RunContext<C> {
        &self.context
    }

    /// Time since the begin (ns).
    fn now(&self) -> u64 {
        self.context.clock.now_ns().saturating_sub(self.context.origin_ns)
    }

    /// Begins the faults that are due.
    fn begin(&mut self) {
        while let Some(fault) = self.context.scenario.faults.get(self.next).filter(|f| f.from_ns <= self.now()).copied()
        {
            self.next += 1;
            match fault.kind {
                FaultKind::ClockJump => self.context.clock.jump(fault.until_ns.saturating_sub(self.now())),
                FaultKind::MemoryPressure => {
                    // Written to, so that the system has to find it.
                    self.pressure = Some((fault.until_ns, vec![1; PRESSURE_BYTES]));
                }
                _ => {}
            }
            self.open.push(OpenFault { fault, refused: false, noticed_ns: None });
        }
        self.pressure
            .take_if(|(until, _)| *until <= self.context.clock.now_ns().saturating_sub(self.context.origin_ns));
    }

    fn look(&mut self) {
        for i in 0..self.observations.len() {
            while let Some(observation) = self.observations[i].pop() {
                if let Observation::Step(step) = &observation {
                    let calm = self.calm(step.scheduled_ns);
                    self.steps.take(step, calm);
                }
                self.recover(&observation);
            }
        }
        let (now, outcomes) = (self.now(), &mut self.outcomes);
        self.open.retain(|open| {
            let waits = now < open.fault.until_ns + GIVEN_UP_NS;
            if !waits {
                outcomes.push(open.ended(None));
            }
            waits
        });
    }

    /// Looks at how the depth camera stands: one that is known to see nothing is a fault that was noticed.
    fn watch_camera(&mut self) {
        let Some(camera) = &self.camera else { return };
        let (now, state) = (self.now(), camera());
        if matches!(state, CameraState::Seeing | CameraState::Starting) {
            return;
        }
        let blind = |fault: &SoakFault| fault.kind.camera_fault().is_some_and(CameraFault::is_blind);
        for open in self.open.iter_mut().filter(|open| blind(&open.fault)) {
            open.noticed_ns.get_or_insert(now.saturating_sub(open.fault.from_ns));
        }
    }

    /// Whether nothing was wrong at a step and long before it, and no shopper had just come.
    fn calm(&mut self, scheduled_ns: u64) -> bool {
        // Of the time that the step's joints are for.
        let at = (scheduled_ns + PERIOD_NS).saturating_sub(self.context.origin_ns);
        let came = self.context.scenario.visit_at(at).is_some_and(|v| at < v.from_ns + CALM_NS);
        if came || !self.open.is_empty() || self.pressure.is_some() {
            self.calm_ns = at + CALM_NS;
        }
        at >= self.calm_ns
    }

    /// Closes the faults that an observation shows to be over.
    fn recover(&mut self, observation: &Observation) {
        let (origin, outcomes) = (self.context.origin_ns, &mut self.outcomes);
        self.open.retain_mut(|open| {
            let until = origin + open.fault.until_ns;
            let over = over(open.fault.kind.recovered_by(), until, &mut open.refused, observation);
            if let Some(at) = over {
                outcomes.push(open.ended(Some(at.saturating_sub(until))));
            }
            over.is_none()
        });
    }

    fn sample(&mut self) {
        if self.pressure.is_none() && self.now() >= self.sampled_ns {
            self.sampled_ns = self.now() + self.every_ns;
            let hours = self.now() as f64 / (3_600.0 * SECOND_NS as f64);
            self.samples.push(MemorySample::take(hours, &self.heap));
        }
    }

    fn revive(&mut self) {
        let Some(health) = &self.health else { return };
        if health.dead.load(Relaxed) && !health.revive.swap(true, Relaxed) {
            self.revived += 1;
        }
    }

    /// Ends: what is open yet is given up, unless its time had not come.
    pub fn close(&mut self) {
        self.look();
        let now = self.now();
        let late = self.open.drain(..).filter(|open| open.fault.until_ns + SECOND_NS <= now);
        self.outcomes.extend(late.map(|open| open.ended(None)));
    }

    /// How full the queues of observations were.
    pub fn capacities(&self) -> impl Iterator<Item = Capacity> {
        self.observations.iter().map(Receiver::capacity)
    }
}

/// When a fault that ended at `until` was over, if an observation shows it; `refused` keeps that its files were.
fn over(by: RecoverySign, until: u64, refused: &mut bool, observation: &Observation) -> Option<u64> {
    match (by, observation) {
        (RecoverySign::Following, Observation::Step(step)) => {
            let follows = step.seen_ns >= until && step.off_m.is_none_or(|off| off <= FOLLOWS_M);
            (follows && good(step, until)).then_some(step.ended_ns)
        }
        (RecoverySign::Calm, Observation::Step(step)) => {
            (step.fastest_m_s <= CALM_M_S && good(step, until)).then_some(step.ended_ns)
        }
        (RecoverySign::Step, Observation::Step(step)) => good(step, until).then_some(step.ended_ns),
        (RecoverySign::Refusal, Observation::Step(step)) => (*refused && good(step, until)).then_some(step.ended_ns),
        (RecoverySign::Refusal, Observation::Refused([begun, _])) => {
            *refused |= *begun >= until;
            None
        }
        (RecoverySign::Picture, Observation::Picture([taken, published])) => (*published >= until).then_some(*taken),
        (RecoverySign::Recording, Observation::Wrote(at)) | (RecoverySign::SceneMaker, Observation::SceneMaker(at)) => {
            (*at >= until).then_some(*at)
        }
        _ => None,
    }
}

/// Whether a step of after a time was in time and can be shown.
fn good(step: &ObservedStep, until: u64) -> bool {
    step.scheduled_ns >= until && step.in_time() && step.is_sound()
}

impl StepTotals {
    fn take(&mut self, step: &ObservedStep, calm: bool) {
        self.nonfinite += step.nonfinite;
        self.unsound_now = if step.is_sound() { 0 } else { self.unsound_now + 1 };
        self.unsound = self.unsound.max(self.unsound_now);
        if let Some(off) = step.off_m.filter(|_| calm) {
            self.off_m = self.off_m.max(off);
        }
    }
}

impl<C: JumpableClock> ThreadLoop for FaultMonitor<C> {
    fn run_due(&mut self) -> Option<u64> {
        self.begin();
        self.watch_camera();
        self.look();
        self.revive();
        self.sample();
        Some(self.context.clock.now_ns() + LOOK_NS)
    }
}
