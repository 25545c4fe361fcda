//! What is worn: garments in the sizes that fit, and what is said of them.

use toile_assets::wardrobe::own;
use toile_base::body::Body;
use toile_fitting::dress::choice::{Choice, Worn};
use toile_fitting::dress::measured::Measured;
use toile_fitting::dress::outfit::Outfit;

use crate::exit::AppError;
use crate::report::Recommendation;

/// Sizes and bakes every garment, and tucks in those that are named.
///
/// # Errors
/// A size that is not made, a garment that cannot be laid on the body or tucked in.
pub fn put_on(
    choices: &[Choice],
    size: Option<&str>,
    tucked: &[String],
    measured: &Measured,
    body: &Body,
) -> Result<Outfit, AppError> {
    let mut outfit = Outfit::put_on(choices.iter().map(|choice| (choice, size)), &measured.best, body)?;
    let mut tucked = tucked.iter();
    tucked.try_for_each(|name| outfit.tuck(name)).map_err(|why| AppError::input(format!("--tuck: {why}")))?;
    Ok(outfit)
}

/// What is said of each garment.
pub fn recommendations(worn: &[Worn]) -> Vec<Recommendation> {
    let said = |worn: &Worn| match &worn.fit {
        Some(fit) => fit.clone().into(),
        None => Recommendation {
            garment: worn.mesh.as_ref().map(|mesh| mesh.file.clone()).unwrap_or_default(),
            size: own::UNKNOWN.to_owned(),
            ..Recommendation::default()
        },
    };
    worn.iter().map(said).collect()
}
