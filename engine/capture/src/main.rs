//! The program `toile-capture`: motion, poses, bodies and faces from the pictures of several cameras.

mod commands;

use std::process::ExitCode;

use toile_cli::program;

fn main() -> ExitCode {
    program::run::<commands::CommandLine>(std::env::args_os(), |line| commands::run(&line.command))
}
