//! What the tests of the house share; the tests themselves live in `tests/`.
//!
//! Reads: the sources and manifests of the workspace, the scene's shopper, recordings. Writes: nothing.
//! Budget: under a second for the whole tree; half a second to dress the shopper's body.
//! Thread: any test's.

pub mod cloth;
pub mod meshes;
pub mod recordings;
pub mod scan;
pub mod stage;
pub mod tolerance;
pub mod tree;
