//! Options that several commands share, and parsers of values.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use toile_cli::arguments::one_of;
use toile_engine::lanes::Width;
use toile_gpu::backend::Backend;

/// The option `--backend`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::Args)]
pub struct BackendArg {
    /// What steps the cloth: cpu; gpu, a graphics device, in a build with `--features gpu`; auto, whichever measures
    /// faster at the start. Where there is no device the processor steps, and a line on stderr says so
    #[arg(
        id = "backend",
        long = "backend",
        value_name = "B",
        value_parser = one_of(Backend::ALL, Backend::name),
        default_value = Backend::Cpu.name()
    )]
    pub choice: Backend,
}

/// The option `--crash-after`: every command that keeps its last seconds for a crash can be made to crash.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct CrashArg {
    /// Panic after so many seconds, to see what a crash leaves
    #[arg(id = "crash-after", long = "crash-after", value_name = "S")]
    pub after_s: Option<u64>,
}

/// A parser of numbers of lanes.
pub fn lanes() -> impl TypedValueParser<Value = Width> {
    let width = |text: String| text.parse().ok().and_then(Width::of).ok_or("there is no such width");
    PossibleValuesParser::new(["1", "4", "8", "16"]).try_map(width)
}

/// What a line of words says to a command that takes these arguments.
#[cfg(test)]
pub(crate) fn parsed<A: clap::Args>(line: &str) -> Result<A, clap::Error> {
    #[derive(clap::Parser)]
    struct Line<A: clap::Args> {
        #[command(flatten)]
        args: A,
    }
    Ok(<Line<A> as clap::Parser>::try_parse_from(line.split_whitespace())?.args)
}
