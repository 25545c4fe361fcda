//! The command line: its commands, its help, and the parsed request.
//!
//! Each command's own arguments stand beside its work in [`crate::commands`].

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use toile_cli::exit::AppError;
use toile_cli::program;
use toile_cli::replay::ReplayArgs;

use crate::commands;
use crate::commands::bake::BakeArgs;
use crate::commands::body::BodyArgs;
use crate::commands::catalogue::CatalogueCommand;
use crate::commands::collage::CollageArgs;
use crate::commands::completions::CompletionsArgs;
use crate::commands::convert::ConvertArgs;
use crate::commands::doctor::DoctorArgs;
use crate::commands::fabric::FabricCommand;
use crate::commands::kiosk::KioskArgs;
use crate::commands::live::LiveArgs;
use crate::commands::measure::MeasureArgs;
use crate::commands::plan::PlanArgs;
use crate::commands::programs::{self, OTHER_COMMANDS, OtherCommand};
use crate::commands::record::RecordArgs;
use crate::commands::run::RunArgs;
use crate::commands::tailor::TailorArgs;
use crate::commands::try_on::TryOnArgs;

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
    subcommands = OTHER_COMMANDS.iter().map(OtherCommand::grammar),
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
    Run(RunArgs),
    Doctor(DoctorArgs),
    Plan(PlanArgs),
    Replay(ReplayArgs),
    Kiosk(KioskArgs),
    Completions(CompletionsArgs),
}

/// All commands with their options and help, for the manual and for completions; those of other programs by name.
pub fn command() -> clap::Command {
    CommandLine::command()
}

/// Runs one command line, the program's name first, and returns the exit code of the process.
pub fn run(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    let args = with_default_command(args.into_iter().collect());
    if let Some((other, args)) = of_another_program(&args) {
        let handed_over = || programs::hand_over(other.program, &args).map(|never| match never {});
        return program::guarded(handed_over).into();
    }
    program::run::<CommandLine>(args, |line| dispatch(&line.command))
}

/// The command of another program that a line names, and the line that this program understands: `help bench` is
/// `bench --help`.
fn of_another_program(args: &[OsString]) -> Option<(&'static OtherCommand, Vec<OsString>)> {
    let named = |at: usize| args.get(at).and_then(|name| OtherCommand::named(name.to_str()?));
    if let Some(other) = named(1) {
        return Some((other, other.arguments(&args[1..])));
    }
    let helped = named(2).filter(|_| args[1] == "help")?;
    let args: Vec<OsString> = args[2..].iter().cloned().chain(["--help".into()]).collect();
    Some((helped, helped.arguments(&args)))
}

fn dispatch(asked: &Command) -> Result<(), AppError> {
    match asked {
        Command::TryOn(args) => commands::try_on::run(args),
        Command::Measure(args) => commands::measure::run(args),
        Command::Record(args) => commands::record::run(args),
        Command::Live(args) => commands::live::run(args),
        Command::Convert(args) => commands::convert::run(args),
        Command::Bake(args) => commands::bake::run(args),
        Command::Tailor(args) => commands::tailor::run(args),
        Command::Catalogue(command) => commands::catalogue::run(command),
        Command::Fabric(command) => commands::fabric::run(command),
        Command::Collage(args) => commands::collage::run(args),
        Command::Body(args) if args.colliders => commands::colliders::run(args),
        Command::Body(args) => commands::body::run(args),
        Command::Run(args) => commands::run::run(args),
        Command::Doctor(args) => commands::doctor::run(args),
        Command::Plan(args) => commands::plan::run(args),
        Command::Replay(args) => commands::replay::run(args),
        Command::Kiosk(args) => commands::kiosk::run(args),
        Command::Completions(args) => commands::completions::run(args, command()),
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

#[cfg(test)]
mod tests;
