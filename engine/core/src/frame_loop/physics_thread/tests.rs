//! The loop against a simulated clock: a scene whose steps take as long as the test sets.

use std::cell::RefCell;
use std::rc::Rc;

use glam::Vec3;
use toile_base::clock::SECOND_NS;
use toile_base::frame::TrackedJoint;
use toile_sensors::filter::JointFilter;

use super::*;
use crate::clock::SimClock;
use crate::frame_loop::event::{EVENTS, EVENTS_NAME, NoCounters};
use crate::frame_loop::handover::{SceneChange, handover};
use crate::frame_loop::queue::{Receiver, bounded};
use crate::frame_loop::recording::{ENTRIES, ENTRIES_NAME};
use crate::frame_loop::replay::{replay, replay_changing};
use crate::frame_loop::sensor_thread::{Playback, SensorThread};
use crate::frame_loop::simulate::simulate;
use crate::triple_buffer::TripleBuffer;

const MS: u64 = 1_000_000;

/// A scene of one number: the joint that it last saw, with what came before it hashed in.
#[derive(Clone)]
struct Toy {
    clock: SimClock,
    /// What a step costs at whole quality, by the time at which it is due (ns).
    cost: fn(u64) -> u64,
    share: f32,
    hash: u64,
    /// Where the joint was at each step (m).
    path: Rc<RefCell<Vec<f32>>>,
}

impl Toy {
    fn new(clock: &SimClock, cost: fn(u64) -> u64) -> Self {
        Self { clock: clock.clone(), cost, share: 1.0, hash: 1, path: Rc::default() }
    }
}

impl LoopScene for Toy {
    fn step(&mut self, joints: &Joints, times: SnapshotTimes, _: &impl Clock) {
        let x = joints.joints[4].position.x;
        self.path.borrow_mut().push(x);
        self.hash = (self.hash ^ u64::from((x * self.share).to_bits())).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.clock.spend(((self.cost)(times.scheduled_ns) as f32 * self.share) as u64);
    }

    fn set_level(&mut self, level: &QualityLevel) {
        self.share = level.substep_share;
    }

    fn measure(&mut self) {}

    fn clear_meters(&mut self) {}

    fn fingerprint(&self) -> u64 {
        self.hash
    }

    fn fault_counts(&self) -> [u64; 2] {
        [0; 2]
    }
}

/// Frames of a sensor for ten seconds: a joint that swings.
fn recording(hz: u64) -> Vec<Joints> {
    let frame = |i: u64| {
        let mut joints = Joints::absent(i * SECOND_NS / hz);
        let swing = (i as f32 / hz as f32 * 3.0).sin() * 0.3;
        joints.joints[4] = TrackedJoint { position: Vec3::new(swing, 1.0, 0.0), confidence: 1.0 };
        joints
    };
    (0..10 * hz).map(frame).collect()
}

struct Rig {
    clock: SimClock,
    sense: SensorThread<Playback, JointFilter, SimClock>,
    physics: PhysicsThread<Toy, SimClock, NoCounters>,
    events: Receiver<Event>,
    recording: Receiver<Entry>,
}

/// A sensor and a loop that begin at an uptime (ns).
fn rig(uptime: u64, frames: &[Joints], cost: fn(u64) -> u64) -> Rig {
    let clock = SimClock::starting_at(uptime);
    let TripleBuffer { writer, reader } = TripleBuffer::new(&SensorFrame::default());
    let (sender, events) = bounded(EVENTS_NAME, EVENTS);
    let (recorder, recording) = bounded(ENTRIES_NAME, 100 * ENTRIES);
    let outlets = PhysicsOutputs { events: sender, recording: Some(recorder) };
    let physics = PhysicsThread::new(Toy::new(&clock, cost), clock.clone(), uptime, reader, outlets, NoCounters);
    let sense = SensorThread::new(Playback::new(frames, uptime, 2), JointFilter::default(), clock.clone(), writer);
    Rig { clock, sense, physics, events, recording }
}

impl Rig {
    fn run(&mut self, until_ns: u64) {
        simulate(&self.clock, &mut [&mut self.sense, &mut self.physics], until_ns);
    }

    fn drained(&mut self) -> Vec<Event> {
        std::iter::from_fn(|| self.events.pop()).collect()
    }
}

