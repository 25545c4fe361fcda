//! The physics thread: it steps the scene 120 times a second.

use toile_base::frame::Joints;
use toile_base::limits::STEP_HZ;

use super::ThreadLoop;
use super::event::{CounterSource, Counters, Event, EventKind, Miss, SENSOR_LOST_NS};
use super::handover::HandoverReceiver;
use super::loop_meters::LoopMeters;
use super::motion_input::MotionInput;
use super::quality_control::{QUALITY_LEVELS, QualityControl, QualityLevel};
use super::queue::Sender;
use super::recording::Entry;
use super::schedule::{Due, Schedule, Tick};
use super::sensor_thread::SensorFrame;
use crate::clock::Clock;
use crate::cloth::Settings;
use crate::meter::PERIOD_NS;
use crate::triple_buffer::Reader;
use crate::world::{SnapshotTimes, World};

/// Steps between two measurements of the error: ten a second, for they take as long as some substeps.
pub const MEASURE_EVERY: u64 = 12;

/// Most dropped steps whose lateness is metered one by one: ten seconds of them.
const MOST_TOLD: u64 = 10 * STEP_HZ as u64;

/// The scene that the loop steps: the world, or a stand-in of a test.
pub trait LoopScene {
    /// One step to where the joints are; publishes a snapshot with these times.
    fn step(&mut self, joints: &Joints, times: SnapshotTimes, clock: &impl Clock);

    /// The quality from the next step on.
    fn set_level(&mut self, level: &QualityLevel);

    /// What is measured behind a step, when there is time.
    fn measure(&mut self);

    /// Forgets what was metered so far.
    fn clear_meters(&mut self);

    /// A hash of the state.
    fn fingerprint(&self) -> u64;

    /// Spoils the state, for a run that tries what is borne.
    fn inject_fault(&mut self, _seed: u64) {}

    /// Takes over the workers of the scene before it.
    fn take_workers_from(&mut self, _before: &mut Self) {}

    /// Steps that a worker broke off, and steps that a garment rolled back, so far.
    fn fault_counts(&self) -> [u64; 2];
}

/// The world as the loop steps it.
#[derive(Debug)]
pub struct WorldScene {
    /// The world that is stepped.
    pub world: World,
    /// The settings of whole quality.
    whole: Settings,
}

impl WorldScene {
    /// At load, when the shopper is dressed.
    pub fn new(mut world: World) -> Self {
        world.measure_every(MEASURE_EVERY);
        Self { whole: *world.settings(), world }
    }
}

impl LoopScene for WorldScene {
    fn step(&mut self, joints: &Joints, times: SnapshotTimes, clock: &impl Clock) {
        self.world.step_at(joints, times, clock);
    }

    fn set_level(&mut self, level: &QualityLevel) {
        let Self { world, whole } = self;
        let settings = level.of(whole);
        world.set_quality(settings.substep_share, settings.wind);
        world.set_contact(settings.contact);
    }

    fn measure(&mut self) {
        self.world.measure();
    }

    fn clear_meters(&mut self) {
        self.world.clear_meters();
    }

    fn fingerprint(&self) -> u64 {
        self.world.fingerprint()
    }

    fn inject_fault(&mut self, seed: u64) {
        self.world.inject_fault(seed);
    }

    fn take_workers_from(&mut self, before: &mut Self) {
        self.world.swap_workers(&mut before.world);
    }

    fn fault_counts(&self) -> [u64; 2] {
        [self.world.broken(), self.world.cloths().iter().map(|c| c.events.rolled_back).sum()]
    }
}

/// A scene and its intake: what the loop and a replay both step, by the same function.
#[derive(Debug)]
pub struct SceneStepper<S> {
    /// The scene that is stepped.
    pub scene: S,
    intake: MotionInput,
    /// The newest sensor frame.
    newest: (u64, u64),
    level: u8,
}

impl<S: LoopScene> SceneStepper<S> {
    /// A scene that has not seen a person move yet.
    pub fn new(scene: S) -> Self {
        Self { scene, intake: MotionInput::default(), newest: (0, 0), level: 0 }
    }

