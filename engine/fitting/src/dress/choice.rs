//! A garment to wear: one of the wardrobe, a mesh, or a sewn pattern, each in its sizes.

use std::path::Path;

use toile_assets::adapt::{MeshReport, OwnMesh, source};
use toile_assets::body::Body;
use toile_assets::draping::{self, PatternPackage, TO_MEASURE};
use toile_assets::garment::Garment;
use toile_assets::sizes::Population;
use toile_assets::wardrobe;
use toile_assets::wardrobe::own;
use toile_assets::wardrobe::style::Style;
use toile_track::measure::Measurements;
use toile_track::recommend::Recommendation;

use super::offer::GarmentOffer;
use crate::FittingError;

/// A garment to wear.
#[derive(Debug, Clone)]
pub struct Choice {
    /// What it was asked for by: a name of the wardrobe, or a path. A recipe finds it again by this.
    pub name: String,
    /// What it is made from.
    pub source: ChoiceSource,
}

/// What a garment is made from.
#[derive(Debug, Clone)]
pub enum ChoiceSource {
    /// A garment of the wardrobe.
    Style(Box<Style>),
    /// A mesh of the user's own.
    Mesh(Box<OwnMesh>),
    /// A sewn pattern or a garment package.
    Pattern(Box<PatternPackage>),
}

/// A garment on the body, and how its size fits; a mesh may have no sizes.
#[derive(Debug, Clone)]
pub struct Worn {
    /// The garment, baked; a mesh of several layers becomes one for each, the innermost first.
    pub garments: Vec<Garment>,
    /// How it fits; none where it was not recommended.
    pub fit: Option<Recommendation>,
    /// What became of a mesh of the user's own.
    pub mesh: Option<MeshReport>,
}

impl Choice {
    /// The garment of a name: one of the wardrobe, a pattern by its ending, or else a mesh, where a file of that name
    /// exists.
    ///
    /// # Errors
    /// A name that is none of these, a file that cannot be used.
    pub fn find(name: &str) -> Result<Self, FittingError> {
        let path = Path::new(name);
        let source = if wardrobe::names().contains(&name) {
            ChoiceSource::Style(Box::new(wardrobe::style(name).map_err(FittingError::input)?))
        } else if draping::is_pattern(name) {
            ChoiceSource::Pattern(Box::new(draping::read_package(path, None).map_err(FittingError::input)?))
        } else if path.exists() || source::is_mesh(name) {
            ChoiceSource::Mesh(Box::new(OwnMesh::read(path).map_err(FittingError::input)?))
        } else {
            ChoiceSource::Style(Box::new(wardrobe::style(name).map_err(FittingError::input)?))
        };
        Ok(Self { name: name.to_owned(), source })
    }

    /// Whose bodies it is made for; what does not say is made for everybody.
    ///
    /// # Errors
    /// A size table that cannot be used.
    pub fn population(&self) -> Result<Population, FittingError> {
        match &self.source {
            ChoiceSource::Style(style) => Ok(style.sizes().map_err(FittingError::input)?.population),
            ChoiceSource::Mesh(own) => Ok(own.sex.into()),
            ChoiceSource::Pattern(package) => package.population().map_err(FittingError::input),
        }
    }

    /// Its sizes; none of a mesh that has none. A pattern for nobody in particular is judged on `wearer`.
    ///
    /// # Errors
    /// Sizes that cannot be used, a pattern that cannot be laid around a body.
    pub fn offer(&self, wearer: &Body) -> Result<Option<GarmentOffer>, FittingError> {
        match &self.source {
            ChoiceSource::Style(style) => GarmentOffer::of_style(style).map(Some),
            ChoiceSource::Mesh(own) => GarmentOffer::of_mesh(own),
            ChoiceSource::Pattern(package) => GarmentOffer::of_pattern(package, wearer).map(Some),
        }
    }

    /// The size that fits, or how the one asked for does; none of a mesh that has no sizes.
    ///
    /// # Errors
    /// A size that is not made; as [`Self::offer`].
    pub fn judge(
        &self,
        size: Option<&str>,
        measured: &Measurements,
        wearer: &Body,
    ) -> Result<Option<Recommendation>, FittingError> {
        let offer = match (&self.source, size) {
            (ChoiceSource::Pattern(package), Some(TO_MEASURE)) => Some(GarmentOffer::made_to_measure(package, wearer)?),
            _ => self.offer(wearer)?,
        };
        offer.map(|offer| offer.judge(size, measured)).transpose()
    }

    /// The garment in a size on a body, baked; a mesh without sizes has `unknown` or none.
    ///
    /// # Errors
    /// A size that is not made, a mesh or pattern that cannot be laid on the body.
    pub fn dress(&self, size: Option<&str>, wearer: &Body) -> Result<Worn, FittingError> {
        let worn = |garments| Worn { garments, fit: None, mesh: None };
        match &self.source {
            ChoiceSource::Style(style) => {
                let size = size.ok_or_else(|| FittingError::Internal(format!("{} has no size", self.name)))?;
                Ok(worn(vec![style.dress(size, wearer).map_err(FittingError::input)?]))
            }
            ChoiceSource::Mesh(mesh) => {
                let dressed = own::dress(mesh, size.filter(|size| *size != own::UNKNOWN), wearer);
                let dressed = dressed.map_err(FittingError::input)?;
                Ok(Worn { garments: dressed.garments, fit: None, mesh: Some(dressed.report) })
            }
            ChoiceSource::Pattern(package) => {
                let size = size.unwrap_or_else(|| package.own_size());
                Ok(worn(vec![package.dress(size, wearer).map_err(FittingError::input)?]))
            }
        }
    }

    /// Sizes the garment for measures and bakes it onto a body.
    ///
    /// # Errors
    /// As [`Self::judge`] and [`Self::dress`].
    pub fn put_on(&self, size: Option<&str>, measured: &Measurements, wearer: &Body) -> Result<Worn, FittingError> {
        let fit = self.judge(size, measured, wearer)?;
        let worn = self.dress(fit.as_ref().map(|fit| fit.size.as_str()).or(size), wearer)?;
        Ok(Worn { fit, ..worn })
    }
}
