//! Who is to stand on the stage: the service's end of it. One change is under way at a time, and what leaves is freed here.

use std::sync::Arc;

use toile_engine::frame::Snapshot;
use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::handover::{HandoverSender, SceneChange};
use toile_engine::frame_loop::physics_thread::Scene;
use toile_engine::frame_loop::render_thread::SceneView;
use toile_engine::triple_buffer::Reader;
use toile_sensors::frame::Joints;

use super::lives::Doors;
use super::recording::Made;
use super::stage::Stage;

/// A scene, dressed, with what is drawn of it.
pub struct Act<S, O> {
    /// The scene.
    pub scene: S,
    /// Where its snapshots come out.
    pub reader: Reader<Snapshot>,
    /// What the eye has to know of it.
    pub outfit: O,
    /// How it was made.
    pub made: Made,
}

impl<S, O> Act<S, O> {
    /// Where it stands still, whatever the sensor sees; none follows the sensor.
    pub fn still(&self) -> Option<Joints> {
        self.made.still.then_some(self.made.first)
    }
}

/// Brings shoppers onto the stage and the mannequin back.
pub struct Changing<S, O> {
    scenes: HandoverSender<Stage<S>>,
    views: HandoverSender<SceneView<O>>,
    /// Who waits to be called.
    waiting: Option<(Act<S, O>, bool)>,
    /// A mannequin that was not on the stage yet.
    mannequin: Option<Act<S, O>>,
    /// Whether the mannequin is on the stage or called to it, and whether it is to be.
    is_still: bool,
    wants_still: bool,
    /// Which of scene and view have yet to come back from a change.
    under_way: [bool; 2],
    /// The last that was called; the first is 0.
    number: u64,
    black_box: Option<Arc<FlightRecorder>>,
}

impl<S: Scene, O> Changing<S, O> {
    /// The mannequin is on the stage; where a black box is kept, it is told how each scene was made.
    pub fn new(doors: Doors<S, O>, black_box: Option<Arc<FlightRecorder>>) -> Self {
        let Doors { scenes, views } = doors;
        let (is_still, wants_still, under_way) = (true, true, [false; 2]);
        Self { scenes, views, waiting: None, mannequin: None, is_still, wants_still, under_way, number: 0, black_box }
    }

    /// Somebody is to be on the stage, and to follow the sensor: another one than before (`afresh`), or the same in other
    /// garments. Who still waits to be called is dropped.
    pub fn bring(&mut self, act: Act<S, O>, afresh: bool) {
        // A shopper who was never called is followed by one whom nobody has seen either.
        let afresh = afresh || self.is_still || self.waiting.as_ref().is_some_and(|(_, afresh)| *afresh);
        self.waiting = Some((act, afresh));
        self.wants_still = false;
    }

    /// The mannequin is to be on the stage; nothing of the shopper stays.
    pub fn wipe(&mut self) {
        self.waiting = None;
        self.wants_still = true;
    }

    /// Whether a mannequin has to be made, for the next time that nobody is there. One is dressed anew each time, so that a
    /// recording that begins with it can be taken again.
    pub fn lacks_mannequin(&self) -> bool {
        !self.is_still && self.mannequin.is_none()
    }

    /// The one that was made.
    pub fn stand_by(&mut self, mannequin: Act<S, O>) {
        self.mannequin = Some(mannequin);
    }

    /// Frees what has left and calls who is due.
    pub fn look(&mut self) {
        if self.scenes.returned().is_some() {
            self.under_way[0] = false;
        }
        if self.views.returned().is_some() {
            self.under_way[1] = false;
        }
        if self.under_way != [false; 2] {
            return;
        }
        if !self.wants_still {
            if let Some((act, afresh)) = self.waiting.take() {
                self.call(act, afresh);
            }
        } else if !self.is_still
            && let Some(mannequin) = self.mannequin.take()
        {
            self.call(mannequin, true);
        }
    }

    fn call(&mut self, act: Act<S, O>, afresh: bool) {
        self.is_still = act.made.still;
        self.number += 1;
        if let Some(black_box) = &self.black_box {
            black_box.describe(&act.made.note(self.number));
        }
        let (number, still) = (self.number, act.still());
        let scene = Box::new(SceneChange { scene: Stage::new(act.scene, still), number, afresh });
        let view =
            Box::new(SceneChange { scene: SceneView { reader: act.reader, outfit: act.outfit }, number, afresh });
        // Both are empty, since one change is under way at a time: nothing is given back.
        self.under_way = [self.scenes.give(scene).is_ok(), self.views.give(view).is_ok()];
    }