    /// From the next step on. Levels beyond the last are clamped to it.
    pub fn set_level(&mut self, level: u8) {
        if level != self.level {
            self.level = level;
            self.scene.set_level(&QUALITY_LEVELS[usize::from(level).min(QUALITY_LEVELS.len() - 1)]);
        }
    }

    /// A sensor frame, for the step that is due at `scheduled_ns`.
    pub fn take(&mut self, seen: &SensorFrame, scheduled_ns: u64) {
        if self.intake.take(&seen.joints, end_of(scheduled_ns)) {
            self.newest = (seen.arrived_ns, seen.number);
        }
    }

    /// Changes the scene for another, which is set to the present level. With `afresh` another shopper comes, and no motion is
    /// carried on.
    pub fn change(&mut self, scene: &mut S, afresh: bool) {
        scene.take_workers_from(&mut self.scene);
        std::mem::swap(&mut self.scene, scene);
        self.scene.set_level(&QUALITY_LEVELS[usize::from(self.level).min(QUALITY_LEVELS.len() - 1)]);
        if afresh {
            (self.intake, self.newest) = (MotionInput::default(), (0, 0));
        }
    }

    /// The joints as a step that is due then (ns) would have them.
    pub fn joints_for(&self, scheduled_ns: u64) -> Joints {
        self.intake.at(end_of(scheduled_ns))
    }

    /// When the newest sensor frame was taken (ns); 0 is none.
    pub fn seen_ns(&self) -> u64 {
        self.intake.seen_ns().unwrap_or(0)
    }

    /// One step: the joints as they are at its end.
    pub fn step(&mut self, scheduled_ns: u64, begun_ns: u64, clock: &impl Clock) {
        let joints = self.intake.at(end_of(scheduled_ns));
        let (arrived_ns, frame) = self.newest;
        let seen_ns = self.intake.seen_ns().unwrap_or(0);
        self.scene.step(
            &joints,
            SnapshotTimes { seen_ns, arrived_ns, frame, scheduled_ns, begun_ns, published_ns: 0 },
            clock,
        );
    }
}

/// The time that a step's result is for (ns).
fn end_of(scheduled_ns: u64) -> u64 {
    scheduled_ns + PERIOD_NS
}

/// When a step was due, begun and published (ns).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StepTimes {
    /// When it was due.
    pub scheduled_ns: u64,
    /// When the step began (ns).
    pub begun_ns: u64,
    /// When it was published.
    pub ended_ns: u64,
}

/// The ends of what the physics writes to, beside the snapshots.
#[derive(Debug)]
pub struct PhysicsOutputs {
    /// Events of the loop, bounded.
    pub events: Sender<Event>,
    /// Entries that a replay needs; `None` without a recording.
    pub recording: Option<Sender<Entry>>,
}

/// What the physics thread runs.
#[derive(Debug)]
pub struct PhysicsThread<S, C, A> {
    /// The scene and its joints, which a replay steps too.
    pub stepper: SceneStepper<S>,
    /// Times and counts so far.
    pub gauges: LoopMeters,
    clock: C,
    schedule: Schedule,
    quality_control: QualityControl,
    seen: Reader<SensorFrame>,
    outlets: PhysicsOutputs,
    changes: Option<HandoverReceiver<S>>,
    taken: StepTimes,
    account: A,
    counters: Counters,
    /// Time without a core when it was last read (ns), and whether a step was late since.
    waited_ns: u64,
    is_wait_owed: bool,
    fault_counts: [u64; 2],
    /// Steps taken, and after how many the meters begin.
    tick: u64,
    warm_up: u64,
    /// Number of the last sensor frame, when it came, and whether there have been none for too long.
    last: u64,
    last_ns: u64,
    lost: bool,
}

impl<S: LoopScene, C: Clock, A: CounterSource> PhysicsThread<S, C, A> {
    /// At load; the first step is due at `origin_ns`.
    pub fn new(
        scene: S,
        clock: C,
        origin_ns: u64,
        seen: Reader<SensorFrame>,
        outlets: PhysicsOutputs,
        account: A,
    ) -> Self {
        Self {
            fault_counts: scene.fault_counts(),
            stepper: SceneStepper::new(scene),
            gauges: LoopMeters::default(),
            clock,
            schedule: Schedule::new(origin_ns, STEP_HZ),
            quality_control: QualityControl::default(),
            seen,
            outlets,
            changes: None,
            taken: StepTimes::default(),
            account,
            counters: Counters::default(),
            waited_ns: 0,
            is_wait_owed: false,
            tick: 0,
            warm_up: 0,
            last: 0,
            last_ns: origin_ns,
            lost: false,
        }
    }

