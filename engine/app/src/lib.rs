//! The product's command line: try on, measure, tailor, run the kiosk.

// Modules in the order of the data: a module imports only from the groups above its own (tests/tests/layers.rs).
mod overlay;
pub mod report;

pub mod fit;
pub mod renderer;

pub mod arguments;

pub mod pictures;
pub mod session_export;
pub mod summary;
pub mod video;

pub mod commands;

pub mod cli;
