//! Somebody dressed: a shopper of the measures that were taken, or the mannequin that stands in for one.

use toile_base::frame::Joints;
use toile_engine::frame::{Frame, Snapshot};
use toile_engine::triple_buffer::Reader;
use toile_sensors::source::Session;

use super::attire::{self, Attire, FindChoice};
use super::measured;
use super::recipe::Recipe;
use super::session;
use super::wish::Wish;
use crate::FittingError;

/// How somebody was dressed: enough to make the same again.
#[derive(Debug, Clone, PartialEq)]
pub struct Dressing {
    /// Body, garments and quality.
    pub recipe: Recipe,
    /// The joints in which they were dressed.
    pub first: Joints,
    /// Whether they stand still there, as the mannequin does.
    pub still: bool,
}

impl Dressing {
    /// The joints in which they stand still; `None` follows the sensor.
    pub fn stands(&self) -> Option<Joints> {
        self.still.then_some(self.first)
    }
}

/// A body of somebody's size, dressed.
#[derive(Debug)]
pub struct Dressed {
    /// The frame, with one worker.
    pub frame: Frame,
    /// Reads the snapshots of the frame.
    pub reader: Reader<Snapshot>,
    /// The recipe of the frame, for a recording.
    pub dressing: Dressing,
}

impl Dressed {
    /// Dresses a body by a recipe, as `first` stands.
    ///
    /// # Errors
    /// A recipe of which no scene can be made.
    pub fn make(recipe: Recipe, first: &Joints, still: bool) -> Result<Self, FittingError> {
        Self::make_of(recipe, first, still, &attire::find_now)
    }

    /// The same with garments that are found by `find`.
    ///
    /// # Errors
    /// As [`Self::make`]; those of `find`.
    pub fn make_of(recipe: Recipe, first: &Joints, still: bool, find: FindChoice<'_>) -> Result<Self, FittingError> {
        let (frame, reader) = recipe.make_of(first, find)?;
        Ok(Self { frame, reader, dressing: Dressing { recipe, first: *first, still } })
    }
}

/// Measures the shopper of a session and dresses them as they stand.
///
/// # Errors
/// A session that nobody can be measured or dressed in, a garment or a size that there is not.
pub fn shopper(session: &Session, attire: &Attire) -> Result<Dressed, FittingError> {
    if session.joints.is_empty() {
        return seen_in_depth(session, attire);
    }
    let track = session::standing(session)?;
    let measured = measured::measure(session, attire.wish.facts())?;
    let recipe = Recipe::choose_of(&session.name, &measured, attire)?;
    Dressed::make_of(recipe, &track[0], false, &|name| attire.find(name))
}

/// The same of a session without joints: the body is followed through its depth.
fn seen_in_depth(session: &Session, attire: &Attire) -> Result<Dressed, FittingError> {
    let measured = measured::measure(session, attire.wish.facts())?;
    let mut followed = session.clone();
    measured::add_joints(&mut followed, &measured)?;
    let track = session::standing(&followed)?;
    let recipe = Recipe::choose_of(&session.name, &measured, attire)?;
    Dressed::make_of(recipe, &track[0], false, &|name| attire.find(name))
}

/// The mannequin that stands in the mirror while nobody is measured: the body that the outermost garment is shown on, as `pose` has
/// it, each garment in its own middle size or the one that is asked for.
///
/// # Errors
/// A garment that there is not, a size that is not made.
pub fn mannequin(wish: &Wish, pose: &Joints) -> Result<Dressed, FittingError> {
    mannequin_in(&Attire::open(wish.clone())?, pose)
}

/// The same in garments that are open.
///
/// # Errors
/// As [`mannequin`].
pub fn mannequin_in(attire: &Attire, pose: &Joints) -> Result<Dressed, FittingError> {
    let (mut garments, mut body) = (Vec::new(), None);
    let wish = &attire.wish;
    for choice in &attire.choices {
        let (sex, measures, size) = choice.shown_on()?;
        let (measures, size) = match &wish.size {
            Some(asked) => (choice.body_of(asked)?.unwrap_or(measures), asked.clone()),
            None => (measures, size),
        };
        body = Some((sex, measures));
        garments.push((choice.name.clone(), size));
    }
    let Some((sex, measures)) = body else {
        return Err(FittingError::Input("no garment is named; name one in [wear]".into()));
    };
    let recipe = Recipe::of_body("mannequin", sex, &measures, garments, wish.quality);
    Dressed::make_of(recipe, pose, true, &|name| attire.find(name))
}
