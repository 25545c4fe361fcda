//! What the tests of the house share; the tests themselves live in `tests/`.
//!
//! Reads: the sources and manifests of the workspace, the scene's shopper, recordings. Writes: nothing.
//! Budget: under a second for the whole tree; half a second to dress the shopper's body.
//! Thread: any test's.

// Rooms in the order of the data: a room imports only from the groups above its own (tests/tests/layers.rs).
pub mod cloth;
pub mod dressed;
pub mod meshes;
pub mod recordings;
pub mod scan;
pub mod tolerance;
pub mod tree;

pub mod exceptions;
pub mod items;

pub mod imports;
