//! `toile completions`: the script that lets a shell complete Toile's commands.

use clap_complete::{Shell, generate};

use crate::cli;
use crate::exit::AppError;
use crate::terminal;

/// Writes the completions for one shell to stdout.
///
/// # Errors
/// Only where stdout cannot be written.
pub fn run(shell: Shell) -> Result<(), AppError> {
    let mut script = Vec::new();
    generate(shell, &mut cli::command(), "toile", &mut script);
    terminal::print(&String::from_utf8_lossy(&script))
}
