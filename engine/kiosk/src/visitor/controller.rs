//! The controller of a visit: feeds the visitor's model with the reports of the sensor and the window, and carries out its effects.

use std::sync::Arc;

use toile_assets::sizes::Population;
use toile_base::frame::Joints;
use toile_engine::frame_loop::physics_thread::LoopScene;
use toile_engine::frame_loop::sensor_thread::ObservedFrame;
use toile_fitting::dress::measured;
use toile_fitting::dress::session;
use toile_fitting::live::own_picture::PictureSwitch;
use toile_fitting::live::shopper_source::ShopperSource;
use toile_track::gesture::Gestures;

use super::dressing_worker::{
    DrapedFrame, DressingContext, DressingJob, DressingWorker, JobResult, MeasuredVisitor, MeasuringJob,
};
use super::face_camera::FaceCamera;
use super::model::{Effect, Input, VisitModel};
use super::own_face::{Portrait, WornFace};
use super::presence::{Presence, PresenceTracker};
use super::wardrobe::{Outfit, Wardrobe};
use crate::error::KioskError;
use crate::service::controller::{ControllerContext, SessionController};
use crate::service::session::{SessionState, StateChange};
use crate::service::stock_watch::{StockChange, StockFigures, StockWatch};

/// A sensor frame older than this says nothing about who is there at the moment (ns).
const STALE_NS: u64 = 500_000_000;

/// Most sensor frames that a shopper is measured from: the longest measuring at 60 Hz.
const MOST_FRAMES: usize = 3600;

/// Fewest frames that a person can be measured from.
const FEWEST_FRAMES: usize = 10;

/// A window, as the controller has it.
pub trait VisitWindow {
    /// The next input from the display since the last poll, if any.
    fn next_input(&mut self) -> Option<Input>;

    /// Shows the model's page; returns a line for the operator, where there is one.
    fn show(&mut self, model: &VisitModel) -> Option<String>;

    /// Shows two outfits beside each other, or none any more.
    fn show_two(&mut self, two: Option<&[DrapedFrame; 2]>);
}

/// A window that shows nothing: that of a kiosk without a display.
pub struct NoWindow;

impl VisitWindow for NoWindow {
    fn next_input(&mut self) -> Option<Input> {
        None
    }

    fn show(&mut self, _model: &VisitModel) -> Option<String> {
        None
    }

    fn show_two(&mut self, _two: Option<&[DrapedFrame; 2]>) {}
}

/// Measuring that takes longer than this many times its own time has found no person.
const PATIENCE: u64 = 4;

/// Jobs that wait for the worker: the last of each kind.
#[derive(Default)]
struct PendingJobs {
    measure: Option<(u32, MeasuringJob)>,
    dress: Option<(u32, Outfit)>,
    two: Option<(u32, Box<[Outfit; 2]>)>,
    snap: Option<(u32, Outfit, f32)>,
    face: Option<(u32, Outfit, Arc<Portrait>)>,
}

/// A measurement under way.
struct OngoingMeasurement {
    number: u32,
    seated: bool,
    since_ns: u64,
    frames: Vec<Joints>,
}

/// The controller of a visit.
pub struct VisitController<'a> {
    model: VisitModel,
    window: Box<dyn VisitWindow + 'a>,
    worker: DressingWorker,
    /// The recording that shoppers are measured from, where one is played.
    played: Option<ShopperSource>,
    presence: PresenceTracker,
    gestures: Gestures,
    /// When a frame last came (ns), what was seen in it, and the last in which a person stood.
    seen: (u64, Presence),
    pose: Option<Joints>,
    /// When depth last came (ns), and up to which time of a recording it was seen since measuring began (ns).
    depth_ns: Option<u64>,
    until_ns: u64,
    /// Gestures that the model has yet to take.
    made: Vec<toile_track::gesture::Gesture>,
    measuring: Option<OngoingMeasurement>,
    jobs: PendingJobs,
    /// Whether the next who is dressed is another one than is shown.
    afresh: bool,
    /// Whether the camera's pictures are handed to the renderer, where shoppers may see themselves.
    switch: Option<PictureSwitch>,
    /// Takes pictures for faces, where shoppers may have theirs taken, and what they wear while one is taken.
    faces: Option<FaceCamera>,
    portrayed: Outfit,
    /// The face that their figure wears.
    worn_face: WornFace,
    watch: Option<StockWatch<Arc<Wardrobe>>>,
    /// Lines for the operator.
    lines: Vec<String>,
}

