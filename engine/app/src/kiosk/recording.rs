//! Recording: the last seconds before a crash, where the configuration asks for them. Joints and measures of whoever stood
//! there are in it, so a shop has to ask for it by name.

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use toile_engine::clock::SimClock;
use toile_engine::frame::Frame;
use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::physics_thread::{FrameScene, SceneStepper};
use toile_engine::frame_loop::queue::Sender;
use toile_engine::frame_loop::recording::{self, Entry, SceneNote};
use toile_engine::frame_loop::replay::{Replayed, replay_changing};
use toile_engine::workers::WorkerPool;
use toile_sensors::frame::Joints;

use super::stage::Stage;
use crate::crash;
use crate::exit::AppError;
use crate::outfit::Recipe;

/// What a recording of the kiosk says of itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KioskRecipe {
    /// Version of the program that wrote it.
    pub version: String,
    /// What it is of.
    pub kiosk: Kind,
}

/// How a kiosk's recording names its scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Each by a note of its number.
    Notes,
}

/// How a scene was made.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// Body, garments and quality.
    pub recipe: Recipe,
    /// The joints in which it was dressed.
    pub first: Joints,
    /// Whether it stands still there, as the mannequin does.
    pub still: bool,
}

/// The text of a note.
#[derive(Serialize, Deserialize)]
struct Said {
    still: bool,
    recipe: Recipe,
}

impl Made {
    /// The same for a recording, under this number.
    pub fn note(&self, number: u64) -> SceneNote {
        let said = Said { still: self.still, recipe: self.recipe.clone() };
        // Plain strings and numbers: it cannot fail, and a note without text is refused by the replay.
        let text = serde_json::to_string(&said).unwrap_or_default();
        SceneNote { number, first: self.first, text }
    }

    fn read(note: &SceneNote) -> Result<Self, AppError> {
        let Said { still, recipe } = serde_json::from_str(&note.text).map_err(|e| {
            AppError::Input(format!("what it says of scene {} is not understood ({e}); record it again", note.number))
        })?;
        Ok(Self { recipe, first: note.first, still })
    }

    /// Makes it again; with one worker, until another scene's are taken over.
    fn stage(&self, pool: Option<WorkerPool>) -> Result<Stage<FrameScene>, AppError> {
        let (frame, _reader) = self.recipe.make(&self.first)?;
        let frame = match pool {
            Some(pool) => frame.with_workers(pool),
            None => frame,
        };
        Ok(Stage::new(FrameScene::new(frame), self.still.then_some(self.first)))
    }

    /// Of nobody.
    #[cfg(test)]
    pub fn for_tests(still: bool) -> Self {
        let recipe = Recipe {
            version: String::new(),
            session: String::new(),
            sex: "female".into(),
            measures: [0; 5],
            garments: Vec::new(),
            quality: "shop".into(),
        };
        Self { recipe, first: Joints::absent(0), still }
    }
}

/// A black box for a run that begins with this scene, which a crash writes there; and where the loop's tape goes.
///
/// # Errors
/// A header that cannot be written, which does not happen.
pub fn keep(first: &Made, path: PathBuf) -> Result<(Arc<FlightRecorder>, Sender<Entry>), AppError> {
    let recipe = KioskRecipe { version: env!("CARGO_PKG_VERSION").to_owned(), kiosk: Kind::Notes };
    let header = recording::header(&serde_json::to_string(&recipe).map_err(AppError::internal)?);
    let (black_box, recording) = crash::record(header, path);
    black_box.describe(&first.note(0));
    black_box.keep(&Entry::Changed { number: 0, afresh: true });
    Ok((black_box, recording))
}

/// Takes a kiosk's recording again: the last frame, and what came out.
///
/// # Errors
/// A recording that does not begin where somebody was dressed, or a scene that cannot be made.
pub fn again(notes: &[SceneNote], entries: &[Entry], workers: usize) -> Result<(Frame, Replayed), AppError> {
    let Some((Entry::Changed { number, .. }, entries)) = entries.split_first() else {
        return Err(AppError::Input("it does not begin where somebody was dressed; record it again".into()));
    };
    let made = |number: u64| {
        let unknown = || AppError::Input(format!("it does not say how scene {number} was made; record it again"));
        notes.iter().find(|note| note.number == number).ok_or_else(unknown).and_then(Made::read)
    };
    let pool = WorkerPool::new(workers).map_err(AppError::input)?;
    let mut stepper = SceneStepper::new(made(*number)?.stage(Some(pool))?);
    let mut refused = None;
    let out = replay_changing(&mut stepper, entries, &SimClock::default(), |number| {
        let stage = made(number).and_then(|made| made.stage(None));
        stage.map_err(|e| refused = refused.take().or(Some(e))).ok()
    });
    match refused {
        Some(error) => Err(error),
        None => Ok((stepper.scene.into_scene().frame, out)),
    }
}
