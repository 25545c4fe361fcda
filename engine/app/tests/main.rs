//! All integration tests of the crate but those of a whole shop, linked once.

/// The program that the tests run.
const PROGRAM: &str = env!("CARGO_BIN_EXE_toile");

#[cfg(unix)]
mod bad_files;
mod bad_input;
mod bake;
mod body;
mod cameras;
mod catalogue;
mod cli;
mod collage;
#[path = "../../../tests/src/program.rs"]
mod common;
mod convert;
mod embedded;
mod export;
mod fabric;
mod kinect;
mod look;
mod man;
mod one_answer;
mod outputs;
mod plan;
#[cfg(unix)]
mod programs;
#[path = "../../../tests/src/recordings.rs"]
mod recordings;
mod run;
mod samples;
mod shopper_facts;
mod tailor;
mod try_on;
mod webcam;
