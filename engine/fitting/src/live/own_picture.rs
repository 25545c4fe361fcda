//! Channel of the camera's pictures to the mirror and to the face camera, each with what was seen in it: the latest only, in
//! memory alone, and only while a shopper looks at themselves or has their face taken.
//!
//! A picture is handed on once its joints are there, so that garment and picture are of one moment. The renderer's result comes
//! back as a number that only the two of them interpret.

use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU8};

use toile_base::frame::{DepthFrame, Joints};
use toile_engine::triple_buffer::{Reader, TripleBuffer, Writer};
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::person_mask::PersonMask;
use toile_sensors::source::live::ColourImage;

/// Copies of a picture that are on their way or held: as many have to be wiped.
const COPIES: u8 = 3;

/// A picture, and what was seen in it.
#[derive(Debug, Clone)]
pub struct SeenPicture {
    /// When it was taken (ns); 0 is none.
    pub taken_ns: u64,
    /// When it arrived (ns).
    pub arrived_ns: u64,
    /// The picture; of no size where there is none.
    pub picture: ColourImage,
    /// How it was seen; none where that is not known.
    pub camera: Option<ColourCamera>,
    /// The joints in it, in our world.
    pub joints: Joints,
    /// Depth of the same moment, shared with the tracker.
    pub depth: Option<Arc<DepthFrame>>,
    /// Odds of a person; of no size where nothing is known.
    pub mask: PersonMask,
}

impl Default for SeenPicture {
    fn default() -> Self {
        Self {
            taken_ns: 0,
            arrived_ns: 0,
            picture: ColourImage::default(),
            camera: None,
            joints: Joints::absent(0),
            depth: None,
            mask: PersonMask::default(),
        }
    }
}

impl SeenPicture {
    /// Nothing of it stays: its bytes are overwritten.
    fn wipe(&mut self) {
        self.picture.rgb.fill(0);
        (self.picture.width, self.picture.height) = (0, 0);
        self.mask.wipe();
        (self.taken_ns, self.arrived_ns, self.joints, self.depth) = (0, 0, Joints::absent(0), None);
    }
}

/// Copies a picture into storage that is there.
pub(super) fn copy(from: &ColourImage, to: &mut ColourImage) {
    (to.width, to.height) = (from.width, from.height);
    to.rgb.clone_from(&from.rgb);
}

/// Flags that both ends and the controller share. Relaxed throughout: each stands by itself and orders nothing.
#[derive(Debug, Default)]
struct Shared {
    /// Whether a person looks at themselves.
    wanted: AtomicBool,
    /// What the renderer last made of a picture.
    outcome: AtomicU8,
}

/// Decides whether pictures are handed on, and asks what became of them.
#[derive(Debug, Clone, Default)]
pub struct PictureSwitch(Arc<Shared>);

impl PictureSwitch {
    /// Hands pictures on from now on, or wipes those that are under way.
    pub fn set(&self, wanted: bool) {
        self.0.wanted.store(wanted, Relaxed);
        if !wanted {
            self.0.outcome.store(0, Relaxed);
        }
    }

    /// Whether they are handed on.
    pub fn is_on(&self) -> bool {
        self.0.wanted.load(Relaxed)
    }

    /// What the renderer made of the last picture.
    pub fn outcome(&self) -> u8 {
        self.0.outcome.load(Relaxed)
    }
}

/// The camera's end, of one receiver or of two.
#[derive(Debug, Default)]
pub struct PictureSender {
    outlets: Vec<PictureOutlet>,
}

/// One receiver's pictures.
#[derive(Debug)]
struct PictureOutlet {
    writer: Writer<SeenPicture>,
    /// Any of them switches it on.
    switches: Vec<PictureSwitch>,
    /// Copies that have yet to be wiped.
    unwiped: u8,
}

/// The receiving end.
#[derive(Debug)]
pub struct PictureReceiver {
    reader: Reader<SeenPicture>,
    switch: PictureSwitch,
}

impl PictureOutlet {
    fn new(switches: Vec<PictureSwitch>, switch: PictureSwitch) -> (Self, PictureReceiver) {
        let TripleBuffer { writer, reader } = TripleBuffer::new(&SeenPicture::default());
        (Self { writer, switches, unwiped: 0 }, PictureReceiver { reader, switch })
    }

    fn is_on(&self) -> bool {
        self.switches.iter().any(PictureSwitch::is_on)
    }

    fn wipe(&mut self) {
        if self.unwiped > 0 {
            self.unwiped -= 1;
            self.writer.publish_with(SeenPicture::wipe);
        }
    }
}

