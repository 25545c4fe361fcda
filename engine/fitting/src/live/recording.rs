//! Recording: the last seconds before a crash, where the configuration asks for them. It holds joints and measures of the person
//! in view, so a shop has to ask for it by name.

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use toile_engine::clock::SimClock;
use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::physics_thread::{SceneStepper, WorldScene};
use toile_engine::frame_loop::queue::Sender;
use toile_engine::frame_loop::recording::{self, Entry, SceneNote};
use toile_engine::frame_loop::replay::{Replayed, replay_changing};
use toile_engine::workers::WorkerPool;
use toile_engine::world::World;

use super::crash;
use super::live_scene::LiveScene;
use crate::FittingError;
use crate::dress::try_on::{DressedWorld, TryOn};

/// What a recording of the kiosk says of itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KioskRecipe {
    /// Version of the program that wrote it.
    pub version: String,
    /// What it is of.
    pub kiosk: SceneNaming,
}

/// How a kiosk's recording names its scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SceneNaming {
    /// Each by a note of its number.
    Notes,
}

/// The text of a note.
#[derive(Serialize, Deserialize)]
struct DressingNote {
    still: bool,
    recipe: TryOn,
}

impl DressedWorld {
    /// The note of a recording that makes the same world again, under this number.
    pub fn note(&self, number: u64) -> SceneNote {
        let note = DressingNote { still: self.still, recipe: self.request.clone() };
        // Plain strings and numbers: it cannot fail, and a note without text is refused by the replay.
        let text = serde_json::to_string(&note).unwrap_or_default();
        SceneNote { number, first: self.first, text }
    }

    /// The world of a note.
    fn read(note: &SceneNote) -> Result<Self, FittingError> {
        let DressingNote { still, recipe } = serde_json::from_str(&note.text).map_err(|e| {
            FittingError::Input(format!(
                "what it says of scene {} is not understood ({e}); record it again",
                note.number
            ))
        })?;
        Ok(Self { still, ..recipe.build(&note.first)? })
    }

    /// The world as the loop steps it; with one worker, until another scene's are taken over.
    fn scene(self, crew: Option<WorkerPool>) -> LiveScene<WorldScene> {
        let stands = self.stands();
        let world = match crew {
            Some(crew) => self.world.with_workers(crew),
            None => self.world,
        };
        LiveScene::new(WorldScene::new(world), stands)
    }
}

/// A flight recorder for a run that begins with this scene, written to `path` if a thread panics; and the queue by which the
/// physics thread fills it.
///
/// # Errors
/// A header that cannot be written, which does not happen.
pub fn keep(first: &DressedWorld, path: PathBuf) -> Result<(Arc<FlightRecorder>, Sender<Entry>), FittingError> {
    let recipe = KioskRecipe { version: env!("CARGO_PKG_VERSION").to_owned(), kiosk: SceneNaming::Notes };
    let header = recording::header(&serde_json::to_string(&recipe).map_err(FittingError::internal)?);
    let (recorder, entries) = crash::record(header, path);
    recorder.describe(&first.note(0));
    recorder.keep(&Entry::Changed { number: 0, afresh: true });
    Ok((recorder, entries))
}

/// Takes a kiosk's recording again: the last frame, and what came out.
///
/// # Errors
/// A recording that does not begin with a dressed person, or a scene that cannot be made.
pub fn again(notes: &[SceneNote], entries: &[Entry], workers: usize) -> Result<(World, Replayed), FittingError> {
    let Some((Entry::Changed { number, .. }, entries)) = entries.split_first() else {
        return Err(FittingError::Input("it does not begin with a dressed person; record it again".into()));
    };
    let made = |number: u64| {
        let unknown = || FittingError::Input(format!("it does not say how scene {number} was made; record it again"));
        notes.iter().find(|note| note.number == number).ok_or_else(unknown).and_then(DressedWorld::read)
    };
    let crew = WorkerPool::new(workers).map_err(FittingError::input)?;
    let mut stepper = SceneStepper::new(made(*number)?.scene(Some(crew)));
    let mut refused = None;
    let out = replay_changing(&mut stepper, entries, &SimClock::default(), |number| {
        let stage = made(number).map(|made| made.scene(None));
        stage.map_err(|e| refused = refused.take().or(Some(e))).ok()
    });
    match refused {
        Some(error) => Err(error),
        None => Ok((stepper.scene.into_scene().world, out)),
    }
}