    /// The same, whose meters begin after so many steps.
    #[must_use]
    pub fn warming_up(self, steps: u64) -> Self {
        Self { warm_up: steps, ..self }
    }

    /// The same, held on a quality level whatever happens.
    #[must_use]
    pub fn held_on(mut self, level: u8) -> Self {
        self.quality_control = QualityControl::held_on(level);
        self.stepper.set_level(self.quality_control.place());
        self
    }

    /// The same, whose scene is changed for those that are handed to it.
    #[must_use]
    pub fn changing(self, changes: HandoverReceiver<S>) -> Self {
        Self { changes: Some(changes), ..self }
    }

    /// Spoils the state before the next step, and records that.
    pub fn inject_fault(&mut self, seed: u64) {
        self.stepper.scene.inject_fault(seed);
        if let Some(recording) = &mut self.outlets.recording {
            recording.push(Entry::Fault(seed));
        }
    }

    /// Times of the last step.
    pub fn taken(&self) -> StepTimes {
        self.taken
    }

    /// The time on the loop's clock (ns).
    pub fn now_ns(&self) -> u64 {
        self.clock.now_ns()
    }

    /// Steps taken so far, the first ones included.
    pub fn ticks(&self) -> u64 {
        self.tick
    }

    /// Index of the quality level.
    pub fn level(&self) -> u8 {
        self.quality_control.place()
    }

    /// One step that is due.
    fn step(&mut self, due: Tick) {
        if self.tick == self.warm_up && self.tick > 0 {
            self.gauges.clear();
            self.stepper.scene.clear_meters();
        }
        let begun = self.clock.now_ns();
        self.drop_steps(&due, begun);
        self.change(due.scheduled_ns);
        let news = self.look(due.scheduled_ns, begun);
        self.gauges.intake.add(self.clock.now_ns() - begun);
        self.stepper.step(due.scheduled_ns, begun, &self.clock);
        let ended = self.clock.now_ns();
        self.taken = StepTimes { scheduled_ns: due.scheduled_ns, begun_ns: begun, ended_ns: ended };
        let counted = self.count();
        self.meter(&due, begun, ended, news);
        let miss = Miss {
            total_ns: ended - due.scheduled_ns,
            late_ns: begun - due.scheduled_ns,
            step_ns: ended - begun,
            counted,
        };
        if miss.total_ns > PERIOD_NS {
            self.gauges.missed += 1;
            self.is_wait_owed = true;
            self.send_event(due.scheduled_ns, EventKind::Missed(miss));
        }
        self.record(due.scheduled_ns);
        self.control_quality(due.scheduled_ns, miss.step_ns);
        self.look_for_trouble(due.scheduled_ns);
        self.gauges.steps += 1;
        self.tick += 1;
        // In the time that is left, if there is enough of it.
        if miss.total_ns < PERIOD_NS / 2 {
            self.stepper.scene.measure();
            if self.is_wait_owed || self.tick.is_multiple_of(MEASURE_EVERY) {
                self.look_for_waits(due.scheduled_ns);
            }
        }
    }

    /// Steps that are given up are metered as late as the one that is taken in their place.
    fn drop_steps(&mut self, due: &Tick, begun: u64) {
        self.gauges.late.add(begun - due.scheduled_ns);
        if due.dropped == 0 {
            return;
        }
        self.gauges.dropped += due.dropped;
        for k in 1..=due.dropped.min(MOST_TOLD) {
            let late = begun - due.scheduled_ns + k * PERIOD_NS;
            self.gauges.late.add(late);
            self.gauges.response.add(late);
        }
        self.send_event(due.scheduled_ns, EventKind::Dropped(due.dropped));
    }

