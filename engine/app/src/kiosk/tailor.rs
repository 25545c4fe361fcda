//! The tailor: measures a shopper and dresses a body of their size, on a thread of its own, which nothing waits for.

use std::sync::Arc;
use std::thread::{self, JoinHandle};

use toile_assets::body::{Measures, Sex};
use toile_assets::sizes::Population;
use toile_assets::wardrobe;
use toile_engine::frame::{Frame, Snapshot};
use toile_engine::triple_buffer::Reader;
use toile_sensors::frame::Joints;
use toile_sensors::source::Session;

use super::recording::Made;
use crate::exit::AppError;
use crate::outfit::{Recipe, Wish};
use crate::shopper;

/// A body of somebody's size, dressed.
pub struct Dressed {
    /// The frame, with one worker.
    pub frame: Frame,
    /// Where its snapshots come out.
    pub reader: Reader<Snapshot>,
    /// How it was made.
    pub made: Made,
}

impl Dressed {
    /// Dresses a body by a recipe, in the joints of a moment.
    ///
    /// # Errors
    /// A recipe of which no scene can be made.
    pub fn make(recipe: Recipe, first: &Joints, still: bool) -> Result<Self, AppError> {
        let (frame, reader) = recipe.make(first)?;
        Ok(Self { frame, reader, made: Made { recipe, first: *first, still } })
    }
}

/// What is to be done.
#[derive(Debug, Clone)]
pub enum Job {
    /// Measure a shopper and dress them.
    Shopper(Model),
    /// Dress the mannequin, as these joints stand.
    Mannequin(Box<Joints>),
}

/// Where measures are taken from.
#[derive(Debug, Clone)]
pub enum Model {
    /// The recording that is played, with its depth.
    Played(Arc<Session>),
    /// The joints of the last second, which are all that a live sender gives.
    Joints(Vec<Joints>),
}

/// The tailor.
#[derive(Debug)]
pub struct Tailor {
    wish: Wish,
    work: Option<JoinHandle<Result<Dressed, AppError>>>,
    /// Whether the shopper that the work is for has left.
    unwanted: bool,
}

/// What became of a job.
pub enum Work {
    /// Somebody is dressed: a shopper, or the mannequin, which stands still.
    Done(Box<Dressed>),
    /// They could not be measured; why is not told to anybody, for it may tell of them.
    Failed,
    /// The tailor's thread panicked.
    Died,
}

impl Tailor {
    /// One who dresses everybody in this.
    pub fn new(wish: Wish) -> Self {
        Self { wish, work: None, unwanted: false }
    }

    /// Whether a job is under way, wanted or not.
    pub fn is_busy(&self) -> bool {
        self.work.is_some()
    }

    /// Begins a job.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn begin(&mut self, job: Job) -> std::io::Result<()> {
        let wish = self.wish.clone();
        self.unwanted = false;
        let work = move || match job {
            Job::Shopper(model) => dress(&model, &wish),
            Job::Mannequin(pose) => mannequin(&wish, &pose),
        };
        self.work = Some(thread::Builder::new().name("toile-tailor".into()).spawn(work)?);
        Ok(())
    }

    /// The shopper has left: what comes of the job is thrown away.
    pub fn forget(&mut self) {
        self.unwanted = true;
    }

    /// What has come of a job, once, when it has ended.
    pub fn look(&mut self) -> Option<Work> {
        if !self.work.as_ref()?.is_finished() {
            return None;
        }
        match self.work.take()?.join() {
            Err(_) => Some(Work::Died),
            Ok(Ok(dressed)) if dressed.made.still => Some(Work::Done(Box::new(dressed))),
            _ if self.unwanted => None,
            Ok(Ok(dressed)) => Some(Work::Done(Box::new(dressed))),
            Ok(Err(_)) => Some(Work::Failed),
        }
    }
}

fn dress(model: &Model, wish: &Wish) -> Result<Dressed, AppError> {
    let live;
    let session = match model {
        Model::Played(session) => session.as_ref(),
        Model::Joints(joints) => {
            live = Session { name: "live".into(), joints: joints.clone(), raw_scale_known: true, ..Session::default() };
            &live
        }
    };
    let track = shopper::believable(session);
    let Some(first) = track.get(shopper::stands_from(&track)) else {
        return Err(AppError::Input("nobody stands there".into()));
    };
    Dressed::make(Recipe::write(session, wish)?, first, false)
}

/// The mannequin that stands in the mirror while nobody is measured: the middle size of the outermost garment, as `pose` has it.
///
/// # Errors
/// A garment that is not in the wardrobe, a size that is not made.
pub fn mannequin(wish: &Wish, pose: &Joints) -> Result<Dressed, AppError> {
    let names = if wish.garments.is_empty() { vec![wardrobe::names()[0].to_owned()] } else { wish.garments.clone() };
    let (mut garments, mut body) = (Vec::new(), None);
    for name in &names {
        let style = wardrobe::style(name).map_err(AppError::input)?;
        let table = style.sizes().map_err(AppError::input)?;
        let codes = table.codes();
        let size = wish.size.clone().unwrap_or_else(|| codes[codes.len() / 2].to_owned());
        let sex = if table.population == Population::Men { Sex::Male } else { Sex::Female };
        body = Some((sex, Measures::from(table.size_body(&size).map_err(AppError::input)?)));
        garments.push((name.clone(), size));
    }
    let Some((sex, m)) = body else { return Err(AppError::Input("no garment is named; name one in [wear]".into())) };
    let measures = [m.stature, m.shoulder_breadth, m.chest_girth, m.waist_girth, m.hip_girth];
    let recipe = Recipe {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        session: "mannequin".to_owned(),
        sex: if sex == Sex::Male { "male" } else { "female" }.to_owned(),
        measures: measures.map(f32::to_bits),
        garments,
        quality: wish.quality.name().to_owned(),
    };
    Dressed::make(recipe, pose, true)
}
