//! The grammar of `toile bench filters`.

use std::path::PathBuf;

use clap::ArgMatches;

use super::{flag, json, path};

/// Arguments of `toile bench filters`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FiltersArgs {
    /// A folder of recordings; nothing measures on motions of a known truth alone.
    pub data: Option<PathBuf>,
    /// All filters in place of the default one.
    pub table: bool,
    /// One JSON object on stdout in place of the table.
    pub json: bool,
}

pub(super) fn grammar() -> clap::Command {
    clap::Command::new("filters")
        .about("Measure jitter, lag and overshoot of the filters of joints, and the slide of feet")
        .long_about(
            "Shows each filter the same motions, whose truth is known, under a sensor's noise, and tells how much a resting \
             joint trembles, how late a moving one comes, and how far it passes its goal. With a folder of recordings it \
             does the same with recorded waves, and tells how far planted feet slide and whether jumps leave the floor.",
        )
        .args([
            path("data", "DIR", "Folder of recordings [default: the environment's TOILE_DATA, if set]"),
            flag("table", "Measure every filter; takes a minute"),
            json(),
        ])
        .after_help("Example: compare all filters\n  toile bench filters --table --data recordings")
}

pub(super) fn parse(matches: &ArgMatches) -> FiltersArgs {
    let given = matches.get_one::<PathBuf>("data").cloned();
    FiltersArgs {
        data: given.or_else(|| std::env::var_os("TOILE_DATA").map(PathBuf::from)),
        table: matches.get_flag("table"),
        json: matches.get_flag("json"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_option_arrives() {
        let line = "filters --table --json --data there";
        let args = parse(&grammar().try_get_matches_from(line.split_whitespace()).unwrap());
        assert_eq!(args, FiltersArgs { data: Some("there".into()), table: true, json: true });
    }
}