impl PictureSender {
    /// One more who looks at pictures, at times of their own; switched off. Called at load: it allocates, and the first pictures of a size allocate
    /// once more.
    pub fn also(&mut self) -> (PictureReceiver, PictureSwitch) {
        let switch = PictureSwitch::default();
        let (outlet, receiver) = PictureOutlet::new(vec![switch.clone()], switch.clone());
        self.outlets.push(outlet);
        (receiver, switch)
    }

    /// A channel before this one, switched by the same switches: it carries pictures to the stage that adds what was seen in them.
    pub(super) fn relay(&self) -> (Self, PictureReceiver) {
        let switches = self.outlets.iter().flat_map(|outlet| outlet.switches.clone()).collect();
        let (outlet, receiver) = PictureOutlet::new(switches, PictureSwitch::default());
        (Self { outlets: vec![outlet] }, receiver)
    }

    /// Hands a picture on where one is wanted: `fill` writes every part of an older one.
    pub fn send(&mut self, mut fill: impl FnMut(&mut SeenPicture)) {
        for outlet in &mut self.outlets {
            if outlet.is_on() {
                outlet.unwiped = COPIES;
                outlet.writer.publish_with(&mut fill);
            } else {
                outlet.wipe();
            }
        }
    }

    /// Whether pictures are wanted.
    pub fn is_on(&self) -> bool {
        self.outlets.iter().any(PictureOutlet::is_on)
    }

    /// Wipes one of the copies of each who wants none, as long as there are any.
    pub fn wipe(&mut self) {
        self.outlets.iter_mut().filter(|outlet| !outlet.is_on()).for_each(PictureOutlet::wipe);
    }

    /// Wipes every copy, also while pictures are wanted: the person has left.
    pub fn forget(&mut self) {
        for outlet in &mut self.outlets {
            outlet.unwiped = COPIES;
            outlet.wipe();
        }
    }
}

impl PictureReceiver {
    /// The newest picture if it was not looked at before.
    pub fn news(&mut self) -> Option<&SeenPicture> {
        self.reader.news()
    }

    /// The newest picture.
    pub fn latest(&mut self) -> &SeenPicture {
        self.reader.latest()
    }

    /// Says what became of it.
    pub fn report(&self, outcome: u8) {
        self.switch.0.outcome.store(outcome, Relaxed);
    }

    /// Whether a person looks at themselves.
    pub fn is_on(&self) -> bool {
        self.switch.is_on()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A channel of pictures, switched off.
    fn channel() -> (PictureSender, PictureReceiver, PictureSwitch) {
        let mut sender = PictureSender::default();
        let (receiver, switch) = sender.also();
        (sender, receiver, switch)
    }

    fn picture(seen: &mut SeenPicture) {
        seen.picture = ColourImage { width: 2, height: 1, rgb: vec![9; 6] };
        (seen.taken_ns, seen.arrived_ns) = (5, 7);
    }

    #[test]
    fn nothing_is_copied_while_no_picture_is_wanted() {
        let (mut sender, mut receiver, switch) = channel();
        sender.send(|_| panic!("no picture is wanted"));
        assert!(receiver.news().is_none());
        switch.set(true);
        sender.send(picture);
        assert_eq!(receiver.news().map(|seen| seen.taken_ns), Some(5));
        receiver.report(3);
        assert_eq!(switch.outcome(), 3);
    }

    #[test]
    fn who_looks_at_times_of_their_own_gets_pictures_then_and_no_other_does() {
        let (mut sender, mut mirror, mirror_switch) = channel();
        let (mut portrait, portrait_switch) = sender.also();
        let (relayed, _) = sender.relay();
        portrait_switch.set(true);
        assert!(sender.is_on() && relayed.is_on() && !mirror_switch.is_on());
        sender.send(picture);
        assert!(mirror.news().is_none() && portrait.news().is_some_and(|seen| seen.taken_ns == 5));
        portrait_switch.set(false);
        mirror_switch.set(true);
        for _ in 0..COPIES {
            sender.send(picture);
            let seen = portrait.news().expect("a blank one");
            assert!(seen.taken_ns == 0 && seen.picture.rgb.iter().all(|b| *b == 0));
        }
        sender.send(picture);
        assert!(portrait.news().is_none() && mirror.news().is_some());
    }

    #[test]
    fn every_copy_is_wiped_when_unwanted() {
        let (mut sender, mut receiver, switch) = channel();
        switch.set(true);
        for _ in 0..4 {
            sender.send(picture);
            receiver.news();
        }
        switch.set(false);
        let mut blank = 0;
        for _ in 0..6 {
            sender.send(picture);
            if let Some(seen) = receiver.news() {
                assert!(seen.picture.rgb.iter().all(|b| *b == 0) && seen.picture.width == 0 && seen.taken_ns == 0);
                blank += 1;
            }
        }
        assert_eq!(blank, COPIES);
        // All that is left in the three places is blank.
        assert!(receiver.latest().picture.rgb.iter().all(|b| *b == 0));
    }
}
