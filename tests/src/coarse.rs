//! Coarse garments, for tests in which any garment will do. Tests of other crates include this file.

use std::fs;
use std::path::{Path, PathBuf};

use toile_assets::drafting;

/// Distance between particles (mm). From 40 mm on the first level of draping is also the last, which takes a sixth of the time.
const SPACING_MM: f64 = 40.0;

/// Writes a garment of the wardrobe as the coarse pattern package `NAME.json` into a folder; returns its path.
///
/// # Panics
/// If the wardrobe has no such garment, or the folder cannot be written.
pub fn write(folder: &Path, name: &str) -> PathBuf {
    let mut package = drafting::package(name).expect("a garment of the wardrobe");
    package.spacing_mm = SPACING_MM;
    let path = folder.join(format!("{name}.json"));
    fs::write(&path, package.text()).expect("the folder can be written");
    path
}
