//! Feel of a zone: one scale from its ease to a word and to the fit map's colours.

toile_base::named! {
    /// How a zone feels, from tight to loose. A garment is comfortable within the range that its file gives; its lower third is
    /// snug, its upper third roomy, and farther outside than a half of it is far too tight or loose.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Feel {
        /// Far below the comfortable range.
        TooTight = "too tight",
        /// Below the comfortable range.
        Tight = "tight",
        /// In its lower third.
        Snug = "snug",
        /// In its middle third.
        Right = "right",
        /// In its upper third.
        Roomy = "roomy",
        /// Above the comfortable range.
        Loose = "loose",
        /// Far above the comfortable range.
        TooLoose = "too loose",
    }
}

impl Feel {
    /// Of an ease by its place in the comfortable range: 0 at its lower end, 1 at its upper.
    pub fn at(place: f32) -> Self {
        match place {
            p if p < -0.5 => Self::TooTight,
            p if p < 0.0 => Self::Tight,
            p if p < 1.0 / 3.0 => Self::Snug,
            p if p <= 2.0 / 3.0 => Self::Right,
            p if p <= 1.0 => Self::Roomy,
            p if p <= 1.5 => Self::Loose,
            _ => Self::TooLoose,
        }
    }

    /// Whether it is within the comfortable range.
    pub const fn is_comfortable(self) -> bool {
        matches!(self, Self::Snug | Self::Right | Self::Roomy)
    }
}

/// Where an ease lies in a comfortable range (m): 0 at its lower end, 1 at its upper.
pub fn place(ease: f32, [least, most]: [f32; 2]) -> f32 {
    (ease - least) / (most - least).max(1e-3)
}

/// The place on the fit map's scale: -1 (loose) .. 1 (tight), within half of it where the zone is comfortable.
pub fn tightness(place: f32) -> f32 {
    (0.5 - place).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feels_divide_the_comfortable_range_in_three() {
        for (place, feel) in [
            (-0.6, Feel::TooTight),
            (-0.01, Feel::Tight),
            (0.0, Feel::Snug),
            (0.5, Feel::Right),
            (1.0, Feel::Roomy),
            (1.2, Feel::Loose),
            (1.6, Feel::TooLoose),
        ] {
            assert_eq!(Feel::at(place), feel, "{place}");
            assert_eq!(tightness(place).abs() <= 0.5, feel.is_comfortable(), "{place}");
        }
    }

    #[test]
    fn the_place_is_that_of_the_ease_in_its_range() {
        assert!((place(0.05, [0.02, 0.08]) - 0.5).abs() < 1e-6);
        assert!(tightness(place(0.02, [0.02, 0.08])) > tightness(place(0.08, [0.02, 0.08])));
    }
}
