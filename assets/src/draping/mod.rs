//! Draping: a sewn pattern is laid around a body, sewn up and let hang.
//!
//! Panels are wrapped around trunk, legs and arms with almost no deformation first; then the energy of the cloth goes down,
//! without gravity until the seams are closed and with it afterwards, on meshes of 50, 25 mm and the final spacing
//! (multi-resolution prepositioning: INRIA MIRAGES 2006).

mod arrange;
mod carry;
mod drape;
mod ease;
mod error;
mod graded;
mod legs;
pub mod limits;
mod outlines;
mod package;
mod panels;
mod pattern_sizes;
mod place;
mod quality;
mod relax;
mod rows;
mod section;
mod skin_field;
mod sleeves;
mod springs;
mod worn;

pub use drape::{DrapeLevel, DrapedPattern, drape};
pub use ease::{PatternEase, ZoneEase, ease, fitting_size};
pub use error::DrapeError;
pub use graded::GradedPattern;
pub use package::{
    FABRIC, HungPattern, PackageError, PatternPackage, SPACING_MM, is_pattern, parse_package, read_package,
};
pub use pattern_sizes::{AS_DRAFTED, PatternSizes, SizeGirths, SizedDraft, TO_MEASURE};
pub use quality::DrapeQuality;
pub use skin_field::SkinField;
