//! A whole try-on: a recording in; measures, size, pictures and the moving scene out.

use crate::error::Result;
use crate::fit::Recommendation;
use crate::garment::Garment;
use crate::measures::Measure;
use crate::picture::{Look, Picture, View};
use crate::recording::{Recording, Shopper};
use crate::scene::{DressOptions, Motion, Scene};
use toile_engine::cloth::Quality;

/// The views of a try-on's pictures, in their order.
pub const VIEWS: [View; 3] = [View::Front, View::Side, View::Back];

/// How a try-on is made. Build it with `..Default::default()`: fields may be added.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TryOnOptions {
    /// What is known of the person.
    pub shopper: Shopper,
    /// Tested settings of the cloth.
    pub quality: Quality,
    /// Width and height of each picture (px); none makes no pictures.
    pub picture: Option<[u32; 2]>,
    /// Names of garments that are tucked in.
    pub tuck: Vec<String>,
}

/// What a try-on gives.
#[derive(Debug)]
pub struct TryOn {
    /// The person's measures.
    pub measures: Vec<Measure>,
    /// Notes on them and the body, a sentence each.
    pub notes: Vec<String>,
    /// How each garment fits; none of a mesh without sizes.
    pub fits: Vec<Option<Recommendation>>,
    /// The end of the recording from the sides of [`VIEWS`]; empty where no pictures were asked for.
    pub pictures: Vec<Picture>,
    /// The same as fit maps.
    pub fit_maps: Vec<Picture>,
    /// The scene as the recording ended.
    pub scene: Scene,
}

/// Measures the person in a recording, puts the garments on a body of those measures, lets them move as the recording does and
/// draws its end: the same measures, sizes and bits as `toile try-on`.
///
/// # Errors
/// A recording in which no person can be measured or followed, a garment that cannot be worn, a size of pictures that cannot be drawn.
pub fn try_on(recording: &Recording, garments: &[Garment], options: &TryOnOptions) -> Result<TryOn> {
    if let Some(size) = options.picture {
        crate::picture::checked_size(size)?;
    }
    let measured = recording.measure(&options.shopper)?;
    let body = measured.body_for(garments)?;
    let motion = Motion::Track(recording.track(&measured)?);
    let dressing =
        DressOptions { motion, quality: options.quality, tuck: options.tuck.clone(), ..DressOptions::default() };
    let mut scene = Scene::dress_with(&body, garments, &dressing)?;
    scene.step_many(scene.duration_steps().unwrap_or_default());
    let (mut pictures, mut fit_maps) = (Vec::new(), Vec::new());
    if let Some(size) = options.picture {
        pictures = scene.pictures(&VIEWS, size, Look::Fabric)?;
        fit_maps = scene.pictures(&VIEWS, size, Look::FitMap)?;
    }
    let fits = scene.garments().iter().map(|worn| worn.fit.clone()).collect();
    let notes = body.notes().iter().chain(measured.notes()).cloned().collect();
    Ok(TryOn { measures: measured.measures(), notes, fits, pictures, fit_maps, scene })
}
