//! What the tests of the house share; the tests themselves live in `tests/`.
//!
//! Reads: the sources and manifests of the workspace. Writes: nothing.
//! Budget: under a second for the whole tree.
//! Thread: any test's.

pub mod scan;
pub mod tree;
