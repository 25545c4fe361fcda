//! The grammar of `toile pareto`.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches};
use toile_perf::pareto::{Options, SCENES};

use super::{flag, json, path, quiet, required};
use crate::exit::AppError;

/// Arguments of `toile pareto`.
#[derive(Debug, Clone, PartialEq)]
pub struct ParetoArgs {
    /// What is measured.
    pub options: Options,
    /// Where the files go.
    pub out: PathBuf,
    /// One JSON object on stdout in place of the table.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("pareto")
        .about("Plot speed against error over the cloth's settings, and tell which are best")
        .long_about(
            "Runs scenes under many settings (solvers, substeps, qualities, meshes, one and two threads), times a step \
             of each and measures how far from x* it ends. Writes an HTML report, plots as PNG and a table of all \
             points as CSV. docs/pareto.md says what x* is.",
        )
        .args([
            Arg::new("scene")
                .value_name("SCENE")
                .value_parser(PossibleValuesParser::new(SCENES))
                .help("The one scene to measure [default: all]"),
            path("out", "DIR", "Folder for the files; it is made if missing").default_value("pareto"),
            flag("quick", "Few settings of small meshes: a look at whether it works"),
            json(),
            quiet(),
        ])
        .after_help("Example: see which settings of the skirt are worth their time\n  toile pareto skirt --out plots")
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<ParetoArgs, AppError> {
    Ok(ParetoArgs {
        options: Options { scene: matches.get_one("scene").cloned(), quick: matches.get_flag("quick") },
        out: required(matches, "out")?,
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}
