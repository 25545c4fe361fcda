//! The odds of a person at each pixel of a square of the picture, which need not be upright.

use glam::{Affine2, Vec2};

/// Odds of a person by place.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PersonMask {
    /// Places along a side; 0 where nothing is known.
    pub side: usize,
    /// Odds that a place shows the person, 0 to 1, row by row `[side * side]`.
    pub odds: Vec<f32>,
    /// From pixels of the picture to shares of the square, 0 to 1 right and down.
    pub from_picture: Affine2,
}

impl PersonMask {
    /// Odds at a pixel of the picture; none outside of the square, or where nothing is known.
    pub fn at(&self, pixel: Vec2) -> Option<f32> {
        let place = self.from_picture.transform_point2(pixel) * self.side as f32;
        // NaN and what lies outside saturate to places that are not there.
        let within = place.cmpge(Vec2::ZERO).all() && place.cmplt(Vec2::splat(self.side as f32)).all();
        let at = place.y as usize * self.side + place.x as usize;
        if within { self.odds.get(at).copied() } else { None }
    }

    /// Takes another mask's values, in the storage that is there.
    pub fn take(&mut self, other: &Self) {
        (self.side, self.from_picture) = (other.side, other.from_picture);
        self.odds.clone_from(&other.odds);
    }

    /// Forgets the person that was seen.
    pub fn wipe(&mut self) {
        self.side = 0;
        self.odds.fill(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_read_in_the_turned_square_and_nothing_outside_of_it() {
        // A square of 10 pixels around (100, 50), whose right is the picture's down.
        let turn = Affine2::from_cols(Vec2::new(0.0, -0.1), Vec2::new(0.1, 0.0), Vec2::ZERO);
        let corner = turn.transform_point2(Vec2::new(100.0, 50.0)) - 0.5;
        let from_picture = Affine2 { translation: -corner, ..turn };
        let mask = PersonMask { side: 2, odds: vec![0.1, 0.2, 0.3, 0.4], from_picture };
        assert_eq!(mask.at(Vec2::new(103.0, 48.0)), Some(0.1));
        assert_eq!(mask.at(Vec2::new(103.0, 52.0)), Some(0.2));
        assert_eq!(mask.at(Vec2::new(97.0, 48.0)), Some(0.3));
        assert_eq!((mask.at(Vec2::new(120.0, 50.0)), mask.at(Vec2::NAN)), (None, None));
        assert_eq!(PersonMask::default().at(Vec2::ZERO), None);
    }
}
