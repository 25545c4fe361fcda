//! The entry of a measure that a shopper took by tape: its name, the typed digits, the unit, and the reason of a refusal.

use toile_assets::sizes::Girth;
use toile_track::fit::measuring::MEASURES;
use toile_track::tape_readings::TapeError;

use super::texts::TextKey;

/// Characters that can be typed: three digits, a decimal mark and one more.
const TYPED: usize = 5;

toile_base::named! {
    /// A measure that shoppers can give, by its name among those that a body is measured by; what decides sizes stands first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum OwnMeasure {
        /// Around the chest at its fullest.
        Chest = "chest_girth",
        /// Around the waist.
        Waist = "waist_girth",
        /// Around the hip at its fullest.
        Hip = "hip_girth",
        /// From the floor to the top of the head.
        Stature = "stature",
        /// Around the chest just below the breasts.
        Underbust = "underbust_girth",
        /// From the crotch to the floor.
        Leg = "leg_length",
        /// From the shoulder over the elbow to the wrist.
        Arm = "arm_length",
        /// From shoulder to shoulder.
        Shoulders = "shoulder_breadth",
        /// Around the neck at its base.
        Neck = "neck_girth",
        /// Around the thigh at its fullest.
        Thigh = "thigh_girth",
        /// From the neck to the crotch.
        Torso = "torso_length",
    }
}

impl OwnMeasure {
    /// Its place in [`MEASURES`].
    pub fn index(self) -> usize {
        MEASURES.iter().position(|m| m.0 == self.name()).unwrap_or_default()
    }

    /// Key of its name in the pages' texts.
    pub const fn word(self) -> TextKey {
        match self {
            Self::Chest => TextKey::OwnChest,
            Self::Waist => TextKey::OwnWaist,
            Self::Hip => TextKey::OwnHip,
            Self::Stature => TextKey::OwnStature,
            Self::Underbust => TextKey::OwnUnderbust,
            Self::Leg => TextKey::OwnLeg,
            Self::Arm => TextKey::OwnArm,
            Self::Shoulders => TextKey::OwnShoulders,
            Self::Neck => TextKey::OwnNeck,
            Self::Thigh => TextKey::OwnThigh,
            Self::Torso => TextKey::OwnTorso,
        }
    }
}

impl From<Girth> for OwnMeasure {
    fn from(girth: Girth) -> Self {
        match girth {
            Girth::Chest => Self::Chest,
            Girth::Waist => Self::Waist,
            Girth::Hip => Self::Hip,
        }
    }
}

/// The unit in which measures are typed and listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LengthUnit {
    /// Centimetres.
    #[default]
    Centimetre,
    /// Inches.
    Inch,
}

impl LengthUnit {
    /// Its length (m).
    pub const fn metres(self) -> f32 {
        match self {
            Self::Centimetre => 0.01,
            Self::Inch => 0.0254,
        }
    }

    /// The other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Centimetre => Self::Inch,
            Self::Inch => Self::Centimetre,
        }
    }

    /// Key of a length in this unit in the pages' texts.
    pub const fn word(self) -> TextKey {
        match self {
            Self::Centimetre => TextKey::LengthCm,
            Self::Inch => TextKey::LengthInch,
        }
    }
}

/// Why a measure is not accepted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EntryFault {
    /// Nothing was typed that is a number.
    Empty,
    /// A length outside of people's range.
    Impossible {
        /// The least that people have (m).
        low_m: f32,
        /// The most that people have (m).
        high_m: f32,
    },
    /// One of the measures given does not go with the others.
    Contradiction {
        /// The one that stands out most, which need not be the last.
        measure: OwnMeasure,
        /// What was given of it (m).
        given_m: f32,
        /// What the others let expect (m).
        expected_m: f32,
        /// Standard deviation of that (m).
        sigma_m: f32,
    },
}

impl From<TapeError> for EntryFault {
    fn from(why: TapeError) -> Self {
        let m = |mm: f32| mm * 1e-3;
        match why {
            TapeError::Unit { low_mm, high_mm, .. } => Self::Impossible { low_m: m(low_mm), high_m: m(high_mm) },
            TapeError::Contradiction { measure, given_mm, expected_mm, sigma_mm } => {
                match OwnMeasure::ALL.into_iter().find(|own| own.name() == measure) {
                    Some(measure) => Self::Contradiction {
                        measure,
                        given_m: m(given_mm),
                        expected_m: m(expected_mm),
                        sigma_m: m(sigma_mm),
                    },
                    None => Self::Empty,
                }
            }
            TapeError::Form(_) | TapeError::Name { .. } => Self::Empty,
        }
    }
}

/// A measure that is being typed.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasureEntry {
    /// Which measure it is.
    pub measure: OwnMeasure,
    /// Why it was not accepted; gone with the next key.
    pub fault: Option<EntryFault>,
    /// Digits, and at most one point.
    typed: heapless::String<TYPED>,
}

impl MeasureEntry {
    /// Nothing typed yet.
    pub fn new(measure: OwnMeasure) -> Self {
        Self { measure, fault: None, typed: heapless::String::new() }
    }

    /// What was typed, with a point as its decimal mark.
    pub fn typed(&self) -> &str {
        &self.typed
    }

    /// Adds a digit; one too many is left out.
    pub fn digit(&mut self, digit: u8) {
        self.fault = None;
        if digit < 10 {
            _ = self.typed.push(char::from(b'0' + digit));
        }
    }

    /// Adds the decimal mark, once and not first.
    pub fn point(&mut self) {
        self.fault = None;
        if !self.typed.is_empty() && !self.typed.contains('.') {
            _ = self.typed.push('.');
        }
    }

    /// Takes the last character back.
    pub fn delete(&mut self) {
        self.fault = None;
        _ = self.typed.pop();
    }

    /// The length that was typed (m), where it is one.
    pub fn metres(&self, unit: LengthUnit) -> Option<f32> {
        self.typed.parse::<f32>().ok().map(|length| length * unit.metres())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(keys: &str) -> MeasureEntry {
        let mut entry = MeasureEntry::new(OwnMeasure::Chest);
        for key in keys.chars() {
            match key {
                '.' => entry.point(),
                '<' => entry.delete(),
                digit => entry.digit(digit as u8 - b'0'),
            }
        }
        entry
    }

    #[test]
    fn all_measures_of_a_body_can_be_given_each_once() {
        let mut places: Vec<usize> = OwnMeasure::ALL.iter().map(|own| own.index()).collect();
        places.sort_unstable();
        assert_eq!(places, (0..MEASURES.len()).collect::<Vec<_>>());
    }

    #[test]
    fn what_is_typed_is_a_length_in_either_unit() {
        let length = |keys: &str, unit| typed(keys).metres(unit);
        let near = |length: Option<f32>, m: f32| (length.unwrap() - m).abs() < 1e-5;
        assert!(near(length("91.5", LengthUnit::Centimetre), 0.915));
        assert!(near(length("36", LengthUnit::Inch), 0.9144));
        assert!(near(length("91<2", LengthUnit::Centimetre), 0.92));
        assert_eq!(length("", LengthUnit::Centimetre), None);
        assert_eq!(typed("..1.2.3").typed(), "1.23", "one mark, and not first");
        assert_eq!(typed("1234567").typed(), "12345", "no more than have a place");
        assert_eq!(typed("91<<<").typed(), "");
    }
}
