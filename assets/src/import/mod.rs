//! Imports: meshes that others made.
//!
//! Reads: files. Writes: [`Shape`](crate::garment::Shape). Budget: at load only. Thread: the loading thread.

pub mod obj;
