//! Imports: meshes, bodies and patterns that others made.
//!
//! Reads: OBJ, glTF and GLB, VRM, MakeHuman folders, sewn patterns. Writes: [`Shape`](toile_bake::Shape), a mesh in its file's own
//! order, a [`Body`](toile_base::body::Body), or a [`Pattern`](crate::pattern::Pattern).
//! Budget: at load only. Thread: the loading thread.

pub mod avatar;
pub mod gltf;
pub mod makehuman;
pub mod obj;
pub mod paint;
pub mod pattern;
pub mod plain;
