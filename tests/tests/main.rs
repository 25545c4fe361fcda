//! All integration tests of the crate, linked once.

mod baking;
mod colliders;
mod contact;
mod determinism;
mod docs;
mod layers;
mod link_curves;
mod motion;
mod names;
mod recordings;
mod scenes;
mod skirt;
mod structure;
mod test_binaries;
mod tucking;
mod world_step;
