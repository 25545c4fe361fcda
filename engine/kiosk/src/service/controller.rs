//! The controller of a session: decides when to measure and dress whoever stands there. Without a window that is the state
//! machine of the session alone.

use std::sync::Arc;

use toile_base::frame::Joints;
use toile_engine::frame::Frame;
use toile_engine::frame_loop::physics_thread::Scene;
use toile_engine::frame_loop::sensor_thread::ObservedFrame;
use toile_fitting::dress::attire::Attire;
use toile_fitting::dress::dressed::Dressed;
use toile_fitting::dress::session;
use toile_fitting::live::dresser::{DressJob, DressOutcome, Dresser, ShopperSource};
use toile_fitting::live::scene_changer::{DressedScene, SceneChanger};

use super::session::{SessionInput, SessionMachine, SessionState, SessionTimes, StateChange};
use super::stock_watch::{StockChange, StockFigures, StockWatch};
use crate::error::KioskError;

/// A sensor frame older than this says nothing about who is there at the moment (ns).
pub const STALE_NS: u64 = 500_000_000;

/// Most sensor frames that a shopper is measured from: the longest measuring at 60 Hz.
pub const MOST_FRAMES: usize = 3600;

/// Fewest frames that somebody can be measured from.
pub const FEWEST_FRAMES: usize = 10;

/// What a dressed frame becomes in the loop, and what the renderer has to know of it.
pub type ToScene<S, O> = Box<dyn Fn(Frame) -> (S, O)>;

/// Parts of the kiosk that a controller uses.
pub struct ControllerContext<S, O> {
    /// How scenes are changed.
    pub changer: SceneChanger<S, O>,
    /// Dresses the mannequin, and shoppers where no window does.
    pub dresser: Dresser,
    /// A dressed frame as a scene of the loop, and what the renderer has to know of it.
    pub to_scene: ToScene<S, O>,
    /// How the mannequin stands.
    pub pose: Joints,
}

impl<S: Scene, O> ControllerContext<S, O> {
    /// Somebody dressed, as the loop takes them.
    pub fn scene(&self, dressed: Dressed) -> DressedScene<S, O> {
        DressedScene::new(dressed, &self.to_scene)
    }

    /// Has a mannequin dressed, where there is none to come back and no other job is under way.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn dress_mannequin(&mut self) -> Result<(), KioskError> {
        if !self.changer.lacks_mannequin() || self.dresser.is_busy() {
            return Ok(());
        }
        self.dresser.begin(DressJob::Mannequin(Box::new(self.pose))).map_err(KioskError::internal)
    }

    /// Whether nobody is shown but the mannequin, and nobody is being dressed.
    pub fn is_at_rest(&self) -> bool {
        self.changer.is_wiped() && !self.dresser.is_busy()
    }

    /// From now on everybody wears something else first, the mannequin too, where there is another one.
    pub fn restock(&mut self, first: Arc<Attire>, mannequin: Option<Box<Dressed>>) {
        self.dresser.change(first);
        if let Some(mannequin) = mannequin {
            let scene = self.scene(*mannequin);
            self.changer.renew(scene);
        }
    }
}

/// Decides what happens in a session.
pub trait SessionController<S, O> {
    /// The state of the session.
    fn state(&self) -> SessionState;

    /// Takes a frame of the sensor, as it came and filtered.
    fn frame(&mut self, frame: ObservedFrame);

    /// Takes the result of a job that it gave; mannequins are not its own.
    fn work(&mut self, work: DressOutcome);

    /// Decides, fifty times a second; returns the change of state, where there is one.
    ///
    /// # Errors
    /// What ends the service.
    fn poll(&mut self, now_ns: u64, context: &mut ControllerContext<S, O>) -> Result<Option<StateChange>, KioskError>;

