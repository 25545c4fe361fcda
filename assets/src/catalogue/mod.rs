//! A shop's catalogue: garment packages, one file each, in a folder, and the theme of its screens.

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
