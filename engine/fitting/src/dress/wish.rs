//! What is to be worn.

use toile_assets::sizes::Population;
use toile_base::body::Sex;
use toile_base::limits::MAX_GARMENTS;
use toile_engine::cloth::Quality;
use toile_track::tape_readings::TapeReadings;

use super::choice::Choice;
use super::measured::ShopperFacts;
use crate::FittingError;

/// Garments, size and quality that are asked for, and what the shopper says of themselves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wish {
    /// Garments of the wardrobe, patterns or mesh files, inner first; empty is [`shown_first`].
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

impl Wish {
    /// The garments that are named.
    ///
    /// # Errors
    /// More than a body wears; a name that there is not, a file that cannot be used.
    pub fn choices(&self) -> Result<Vec<Choice>, FittingError> {
        self.check_count()?;
        self.names().into_iter().map(Choice::find).collect()
    }

    /// Whether a body can wear so many.
    ///
    /// # Errors
    /// That it cannot, with the cure.
    pub fn check_count(&self) -> Result<(), FittingError> {
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
            shown_first(self.sex).to_vec()
        } else {
            self.garments.iter().map(String::as_str).collect()
        }
    }
}

/// What is worn where nothing is asked for, inner first: a dress, or trousers and a shirt by who is known to be a man.
pub const fn shown_first(sex: Option<Sex>) -> &'static [&'static str] {
    match sex {
        Some(Sex::Male) => &["mens-trousers", "mens-shirt"],
        Some(Sex::Female) | None => &["strap-dress"],
    }
}

/// Whose bodies these garments are made for: the first of them that is not made for everybody decides.
///
/// # Errors
/// A garment whose size table cannot be used.
pub fn population<'a>(choices: impl IntoIterator<Item = &'a Choice>) -> Result<Population, FittingError> {
    for choice in choices {
        let population = choice.population()?;
        if population != Population::Mixed {
            return Ok(population);
        }
    }
    Ok(Population::Mixed)
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
    }
}
