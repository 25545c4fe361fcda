//! A shop's catalogue: garment packages, one file each, in a folder, and the theme of its screens.
//!
//! Reads: `catalogue.toml`, the logo and the font that it names, and zip archives that hold `garment.toml` and what it names;
//! everything in them may have been made by anybody. Writes: manifests, and the packages' files on demand.
//! Budget: 1 ms a package at load; [`limits`] bound what each may hold.
//! Thread: the loading thread.

mod collage;
mod error;
mod fitting;
mod font;
pub mod limits;
pub mod manifest;
pub mod package;
mod photographed;
mod picture;
pub mod price;
mod shop;
mod theme;

pub use collage::{CollageGarment, CollagePictures, CollageView, LAYERS, WearingLayer};
pub use error::CatalogueError;
pub use fitting::{FittingLevel, StretchLimits};
pub use manifest::{GarmentManifest, ManifestColour, Words, word};
pub use package::GarmentPackage;
pub use photographed::{GarmentPhotographs, PhotographedGarment};
pub use picture::Picture;
pub use price::Price;
pub use shop::{Catalogue, CatalogueItem, FILE, RefusedPackage, ShopFile};
pub use theme::{ShopTheme, ThemeColours, ThemeFile, contrast};
