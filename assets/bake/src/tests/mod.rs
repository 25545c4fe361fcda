//! Shared by the tests of several modules.

pub(crate) mod meshes;
