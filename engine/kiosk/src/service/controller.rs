//! The service's side of the controller of a session: the interface to the service, and the parts of the kiosk that it uses.

use std::sync::Arc;

use toile_base::frame::Joints;
use toile_engine::frame_loop::physics_thread::LoopScene;
use toile_engine::frame_loop::sensor_thread::ObservedFrame;
use toile_engine::world::World;
use toile_fitting::dress::try_on::{DressedWorld, TryOn};
use toile_fitting::live::background::{BackgroundJob, Finished};
use toile_fitting::live::scene_changer::{DressedScene, SceneChanger};

use super::session::{SessionState, StateChange};
use super::stock_watch::StockFigures;
use crate::error::KioskError;

/// Turns a dressed world into a scene of the loop, and into the data that the renderer needs.
pub type ToScene<S, O> = Box<dyn Fn(World) -> (S, O)>;

/// Parts of the kiosk that a controller uses.
pub struct ControllerContext<S, O> {
    /// How scenes are changed.
    pub changer: SceneChanger<S, O>,
    /// The request that every visitor begins with, the mannequin too.
    pub first: Arc<TryOn>,
    /// The mannequin that is being dressed.
    pub dressing: BackgroundJob<Result<DressedWorld, KioskError>>,
    /// Turns a dressed world into a scene of the loop, and into the data that the renderer needs.
    pub to_scene: ToScene<S, O>,
    /// How the mannequin stands.
    pub pose: Joints,
}

impl<S: LoopScene, O> ControllerContext<S, O> {
    /// A dressed person, as the loop takes them.
    pub fn scene(&self, dressed: DressedWorld) -> DressedScene<S, O> {
        DressedScene::new(dressed, &self.to_scene)
    }

    /// Has a mannequin dressed, where there is none to come back and no other job is under way.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn dress_mannequin(&mut self) -> Result<(), KioskError> {
        if !self.changer.lacks_mannequin() || self.dressing.is_running() {
            return Ok(());
        }
        let (first, pose) = (self.first.clone(), self.pose);
        self.dressing.start("toile-mannequin", move || first.on_mannequin(&pose)).map_err(KioskError::internal)
    }

    /// Keeps a mannequin that is dressed. One that could not be dressed is tried again.
    ///
    /// # Errors
    /// Where its thread panicked.
    pub fn take_mannequin(&mut self) -> Result<(), KioskError> {
        match self.dressing.poll() {
            Some(Finished::Done { value: Ok(mannequin), .. }) => {
                let scene = self.scene(mannequin);
                self.changer.stand_by(scene);
                Ok(())
            }
            Some(Finished::Panicked) => Err(KioskError::Internal(
                "the thread that dresses the mannequin panicked; start the kiosk again".into(),
            )),
            Some(Finished::Done { value: Err(_), .. }) | None => Ok(()),
        }
    }

    /// Whether only the mannequin is shown, and no shopper is being dressed.
    pub fn is_at_rest(&self) -> bool {
        self.changer.is_wiped() && !self.dressing.is_running()
    }

    /// From now on every visitor wears something else first, the mannequin too, where there is another one.
    pub fn restock(&mut self, first: Arc<TryOn>, mannequin: Option<Box<DressedWorld>>) {
        self.first = first;
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

    /// Decides, fifty times a second; returns the change of state, where there is one.
    ///
    /// # Errors
    /// What ends the service.
    fn poll(&mut self, now_ns: u64, context: &mut ControllerContext<S, O>) -> Result<Option<StateChange>, KioskError>;

    /// Lines for the operator, each once.
    fn lines(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// What the health line says of the stock, where it is watched.
    fn stock(&self) -> Option<&StockFigures> {
        None
    }
}
