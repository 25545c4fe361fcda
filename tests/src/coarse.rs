//! Coarse garments, for tests in which any garment will do. Tests of other crates include this file.

use std::fs;
use std::path::{Path, PathBuf};

use toile_assets::drafting;
use toile_assets::draping::PatternPackage;

/// Distance between particles (mm). From 40 mm on the first level of draping is also the last, which takes a sixth of the time.
const SPACING_MM: f64 = 40.0;

/// A garment of the wardrobe as a coarse pattern package.
///
/// # Panics
/// If the wardrobe has no such garment.
pub fn package(name: &str) -> PatternPackage {
    let mut package = drafting::package(name).expect("a garment of the wardrobe");
    package.spacing_mm = SPACING_MM;
    package
}

/// Writes it as `NAME.json` into a folder; returns its path.
///
/// # Panics
/// As [`package`], and if the folder cannot be written.
pub fn write(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(format!("{name}.json"));
    fs::write(&path, package(name).text()).expect("the folder can be written");
    path
}
