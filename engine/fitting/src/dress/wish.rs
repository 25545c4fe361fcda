//! What is to be worn.

use std::path::Path;

use toile_assets::adapt::{MeshReport, OwnMesh, source};
use toile_assets::body::{Body, Sex};
use toile_assets::draping::{self, PatternPackage};
use toile_assets::garment::Garment;
use toile_assets::limits::MAX_GARMENTS;
use toile_assets::sizes::Population;
use toile_assets::wardrobe;
use toile_assets::wardrobe::own;
use toile_assets::wardrobe::style::Style;
use toile_engine::cloth::Quality;
use toile_track::measure::Measurements;
use toile_track::recommend::Recommendation;
use toile_track::tape_readings::TapeReadings;

use super::measured::ShopperFacts;
use super::{pattern_size, size};
use crate::FittingError;

/// Garments, size and quality that are asked for, and what the shopper says of themselves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wish {
    /// Garments of the wardrobe or mesh files, inner first; empty is the first of the wardrobe.
    pub garments: Vec<String>,
    /// A size in place of the recommended one.
    pub size: Option<String>,
    /// How the cloth is stepped.
    pub quality: Quality,
    /// The shopper's sex, if it was given.
    pub sex: Option<Sex>,
    /// Whether the shopper is a child, if it is known.
    pub child: Option<bool>,
    /// Measures that they took by tape.
    pub tape: TapeReadings,
}

impl Wish {
    /// What it says of the shopper.
    pub fn facts(&self) -> ShopperFacts {
        ShopperFacts { sex: self.sex, child: self.child, tape: self.tape, ..ShopperFacts::default() }
    }
}

/// A garment to wear.
#[derive(Debug, Clone)]
pub enum Choice {
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

impl Wish {
    /// The garments that are named: one of the wardrobe, a pattern by its ending, or else a mesh, where a
    /// file of that name exists.
    ///
    /// # Errors
    /// A name that is neither.
    pub fn choices(&self) -> Result<Vec<Choice>, FittingError> {
        self.check_count()?;
        self.names().into_iter().map(choice).collect()
    }

    /// The same, of garments of the wardrobe alone.
    ///
    /// # Errors
    /// A name that is not in the wardrobe.
    pub fn styles(&self) -> Result<Vec<Style>, FittingError> {
        self.check_count()?;
        self.names().into_iter().map(|name| wardrobe::style(name).map_err(FittingError::input)).collect()
    }

    fn check_count(&self) -> Result<(), FittingError> {
        let count = self.garments.len();
        if count > MAX_GARMENTS {
            return Err(FittingError::Input(format!(
                "{count} garments are asked for, and a body wears at most {MAX_GARMENTS} at once; leave some out"
            )));
        }
        Ok(())
    }

    fn names(&self) -> Vec<&str> {
        if self.garments.is_empty() {
            vec![wardrobe::names()[0]]
        } else {
            self.garments.iter().map(String::as_str).collect()
        }
    }
}

fn choice(name: &str) -> Result<Choice, FittingError> {
    if draping::is_pattern(name) && !wardrobe::names().contains(&name) {
        let package = draping::read_package(Path::new(name), None).map_err(FittingError::input)?;
        return Ok(Choice::Pattern(Box::new(package)));
    }
    let is_file = Path::new(name).exists() || source::is_mesh(name);
    if is_file && !wardrobe::names().contains(&name) {
        let own = OwnMesh::read(Path::new(name)).map_err(FittingError::input)?;
        return Ok(Choice::Mesh(Box::new(own)));
    }
    wardrobe::style(name).map(|style| Choice::Style(Box::new(style))).map_err(FittingError::input)
}

/// Whose bodies these garments are made for: the first of them that is not made for everybody decides.
///
/// # Errors
/// A garment whose size table cannot be used.
pub fn population<'a>(styles: impl IntoIterator<Item = &'a Style>) -> Result<Population, FittingError> {
    for style in styles {
        let population = style.sizes().map_err(FittingError::input)?.population;
        if population != Population::Mixed {
            return Ok(population);
        }
    }
    Ok(Population::Mixed)
}

/// The same for choices; a pattern or mesh that does not say whose it is, is made for everybody.
///
/// # Errors
/// As [`population`].
pub fn population_of(choices: &[Choice]) -> Result<Population, FittingError> {
    for choice in choices {
        let population = match choice {
            Choice::Style(style) => population([&**style])?,
            Choice::Mesh(own) => own.sex.into(),
            Choice::Pattern(package) => package.population().map_err(FittingError::input)?,
        };
        if population != Population::Mixed {
            return Ok(population);
        }
    }
    Ok(Population::Mixed)
}

/// Sizes a garment for measures and bakes it onto a body.
///
/// # Errors
/// A size that is not made, a size asked for of a mesh, a mesh or pattern that cannot be used.
pub fn put_on(choice: &Choice, size: Option<&str>, measured: &Measurements, body: &Body) -> Result<Worn, FittingError> {
    match choice {
        Choice::Style(style) => {
            let fit = size::judge(style, size, measured)?;
            let garment = style.dress(&fit.size, body).map_err(FittingError::input)?;
            Ok(Worn { garments: vec![garment], fit: Some(fit), mesh: None })
        }
        Choice::Mesh(mesh) => {
            let fit = size::judge_mesh(mesh, size, measured)?;
            let size = fit.as_ref().map(|fit| fit.size.as_str()).or(size);
            let dressed = own::dress(mesh, size, body).map_err(FittingError::input)?;
            Ok(Worn { garments: dressed.garments, fit, mesh: Some(dressed.report) })
        }
        Choice::Pattern(package) => {
            let fit = pattern_size::judge_pattern(package, size, measured, body)?;
            let garment = package.dress(&fit.size, body).map_err(FittingError::input)?;
            Ok(Worn { garments: vec![garment], fit: Some(fit), mesh: None })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_wears_forty_shirts() {
        let wish = Wish { garments: vec!["t-shirt".to_owned(); 40], ..Wish::default() };
        let refused = wish.choices().unwrap_err();
        assert!(
            matches!(&refused, FittingError::Input(text) if text.contains(&format!("at most {MAX_GARMENTS}"))),
            "{refused}"
        );
        assert_eq!(wish.styles().unwrap_err(), refused);
    }
}
