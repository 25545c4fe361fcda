//! Replay: a recorded run taken again, step by step, by the same function, and compared bit for bit.

use super::physics_thread::{LoopScene, SceneStepper};
use super::recording::Entry;
use crate::clock::Clock;

/// What came out of a replay.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Replayed {
    /// Steps that were replayed.
    pub ticks: u64,
    /// Hash of the state at the end.
    pub fingerprint: u64,
    /// The first step whose state is another than the recorded one.
    pub diverged_at: Option<u64>,
    /// The first step that follows on a step that was not recorded, after which no state can be the same.
    pub gap_at: Option<u64>,
}

/// Takes the recorded steps again. The scene is dressed as the recording says already; nothing stops at a difference, so
/// that the rest of the run can be looked at.
pub fn replay<S: LoopScene>(stepper: &mut SceneStepper<S>, entries: &[Entry], clock: &impl Clock) -> Replayed {
    replay_changing(stepper, entries, clock, |_| None)
}

/// The same where scenes were changed: `make` makes the one of a number. One that cannot be made changes nothing, and the
/// next step ends in other bits.
pub fn replay_changing<S: LoopScene>(
    stepper: &mut SceneStepper<S>,
    entries: &[Entry],
    clock: &impl Clock,
    mut make: impl FnMut(u64) -> Option<S>,
) -> Replayed {
    let mut out = Replayed::default();
    // A recording may begin in the middle of a run, where a shopper was dressed.
    let mut next = None;
    // Frames are taken with the time of the step that knew them, which follows them.
    let mut waiting = None;
    for entry in entries {
        match entry {
            Entry::Dressed(_) => {}
            Entry::Changed { number, afresh } => {
                if let Some(mut scene) = make(*number) {
                    stepper.change(&mut scene, *afresh);
                }
            }
            Entry::SensorFrame(seen) => waiting = Some(seen),
            Entry::Fault(seed) => stepper.scene.inject_fault(*seed),
            Entry::Step { tick, scheduled_ns, level, fingerprint } => {
                if next.is_some_and(|next| next != *tick) {
                    out.gap_at = out.gap_at.or(Some(*tick));
                }
                next = Some(tick + 1);
                stepper.set_level(*level);
                if let Some(seen) = waiting.take() {
                    stepper.take(seen, *scheduled_ns);
                }
                stepper.step(*scheduled_ns, *scheduled_ns, clock);
                out.fingerprint = stepper.scene.fingerprint();
                if out.fingerprint != *fingerprint {
                    out.diverged_at = out.diverged_at.or(Some(*tick));
                }
                out.ticks += 1;
            }
        }
    }
    out
}
