//! The program of the evidence: benchmarks, validation and long runs, each figure with its error.

mod commands;

use std::process::ExitCode;

use toile_cli::heap::Counted;
use toile_cli::program;

/// The system's allocator, counted: `bench` and `soak` report allocations and memory as they happen in the program.
#[global_allocator]
static ALLOCATOR: Counted = Counted;

fn main() -> ExitCode {
    program::run::<commands::CommandLine>(std::env::args_os(), |line| commands::run(&line.command))
}
