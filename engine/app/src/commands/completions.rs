//! `toile completions`: the script that lets a shell complete Toile's commands.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap_complete::{Shell, generate};
use toile_cli::exit::AppError;
use toile_cli::terminal;

/// Shells that completions are written for, as they are called.
const SHELLS: [&str; 5] = ["bash", "elvish", "fish", "powershell", "zsh"];

/// Print the completions of a shell.
#[derive(Debug, Clone, Copy, PartialEq, clap::Args)]
#[command(after_help = "Example: complete Toile's options in bash\n  toile completions bash > \
                        ~/.local/share/bash-completion/completions/toile")]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_name = "SHELL", value_parser = PossibleValuesParser::new(SHELLS).try_map(|name| name.parse::<Shell>()))]
    pub shell: Shell,
}

/// Writes the completions of all commands for one shell to stdout.
///
/// # Errors
/// Only where stdout cannot be written.
pub fn run(args: &CompletionsArgs, mut all: clap::Command) -> Result<(), AppError> {
    let mut script = Vec::new();
    generate(args.shell, &mut all, "toile", &mut script);
    terminal::print(&String::from_utf8_lossy(&script))
}
