//! All integration tests of the crate, linked once.

/// The program that the tests run.
const PROGRAM: &str = env!("CARGO_BIN_EXE_toile-study");

#[path = "../../../tests/src/program.rs"]
mod common;
mod study;
