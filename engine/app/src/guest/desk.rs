//! Desk: the guest's machine at work in the kiosk's service: what the sensor and the window say goes in, what it decides is done.

use toile_engine::frame::{Frame, Snapshot};
use toile_engine::pace::physics::Scene;
use toile_engine::pace::queue::Sender;
use toile_engine::relay::Writer;
use toile_sensors::filter::{FilterSettings, JointFilter};
use toile_sensors::frame::Joints;
use toile_track::gesture::Gestures;

use super::atelier::{Atelier, Client, Done, Job, Room};
use super::layout::Mount;
use super::model::{Errand, Input, Model};
use super::screen::Screen;
use super::shelf::Outfit;
use super::sight::{Seen, Watcher};
use super::words::Words;
use crate::exit::AppError;
use crate::kiosk::host::{FEWEST_FRAMES, Hall, Host, MOST_FRAMES, STALE_NS};
use crate::kiosk::session::{Change, State};
use crate::kiosk::tailor::{self, Work};
use crate::shopper;

/// Two outfits, draped, as the eye has to know them: left and right.
pub type Pair<O> = Box<[O; 2]>;

/// What was asked for at the display since the last look, one by one.
pub type Asked<'a> = Box<dyn FnMut() -> Option<Input> + 'a>;

/// The window's ends.
pub struct Front<'a, O> {
    /// Where screens go: the latest is shown.
    pub screens: Writer<Screen>,
    /// What is asked for at the display: the end of a bounded queue.
    pub asked: Asked<'a>,
    /// Where two outfits go, and none when they are to be seen no more.
    pub pairs: Sender<Option<Pair<O>>>,
    /// What the eye has to know of a frame as it lies in a snapshot.
    pub draped: fn(&Frame, &Snapshot) -> O,
}

/// Measuring that takes longer than this many times its own time has found nobody.
const PATIENCE: u64 = 4;

/// Jobs that wait for the atelier: the last of each kind.
#[derive(Default)]
struct Orders {
    measure: Option<(u32, tailor::Model, bool)>,
    dress: Option<(u32, Outfit)>,
    two: Option<(u32, Box<[Outfit; 2]>)>,
    snap: Option<(u32, Outfit, f32)>,
}

/// Measuring under way.
struct Measuring {
    number: u32,
    seated: bool,
    since_ns: u64,
    frames: Vec<Joints>,
}

/// The desk.
pub struct Desk<'a, O> {
    model: Model,
    words: Words,
    mount: Mount,
    front: Front<'a, O>,
    atelier: Atelier,
    /// The recording that shoppers are measured from, where one is played.
    played: Option<tailor::Model>,
    watcher: Watcher,
    filter: JointFilter,
    gestures: Gestures,
    /// When a frame last came (ns), what was seen in it, and the last in which somebody stood.
    seen: (u64, Seen),
    pose: Option<Joints>,
    /// Gestures that the machine has yet to be told.
    made: Vec<toile_track::gesture::Gesture>,
    measuring: Option<Measuring>,
    orders: Orders,
    /// Whether the next who is dressed is another one than stands on the stage.
    afresh: bool,
    shown: Option<Screen>,
}

impl<'a, O> Desk<'a, O> {
    /// Nobody is there. `mark` is the mark's place on the floor (x, z in the sensor's world, m), if that is known.
    pub fn new(
        (model, words, mount): (Model, Words, Mount),
        front: Front<'a, O>,
        room: Room,
        played: Option<tailor::Model>,
        mark: Option<[f32; 2]>,
    ) -> Self {
        Self {
            model,
            words,
            mount,
            front,
            atelier: Atelier::new(room),
            played,
            watcher: Watcher::new(mark),
            filter: JointFilter::new(FilterSettings::default()),
            gestures: Gestures::new(),
            seen: (0, Seen::default()),
            pose: None,
            made: Vec::new(),
            measuring: None,
            orders: Orders::default(),
            afresh: true,
            shown: None,
        }
    }

    /// Tells the machine something and does what it decides.
    fn tell<S: Scene>(&mut self, now: u64, input: Input, hall: &mut Hall<S, O>) {
        for errand in self.model.update(now, input) {
            self.run(now, errand, hall);
        }
    }

    fn run<S: Scene>(&mut self, now: u64, errand: Errand, hall: &mut Hall<S, O>) {
        match errand {
            Errand::Measure { number, seated } => {
                self.measuring = Some(Measuring { number, seated, since_ns: now, frames: Vec::new() });
            }
            Errand::Dress { number, outfit } => self.orders.dress = Some((number, outfit)),
            Errand::DrapeTwo { number, outfits } => self.orders.two = Some((number, outfits)),
            Errand::Snap { number, outfit, yaw } => self.orders.snap = Some((number, outfit, yaw)),
            Errand::Hide => self.clear(hall),
            Errand::Forget => {
                self.clear(hall);
                self.pose = None;
                self.watcher.forget();
                self.gestures.reset();
                self.made.clear();
            }
        }
    }