impl<'a> VisitController<'a> {
    /// No person is in view. `mark` is the mark's place on the floor (x, z in the sensor's world, m), if that is known.
    pub fn new(
        model: VisitModel,
        window: Box<dyn VisitWindow + 'a>,
        context: DressingContext,
        played: Option<ShopperSource>,
        mark: Option<[f32; 2]>,
    ) -> Self {
        Self {
            model,
            window,
            worker: DressingWorker::new(context),
            played,
            presence: PresenceTracker::new(mark),
            gestures: Gestures::new(),
            seen: (0, Presence::default()),
            pose: None,
            depth_ns: None,
            until_ns: 0,
            made: Vec::new(),
            measuring: None,
            jobs: PendingJobs::default(),
            afresh: true,
            switch: None,
            faces: None,
            portrayed: Outfit::new(),
            worn_face: WornFace::default(),
            watch: None,
            lines: Vec::new(),
        }
    }

    /// The same with a stock that is watched.
    #[must_use]
    pub fn watching(self, watch: Option<StockWatch<Arc<Wardrobe>>>) -> Self {
        Self { watch, ..self }
    }

    /// The same, which switches the camera's pictures on and off.
    #[must_use]
    pub fn switching(self, switch: Option<PictureSwitch>) -> Self {
        Self { switch, ..self }
    }

    /// The same, which takes the faces of those who ask for it; the dressing side reads `worn`. Nothing is offered where no face can be
    /// taken.
    #[must_use]
    pub fn taking_faces(mut self, faces: Option<FaceCamera>, worn: WornFace) -> Self {
        if faces.is_some() && self.worker.makes_faces() {
            self.model.offer_faces();
            self.faces = faces;
        }
        Self { worn_face: worn, ..self }
    }

    /// Takes a stock that was read again, when no person is in view: a visitor keeps what they see.
    fn restock<S: LoopScene, O>(&mut self, context: &mut ControllerContext<S, O>) {
        let Some(watch) = &mut self.watch else { return };
        watch.poll();
        if self.model.is_idle()
            && !self.worker.is_busy()
            && context.is_at_rest()
            && let Some(StockChange { stock, hung, mannequin }) = watch.take()
        {
            self.model.restock(hung.clone(), stock.first.names());
            self.worker.restock(hung, stock.first.clone());
            context.restock(stock.first, mannequin);
        }
    }

    /// Updates the model with an input and carries out its effects.
    fn update<S: LoopScene, O>(&mut self, now: u64, input: Input, context: &mut ControllerContext<S, O>) {
        for effect in self.model.update(now, input) {
            self.run(now, effect, context);
        }
    }

    fn run<S: LoopScene, O>(&mut self, now: u64, effect: Effect, context: &mut ControllerContext<S, O>) {
        match effect {
            Effect::Measure { number, seated } => {
                self.played.iter().for_each(ShopperSource::begin);
                self.measuring = Some(OngoingMeasurement { number, seated, since_ns: now, frames: Vec::new() });
                self.until_ns = 0;
            }
            Effect::MeasureTurn { number } => match self.played.clone() {
                Some(source) => {
                    let job = MeasuringJob { source, seated: false, until_ns: self.until_ns };
                    self.jobs.measure = Some((number, job));
                }
                // Of joints alone no turn is offered.
                None => self.update(now, Input::Failed(number), context),
            },
            Effect::Dress { number, outfit } => self.jobs.dress = Some((number, outfit)),
            Effect::DrapeTwo { number, outfits } => self.jobs.two = Some((number, outfits)),
            Effect::Snap { number, outfit, yaw } => self.jobs.snap = Some((number, outfit, yaw)),
            Effect::TakeFace { number, outfit } => {
                self.portrayed = outfit;
                self.faces.iter_mut().for_each(|faces| faces.ask(number, now));
            }
            Effect::Hide => self.clear(context),
            Effect::Forget => {
                self.clear(context);
                self.pose = None;
                self.played.iter().for_each(ShopperSource::forget);
                (self.depth_ns, self.until_ns) = (None, 0);
                self.presence.forget();
                self.gestures.reset();
                self.made.clear();
            }
        }
    }

