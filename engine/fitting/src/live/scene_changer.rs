//! Hands dressed scenes over to the running loop: shoppers come, change clothes and leave, and the mannequin returns. One change is
//! under way at a time, and the replaced scene is freed here, never by the loop's own threads.

use std::sync::Arc;

use toile_base::frame::Joints;
use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::handover::{HandoverSender, SceneChange};
use toile_engine::frame_loop::physics_thread::LoopScene;
use toile_engine::frame_loop::recording::SceneNote;
use toile_engine::frame_loop::render_thread::SceneView;
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot, World};

use super::live_scene::{LiveScene, SceneHandover};
use crate::dress::try_on::DressedWorld;

/// A dressed scene, with what is drawn of it.
pub struct DressedScene<S, O> {
    /// The scene that is stepped.
    pub scene: S,
    /// Reads the snapshots of the scene.
    pub reader: Reader<Snapshot>,
    /// What the renderer has to know of it.
    pub outfit: O,
    /// How it stands, whatever the sensor sees; `None` follows the sensor.
    pub still: Option<Joints>,
    /// What a recording says of it; the number is that of the change.
    pub note: Option<SceneNote>,
    /// Its number, where a script numbers scenes; otherwise changes are counted.
    pub number: Option<u64>,
}

impl<S, O> DressedScene<S, O> {
    /// A dressed person, as `stage` makes a scene of their frame.
    pub fn new(dressed: DressedWorld, stage: impl FnOnce(World) -> (S, O)) -> Self {
        let (still, note) = (dressed.stands(), Some(dressed.note(0)));
        let (scene, outfit) = stage(dressed.world);
        Self { scene, reader: dressed.reader, outfit, still, note, number: None }
    }
}

/// Brings shoppers into the loop, and the mannequin back.
pub struct SceneChanger<S, O> {
    scenes: HandoverSender<LiveScene<S>>,
    views: HandoverSender<SceneView<O>>,
    /// The scene that waits to be handed over, and whether another shopper comes with it.
    waiting: Option<(DressedScene<S, O>, bool)>,
    /// A mannequin that was not shown yet.
    mannequin: Option<DressedScene<S, O>>,
    /// Whether the mannequin is shown or was handed over, and whether it is to be.
    is_still: bool,
    wants_still: bool,
    /// Whether the mannequin that is shown, or was handed over, wears what is worn no more.
    stale: bool,
    /// Which of scene and view have yet to come back from a change.
    under_way: [bool; 2],
    /// The last scene that was handed over; the first is 0.
    number: u64,
    /// Scenes that were handed over.
    changes: u64,
    recorder: Option<Arc<FlightRecorder>>,
}

impl<S: LoopScene, O> SceneChanger<S, O> {
    /// The loop began with the mannequin (`is_still`) or with a shopper; where a flight recorder is kept, it is given the note of each
    /// scene.
    pub fn new(handover: SceneHandover<S, O>, is_still: bool, recorder: Option<Arc<FlightRecorder>>) -> Self {
        let SceneHandover { scenes, views } = handover;
        Self {
            scenes,
            views,
            waiting: None,
            mannequin: None,
            is_still,
            wants_still: is_still,
            stale: false,
            under_way: [false; 2],
            number: 0,
            changes: 0,
            recorder,
        }
    }

    /// Shows a shopper who follows the sensor: another one than before (`afresh`), or the same in other garments. A scene that
    /// still waits is dropped.
    pub fn show(&mut self, scene: DressedScene<S, O>, afresh: bool) {
        // After a shopper who was never shown, the next one was not shown either.
        let afresh = afresh || self.is_still || self.waiting.as_ref().is_some_and(|(_, afresh)| *afresh);
        self.waiting = Some((scene, afresh));
        self.wants_still = false;
    }

    /// Shows the mannequin; nothing of the shopper stays.
    pub fn wipe(&mut self) {
        self.waiting = None;
        self.wants_still = true;
    }

