//! The commands of `toile-perf`, one file each: its arguments and what it does with them.

use clap::{Parser, Subcommand};
use toile_cli::exit::AppError;
use toile_cli::replay::ReplayArgs;

mod arguments;
mod bench;
mod latency;
mod pareto;
mod replay;
mod soak;
mod torture;
mod validate;

/// Benchmarks, validation and long runs of Toile, each figure with its error.
///
/// `toile bench` and the like run this program, which lies beside `toile`.
#[derive(Debug, Parser)]
#[command(
    name = "toile-perf",
    version,
    after_help = "Example: the cost of a step of cloth, with its strain\n  toile-perf bench skirt --motion walk"
)]
pub struct CommandLine {
    #[command(subcommand)]
    pub command: PerfCommand,
}

/// What the user asked for. The help of a command is the doc of its arguments, which a doc here would replace.
#[derive(Debug, Clone, PartialEq, Subcommand)]
pub enum PerfCommand {
    #[command(subcommand)]
    Bench(bench::BenchCommand),
    Validate(validate::ValidateArgs),
    Pareto(pareto::ParetoArgs),
    Torture(torture::TortureArgs),
    Latency(latency::LatencyArgs),
    Soak(soak::SoakArgs),
    Replay(ReplayArgs),
}

/// Runs a command.
///
/// # Errors
/// As each command says.
pub fn run(command: &PerfCommand) -> Result<(), AppError> {
    match command {
        PerfCommand::Bench(command) => bench::run(command),
        PerfCommand::Validate(args) => validate::run(args),
        PerfCommand::Pareto(args) => pareto::run(args),
        PerfCommand::Torture(args) => torture::run(args),
        PerfCommand::Latency(args) => latency::run(args),
        PerfCommand::Soak(args) => soak::run(args),
        PerfCommand::Replay(args) => replay::run(args),
    }
}
