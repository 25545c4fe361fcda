//! All integration tests of the crate, linked once.

mod catalogue;
mod drafts;
mod draping;
mod meshes;
mod patterns;
#[path = "../../tests/src/recordings.rs"]
mod recordings;
mod sizes;
