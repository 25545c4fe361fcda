//! The grammar of `toile validate`.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, value_parser};
use toile_perf::validate::Level;
use toile_perf::validate::run::{NAMES, Options};

use super::backend::{asked_backend, backend};
use super::{json, quiet, required, text};
use crate::exit::AppError;

/// Arguments of `toile validate`.
#[derive(Debug, Clone, PartialEq)]
pub struct ValidateArgs {
    /// What is run.
    pub options: Options,
    /// One JSON object on stdout in place of the table.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    let levels: Vec<&str> = Level::ALL.iter().map(|level| level.name()).chain(["all"]).collect();
    clap::Command::new("validate")
        .about("Hold the cloth against exact solutions, each with its error and the time of a step")
        .long_about(
            "Runs cases whose answer is known: strips that bend, columns that give way, strings, pendulums, waves, \
             friction. Each is run as garments are, in each quality, and with so many substeps that more change \
             nothing. Targets are for the quality fine; a missed one is told with its cause, and ends with exit code \
             3. docs/validate.md says what each case is.",
        )
        .args([
            Arg::new("case")
                .value_name("CASE")
                .value_parser(PossibleValuesParser::new(NAMES))
                .help("The one case to run [default: all]"),
            text("quality", "Q", "Settings to tell: one of them, or all")
                .value_parser(PossibleValuesParser::new(levels))
                .default_value("all"),
            text("parameter", "P", "Only what the table tells with this parameter, such as 'Gamma 10' [default: all]"),
            text("every", "K", "Run one in K cases of each name: a quick look")
                .value_parser(value_parser!(u64).range(1..=1_000))
                .default_value("1"),
            text("threads", "T", "Threads that run cases side by side [default: 2, or as many cores as there are]")
                .value_parser(["1", "2"]),
            backend(),
            json(),
            quiet(),
        ])
        .after_help("Example: see how right the cantilever is as garments are stepped\n  toile validate cantilever --quality fine")
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<ValidateArgs, AppError> {
    let quality = required::<String>(matches, "quality")?;
    let usual = Options::default();
    let options = Options {
        case: matches.get_one("case").cloned(),
        parameter: matches.get_one("parameter").cloned(),
        levels: Level::ALL.into_iter().filter(|level| quality == "all" || level.name() == quality).collect(),
        threads: matches.get_one::<String>("threads").and_then(|t| t.parse().ok()).unwrap_or(usual.threads),
        every: usize::try_from(required::<u64>(matches, "every")?).map_err(AppError::internal)?,
        backend: asked_backend(matches)?,
    };
    Ok(ValidateArgs { options, json: matches.get_flag("json"), quiet: matches.get_flag("quiet") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_and_a_quality_are_picked_and_unknown_ones_refused() {
        let parsed = |line: &str| grammar().try_get_matches_from(line.split_whitespace());
        let args = args(&parsed("validate cantilever --quality fine --every 6 --threads 1 --json").unwrap()).unwrap();
        assert_eq!(args.options.case.as_deref(), Some("cantilever"));
        assert_eq!((args.options.levels, args.options.every, args.options.threads), (vec![Level::GATED], 6, 1));
        assert!(args.json);
        assert!(parsed("validate cantilevr").is_err() && parsed("validate --quality best").is_err());
    }
}
