//! The command line of Toile; everything it does is in the library of the same name.

use std::process::ExitCode;

fn main() -> ExitCode {
    toile::run(std::env::args_os())
}
