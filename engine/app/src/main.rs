//! The command line of Toile; everything it does is in the library of the same name.

use std::alloc::System;
use std::process::ExitCode;

use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};

/// The system's allocator, counted: `toile bench` reports allocations and memory as they happen in the program that is
/// shipped. A frame allocates nothing, so counting costs it nothing.
#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

fn main() -> ExitCode {
    toile::run(std::env::args_os())
}
