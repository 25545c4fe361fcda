//! The grammar of `toile torture`.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, value_parser};
use toile_engine::cloth::Quality;
use toile_perf::torture::{CASES, Options, SEEDS};

use super::backend::{asked_backend, backend};
use super::{json, quiet, required, text};
use crate::exit::AppError;

/// Most seeds of a case: a day's work.
const MAX_SEEDS: u64 = 100_000;

/// Arguments of `toile torture`.
#[derive(Debug, Clone, PartialEq)]
pub struct TortureArgs {
    /// Which cases and seeds.
    pub options: Options,
    /// One JSON object on stdout in place of the table.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("torture")
        .about("Do to the cloth what no cloth ever meets, and see whether it comes back")
        .long_about(
            "Runs the hard cases: cloth that starts where none can be, surroundings that jump, ratios and steps beyond \
             all measure, inputs that are no numbers. Required are: nothing that is not finite is ever published, no \
             particle is faster than the limit, and the cloth is back within 1 mm of its place of rest in 5 s where \
             it has only one. A case that fails makes the exit code 3. docs/torture.md describes the cases.",
        )
        .args([
            Arg::new("case")
                .value_name("CASE")
                .value_parser(PossibleValuesParser::new(CASES.map(|case| case.name)))
                .help("One case [default: all of them]"),
            text("seeds", "N", "Seeds of each case, from 0 on")
                .value_parser(value_parser!(u64).range(1..=MAX_SEEDS))
                .conflicts_with("seed"),
            text("seed", "S", "One seed: what failed, once more").value_parser(value_parser!(u64).range(..u64::MAX)),
            text("quality", "Q", "Settings of the cloth where a case does not choose its own: draft, shop or fine")
                .value_parser(Quality::ALL.map(Quality::name))
                .default_value(Quality::default().name()),
            backend(),
            json(),
            quiet(),
        ])
        .after_help("Example: run one seed of a case once more\n  toile torture squeeze --seed 7")
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<TortureArgs, AppError> {
    let seeds = match matches.get_one::<u64>("seed") {
        Some(&seed) => seed..seed + 1,
        None => 0..matches.get_one("seeds").copied().unwrap_or(SEEDS),
    };
    let quality = required::<String>(matches, "quality")?.parse().map_err(AppError::internal)?;
    Ok(TortureArgs {
        options: Options { case: matches.get_one("case").cloned(), seeds, quality, backend: asked_backend(matches)? },
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_gpu::stepper::Backend;

    fn parsed(line: &str) -> Result<TortureArgs, AppError> {
        args(&grammar().try_get_matches_from(line.split_whitespace()).map_err(AppError::input)?)
    }

    #[test]
    fn all_cases_and_seeds_are_the_default() {
        assert_eq!(parsed("torture").unwrap().options, Options::default());
    }

    #[test]
    fn one_case_and_one_seed_can_be_named() {
        let args = parsed("torture squeeze --seed 7 --quality fine --backend auto --json -q").unwrap();
        let (quality, backend) = (Quality::Fine, Backend::Auto);
        let options = Options { case: Some("squeeze".into()), seeds: 7..8, quality, backend };
        assert_eq!(args, TortureArgs { options, json: true, quiet: true });
        assert_eq!(parsed("torture --seeds 3").unwrap().options.seeds, 0..3);
        for wrong in ["torture squeze", "torture --seeds 0", "torture --seed 1 --seeds 2"] {
            assert!(parsed(wrong).is_err(), "{wrong}");
        }
    }
}
