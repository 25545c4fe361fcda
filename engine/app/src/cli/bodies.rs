//! The grammar of `toile bench body`.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, value_parser};

use super::{json, quiet, required, text};
use crate::exit::AppError;

/// Most people of a file that are built: more than any survey has.
const MAX_PEOPLE: u64 = 100_000;

/// Arguments of `toile bench body`.
#[derive(Debug, Clone, PartialEq)]
pub struct BodiesArgs {
    /// Files of ANSUR II, one sex each.
    pub files: Vec<PathBuf>,
    /// People drawn from each.
    pub people: usize,
    /// Which people.
    pub seed: u64,
    /// One JSON object on stdout in place of the tables.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("body")
        .about("Build bodies to the measures of real people, and tell their errors, their time and their flaws")
        .long_about(
            "Draws random people of ANSUR II, builds each one's body from stature, neck, chest, waist at the navel, \
             buttocks, crotch height, sleeve and shoulder breadth, and reads the result off the mesh. Limits are those \
             of ISO 20685: 4 mm for heights, breadths and the neck, 9 mm for large girths. A measure out of its limit, \
             or a body that is rough or folded, makes the exit code 3; so do bodies that take longer than 20 ms.",
        )
        .args([
            Arg::new("ansur")
                .long("ansur")
                .value_name("FILE")
                .required(true)
                .action(ArgAction::Append)
                .value_parser(value_parser!(PathBuf))
                .help("A file of ANSUR II, such as ANSUR_II_FEMALE.csv; repeat it for the other sex"),
            text("people", "N", "People drawn from each file")
                .value_parser(value_parser!(u64).range(1..=MAX_PEOPLE))
                .default_value("500"),
            text("seed", "S", "Which people are drawn").value_parser(value_parser!(u64)).default_value("1"),
            json(),
            quiet(),
        ])
        .after_help(
            "Example: see how well fifty women are met\n  toile bench body --ansur ANSUR_II_FEMALE.csv --people 50",
        )
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<BodiesArgs, AppError> {
    Ok(BodiesArgs {
        files: matches.get_many("ansur").into_iter().flatten().cloned().collect(),
        people: usize::try_from(required::<u64>(matches, "people")?).map_err(AppError::internal)?,
        seed: required(matches, "seed")?,
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}
