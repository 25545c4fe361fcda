//! All integration tests of the crate, linked once.

/// The program that the tests run.
const PROGRAM: &str = env!("CARGO_BIN_EXE_toile-perf");

mod ansur;
#[cfg(feature = "gpu")]
mod backend;
mod backend_option;
mod bench;
#[path = "../../tests/src/coarse.rs"]
mod coarse;
mod colliders;
#[path = "../../tests/src/program.rs"]
mod common;
mod latency;
mod measuring;
mod oracle;
#[cfg(unix)]
mod outputs;
mod pointing;
#[path = "../../tests/src/recordings.rs"]
mod recordings;
mod reliability;
mod soak;
mod torture;
mod validate;
mod webcam;