    /// Nothing of the shopper is to be seen any more, and no work for them goes on.
    fn clear<S: LoopScene, O>(&mut self, context: &mut ControllerContext<S, O>) {
        self.worker.forget();
        self.worn_face.take_away();
        self.faces.iter_mut().for_each(FaceCamera::cancel);
        self.portrayed.clear();
        (self.jobs, self.measuring, self.afresh) = (PendingJobs::default(), None, true);
        context.changer.wipe();
        self.window.show_two(None);
    }

    /// Takes what the worker has done.
    fn done<S: LoopScene, O>(&mut self, now: u64, number: u32, done: JobResult, context: &mut ControllerContext<S, O>) {
        let input = match done {
            JobResult::Measured(known) => {
                let sex = measured::sex(known.population, Population::Women);
                if let Some(camera) = self.played.as_ref().and_then(ShopperSource::camera) {
                    camera.follow(sex);
                }
                Input::Measured(number, known)
            }
            JobResult::Dressed(dressed) => {
                // What was asked for before something else was is not shown.
                if !self.model.awaits_dress(number) {
                    return;
                }
                let act = context.scene(*dressed);
                context.changer.show(act, std::mem::take(&mut self.afresh));
                Input::Dressed(number)
            }
            JobResult::Two(two) => {
                self.window.show_two(Some(&*two));
                Input::Draped(number)
            }
            JobResult::Picture(offered) => Input::PictureTaken(number, offered),
            JobResult::Face(made) => {
                let taken = made.map(|heads| self.worn_face.put_on(heads));
                Input::FaceTaken(number, taken)
            }
            JobResult::Failed => Input::Failed(number),
        };
        self.update(now, input, context);
    }

    /// Gives the worker the picture that was asked for, or says that there is none.
    fn take_face<S: LoopScene, O>(&mut self, now: u64, context: &mut ControllerContext<S, O>) {
        let taken = self.faces.as_mut().and_then(|faces| faces.poll(now));
        match taken {
            Some((number, Ok(portrait))) => self.jobs.face = Some((number, self.portrayed.clone(), portrait)),
            Some((number, Err(trouble))) => self.update(now, Input::FaceTaken(number, Err(trouble)), context),
            None => {}
        }
    }

    /// Ends measuring when enough was seen, or when too little came for too long.
    fn measure<S: LoopScene, O>(&mut self, now: u64, context: &mut ControllerContext<S, O>) {
        let Some(measuring) = &self.measuring else { return };
        let (lasted, whole) = (now.saturating_sub(measuring.since_ns), self.model.times().measure_ns);
        let enough = measuring.frames.len() >= FEWEST_FRAMES;
        if lasted < whole || (!enough && lasted < PATIENCE * whole) {
            return;
        }
        let Some(OngoingMeasurement { number, seated, frames, .. }) = self.measuring.take() else { return };
        if enough {
            let source = self.played.clone().unwrap_or(ShopperSource::Joints(frames));
            // The front first: the shopper does not wait for a turn that may not come.
            self.jobs.measure = Some((number, MeasuringJob { source, seated, until_ns: 0 }));
        } else {
            self.update(now, Input::Failed(number), context);
        }
    }

