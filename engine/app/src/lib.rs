//! The product's command line: try on, measure, tailor, run the kiosk.
//!
//! Reads: arguments, sessions, garments. Writes: one report on stdout, words on stderr, files in the output folder.
//! Budget: the words and the parsing take under 10 ms; the work itself is budgeted by the crates it calls.
//! Thread: the main thread, which loads, starts the frame's threads and waits for them.

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
