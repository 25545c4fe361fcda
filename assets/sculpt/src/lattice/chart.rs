//! The pieces of the texture atlas.

/// A piece of the texture atlas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Chart {
    /// Trunk and neck, from side to side.
    Front,
    /// Back of the trunk and neck, from side to side.
    Back,
    /// Face and forehead.
    Face,
    /// Back and crown of the head.
    Nape,
    /// An ear; true is the right one.
    Ear(bool),
    /// Upper side of an arm, with the hand's back.
    ArmUpper(bool),
    /// Lower side of an arm, with the palm.
    ArmLower(bool),
    /// Front of a leg, with the instep.
    LegFront(bool),
    /// Back of a leg.
    LegBack(bool),
    /// Sole of a foot.
    Sole(bool),
}

/// Number of pieces of the atlas.
pub const CHARTS: usize = 16;

impl Chart {
    /// Number of the chart, below [`CHARTS`].
    pub fn number(self) -> u8 {
        match self {
            Self::Front => 0,
            Self::Back => 1,
            Self::Face => 2,
            Self::Nape => 3,
            Self::Ear(right) => 4 + u8::from(right),
            Self::ArmUpper(right) => 6 + u8::from(right),
            Self::ArmLower(right) => 8 + u8::from(right),
            Self::LegFront(right) => 10 + u8::from(right),
            Self::LegBack(right) => 12 + u8::from(right),
            Self::Sole(right) => 14 + u8::from(right),
        }
    }

    /// The same piece of the other side; each variant's flag says whether it is the right one.
    pub(crate) fn mirror(self) -> Self {
        match self {
            Self::Ear(_) => Self::Ear(true),
            Self::ArmUpper(_) => Self::ArmUpper(true),
            Self::ArmLower(_) => Self::ArmLower(true),
            Self::LegFront(_) => Self::LegFront(true),
            Self::LegBack(_) => Self::LegBack(true),
            Self::Sole(_) => Self::Sole(true),
            both => both,
        }
    }
}
