//! What is worn: garments in the sizes that fit, what is said of them, and the colours of the fit map.

use toile_assets::adapt::MeshReport;
use toile_assets::body::Body;
use toile_assets::garment::Garment;
use toile_assets::sizes::Girth;
use toile_assets::wardrobe::own;
use toile_engine::cloth::layers::tuck_in;
use toile_engine::cloth::{Cloth, measure};
use toile_engine::frame::Frame;
use toile_fitting::dress::choice::Choice;
use toile_fitting::dress::measured::Measured;
use toile_view::fit_map;

use crate::exit::AppError;
use crate::report::Recommendation;

/// The garments that are worn, and what there is to say of them.
pub struct PutOn {
    /// Inner first.
    pub garments: Vec<Garment>,
    /// One for each choice.
    pub recommendations: Vec<Recommendation>,
    /// Of the meshes of the user's own.
    pub meshes: Vec<MeshReport>,
    /// How tight each garment was judged at each zone.
    pub judged: Vec<JudgedTightness>,
}

/// How tight a garment was judged, -1 (loose) .. 1 (tight), at the zones where it is known.
pub type JudgedTightness = Vec<(Girth, f32)>;

/// Sizes and bakes every garment.
///
/// # Errors
/// A size that is not made, a garment that cannot be laid on the body.
pub fn put_on(choices: &[Choice], size: Option<&str>, measured: &Measured, body: &Body) -> Result<PutOn, AppError> {
    let mut put_on =
        PutOn { garments: Vec::new(), recommendations: Vec::new(), meshes: Vec::new(), judged: Vec::new() };
    let mut beneath = Vec::new();
    for choice in choices {
        let worn = choice.put_on(size, &measured.best, body, &beneath)?;
        beneath.extend(choice.offer(body)?);
        let zones = worn.fit.iter().flat_map(|fit| &fit.zones);
        let judged: JudgedTightness = zones.filter_map(|z| Some((z.zone, z.tightness?))).collect();
        put_on.judged.extend(worn.garments.iter().map(|_| judged.clone()));
        put_on.recommendations.push(match worn.fit {
            Some(fit) => fit.into(),
            None => Recommendation {
                garment: worn.mesh.as_ref().map(|mesh| mesh.file.clone()).unwrap_or_default(),
                size: own::UNKNOWN.to_owned(),
                ..Recommendation::default()
            },
        });
        put_on.garments.extend(worn.garments);
        put_on.meshes.extend(worn.mesh);
    }
    Ok(put_on)
}

/// Tucks in a garment that is worn, by its name.
///
/// # Errors
/// A garment that is not worn, or has nothing to be tucked into.
pub fn tuck(garments: &mut [Garment], name: &str) -> Result<(), AppError> {
    let Some(place) = garments.iter().rposition(|g| g.name == name) else {
        let worn: Vec<&str> = garments.iter().map(|g| g.name.as_str()).collect();
        let worn = worn.join(", ");
        return Err(AppError::input(format!(
            "--tuck: {name} is not worn; name one of {worn}, or add --garment {name}"
        )));
    };
    tuck_in(garments, place).map_err(|why| AppError::input(format!("--tuck: {why}")))
}

/// The fit map of each garment: how tight it sits from place to place, in the mean as tight as it was judged.
pub fn fit_colours(frame: &Frame, judged: &[JudgedTightness]) -> Vec<Vec<f32>> {
    let levels = &frame.body().levels;
    let level = |zone: Girth| match zone {
        Girth::Chest => levels.chest,
        Girth::Waist => levels.waist,
        Girth::Hip => levels.hip,
    };
    let map = |((cloth, garment), judged): ((&Cloth, &Garment), &JudgedTightness)| {
        let local = measure::tightness(cloth, garment, frame.colliders());
        let heights: Vec<f32> = garment.start.iter().map(|p| p.y).collect();
        let mut known: Vec<(f32, f32)> = judged.iter().map(|(zone, tight)| (level(*zone), *tight)).collect();
        known.sort_by(|a, b| b.0.total_cmp(&a.0));
        fit_map::agreed(&local, &heights, &known)
    };
    frame.cloths().iter().zip(frame.garments()).zip(judged).map(map).collect()
}
