//! The window of a visit: pages with their texts and photographs on the way out, touch and keys on the way in.

use toile_engine::frame_loop::queue::Sender;
use toile_engine::triple_buffer::Writer;
use toile_engine::world::{Snapshot, World};

use super::controller::VisitWindow;
use super::dressing_worker::DrapedFrame;
use super::model::{Input, VisitModel};
use super::photographs::Photographs;
use super::reach::DisplayMount;
use super::screen::Screen;
use super::texts::Texts;

/// Two outfits, draped, as the renderer draws them: left and right.
pub type OutfitPair<O> = Box<[O; 2]>;

/// The next input from the display since the last poll, if any.
pub type NextInput<'a> = Box<dyn FnMut() -> Option<Input> + 'a>;

/// What the renderer has to know of a frame as it lies in a snapshot.
pub type ToOutfit<O> = Box<dyn Fn(&World, &Snapshot) -> O>;

/// The ends of the window's channels.
pub struct WindowChannels<'a, O> {
    /// Where screens go: the latest is shown.
    pub screens: Writer<Screen>,
    /// What is asked for at the display: the end of a bounded queue.
    pub next_input: NextInput<'a>,
    /// Where two outfits go, and none when they are to be seen no more.
    pub pairs: Sender<Option<OutfitPair<O>>>,
    /// What the renderer has to know of a frame as it lies in a snapshot.
    pub draped: ToOutfit<O>,
}

/// A window with pages.
pub struct PageWindow<'a, O> {
    texts: Texts,
    mount: DisplayMount,
    channels: WindowChannels<'a, O>,
    photographs: Photographs,
    shown: Option<Screen>,
}

impl<'a, O> PageWindow<'a, O> {
    /// A window on which nothing was shown yet.
    pub fn new(texts: Texts, mount: DisplayMount, channels: WindowChannels<'a, O>) -> Self {
        Self { texts, mount, channels, photographs: Photographs::default(), shown: None }
    }
}

impl<O> VisitWindow for PageWindow<'_, O> {
    fn next_input(&mut self) -> Option<Input> {
        (self.channels.next_input)()
    }

    fn show(&mut self, model: &VisitModel) -> Option<String> {
        let mut screen = Screen::of(model, &self.texts, &self.mount);
        let failed = self.photographs.show(&mut screen, model.wardrobe());
        if self.shown.as_ref() != Some(&screen) {
            self.channels.screens.publish(screen.clone());
            self.shown = Some(screen);
        }
        failed.map(|left| format!("a photograph is not shown: {}", left.why))
    }

    fn show_two(&mut self, two: Option<&[DrapedFrame; 2]>) {
        let pair =
            two.map(|two| Box::new(two.each_ref().map(|(world, snapshot)| (self.channels.draped)(world, snapshot))));
        self.channels.pairs.push(pair);
    }
}