#[test]
fn every_step_is_taken_once_and_in_time_however_long_the_clock_has_run() {
    let frames = recording(30);
    let mut hashes = Vec::new();
    for days in [0, 2, 50, 414] {
        let uptime = days * 86_400 * SECOND_NS;
        let mut rig = rig(uptime, &frames, |_| 3 * MS);
        rig.run(uptime + 10 * SECOND_NS);
        assert_eq!(rig.drained(), []);
        let gauges = &rig.physics.gauges;
        assert_eq!((gauges.steps, gauges.missed, gauges.dropped, gauges.skipped), (1_200, 0, 0, 0));
        assert_eq!(rig.physics.stepper.scene.path.borrow().len(), 1_200);
        let reaction = gauges.reaction.histogram();
        assert!(reaction.max() <= PERIOD_NS + 3 * MS + MS / 5, "{} ns to a snapshot", reaction.max());
        hashes.push(rig.physics.stepper.scene.hash);
    }
    assert!(hashes.windows(2).all(|w| w[0] == w[1]), "the uptime changes what is computed: {hashes:x?}");
}

#[test]
fn a_late_wake_up_is_made_up_for_or_dropped_and_told() {
    let mut rig = rig(0, &recording(30), |_| MS);
    rig.run(SECOND_NS);
    rig.clock.oversleep_once(20 * MS);
    rig.run(2 * SECOND_NS);
    assert_eq!((rig.physics.gauges.steps, rig.physics.gauges.dropped), (240, 0), "made up for");
    let missed = rig.physics.gauges.missed;
    let drained = rig.drained();
    let (last, late) = drained.split_last().unwrap();
    assert!(
        (1..=3).contains(&missed) && late.iter().all(|e| matches!(e.what, EventKind::Missed(_))),
        "{missed} {drained:?}"
    );
    assert_eq!(last.what, EventKind::Waited(0), "the first step with time to spare looks for waits");
    rig.clock.oversleep_once(500 * MS);
    rig.run(4 * SECOND_NS);
    let drained = rig.drained();
    let gauges = &rig.physics.gauges;
    assert_eq!(gauges.steps + gauges.dropped, 480, "no step is lost without being counted");
    assert!((50..60).contains(&gauges.dropped));
    assert!(drained.iter().any(|e| e.what == EventKind::Dropped(gauges.dropped)), "{drained:?}");
    // Corrected for coordinated omission: the steps that could not be taken count with their lateness.
    assert_eq!(gauges.response.histogram().len(), 480);
    assert!(gauges.response.histogram().value_at_quantile(0.9) > 20 * MS);
    assert!(gauges.step.histogram().max() < 2 * MS, "the steps themselves were short");
}

#[test]
fn quality_is_given_up_before_deadlines_and_comes_back_when_the_load_is_gone() {
    // Ten ms a step from second 2 to second 5.
    let cost = |due: u64| if (2 * SECOND_NS..5 * SECOND_NS).contains(&due) { 10 * MS } else { 3 * MS };
    let mut rig = rig(0, &recording(30), cost);
    rig.run(10 * SECOND_NS);
    let drained = rig.drained();
    let gauges = &rig.physics.gauges;
    assert_eq!((gauges.steps, gauges.dropped), (1_200, 0));
    let changes: Vec<u8> =
        drained.iter().filter_map(|e| if let EventKind::Quality(c) = e.what { Some(c.to) } else { None }).collect();
    assert_eq!(changes, [1, 2, 1, 0], "each change is told");
    assert!(gauges.missed <= 8, "{} steps were late until quality was given up", gauges.missed);
    assert_eq!(gauges.level_steps.iter().sum::<u64>(), 1_200);
    assert_eq!(rig.physics.level(), 0);
}

#[test]
fn a_sensor_that_is_lost_and_found_is_told_and_the_body_stays() {
    let mut frames = recording(30);
    frames.retain(|f| !(2 * SECOND_NS..4 * SECOND_NS).contains(&f.time_ns));
    let mut rig = rig(0, &frames, |_| MS);
    rig.run(6 * SECOND_NS);
    let drained: Vec<EventKind> = rig.drained().into_iter().map(|e| e.what).collect();
    assert_eq!(drained, [EventKind::SensorLost, EventKind::SensorBack]);
    let path = rig.physics.stepper.scene.path.borrow();
    assert!(path.iter().all(|x| x.is_finite() && x.abs() < 0.6));
}

