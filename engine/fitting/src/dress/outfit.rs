//! An outfit: garments in the sizes that fit, one over the other.

use toile_assets::sizes::Girth;
use toile_base::body::Body;
use toile_base::garment::Garment;
use toile_engine::cloth::layers::tuck_in;
use toile_track::measure::Measurements;

use super::choice::{Choice, Worn};
use crate::FittingError;

/// Garments on one body.
#[derive(Debug, Clone, Default)]
pub struct Outfit {
    /// What became of each choice, without its garments, inner first.
    pub worn: Vec<Worn>,
    /// The baked garments of all of them, inner first.
    pub garments: Vec<Garment>,
    /// Which of the choices each garment is of `[garments]`.
    pub choice_of: Vec<usize>,
}

impl Outfit {
    /// Sizes and bakes every garment over those that are worn beneath it; `sizes` are those that were asked for, one a choice.
    ///
    /// # Errors
    /// A size that is not made, a garment that cannot be laid on the body.
    pub fn put_on<'a>(
        choices: impl IntoIterator<Item = (&'a Choice, Option<&'a str>)>,
        measured: &Measurements,
        wearer: &Body,
    ) -> Result<Self, FittingError> {
        let (mut outfit, mut beneath) = (Self::default(), Vec::new());
        for (number, (choice, size)) in choices.into_iter().enumerate() {
            let mut worn = choice.put_on(size, measured, wearer, &beneath)?;
            beneath.extend(choice.offer(wearer)?);
            outfit.choice_of.extend(worn.garments.iter().map(|_| number));
            outfit.garments.append(&mut worn.garments);
            outfit.worn.push(worn);
        }
        Ok(outfit)
    }

    /// How tight each garment was judged, -1 (loose) .. 1 (tight), at the zones where it is known `[garments]`.
    pub fn judged(&self) -> Vec<Vec<(Girth, f32)>> {
        let of = |choice: &usize| {
            let zones = self.worn[*choice].fit.iter().flat_map(|fit| &fit.zones);
            zones.filter_map(|z| Some((z.zone, z.tightness?))).collect()
        };
        self.choice_of.iter().map(of).collect()
    }

    /// Tucks in a garment that is worn, by its name.
    ///
    /// # Errors
    /// A garment that is not worn, or has nothing to be tucked into.
    pub fn tuck(&mut self, name: &str) -> Result<(), FittingError> {
        let Some(place) = self.garments.iter().rposition(|g| g.name == name) else {
            let worn: Vec<&str> = self.garments.iter().map(|g| g.name.as_str()).collect();
            let worn = worn.join(", ");
            return Err(FittingError::Input(format!(
                "{name} is not worn, so that it cannot be tucked in; name one of {worn}"
            )));
        };
        tuck_in(&mut self.garments, place).map_err(FittingError::input)
    }
}
