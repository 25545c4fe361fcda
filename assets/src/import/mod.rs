//! Imports: meshes that others made.
//!
//! Reads: OBJ, glTF and GLB. Writes: [`Shape`](crate::garment::Shape), or a mesh in its file's own order.
//! Budget: at load only. Thread: the loading thread.

pub mod gltf;
pub mod obj;
pub mod plain;
