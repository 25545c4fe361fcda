//! A garment with its choice of sizes: the sizes that are made, their finished girths, and the ease that feels right.

use toile_assets::sizes::{GarmentKind, Girth, SizeTable};

/// A zone of fit is where a girth is taken.
pub type Zone = Girth;

/// Finished girth of a garment at one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneGirth {
    /// Where the girth is taken.
    pub zone: Zone,
    /// Girth of the garment (m).
    pub girth_m: f32,
}

/// Ease (garment less body) that feels right at one zone; negative where the cloth is meant to stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EaseRange {
    /// Where the girth is taken.
    pub zone: Zone,
    /// Less than this is tight (m).
    pub least: f32,
    /// More than this is loose (m).
    pub most: f32,
}

/// One size of a garment as it is made.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeSize {
    /// Code, as in the size table.
    pub code: String,
    /// Finished girths, those zones that the garment covers.
    pub zones: Vec<ZoneGirth>,
}

/// A garment to choose a size of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offer<'a> {
    /// Name of the garment.
    pub garment: &'a str,
    /// Kind of the garment, which decides its primary measures.
    pub kind: GarmentKind,
    /// The table that its sizes are designated by.
    pub table: &'a SizeTable,
    /// The sizes that are made, smallest first.
    pub sizes: &'a [MadeSize],
    /// Comfortable ease at the zones that matter.
    pub ease: &'a [EaseRange],
}
