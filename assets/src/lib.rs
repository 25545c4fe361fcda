//! What is baked and shared: limits, skeleton, body, rig, fabrics, sizes, patterns, garments.
//!
//! Reads: TOML, OBJ and the data embedded under `data/`. Writes: immutable assets that every other room borrows.
//! Budget: at load only; nothing here runs inside the frame.
//! Thread: the loading thread.

// Rooms in the order of the data: a room imports only from the groups above its own (tests/tests/layers.rs).
#[macro_use]
mod put_line;

pub mod file;
pub mod texture;
pub mod toml_keys;

pub mod fabric;
pub mod pattern;

pub mod body;

pub mod export;
pub mod import;
pub mod rig;
pub mod scene;
pub mod sizes;
pub mod tailor;

pub mod adapt;

pub mod scene_file;
pub mod wardrobe;

pub mod draping;

pub mod drafting;

pub mod catalogue;

#[cfg(test)]
#[path = "../../tests/src/recordings.rs"]
mod recordings;