    /// Nothing of the shopper is to be seen any more, and no work for them goes on.
    fn clear<S: Scene>(&mut self, hall: &mut Hall<S, O>) {
        self.atelier.forget();
        (self.orders, self.measuring, self.afresh) = (Orders::default(), None, true);
        hall.changing.wipe();
        self.front.pairs.push(None);
    }

    /// Takes what the atelier has done.
    fn done<S: Scene>(&mut self, now: u64, number: u32, done: Done, hall: &mut Hall<S, O>) {
        let input = match done {
            Done::Measured(known) => Input::Measured(number, known),
            Done::Dressed(dressed) => {
                // What was asked for before something else was is not shown.
                if !self.model.awaits_dress(number) {
                    return;
                }
                let act = hall.act(*dressed);
                hall.changing.bring(act, std::mem::take(&mut self.afresh));
                Input::Dressed(number)
            }
            Done::Two(two) => {
                let [left, right] = two.each_ref().map(|(frame, snapshot)| (self.front.draped)(frame, snapshot));
                self.front.pairs.push(Some(Box::new([left, right])));
                Input::Draped(number)
            }
            Done::Picture(code) => Input::PictureTaken(number, code),
            Done::Failed => Input::Failed(number),
        };
        self.tell(now, input, hall);
    }

    /// Ends measuring when enough was seen, or when too little came for too long.
    fn measure<S: Scene>(&mut self, now: u64, hall: &mut Hall<S, O>) {
        let Some(measuring) = &self.measuring else { return };
        let (lasted, whole) = (now.saturating_sub(measuring.since_ns), self.model.rules().measure_ns);
        let enough = measuring.frames.len() >= FEWEST_FRAMES;
        if lasted < whole || (!enough && lasted < PATIENCE * whole) {
            return;
        }
        let Some(Measuring { number, seated, frames, .. }) = self.measuring.take() else { return };
        if enough {
            let model = self.played.clone().unwrap_or(tailor::Model::Joints(frames));
            self.orders.measure = Some((number, model, seated));
        } else {
            self.tell(now, Input::Failed(number), hall);
        }
    }

    /// Gives the atelier the next job.
    fn order(&mut self) -> Result<(), AppError> {
        if self.atelier.is_busy() {
            return Ok(());
        }
        let client = || Some(Box::new(Client { known: self.model.known()?.clone(), pose: self.pose? }));
        let orders = &mut self.orders;
        let job = if let Some((number, model, seated)) = orders.measure.take() {
            Some((number, Job::Measure(model, seated)))
        } else if let Some((number, outfit)) = orders.dress.take() {
            client().map(|client| (number, Job::Dress(client, outfit)))
        } else if let Some((number, outfits)) = orders.two.take() {
            client().map(|client| (number, Job::Two(client, outfits)))
        } else if let Some((number, outfit, yaw)) = orders.snap.take() {
            client().map(|client| (number, Job::Snap(client, outfit, yaw)))
        } else {
            None
        };
        let Some((number, job)) = job else { return Ok(()) };
        self.atelier.begin(number, job).map_err(AppError::internal)
    }

    /// Shows what has changed.
    fn show(&mut self) {
        let screen = Screen::of(&self.model, &self.words, &self.mount);
        if self.shown.as_ref() != Some(&screen) {
            self.front.screens.publish(screen.clone());
            self.shown = Some(screen);
        }
    }
}

impl<S: Scene, O> Host<S, O> for Desk<'_, O> {
    fn state(&self) -> State {
        self.model.state()
    }

    fn frame(&mut self, frame: Joints) {
        self.seen = (frame.time_ns, self.watcher.push(&frame));
        let filtered = self.filter.push(&frame);
        if shopper::is_seen(&filtered) {
            self.pose = Some(filtered);
        }
        self.made.extend(self.gestures.push(&filtered, None).into_iter().flatten().map(|event| event.gesture));
        if let Some(measuring) = &mut self.measuring
            && shopper::is_seen(&frame)
            && measuring.frames.len() < MOST_FRAMES
        {
            measuring.frames.push(frame);
        }
    }

    fn work(&mut self, _work: Work) {}

    fn look(&mut self, now: u64, hall: &mut Hall<S, O>) -> Result<Option<Change>, AppError> {
        let from = self.model.state();
        let stale = now.saturating_sub(self.seen.0) >= STALE_NS;
        let seen = if stale { Seen::default() } else { self.seen.1 };
        self.tell(now, Input::Seen(seen), hall);
        while let Some(input) = (self.front.asked)() {
            self.tell(now, input, hall);
        }
        for gesture in std::mem::take(&mut self.made) {
            self.tell(now, Input::Gesture(gesture), hall);
        }
        if let Some((number, done)) = self.atelier.look()? {
            self.done(now, number, done, hall);
        }
        self.measure(now, hall);
        self.order()?;
        self.show();
        let to = self.model.state();
        Ok((from != to).then_some(Change { from, to }))
    }
}
