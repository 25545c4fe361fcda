//! Imports: meshes, bodies and patterns that others made.

pub mod avatar;
pub mod gltf;
pub mod makehuman;
pub mod obj;
pub mod paint;
pub mod pattern;
pub mod plain;
