//! A shop's catalogue: garment packages, one file each, in a folder.
//!
//! Reads: `catalogue.toml` and zip archives that hold `garment.toml` and what it names; everything in them may have been made by
//! anybody. Writes: manifests, and the packages' files on demand.
//! Budget: 1 ms a package at load; [`limits`] bound what each may hold.
//! Thread: the loading thread.

mod error;
pub mod limits;
pub mod manifest;
pub mod package;
pub mod price;
mod shop;

pub use error::CatalogueError;
pub use manifest::{GarmentManifest, ManifestColour, Words, word};
pub use package::GarmentPackage;
pub use price::Price;
pub use shop::{Catalogue, CatalogueItem, RefusedPackage, ShopFile};
