//! Imports: meshes and bodies that others made.
//!
//! Reads: OBJ, glTF and GLB, VRM, MakeHuman folders. Writes: [`Shape`](crate::garment::Shape), a mesh in its file's own
//! order, or a [`Body`](crate::body::Body).
//! Budget: at load only. Thread: the loading thread.

pub mod avatar;
pub mod gltf;
pub mod makehuman;
pub mod obj;
pub mod plain;