    /// Gives the worker the next job.
    fn start_next_job(&mut self) -> Result<(), KioskError> {
        if self.worker.is_busy() {
            return Ok(());
        }
        let client = || Some(Box::new(MeasuredVisitor { known: self.model.known()?.clone(), pose: self.pose? }));
        let jobs = &mut self.jobs;
        let job = if let Some((number, job)) = jobs.measure.take() {
            Some((number, DressingJob::Measure(job)))
        } else if let Some((number, outfit)) = jobs.dress.take() {
            client().map(|client| (number, DressingJob::Dress(client, outfit)))
        } else if let Some((number, outfits)) = jobs.two.take() {
            client().map(|client| (number, DressingJob::Two(client, outfits)))
        } else if let Some((number, outfit, yaw)) = jobs.snap.take() {
            client().map(|client| (number, DressingJob::Snap(client, outfit, yaw)))
        } else if let Some((number, outfit, portrait)) = jobs.face.take() {
            client().map(|client| (number, DressingJob::Face(client, outfit, portrait)))
        } else {
            None
        };
        let Some((number, job)) = job else { return Ok(()) };
        self.worker.begin(number, job).map_err(KioskError::internal)
    }

    /// Shows what has changed.
    fn show(&mut self) {
        self.lines.extend(self.window.show(&self.model));
    }
}

impl<S: LoopScene, O> SessionController<S, O> for VisitController<'_> {
    fn state(&self) -> SessionState {
        self.model.state()
    }

    fn frame(&mut self, frame: ObservedFrame) {
        let ObservedFrame { raw, filtered, depth, others: (others, nearer) } = frame;
        if let Some(image) = &depth {
            self.depth_ns = Some(raw.time_ns);
            self.until_ns = self.until_ns.max(image.frame().time_ns);
        }
        // Depth comes more seldom than joints do.
        let has_depth = self.depth_ns.is_some_and(|then| raw.time_ns.saturating_sub(then) < STALE_NS);
        let seen = self.presence.push(&raw);
        let people = if seen.people > 0 { seen.people.saturating_add(others) } else { 0 };
        self.seen = (raw.time_ns, Presence { depth: has_depth, people, nearer: nearer && people > 0, ..seen });
        if session::is_present(&filtered) {
            self.pose = Some(filtered);
        }
        let depth = depth.as_ref().map(|image| image.frame());
        self.made.extend(self.gestures.push(&filtered, depth).into_iter().flatten().map(|event| event.gesture));
        if let Some(measuring) = &mut self.measuring
            && session::is_present(&raw)
            && measuring.frames.len() < MOST_FRAMES
        {
            measuring.frames.push(raw);
        }
    }

    fn poll(&mut self, now: u64, context: &mut ControllerContext<S, O>) -> Result<Option<StateChange>, KioskError> {
        let from = self.model.state();
        let stale = now.saturating_sub(self.seen.0) >= STALE_NS;
        let seen = if stale { Presence::default() } else { self.seen.1 };
        self.update(now, Input::Presence(seen), context);
        if let Some(camera) = self.played.as_ref().and_then(ShopperSource::camera) {
            let state = camera.figures().state;
            self.update(now, Input::Camera(state), context);
        }
        if let Some(outcome) = self.switch.as_ref().map(PictureSwitch::outcome) {
            self.update(now, Input::OwnPicture(outcome), context);
        }
        while let Some(input) = self.window.next_input() {
            self.update(now, input, context);
        }
        for gesture in std::mem::take(&mut self.made) {
            self.update(now, Input::Gesture(gesture), context);
        }
        if let Some((number, done)) = self.worker.poll()? {
            self.done(now, number, done, context);
        }
        self.take_face(now, context);
        self.measure(now, context);
        self.start_next_job()?;
        self.restock(context);
        // Pictures are copied only while the visitor looks at themselves.
        if let Some(switch) = &self.switch {
            let shows = self.model.shows_own_picture();
            if switch.is_on() != shows {
                switch.set(shows);
            }
        }
        self.show();
        let to = self.model.state();
        Ok((from != to).then_some(StateChange { from, to }))
    }

    fn lines(&mut self) -> Vec<String> {
        let mut lines = std::mem::take(&mut self.lines);
        lines.extend(self.watch.iter_mut().flat_map(StockWatch::lines));
        lines
    }

    fn stock(&self) -> Option<&StockFigures> {
        self.watch.as_ref().map(StockWatch::figures)
    }
}
