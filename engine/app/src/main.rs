//! The command line of Toile; everything it does is in the library of the same name.

use std::process::ExitCode;

use toile_cli::heap::Counted;

/// The system's allocator, counted: reports tell allocations and memory as they happen in the program that is shipped.
/// A step allocates nothing, so counting costs it nothing.
#[global_allocator]
static ALLOCATOR: Counted = Counted;

fn main() -> ExitCode {
    toile::cli::run(std::env::args_os())
}