    /// Lines for whoever looks after the kiosk, each once.
    fn lines(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// What the health line says of the stock, where it is watched.
    fn stock(&self) -> Option<&StockFigures> {
        None
    }
}

/// The session alone: everybody who steps in is measured and dressed in the same.
pub struct HeadlessController {
    session: SessionMachine,
    /// Time over which a shopper is measured (ns).
    measure_ns: u64,
    /// The recording that shoppers are measured from, where one is played.
    played: Option<ShopperSource>,
    /// When a frame last came, and whether somebody was seen in it.
    seen: (u64, bool),
    /// What the shopper is measured from, and who was made of it.
    model: Vec<Joints>,
    fitted: Option<Box<Dressed>>,
    dressed: bool,
    watch: Option<StockWatch<()>>,
}

impl HeadlessController {
    /// Nobody is there, at this time (ns).
    pub fn new(times: SessionTimes, measure_ns: u64, played: Option<ShopperSource>, now_ns: u64) -> Self {
        let session = SessionMachine::new(times, now_ns);
        Self {
            session,
            measure_ns,
            played,
            seen: (0, false),
            model: Vec::new(),
            fitted: None,
            dressed: false,
            watch: None,
        }
    }

    /// The same with a stock that is watched.
    #[must_use]
    pub fn watching(self, watch: Option<StockWatch<()>>) -> Self {
        Self { watch, ..self }
    }

    /// Takes a stock that was read again, when nobody is there.
    fn restock<S: Scene, O>(&mut self, context: &mut ControllerContext<S, O>) {
        let Some(watch) = &mut self.watch else { return };
        watch.poll();
        if self.session.state() == SessionState::Attract
            && context.is_at_rest()
            && let Some(StockChange { stock, mannequin, .. }) = watch.take()
        {
            context.restock(stock.first, mannequin);
        }
    }

    /// What a change of state brings about.
    fn change<S: Scene, O>(&mut self, change: StateChange, context: &mut ControllerContext<S, O>) {
        match change.to {
            SessionState::Measuring => {
                self.model.clear();
                self.played.iter().for_each(ShopperSource::begin);
            }
            SessionState::TryOn => {
                self.model.clear();
                if let Some(fitted) = self.fitted.take() {
                    let act = context.scene(*fitted);
                    context.changer.show(act, true);
                }
            }
            SessionState::Left => {}
            SessionState::Attract => {
                self.model.clear();
                (self.fitted, self.dressed) = (None, false);
                context.dresser.forget();
                self.played.iter().for_each(ShopperSource::forget);
                context.changer.wipe();
            }
        }
    }
}

impl<S: Scene, O> SessionController<S, O> for HeadlessController {
    fn state(&self) -> SessionState {
        self.session.state()
    }

    fn frame(&mut self, frame: ObservedFrame) {
        let frame = frame.raw;
        self.seen = (frame.time_ns, session::is_present(&frame));
        if self.session.state() == SessionState::Measuring && self.seen.1 && self.model.len() < MOST_FRAMES {
            self.model.push(frame);
        }
    }

    fn work(&mut self, work: DressOutcome) {
        match work {
            DressOutcome::Done(dressed) => (self.fitted, self.dressed) = (Some(dressed), true),
            DressOutcome::Failed | DressOutcome::Panicked => self.model.clear(),
        }
    }

    fn poll(&mut self, now: u64, context: &mut ControllerContext<S, O>) -> Result<Option<StateChange>, KioskError> {
        let shopper = self.seen.1 && now.saturating_sub(self.seen.0) < STALE_NS;
        let change = self.session.update(now, SessionInput { shopper, dressed: self.dressed });
        if let Some(change) = change {
            self.change(change, context);
        }
        self.restock(context);
        let enough = self.session.lasted_ns(now) >= self.measure_ns && self.model.len() >= FEWEST_FRAMES;
        let wanted = self.session.state() == SessionState::Measuring && !self.dressed && !context.dresser.is_busy();
        if enough && wanted {
            let model = self.played.clone();
            let model = model.unwrap_or_else(|| ShopperSource::Joints(std::mem::take(&mut self.model)));
            context.dresser.begin(DressJob::Shopper(model)).map_err(KioskError::internal)?;
        }
        Ok(change)
    }

    fn lines(&mut self) -> Vec<String> {
        self.watch.as_mut().map(StockWatch::lines).unwrap_or_default()
    }

    fn stock(&self) -> Option<&StockFigures> {
        self.watch.as_ref().map(StockWatch::figures)
    }
}
