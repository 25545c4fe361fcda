//! A program from its command line to its exit code.

use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;

use crate::exit::{self, AppError, Code};
use crate::terminal;

/// What a command line asks for.
#[derive(Debug, Clone, PartialEq)]
pub enum Asked<C> {
    /// A command with its options.
    Command(C),
    /// Help or version: text to print.
    Text(String),
}

/// Runs one command line, the program's name first, and returns the exit code of the process.
pub fn run<C: Parser>(
    args: impl IntoIterator<Item = OsString>,
    work: impl FnOnce(&C) -> Result<(), AppError>,
) -> ExitCode {
    exit::install_panic_hook();
    let args: Vec<OsString> = args.into_iter().collect();
    let done = guarded(|| match parse(&args)? {
        Asked::Command(command) => work(&command),
        Asked::Text(text) => terminal::print(&text),
    });
    done.into()
}

/// Does some work, prints its error if it has one, and turns a panic, on any thread, into [`Code::Internal`].
pub fn guarded(work: impl FnOnce() -> Result<(), AppError>) -> Code {
    // Unwinding rather than leaving at once lets an output folder take back its unfinished files. Nothing that the
    // work has touched is looked at again, so it need not be unwind-safe.
    let outcome = catch_unwind(AssertUnwindSafe(work));
    let code = match outcome {
        Ok(Ok(())) => Code::Ok,
        Ok(Err(error)) => {
            error.print();
            error.code()
        }
        Err(_) => Code::Internal,
    };
    // A panic on another thread was reported by the hook; whatever this thread made of it, the run has failed.
    if exit::panicked() { Code::Internal } else { code }
}

/// Parses a command line, the program's name first.
///
/// # Errors
/// [`AppError::Usage`] with one sentence that ends with where help is.
pub fn parse<C: Parser>(args: &[OsString]) -> Result<Asked<C>, AppError> {
    let error = match C::try_parse_from(args) {
        Ok(command) => return Ok(Asked::Command(command)),
        Err(error) => error,
    };
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        return Ok(Asked::Text(error.render().to_string()));
    }
    let program = C::command();
    let known = |arg: &&OsString| program.get_subcommands().any(|c| **arg == c.get_name());
    let command = args.get(1).filter(known).map_or_else(String::new, |name| format!(" {}", name.to_string_lossy()));
    Err(AppError::Usage(sentence(&error, &format!("{}{command}", program.get_name()))))
}

fn sentence(error: &clap::Error, place: &str) -> String {
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return format!("`{place}` needs a command; see `{place} --help`");
    }
    let text = error.render().to_string();
    let parts = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let parts: Vec<&str> = parts.filter(|line| !line.is_empty() && !line.starts_with("For more information")).collect();
    let (what, tips) = parts.split_first().unwrap_or((&"the command line was not understood", &[]));
    let what = what.trim_start_matches("error: ");
    // A list of missing arguments ends its first line with a colon; any other lines are tips.
    let tips = match (tips, what.ends_with(':')) {
        ([], _) => String::new(),
        (tips, true) => format!(" {}", tips.join(", ")),
        (tips, false) => format!(" ({})", tips.join("; ").replace("tip: ", "")),
    };
    format!("{what}{tips}; see `{place} --help`")
}
