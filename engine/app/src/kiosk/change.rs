//! Who is to stand on the stage: the service's end of it. One change is under way at a time, and what leaves is freed here.

use toile_engine::frame::Snapshot;
use toile_engine::pace::queue::{Receiver, Sender};
use toile_engine::relay::Reader;

use super::stage::Act;

/// The service's ends of the stage, as physics and as render have them.
pub struct Doors<S> {
    /// Acts for physics to step.
    pub call: Sender<Box<Act<S>>>,
    /// Acts that have left.
    pub left: Receiver<Box<Act<S>>>,
    /// Where render is to look.
    pub show: Sender<Reader<Snapshot>>,
    /// Where it looked before.
    pub shown: Receiver<Reader<Snapshot>>,
}

/// An act and where its snapshots come out, as far as both are back.
type Pair<S> = (Option<Box<Act<S>>>, Option<Reader<Snapshot>>);

/// Brings shoppers onto the stage and the mannequin back.
pub struct Changing<S> {
    doors: Doors<S>,
    /// Who waits to be called.
    waiting: Option<(Box<Act<S>>, Reader<Snapshot>)>,
    /// The mannequin, while a shopper is on the stage.
    mannequin: Pair<S>,
    /// Whether the mannequin is on the stage or called to it, and whether it is to be.
    is_still: bool,
    wants_still: bool,
    /// Which of act and reader have yet to come back from a change.
    under_way: [bool; 2],
}

impl<S> Changing<S> {
    /// The mannequin is on the stage.
    pub fn new(doors: Doors<S>) -> Self {
        let mannequin = (None, None);
        Self { doors, waiting: None, mannequin, is_still: true, wants_still: true, under_way: [false; 2] }
    }

    /// A shopper is to be on the stage, and to follow the sensor.
    pub fn bring(&mut self, scene: S, reader: Reader<Snapshot>) {
        self.waiting = Some((Box::new(Act { scene, still: None }), reader));
        self.wants_still = false;
    }

    /// The mannequin is to be on the stage; nothing of the shopper stays.
    pub fn wipe(&mut self) {
        self.waiting = None;
        self.wants_still = true;
    }

    /// Takes in what has left and calls who is due.
    pub fn look(&mut self) {
        // Whoever comes back was on before the one who is on now.
        while let Some(act) = self.doors.left.pop() {
            self.under_way[0] = false;
            self.mannequin.0 = (!self.is_still).then_some(act);
        }
        while let Some(reader) = self.doors.shown.pop() {
            self.under_way[1] = false;
            self.mannequin.1 = (!self.is_still).then_some(reader);
        }
        if self.under_way != [false; 2] {
            return;
        }
        if !self.wants_still && self.is_still {
            if let Some((act, reader)) = self.waiting.take() {
                self.call(act, reader);
            }
        } else if self.wants_still
            && !self.is_still
            && let (Some(act), Some(reader)) = (self.mannequin.0.take(), self.mannequin.1.take())
        {
            self.call(act, reader);
        }
    }

    fn call(&mut self, act: Box<Act<S>>, reader: Reader<Snapshot>) {
        self.is_still = !self.is_still;
        self.under_way = [true; 2];
        // Both queues are empty: one change is under way at a time.
        self.doors.call.push(act);
        self.doors.show.push(reader);
    }

    /// Whether nothing of a shopper is left: the mannequin is on the stage and nobody is on the way from it.
    pub fn is_wiped(&self) -> bool {
        self.is_still && self.waiting.is_none() && self.under_way == [false; 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_engine::frame::Times;
    use toile_engine::pace::queue::bounded;
    use toile_engine::relay::Relay;
    use toile_engine::skin::SkinningJob;

    /// Stage and renderer as threads have them: one act each.
    struct Threads {
        act: Box<Act<u8>>,
        next: Receiver<Box<Act<u8>>>,
        gone: Sender<Box<Act<u8>>>,
        show: Receiver<Reader<Snapshot>>,
        shown: Sender<Reader<Snapshot>>,
        reader: Reader<Snapshot>,
    }

    impl Threads {
        fn turn(&mut self) {
            if let Some(next) = self.next.pop() {
                self.gone.push(std::mem::replace(&mut self.act, next));
            }
            if let Some(next) = self.show.pop() {
                self.shown.push(std::mem::replace(&mut self.reader, next));
            }
        }
    }

    /// Of nothing at all: no vertex, no garment.
    fn reader() -> Reader<Snapshot> {
        let skin = SkinningJob::new::<4>(&[], &[], &[]).unwrap().posed();
        Relay::new(&Snapshot { tick: 0, times: Times::default(), skin, garments: Box::new([]) }).reader
    }

    fn set() -> (Changing<u8>, Threads) {
        let ((call, next), (gone, left)) = (bounded("", 4), bounded("", 4));
        let ((show, showing), (shown, back)) = (bounded("", 4), bounded("", 4));
        let changing = Changing::new(Doors { call, left, show, shown: back });
        let act = Box::new(Act { scene: 0, still: None });
        (changing, Threads { act, next, gone, show: showing, shown, reader: reader() })
    }

    #[test]
    fn shoppers_come_and_the_mannequin_returns_each_time() {
        let (mut changing, mut threads) = set();
        for shopper in 1..4 {
            changing.bring(shopper, reader());
            for _ in 0..2 {
                changing.look();
                threads.turn();
            }
            assert_eq!(threads.act.scene, shopper);
            assert!(!changing.is_wiped());
            changing.wipe();
            for _ in 0..3 {
                changing.look();
                threads.turn();
            }
            changing.look();
            assert_eq!(threads.act.scene, 0, "the mannequin");
            assert!(changing.is_wiped());
        }
    }

    #[test]
    fn who_leaves_before_the_stage_has_changed_is_wiped_all_the_same() {
        let (mut changing, mut threads) = set();
        changing.bring(7, reader());
        changing.look();
        // Called, but physics has not looked yet.
        changing.wipe();
        changing.look();
        assert!(!changing.is_wiped());
        for _ in 0..4 {
            threads.turn();
            changing.look();
        }
        assert_eq!(threads.act.scene, 0);
        assert!(changing.is_wiped());
        // And one who was never called is not kept.
        changing.bring(8, reader());
        changing.wipe();
        changing.look();
        threads.turn();
        assert!(threads.act.scene == 0 && changing.is_wiped());
    }
}
