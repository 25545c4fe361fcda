//! All integration tests of the crate, linked once.

mod determinism;
mod docs;
mod house;
mod laws;
mod laws_baking;
mod laws_colliders;
mod laws_contact;
mod laws_links;
mod laws_motion;
mod laws_tucked;
mod layers;
mod names;
mod recordings;
mod scenes;
mod skirt;
mod test_binaries;
