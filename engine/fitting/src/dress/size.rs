//! The size of each garment and the fit of each of its zones, as recommended by `toile_track::recommend`.

use toile_assets::adapt::OwnMesh;
use toile_assets::sizes::{Girth, SizeError, SizeTable};
use toile_assets::wardrobe::own;
use toile_assets::wardrobe::style::Style;
use toile_track::measure::Measurements;
use toile_track::recommend::{self, EaseRange, MadeSize, Offer, Recommendation, ZoneGirth};

use crate::FittingError;

/// The size that fits, or the one asked for, judged at every zone that the garment reaches.
///
/// # Errors
/// A garment whose table or sizes cannot be used, a size that is not made.
pub fn judge(style: &Style, size: Option<&str>, measured: &Measurements) -> Result<Recommendation, FittingError> {
    let table = style.sizes().map_err(FittingError::input)?;
    let sizes = made(style, &table).map_err(FittingError::input)?;
    let range = |zone: Girth| style.comfort_mm.at(zone).map(|[least, most]| EaseRange { zone, least, most });
    let ease: Vec<EaseRange> = Girth::ALL.into_iter().filter_map(range).collect();
    let offer = Offer { garment: &style.name, kind: style.kind, table: &table, sizes: &sizes, ease: &ease };
    match size {
        Some(size) => recommend::evaluate(measured, &offer, size),
        None => recommend::recommend(measured, &offer),
    }
    .map_err(FittingError::input)
}

/// The size of a mesh of the user's own that fits, or the one asked for; nothing of a mesh that has no sizes.
///
/// # Errors
/// As [`judge`].
pub fn judge_mesh(
    own: &OwnMesh,
    size: Option<&str>,
    measured: &Measurements,
) -> Result<Option<Recommendation>, FittingError> {
    let Some(mesh) = &own.sizes else { return Ok(None) };
    let made = |code: &str| {
        let finished = own.finished_in(mesh, &mesh.table.size_body(code)?);
        let zones = finished.into_iter().map(|(zone, girth_m)| ZoneGirth { zone, girth_m }).collect();
        Ok(MadeSize { code: code.into(), zones })
    };
    let sizes = mesh.table.codes().into_iter().map(made).collect::<Result<Vec<_>, SizeError>>();
    let sizes = sizes.map_err(FittingError::input)?;
    let ease = own::comfort(own, mesh.kind).map_err(FittingError::input)?;
    let ease: Vec<EaseRange> = ease.into_iter().map(|(zone, [least, most])| EaseRange { zone, least, most }).collect();
    let name = own.measures.name.as_deref().unwrap_or(&own.path);
    let offer = Offer { garment: name, kind: mesh.kind, table: &mesh.table, sizes: &sizes, ease: &ease };
    match size {
        Some(size) => recommend::evaluate(measured, &offer, size),
        None => recommend::recommend(measured, &offer),
    }
    .map(Some)
    .map_err(FittingError::input)
}

/// The finished girths of every size that is made.
fn made(style: &Style, table: &SizeTable) -> Result<Vec<MadeSize>, SizeError> {
    let size = |code: &str| {
        let finished = style.finished(&table.size_body(code)?);
        let zones = finished.into_iter().map(|(zone, girth_m)| ZoneGirth { zone, girth_m }).collect();
        Ok(MadeSize { code: code.into(), zones })
    };
    table.codes().into_iter().map(size).collect()
}
