//! The stage: the scene that physics steps and render looks at, and how another one takes its place without either of
//! them allocating, freeing or waiting. What leaves the stage is handed back and freed elsewhere.

use std::sync::Arc;

use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame::{Snapshot, Times};
use toile_engine::meter::PERIOD_NS;
use toile_engine::pace::Turn;
use toile_engine::pace::governor::{LADDER, Rung};
use toile_engine::pace::physics::{Scene, Staged};
use toile_engine::pace::queue::{Receiver, Sender};
use toile_engine::pace::render::{Eye, Render};
use toile_engine::relay::Reader;
use toile_sensors::frame::Joints;

use super::watchdog::Pulse;

/// Scenes on their way onto the stage or from it: one is ever under way.
pub const CHANGES: usize = 4;

/// The name of the bound, as warnings give it.
pub const CHANGES_NAME: &str = "CHANGES (engine/app/src/kiosk/stage.rs)";

/// Beats that wait to be counted: eight seconds.
pub const BEATS: usize = 1024;

/// The name of the bound, as warnings give it.
pub const BEATS_NAME: &str = "BEATS (engine/app/src/kiosk/stage.rs)";

/// A scene that can take the place of another.
pub trait Staging: Scene {
    /// Takes over what stays on the stage, such as the workers' threads.
    fn take_over(&mut self, from: &mut Self);
}

impl Staging for Staged {
    fn take_over(&mut self, from: &mut Self) {
        self.frame.take_crew(&mut from.frame);
    }
}

/// Who is on the stage.
#[derive(Debug)]
pub struct Act<S> {
    /// The scene, dressed.
    pub scene: S,
    /// Where it stands still, whatever the sensor sees; none follows the sensor.
    pub still: Option<Joints>,
}

/// What one step came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Beat {
    /// From its begin to its publication (ns).
    pub step_ns: u64,
    /// Whether it was published after its period.
    pub late: bool,
    /// The place in the governor's ladder.
    pub rung: u8,
    /// Steps so far that were rolled back, because of a number that is none.
    pub nonfinite: u64,
}

/// The physics' ends of the stage.
#[derive(Debug)]
pub struct Wings<S> {
    /// Who comes next.
    pub next: Receiver<Box<Act<S>>>,
    /// Who has left.
    pub gone: Sender<Box<Act<S>>>,
    /// What each step came to.
    pub beats: Sender<Beat>,
    /// What the watchdog looks at.
    pub pulse: Arc<Pulse>,
}

/// The stage as physics steps it.
#[derive(Debug)]
pub struct Stage<S> {
    act: Box<Act<S>>,
    wings: Wings<S>,
    rung: Rung,
    place: u8,
    /// What those who have left counted: their own counts begin at 0.
    past: [u64; 2],
}

impl<S: Staging> Stage<S> {
    /// With somebody on it. At load.
    pub fn new(first: Act<S>, wings: Wings<S>) -> Self {
        Self { act: Box::new(first), wings, rung: LADDER[0], place: 0, past: [0; 2] }
    }

    /// The scene that is on it.
    pub fn scene(&self) -> &S {
        &self.act.scene
    }

    /// Lets the next one on, if somebody waits.
    fn change(&mut self) {
        let Some(mut next) = self.wings.next.pop() else { return };
        next.scene.take_over(&mut self.act.scene);
        next.scene.set_rung(&self.rung);
        self.past = self.troubles();
        let came_with = next.scene.troubles();
        self.past = [0, 1].map(|k| self.past[k].saturating_sub(came_with[k]));
        // The queue has room for all that there are.
        self.wings.gone.push(std::mem::replace(&mut self.act, next));
    }
}

impl<S: Staging> Scene for Stage<S> {
    fn step(&mut self, joints: &Joints, times: Times, clock: &impl Clock) {
        self.change();
        let still = self.act.still.as_ref();
        self.act.scene.step(still.unwrap_or(joints), times, clock);
        let ended = clock.now_ns();
        self.wings.pulse.step();
        let [_, nonfinite] = self.troubles();
        let step_ns = ended.saturating_sub(times.begun_ns);
        let late = ended.saturating_sub(times.scheduled_ns) > PERIOD_NS;
        self.wings.beats.push(Beat { step_ns, late, rung: self.place, nonfinite });
    }

    fn set_rung(&mut self, rung: &Rung) {
        self.rung = *rung;
        self.place = LADDER.iter().position(|r| r == rung).unwrap_or_default() as u8;
        self.act.scene.set_rung(rung);
    }

