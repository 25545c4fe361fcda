//! For whom the drafts of a pattern are: the sizes that a package names.

use serde::{Deserialize, Serialize};

use crate::sizes::{GarmentKind, Girth};

/// The size of a pattern with one draft and no size table.
pub const AS_DRAFTED: &str = "as drafted";

/// The size of a pattern that is graded for the wearer's own measures.
pub const TO_MEASURE: &str = "to measure";

/// For whom a package's drafts are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatternSizes {
    /// A table of sizes that is built in.
    pub table: String,
    /// What the garment is: by the girth that decides the size of its kind the drafts are graded.
    pub kind: GarmentKind,
    /// Size that the package's own draft is for.
    pub size: String,
    /// Drafts for other sizes.
    #[serde(default)]
    pub drafts: Vec<SizedDraft>,
    /// Girths of every size that is made, as `toile tailor` found them; none where it has not looked.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub girths: Vec<SizeGirths>,
}

/// What a size measures around the bodies that it is for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SizeGirths {
    /// Code of the size.
    pub size: String,
    /// At the chest (mm), if it is judged there.
    pub chest_mm: Option<f64>,
    /// At the waist (mm).
    pub waist_mm: Option<f64>,
    /// At the hip (mm).
    pub hip_mm: Option<f64>,
}

impl SizeGirths {
    /// The girth at a zone (m).
    pub fn at(&self, zone: Girth) -> Option<f64> {
        match zone {
            Girth::Chest => self.chest_mm,
            Girth::Waist => self.waist_mm,
            Girth::Hip => self.hip_mm,
        }
        .map(|mm| mm * 1e-3)
    }
}

/// A draft for one size.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SizedDraft {
    /// Code of the size.
    pub size: String,
    /// Text of the draft's file.
    pub pattern: String,
    /// Text of its seam file, where its format has no sewing.
    pub seams: Option<String>,
}
