//! The command line of Toile; everything it does is in the library of the same name.

use std::process::ExitCode;

use toile::heap::Counted;

/// The system's allocator, counted: `toile bench` and `toile soak` report allocations and memory as they happen in the
/// program that is shipped. A frame allocates nothing, so counting costs it nothing.
#[global_allocator]
static ALLOCATOR: Counted = Counted;

fn main() -> ExitCode {
    toile::run(std::env::args_os())
}
