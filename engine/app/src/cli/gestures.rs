//! The grammar of `toile bench gestures`.

use clap::{ArgMatches, value_parser};

use super::{flag, json, required, text};
use crate::exit::AppError;

/// Arguments of `toile bench gestures`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GesturesArgs {
    /// Sequences of each gesture under each condition.
    pub sequences: u32,
    /// Seed of the first one.
    pub seed: u64,
    /// Tables in Markdown in place of the summary.
    pub table: bool,
    /// One JSON object on stdout in place of the summary.
    pub json: bool,
}

/// Most sequences of a cell: 70 cells of a millisecond each make it a quarter of an hour.
const MAX_SEQUENCES: i64 = 10_000;

pub(super) fn grammar() -> clap::Command {
    clap::Command::new("gestures")
        .about("Tell how many gestures are missed and how many are seen where there are none, and what a frame costs")
        .long_about(
            "Lets made-up shoppers of many sizes, distances and speeds swipe, hold a hand out, open and close it, and do \
             what people do before a mirror that is no gesture, seen by a sensor with noise and lost frames. Counts \
             gestures missed and false events, and times the recogniser.",
        )
        .args([
            text("sequences", "N", "Sequences of each gesture under each condition")
                .value_parser(value_parser!(u32).range(1..=MAX_SEQUENCES))
                .default_value("100"),
            text("seed", "N", "Seed of the first sequence").value_parser(value_parser!(u64)).default_value("1"),
            flag("table", "Print all tables in Markdown"),
            json(),
        ])
        .after_help("Example: the tables of docs/gestures.md\n  toile bench gestures --sequences 200 --table")
}

pub(super) fn parse(matches: &ArgMatches) -> Result<GesturesArgs, AppError> {
    Ok(GesturesArgs {
        sequences: required(matches, "sequences")?,
        seed: required(matches, "seed")?,
        table: matches.get_flag("table"),
        json: matches.get_flag("json"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_option_arrives() {
        let parsed = |line: &str| parse(&grammar().try_get_matches_from(line.split_whitespace()).unwrap()).unwrap();
        let args = GesturesArgs { sequences: 100, seed: 1, table: false, json: false };
        assert_eq!(parsed("gestures"), args);
        let args = GesturesArgs { sequences: 7, seed: 9, table: true, json: true };
        assert_eq!(parsed("gestures --sequences 7 --seed 9 --table --json"), args);
    }
}
