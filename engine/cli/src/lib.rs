//! The parts that the command-line programs of Toile share: exit codes, output files, JSON documents, common options.

// Modules in the order of the data: a module imports only from the groups above its own (tests/tests/layers.rs).
pub mod heap;
pub mod machine;
pub mod output;

pub mod document;
pub mod exit;

pub mod terminal;

pub mod arguments;
pub mod picture;
pub mod program;

pub mod camera;
pub mod replay;