    /// Changes the scene, if another was handed over.
    fn change(&mut self, scheduled_ns: u64) {
        let Some(changes) = &mut self.changes else { return };
        let stepper = &mut self.stepper;
        let taken = changes.take(|change| stepper.change(&mut change.scene, change.afresh));
        let Some((number, afresh)) = taken else { return };
        self.fault_counts = self.stepper.scene.fault_counts();
        if let Some(recording) = &mut self.outlets.recording {
            recording.push(Entry::Changed { number, afresh });
        }
        self.send_event(scheduled_ns, EventKind::Changed(number));
    }

    /// Takes the newest sensor frame, if there is a new one; gives when it arrived (ns).
    fn look(&mut self, scheduled_ns: u64, begun: u64) -> Option<u64> {
        let news = self.seen.news().copied().filter(|seen| seen.number > 0);
        if let Some(seen) = news {
            self.gauges.skipped += (seen.number - self.last).saturating_sub(1);
            self.last = seen.number;
            self.last_ns = begun;
            self.stepper.take(&seen, scheduled_ns);
            if let Some(recording) = &mut self.outlets.recording {
                recording.push(Entry::SensorFrame(seen));
            }
        }
        let lost = begun.saturating_sub(self.last_ns) > SENSOR_LOST_NS;
        if lost != self.lost {
            self.lost = lost;
            self.send_event(scheduled_ns, if lost { EventKind::SensorLost } else { EventKind::SensorBack });
        }
        news.map(|seen| seen.arrived_ns)
    }

    fn meter(&mut self, due: &Tick, begun: u64, ended: u64, news: Option<u64>) {
        let gauges = &mut self.gauges;
        gauges.step.add(ended - begun);
        gauges.response.add(ended - due.scheduled_ns);
        gauges.level_steps[usize::from(self.quality_control.place())] += 1;
        if let Some(arrived_ns) = news {
            gauges.wait.add(begun.saturating_sub(arrived_ns));
            gauges.reaction.add(ended.saturating_sub(arrived_ns));
        }
    }

    /// What the thread's counters grew by since they were last looked at.
    fn count(&mut self) -> Counters {
        let now = self.account.counters();
        now.since(&std::mem::replace(&mut self.counters, now))
    }

    /// Reads how long the thread waited for a core, and reports it where steps were late since.
    fn look_for_waits(&mut self, scheduled_ns: u64) {
        let now = self.account.waited_ns();
        let before = std::mem::replace(&mut self.waited_ns, now);
        if std::mem::take(&mut self.is_wait_owed) {
            self.send_event(scheduled_ns, EventKind::Waited(now.saturating_sub(before)));
        }
    }

    fn record(&mut self, scheduled_ns: u64) {
        if let Some(recording) = &mut self.outlets.recording {
            let fingerprint = self.stepper.scene.fingerprint();
            let (tick, level) = (self.tick, self.quality_control.place());
            recording.push(Entry::Step { tick, scheduled_ns, level, fingerprint });
        }
    }

    fn control_quality(&mut self, scheduled_ns: u64, step_ns: u64) {
        if let Some(change) = self.quality_control.after(step_ns) {
            self.stepper.set_level(change.to);
            self.send_event(scheduled_ns, EventKind::Quality(change));
        }
    }

    fn look_for_trouble(&mut self, scheduled_ns: u64) {
        let now = self.stepper.scene.fault_counts();
        let before = std::mem::replace(&mut self.fault_counts, now);
        for (k, what) in [EventKind::Broken, EventKind::RolledBack].into_iter().enumerate() {
            if now[k] > before[k] {
                self.send_event(scheduled_ns, what);
            }
        }
    }

    fn send_event(&mut self, scheduled_ns: u64, what: EventKind) {
        // One that does not fit is counted by the queue.
        self.outlets.events.push(Event { tick: self.tick, scheduled_ns, what });
    }
}

impl<S: LoopScene, C: Clock, A: CounterSource> ThreadLoop for PhysicsThread<S, C, A> {
    fn begin(&mut self) {
        self.account.begin();
        (self.counters, self.waited_ns) = (self.account.counters(), self.account.waited_ns());
    }

    fn run_due(&mut self) -> Option<u64> {
        match self.schedule.due(self.clock.now_ns()) {
            Due::At(ns) => Some(ns),
            Due::Now(tick) => {
                self.step(tick);
                Some(self.schedule.next_ns())
            }
        }
    }
}

#[cfg(test)]
mod tests;