    fn measure(&mut self) {
        self.act.scene.measure();
    }

    fn clear_meters(&mut self) {
        self.act.scene.clear_meters();
    }

    fn fingerprint(&self) -> u64 {
        self.act.scene.fingerprint()
    }

    fn troubles(&self) -> [u64; 2] {
        let now = self.act.scene.troubles();
        [0, 1].map(|k| self.past[k] + now[k])
    }
}

/// The render's life, whose scene changes with the stage's.
#[derive(Debug)]
pub struct Watching<E> {
    /// The life itself.
    pub render: Render<E, RealClock>,
    next: Receiver<Reader<Snapshot>>,
    gone: Sender<Reader<Snapshot>>,
    pulse: Arc<Pulse>,
}

impl<E: Eye> Watching<E> {
    /// Looks where `next` says, and hands back where it has looked.
    pub fn new(
        render: Render<E, RealClock>,
        next: Receiver<Reader<Snapshot>>,
        gone: Sender<Reader<Snapshot>>,
        pulse: Arc<Pulse>,
    ) -> Self {
        Self { render, next, gone, pulse }
    }
}

impl<E: Eye> Turn for Watching<E> {
    fn turn(&mut self) -> Option<u64> {
        if let Some(reader) = self.next.pop() {
            let before = self.render.watch(reader);
            self.gone.push(before);
        }
        let next = self.render.turn();
        self.pulse.pictures(self.render.pictures);
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_engine::clock::SimClock;
    use toile_engine::pace::queue::bounded;

    /// A scene that says what it was asked.
    #[derive(Debug, Default)]
    struct Said {
        name: u8,
        crew: u8,
        rolled_back: u64,
        substeps: f32,
        seen_ns: Vec<u64>,
    }

    impl Scene for Said {
        fn step(&mut self, joints: &Joints, _times: Times, _clock: &impl Clock) {
            self.seen_ns.push(joints.time_ns);
            self.rolled_back += 1;
        }
        fn set_rung(&mut self, rung: &Rung) {
            self.substeps = rung.substep_share;
        }
        fn measure(&mut self) {}
        fn clear_meters(&mut self) {}
        fn fingerprint(&self) -> u64 {
            u64::from(self.name)
        }
        fn troubles(&self) -> [u64; 2] {
            [0, self.rolled_back]
        }
    }

    impl Staging for Said {
        fn take_over(&mut self, from: &mut Self) {
            std::mem::swap(&mut self.crew, &mut from.crew);
        }
    }

    #[test]
    fn another_scene_takes_over_crew_quality_and_counts_and_the_first_comes_back_out() {
        let (mut call, next) = bounded(CHANGES_NAME, CHANGES);
        let (gone, mut left) = bounded(CHANGES_NAME, CHANGES);
        let (beats, mut told) = bounded(BEATS_NAME, BEATS);
        let pulse = Arc::new(Pulse::default());
        let still = Some(Joints::absent(7));
        let first = Act { scene: Said { name: 1, crew: 9, ..Said::default() }, still };
        let mut stage = Stage::new(first, Wings { next, gone, beats, pulse: pulse.clone() });
        let clock = SimClock::default();
        let step = |stage: &mut Stage<Said>| stage.step(&Joints::absent(50), Times::default(), &clock);
        stage.set_rung(&LADDER[1]);
        step(&mut stage);
        assert!(call.push(Box::new(Act { scene: Said { name: 2, ..Said::default() }, still: None })));
        step(&mut stage);
        assert_eq!(stage.fingerprint(), 2);
        assert_eq!((stage.scene().crew, stage.scene().substeps), (9, LADDER[1].substep_share));
        assert_eq!(stage.scene().seen_ns, [50], "it follows the sensor");
        let before = left.pop().unwrap();
        assert_eq!(
            (before.scene.name, before.scene.crew, &before.scene.seen_ns[..]),
            (1, 0, &[7][..]),
            "it stood still"
        );
        assert_eq!(stage.troubles(), [0, 2], "no count begins anew");
        // Back on, with the counts that it left with.
        assert!(call.push(before));
        step(&mut stage);
        assert_eq!(stage.troubles(), [0, 3]);
        let beats: Vec<(u8, u64)> = std::iter::from_fn(|| told.pop()).map(|b| (b.rung, b.nonfinite)).collect();
        assert_eq!(beats, [(1, 1), (1, 2), (1, 3)]);
        assert_eq!(pulse.count(), [3, 0]);
    }
}
