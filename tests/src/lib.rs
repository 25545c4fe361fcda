//! What the structure tests and the tests of the whole share; the tests themselves live in `tests/`.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
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
