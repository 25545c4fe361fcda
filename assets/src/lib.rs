//! Assets, made at load and shared: limits, skeleton, body, rig, fabrics, sizes, patterns, garments.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
#[macro_use]
mod put_line;

pub mod delaunay;
pub mod file;
pub mod texture;
pub mod toml_keys;

pub mod fabric;
pub mod pattern;

pub mod body;

pub mod export;
pub mod import;
pub mod people;
pub mod rig;
pub mod scene;
pub mod sizes;
pub mod tailor;

pub mod adapt;

pub mod scene_file;

pub mod draping;

pub mod drafting;

pub mod catalogue;

#[cfg(test)]
#[path = "../../tests/src/recordings.rs"]
mod recordings;
