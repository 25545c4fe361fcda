//! The command line: its commands, its help, and what one line asks for.
//!
//! Each command's own arguments stand beside its work in [`crate::commands`].

use std::ffi::OsString;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};

use crate::commands::bake::BakeArgs;
use crate::commands::bench::BenchCommand;
use crate::commands::body::BodyArgs;
use crate::commands::capture::CaptureCommand;
use crate::commands::catalogue::CatalogueCommand;
use crate::commands::collage::CollageArgs;
use crate::commands::completions::CompletionsArgs;
use crate::commands::convert::ConvertArgs;
use crate::commands::doctor::DoctorArgs;
use crate::commands::fabric::FabricCommand;
use crate::commands::kiosk::KioskArgs;
use crate::commands::latency::LatencyArgs;
use crate::commands::live::LiveArgs;
use crate::commands::measure::MeasureArgs;
use crate::commands::pareto::ParetoArgs;
use crate::commands::plan::PlanArgs;
use crate::commands::record::RecordArgs;
use crate::commands::replay::ReplayArgs;
use crate::commands::run::RunArgs;
use crate::commands::soak::SoakArgs;
use crate::commands::study::StudyArgs;
use crate::commands::tailor::TailorArgs;
use crate::commands::torture::TortureArgs;
use crate::commands::try_on::TryOnArgs;
use crate::commands::validate::ValidateArgs;
use crate::exit::AppError;

/// A real-time virtual fitting room: measures a shopper and dresses a body of their size.
///
/// Measures a shopper before a depth camera and dresses a body of their size in garments that move as cloth, 120 steps a
/// second.
///
/// Without a command, `toile` runs `toile try-on`, and takes its options.
#[derive(Debug, Parser)]
#[command(
    name = "toile",
    version,
    override_usage = "toile [OPTIONS OF TRY-ON]\n       toile <COMMAND>",
    after_help = "Example: dress the shopper of the embedded session, and look at out/\n  toile"
)]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

/// What the user asked for. The help of a command is the doc of its arguments, which a doc here would replace.
#[derive(Debug, Clone, PartialEq, Subcommand)]
pub(crate) enum Command {
    TryOn(TryOnArgs),
    Measure(MeasureArgs),
    Record(RecordArgs),
    Live(LiveArgs),
    Convert(ConvertArgs),
    Bake(BakeArgs),
    Tailor(TailorArgs),
    #[command(subcommand)]
    Catalogue(CatalogueCommand),
    #[command(subcommand)]
    Fabric(FabricCommand),
    Collage(CollageArgs),
    Body(BodyArgs),
    #[command(subcommand)]
    Capture(CaptureCommand),
    Run(RunArgs),
    Doctor(DoctorArgs),
    #[command(subcommand)]
    Bench(BenchCommand),
    Validate(ValidateArgs),
    Pareto(ParetoArgs),
    Torture(TortureArgs),
    Latency(LatencyArgs),
    Plan(PlanArgs),
    Study(StudyArgs),
    Replay(ReplayArgs),
    Soak(SoakArgs),
    Kiosk(KioskArgs),
    Completions(CompletionsArgs),
    /// Help or version: text to print.
    #[command(skip)]
    Print(String),
}

/// All commands with their options and help, for the manual and for completions.
pub fn command() -> clap::Command {
    CommandLine::command()
}

/// Parses a command line, the program's name first.
///
/// # Errors
/// [`AppError::Usage`] with one sentence.
pub(crate) fn parse(args: Vec<OsString>) -> Result<Command, AppError> {
    let args = with_default_command(args);
    match CommandLine::try_parse_from(&args) {
        Ok(line) => Ok(line.command),
        Err(error) => help_or_error(&error, &args),
    }
}

/// Puts `try-on` where no command is given, and moves flags given before a command behind it: `toile --json doctor`.
fn with_default_command(mut args: Vec<OsString>) -> Vec<OsString> {
    let is_flag = |arg: &OsString| ["--json", "--quiet", "-q"].iter().any(|flag| arg == flag);
    if args.is_empty() {
        args.push("toile".into());
    }
    let flags = args[1..].iter().take_while(|a| is_flag(a)).count();
    let first = args.get(1 + flags).map(|a| a.to_string_lossy().into_owned());
    match first.as_deref() {
        Some("-h" | "--help" | "-V" | "--version") => {}
        Some(word) if !word.starts_with('-') => args[1..=1 + flags].rotate_right(1),
        _ => args.insert(1, "try-on".into()),
    }
    args
}

/// Help and version become text to print; a real error becomes one sentence that ends with where help is.
fn help_or_error(error: &clap::Error, args: &[OsString]) -> Result<Command, AppError> {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        let colour = crate::terminal::Paint::for_stdout().is_on();
        let text = error.render();
        return Ok(Command::Print(if colour { text.ansi().to_string() } else { text.to_string() }));
    }
    let known = |arg: &&OsString| command().get_subcommands().any(|c| **arg == c.get_name());
    let place = args.get(1).filter(known).map_or_else(String::new, |name| format!(" {}", name.to_string_lossy()));
    Err(AppError::Usage(sentence(error, &place)))
}

fn sentence(error: &clap::Error, place: &str) -> String {
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return format!("`toile{place}` needs a command; see `toile{place} --help`");
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
    format!("{what}{tips}; see `toile{place} --help`")
}

#[cfg(test)]
mod tests;
