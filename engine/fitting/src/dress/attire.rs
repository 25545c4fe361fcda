//! Attire: the garments of a wish, open. They are put on as they were found, whatever becomes of their files since.

use std::sync::Arc;

use super::garment_source::GarmentSource;
use super::wish::Wish;
use crate::FittingError;

/// Finds a garment by its name.
pub type FindChoice<'a> = &'a dyn Fn(&str) -> Result<Arc<GarmentSource>, FittingError>;

/// Finds a garment as it is at the moment.
///
/// # Errors
/// As [`GarmentSource::find`].
pub fn find_now(name: &str) -> Result<Arc<GarmentSource>, FittingError> {
    GarmentSource::find(name).map(Arc::new)
}

/// A wish with its garments.
#[derive(Debug, Clone)]
pub struct Attire {
    /// What is asked for.
    pub wish: Wish,
    /// The garments, inner first.
    pub choices: Vec<Arc<GarmentSource>>,
}

impl Attire {
    /// Opens the garments of a wish.
    ///
    /// # Errors
    /// As [`Wish::choices`].
    pub fn open(wish: Wish) -> Result<Self, FittingError> {
        let choices = wish.choices()?.into_iter().map(Arc::new).collect();
        Ok(Self { wish, choices })
    }

    /// A garment by its name: one of these, or as it is at the moment.
    ///
    /// # Errors
    /// As [`GarmentSource::find`].
    pub fn find(&self, name: &str) -> Result<Arc<GarmentSource>, FittingError> {
        match self.choices.iter().find(|choice| choice.name == name) {
            Some(choice) => Ok(choice.clone()),
            None => find_now(name),
        }
    }
}