#[test]
fn a_recorded_run_is_taken_again_bit_for_bit_and_a_difference_is_found_where_it_is() {
    let cost = |due: u64| if due % SECOND_NS < 100 * MS { 9 * MS } else { 4 * MS };
    let mut rig = rig(7, &recording(15), cost);
    rig.clock.oversleep_once(100 * MS);
    rig.run(10 * SECOND_NS);
    let entries: Vec<Entry> = std::iter::from_fn(|| rig.recording.pop()).collect();
    let steps = rig.physics.gauges.steps;
    assert!(rig.physics.gauges.dropped > 0 && rig.physics.gauges.level_steps[1] > 0, "a run with trouble in it");
    let again = |entries: &[Entry]| {
        let clock = SimClock::default();
        replay(&mut SceneStepper::new(Toy::new(&clock, |_| 0)), entries, &clock)
    };
    let out = again(&entries);
    assert_eq!((out.ticks, out.diverged_at, out.gap_at), (steps, None, None));
    assert_eq!(out.fingerprint, rig.physics.stepper.scene.hash);

    let mut changed = entries.clone();
    let mut after = None;
    for entry in &mut changed[500..] {
        match entry {
            Entry::SensorFrame(seen) if after.is_none() => {
                seen.joints.joints[4].position.x += 1e-3;
                after = Some(u64::MAX);
            }
            Entry::Step { tick, .. } if after == Some(u64::MAX) => after = Some(*tick),
            _ => {}
        }
    }
    let found = again(&changed).diverged_at.unwrap();
    assert!((after.unwrap()..after.unwrap() + 2).contains(&found), "{found} after {after:?}");
    let mut lost = entries;
    lost.remove(lost.len() / 2);
    assert!(again(&lost).diverged_at.is_some() || again(&lost).gap_at.is_some());
}

#[test]
fn another_scene_takes_the_place_between_two_steps_and_in_the_replay_too() {
    let frames = recording(30);
    let Rig { clock, sense, physics, events, recording } = rig(7, &frames, |_| MS);
    let (mut giver, taker) = handover();
    let mut rig = Rig { clock, sense, physics: physics.changing(taker), events, recording };
    rig.physics = rig.physics.held_on(2);
    for number in 1..=4 {
        rig.run(number * 2 * SECOND_NS);
        let scene = Toy::new(&rig.clock, |_| MS);
        assert!(giver.give(Box::new(SceneChange { scene, number, afresh: number % 2 == 0 })).is_ok());
        rig.run(number * 2 * SECOND_NS + SECOND_NS);
        let before = giver.returned().expect("the scene before");
        assert!(before.scene.path.borrow().len() >= 200 && before.number == number);
        assert_eq!(rig.physics.stepper.scene.share, 0.5, "the level goes on");
    }
    let drained: Vec<EventKind> = rig.drained().into_iter().map(|e| e.what).collect();
    assert_eq!(drained, (1..=4).map(EventKind::Changed).collect::<Vec<_>>());
    let entries: Vec<Entry> = std::iter::from_fn(|| rig.recording.pop()).collect();
    let clock = SimClock::default();
    let again = |entries: &[Entry]| {
        let mut stepper = SceneStepper::new(Toy::new(&clock, |_| 0));
        replay_changing(&mut stepper, entries, &clock, |_| Some(Toy::new(&clock, |_| 0)))
    };
    let out = again(&entries);
    assert_eq!((out.ticks, out.diverged_at, out.gap_at), (rig.physics.ticks(), None, None));
    assert_eq!(out.fingerprint, rig.physics.stepper.scene.hash);
    // From the arrival of a shopper, where a flight recorder begins; with a garment alone the shopper's motion is not known.
    let from = |number: u64| entries.iter().position(|e| matches!(e, Entry::Changed { number: n, .. } if *n == number));
    let late = again(&entries[from(2).unwrap()..]);
    assert_eq!((late.diverged_at, late.gap_at, late.fingerprint), (None, None, out.fingerprint));
    assert!(again(&entries[from(3).unwrap()..]).diverged_at.is_some());
}
