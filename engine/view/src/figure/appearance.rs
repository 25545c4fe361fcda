//! Choices for the look of a mannequin: its skin tone and its hair.

use std::str::FromStr;

use glam::Vec3;
use toile_assets::toml_keys;
use toile_base::body::Sex;

use super::moulded::Cut;
use crate::image::linear;

toile_base::named! {
    /// Tone of a mannequin's skin.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum SkinTone {
        /// A light grey-beige, neutral beside any garment.
        #[default]
        Mannequin = "mannequin",
        /// Very light.
        Porcelain = "porcelain",
        /// Light.
        Sand = "sand",
        /// Middle.
        Honey = "honey",
        /// Dark.
        Umber = "umber",
        /// Very dark.
        Ebony = "ebony",
    }
}

toile_base::named! {
    /// A mannequin's hair: none, or moulded.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum Hair {
        /// None.
        #[default]
        None = "none",
        /// Close to the head.
        Short = "short",
        /// Down to the jaw, with a fringe.
        Bob = "bob",
        /// Combed back into a bun.
        Bun = "bun",
    }
}

impl Hair {
    /// What is put on a head of which nothing is said: a bob on a woman's, short hair on a man's.
    pub const fn usual(sex: Sex) -> Self {
        match sex {
            Sex::Female => Self::Bob,
            Sex::Male => Self::Short,
        }
    }
}

/// How a mannequin looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Appearance {
    /// Tone of the skin.
    pub skin: SkinTone,
    /// The hair.
    pub hair: Hair,
}

/// A name that none of a choice has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no {what} is called {name:?}; {cure}")]
pub struct UnknownName {
    what: &'static str,
    name: String,
    cure: String,
}

impl UnknownName {
    fn new(what: &'static str, name: &str, known: &[&'static str]) -> Self {
        let cure = match toml_keys::nearest(name, known.iter().copied()) {
            Some(meant) => format!("did you mean {meant:?}?"),
            None => format!("choose one of {}", known.join(", ")),
        };
        Self { what, name: name.to_owned(), cure }
    }
}

impl FromStr for SkinTone {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        let unknown = || UnknownName::new("skin tone", name, &Self::ALL.map(Self::name));
        Self::ALL.into_iter().find(|tone| tone.name() == name).ok_or_else(unknown)
    }
}

impl FromStr for Hair {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        let unknown = || UnknownName::new("hair", name, &Self::ALL.map(Self::name));
        Self::ALL.into_iter().find(|hair| hair.name() == name).ok_or_else(unknown)
    }
}

impl SkinTone {
    /// Linear RGB of the skin.
    pub fn colour(self) -> Vec3 {
        let srgb = |bytes: [u8; 3]| Vec3::from_array(bytes.map(|b| linear(f32::from(b) / 255.0)));
        match self {
            Self::Mannequin => crate::scene::MANNEQUIN,
            Self::Porcelain => srgb([230, 210, 194]),
            Self::Sand => srgb([206, 174, 152]),
            Self::Honey => srgb([176, 136, 109]),
            Self::Umber => srgb([117, 85, 68]),
            Self::Ebony => srgb([71, 53, 46]),
        }
    }

    /// sRGB bytes of the hair that goes with it.
    pub(crate) fn hair(self) -> [u8; 3] {
        match self {
            Self::Mannequin => [146, 134, 121],
            Self::Porcelain => [112, 84, 64],
            Self::Sand => [76, 57, 47],
            Self::Honey => [52, 41, 36],
            Self::Umber => [38, 30, 27],
            Self::Ebony => [27, 23, 22],
        }
    }
}

const SHORT: Cut = Cut {
    whorl: Vec3::new(0.0, 0.86, -0.51),
    hem: &[
        Vec3::new(0.0, -38.0, 95.0),
        Vec3::new(22.0, -36.0, 90.0),
        Vec3::new(44.0, -38.0, 76.0),
        Vec3::new(60.0, -66.0, 63.0),
        Vec3::new(69.0, -104.0, 48.0),
        Vec3::new(70.0, -126.0, 34.0),
        Vec3::new(70.0, -128.0, 20.0),
        Vec3::new(72.0, -114.0, 4.0),
        Vec3::new(68.0, -118.0, -16.0),
        Vec3::new(58.0, -146.0, -36.0),
        Vec3::new(32.0, -168.0, -48.0),
        Vec3::new(0.0, -172.0, -53.0),
    ],
    thickness: [3.2, 14.0],
    round: 3.2,
    combed: 0.8,
    hangs: None,
    bun: None,
};

const BOB: Cut = Cut {
    whorl: Vec3::new(0.0, 0.86, -0.51),
    hem: &[
        Vec3::new(0.0, -64.0, 102.0),
        Vec3::new(30.0, -64.0, 94.0),
        Vec3::new(56.0, -72.0, 72.0),
        Vec3::new(74.0, -120.0, 52.0),
        Vec3::new(76.0, -180.0, 44.0),
        Vec3::new(78.0, -204.0, 24.0),
        Vec3::new(80.0, -208.0, 0.0),
        Vec3::new(66.0, -210.0, -44.0),
        Vec3::new(36.0, -210.0, -74.0),
        Vec3::new(0.0, -210.0, -82.0),
    ],
    thickness: [8.0, 11.0],
    round: 7.0,
    combed: 0.8,
    hangs: Some([82.0, 96.0]),
    bun: None,
};

const BUN: Cut = Cut {
    whorl: Vec3::new(0.0, 0.5, -0.87),
    hem: &[
        Vec3::new(0.0, -34.0, 93.0),
        Vec3::new(32.0, -38.0, 86.0),
        Vec3::new(53.0, -54.0, 72.0),
        Vec3::new(67.0, -92.0, 52.0),
        Vec3::new(72.0, -116.0, 28.0),
        Vec3::new(71.0, -122.0, 2.0),
        Vec3::new(65.0, -130.0, -22.0),
        Vec3::new(52.0, -150.0, -40.0),
        Vec3::new(28.0, -160.0, -50.0),
        Vec3::new(0.0, -162.0, -54.0),
    ],
    thickness: [4.0, 5.5],
    round: 3.5,
    combed: 0.6,
    hangs: None,
    bun: Some([Vec3::new(0.0, -40.0, -90.0), Vec3::new(38.0, 37.0, 30.0)]),
};

impl Hair {
    /// How it is cut, if there is any.
    pub(super) fn cut(self) -> Option<&'static Cut> {
        match self {
            Self::None => None,
            Self::Short => Some(&SHORT),
            Self::Bob => Some(&BOB),
            Self::Bun => Some(&BUN),
        }
    }
}
