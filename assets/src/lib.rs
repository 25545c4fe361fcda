//! What is baked and shared: limits, skeleton, body, rig, fabrics, sizes, garments.
//!
//! Reads: TOML, OBJ and the data embedded under `data/`. Writes: immutable assets that every other room borrows.
//! Budget: at load only; nothing here runs inside the frame.
//! Thread: the loading thread.

pub mod bake;
pub mod body;
pub mod cone;
pub mod export;
pub mod fabric;
pub mod file;
pub mod garment;
pub mod import;
pub mod limits;
pub mod mesh;
pub mod numeric;
pub mod rig;
pub mod scene;
pub mod scene_file;
pub mod sizes;
pub mod skeleton;
pub mod toml_keys;
pub mod wardrobe;