    /// Whether nothing of a shopper is left: the mannequin is on the stage and nobody is on the way from it.
    pub fn is_wiped(&self) -> bool {
        self.is_still && self.waiting.is_none() && self.under_way == [false; 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_engine::clock::Clock;
    use toile_engine::frame::Times;
    use toile_engine::frame_loop::governor::Rung;
    use toile_engine::frame_loop::handover::{HandoverReceiver, handover};
    use toile_engine::skin::SkinningJob;
    use toile_engine::triple_buffer::TripleBuffer;

    /// A number on the stage.
    #[derive(Debug)]
    struct Nth(u64);

    impl Scene for Nth {
        fn step(&mut self, _joints: &Joints, _times: Times, _clock: &impl Clock) {}
        fn set_rung(&mut self, _rung: &Rung) {}
        fn measure(&mut self) {}
        fn clear_meters(&mut self) {}
        fn fingerprint(&self) -> u64 {
            self.0
        }
        fn troubles(&self) -> [u64; 2] {
            [0; 2]
        }
    }

    /// Physics and render as threads have them.
    struct Threads {
        scene: Stage<Nth>,
        outfit: u64,
        afresh: bool,
        scenes: HandoverReceiver<Stage<Nth>>,
        views: HandoverReceiver<SceneView<u64>>,
    }

    impl Threads {
        fn turn(&mut self) {
            let scene = &mut self.scene;
            if let Some((_, afresh)) = self.scenes.take(|c| std::mem::swap(scene, &mut c.scene)) {
                self.afresh = afresh;
            }
            let outfit = &mut self.outfit;
            self.views.take(|c| std::mem::swap(outfit, &mut c.scene.outfit));
        }

        fn shown(&self) -> [u64; 2] {
            [self.scene.fingerprint(), self.outfit]
        }
    }

    /// The mannequin is 0.
    fn act(number: u64) -> Act<Nth, u64> {
        let skin = SkinningJob::new::<4>(&[], &[], &[]).unwrap().posed();
        let snapshot = Snapshot { tick: 0, times: Times::default(), skin, garments: Box::new([]) };
        let made = Made::for_tests(number == 0);
        Act { scene: Nth(number), reader: TripleBuffer::new(&snapshot).reader, outfit: number, made }
    }

    fn set() -> (Changing<Nth, u64>, Threads) {
        let ((scenes, taken), (views, looked_at)) = (handover(), handover());
        let threads =
            Threads { scene: Stage::new(Nth(0), None), outfit: 0, afresh: false, scenes: taken, views: looked_at };
        (Changing::new(Doors { scenes, views }, None), threads)
    }

    fn turns(changing: &mut Changing<Nth, u64>, threads: &mut Threads) {
        for _ in 0..3 {
            changing.look();
            threads.turn();
        }
        changing.look();
    }

    #[test]
    fn shoppers_come_change_and_the_mannequin_returns_each_time() {
        let (mut changing, mut threads) = set();
        assert!(!changing.lacks_mannequin());
        for shopper in [10, 20, 30] {
            changing.bring(act(shopper), true);
            turns(&mut changing, &mut threads);
            assert_eq!((threads.shown(), threads.afresh), ([shopper; 2], true));
            changing.bring(act(shopper + 1), false);
            turns(&mut changing, &mut threads);
            assert_eq!((threads.shown(), threads.afresh), ([shopper + 1; 2], false), "in other garments");
            assert!(!changing.is_wiped() && changing.lacks_mannequin());
            changing.wipe();
            turns(&mut changing, &mut threads);
            assert!(!changing.is_wiped(), "the mannequin is not dressed yet");
            changing.stand_by(act(0));
            turns(&mut changing, &mut threads);
            assert_eq!((threads.shown(), threads.afresh), ([0; 2], true), "the mannequin");
            assert!(changing.is_wiped() && !changing.lacks_mannequin());
        }
    }

    #[test]
    fn who_leaves_before_the_stage_has_changed_is_wiped_all_the_same() {
        let (mut changing, mut threads) = set();
        changing.bring(act(7), true);
        changing.look();
        // Called, but physics has not looked yet.
        changing.wipe();
        changing.stand_by(act(0));
        changing.look();
        assert!(!changing.is_wiped());
        turns(&mut changing, &mut threads);
        assert!(threads.shown() == [0; 2] && changing.is_wiped());
        // And one who was never called is not kept.
        changing.bring(act(8), true);
        changing.wipe();
        turns(&mut changing, &mut threads);
        assert!(threads.shown() == [0; 2] && changing.is_wiped());
    }

    #[test]
    fn a_change_that_overtakes_the_first_still_brings_somebody_new() {
        let (mut changing, mut threads) = set();
        changing.bring(act(7), true);
        changing.bring(act(8), false);
        turns(&mut changing, &mut threads);
        assert_eq!((threads.shown(), threads.afresh), ([8; 2], true));
    }
}