    /// Whether a mannequin has to be made for the next time without a person in view. One is dressed anew each time, so that a
    /// recording that begins with it can be replayed.
    pub fn lacks_mannequin(&self) -> bool {
        (!self.is_still || self.stale) && self.mannequin.is_none()
    }

    /// Another mannequin takes the place of the one that is shown, and of one that was kept.
    pub fn renew(&mut self, mannequin: DressedScene<S, O>) {
        (self.mannequin, self.stale) = (Some(mannequin), self.is_still);
    }

    /// Keeps a mannequin for the next time without a person in view.
    pub fn stand_by(&mut self, mannequin: DressedScene<S, O>) {
        self.mannequin = Some(mannequin);
    }

    /// Frees what was replaced and hands over what is due.
    pub fn update(&mut self) {
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
            if let Some((scene, afresh)) = self.waiting.take() {
                self.hand_over(scene, afresh);
            }
        } else if (!self.is_still || self.stale)
            && let Some(mannequin) = self.mannequin.take()
        {
            self.hand_over(mannequin, true);
        }
    }

    fn hand_over(&mut self, dressed: DressedScene<S, O>, afresh: bool) {
        let DressedScene { scene, reader, outfit, still, note, number } = dressed;
        (self.is_still, self.stale) = (still.is_some(), false);
        self.changes += 1;
        self.number = number.unwrap_or(self.number + 1);
        let number = self.number;
        if let (Some(recorder), Some(note)) = (&self.recorder, note) {
            recorder.describe(&SceneNote { number, ..note });
        }
        let scene = Box::new(SceneChange { scene: LiveScene::new(scene, still), number, afresh });
        let view = Box::new(SceneChange { scene: SceneView { reader, outfit }, number, afresh });
        // Both are empty, since one change is under way at a time: nothing is given back.
        self.under_way = [self.scenes.give(scene).is_ok(), self.views.give(view).is_ok()];
    }

    /// Whether a scene waits to be handed over; another one would take its place.
    pub fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// Scenes that were handed over so far.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Whether nothing of a shopper is left: the mannequin is shown and no change is under way.
    pub fn is_wiped(&self) -> bool {
        self.is_still && self.waiting.is_none() && self.under_way == [false; 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Quat, Vec3};
    use toile_base::skeleton::{JOINTS, Pose};
    use toile_engine::clock::Clock;
    use toile_engine::frame_loop::handover::{HandoverReceiver, handover};
    use toile_engine::frame_loop::quality_control::QualityLevel;
    use toile_engine::skin::SkinningJob;
    use toile_engine::triple_buffer::TripleBuffer;
    use toile_engine::world::SnapshotTimes;

    /// A number on the stage.
    #[derive(Debug)]
    struct Nth(u64);

    impl LoopScene for Nth {
        fn step(&mut self, _joints: &Joints, _times: SnapshotTimes, _clock: &impl Clock) {}
        fn set_level(&mut self, _level: &QualityLevel) {}
        fn measure(&mut self) {}
        fn clear_meters(&mut self) {}
        fn fingerprint(&self) -> u64 {
            self.0
        }
        fn fault_counts(&self) -> [u64; 2] {
            [0; 2]
        }
    }

    /// Physics and render as they run on threads.
    struct Threads {
        scene: LiveScene<Nth>,
        outfit: u64,
        afresh: bool,
        scenes: HandoverReceiver<LiveScene<Nth>>,
        views: HandoverReceiver<SceneView<u64>>,
    }

    impl Threads {
        fn run_due(&mut self) {
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
    fn scene(number: u64) -> DressedScene<Nth, u64> {
        let skin = SkinningJob::new::<4>(&[], &[], &[]).unwrap().posed();
        let pose = Pose { root: Vec3::ZERO, local: [Quat::IDENTITY; JOINTS] };
        let snapshot = Snapshot { tick: 0, times: SnapshotTimes::default(), skin, garments: Box::new([]), pose };
        let still = (number == 0).then(|| Joints::absent(0));
        DressedScene {
            scene: Nth(number),
            reader: TripleBuffer::new(&snapshot).reader,
            outfit: number,
            still,
            note: None,
            number: None,
        }
    }

    fn set() -> (SceneChanger<Nth, u64>, Threads) {
        let ((scenes, taken), (views, looked_at)) = (handover(), handover());
        let threads =
            Threads { scene: LiveScene::new(Nth(0), None), outfit: 0, afresh: false, scenes: taken, views: looked_at };
        (SceneChanger::new(SceneHandover { scenes, views }, true, None), threads)
    }

    fn turns(changing: &mut SceneChanger<Nth, u64>, threads: &mut Threads) {
        for _ in 0..3 {
            changing.update();
            threads.run_due();
        }
        changing.update();
    }

    #[test]
    fn shoppers_come_change_and_the_mannequin_returns_each_time() {
        let (mut changing, mut threads) = set();
        assert!(!changing.lacks_mannequin());
        for shopper in [10, 20, 30] {
            changing.show(scene(shopper), true);
            turns(&mut changing, &mut threads);
            assert_eq!((threads.shown(), threads.afresh), ([shopper; 2], true));
            changing.show(scene(shopper + 1), false);
            turns(&mut changing, &mut threads);
            assert_eq!((threads.shown(), threads.afresh), ([shopper + 1; 2], false), "in other garments");
            assert!(!changing.is_wiped() && changing.lacks_mannequin());
            changing.wipe();
            turns(&mut changing, &mut threads);
            assert!(!changing.is_wiped(), "the mannequin is not dressed yet");
            changing.stand_by(scene(0));
            turns(&mut changing, &mut threads);
            assert_eq!((threads.shown(), threads.afresh), ([0; 2], true), "the mannequin");
            assert!(changing.is_wiped() && !changing.lacks_mannequin());
        }
    }

    #[test]
    fn who_leaves_before_the_stage_has_changed_is_wiped_all_the_same() {
        let (mut changing, mut threads) = set();
        changing.show(scene(7), true);
        changing.update();
        // Called, but physics has not looked yet.
        changing.wipe();
        changing.stand_by(scene(0));
        changing.update();
        assert!(!changing.is_wiped());
        turns(&mut changing, &mut threads);
        assert!(threads.shown() == [0; 2] && changing.is_wiped());
        // And one who was never called is not kept.
        changing.show(scene(8), true);
        changing.wipe();
        turns(&mut changing, &mut threads);
        assert!(threads.shown() == [0; 2] && changing.is_wiped());
    }

    #[test]
    fn a_mannequin_in_other_clothes_takes_the_place_of_the_one_that_is_shown() {
        let (mut changing, mut threads) = set();
        let other = || DressedScene { scene: Nth(5), outfit: 5, ..scene(0) };
        changing.renew(other());
        turns(&mut changing, &mut threads);
        assert_eq!(threads.shown(), [5; 2]);
        assert!(changing.is_wiped() && !changing.lacks_mannequin());
        // A shopper steps in before it was shown: it is there when they have left.
        changing.show(scene(7), true);
        turns(&mut changing, &mut threads);
        changing.stand_by(scene(0));
        changing.renew(other());
        turns(&mut changing, &mut threads);
        assert_eq!(threads.shown(), [7; 2], "who is there keeps what they see");
        changing.wipe();
        turns(&mut changing, &mut threads);
        assert_eq!(threads.shown(), [5; 2]);
    }

    #[test]
    fn an_overtaking_change_still_brings_a_new_shopper() {
        let (mut changing, mut threads) = set();
        changing.show(scene(7), true);
        changing.show(scene(8), false);
        turns(&mut changing, &mut threads);
        assert_eq!((threads.shown(), threads.afresh), ([8; 2], true));
    }
}
