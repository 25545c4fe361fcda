//! The grammar of `toile bench measure`.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use toile_perf::measuring::Sensor;

use super::{json, quiet, required, text};
use crate::exit::AppError;

/// Most people of a file that are measured: more than any survey has.
const MAX_PEOPLE: u64 = 100_000;

/// Most frames of one person: ten seconds.
const MAX_FRAMES: u64 = 300;

/// Arguments of `toile bench measure`.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuringArgs {
    /// Files of ANSUR II, one sex each.
    pub files: Vec<PathBuf>,
    /// People drawn from each.
    pub people: usize,
    /// Frames of each.
    pub frames: usize,
    /// Which people.
    pub seed: u64,
    /// The cameras.
    pub sensors: Vec<Sensor>,
    /// One JSON object on stdout in place of the tables.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

pub(super) fn grammar() -> clap::Command {
    clap::Command::new("measure")
        .about("Measure synthetic people before synthetic cameras, and tell the errors of both ways of measuring")
        .long_about(
            "Draws random people of ANSUR II, gives each a shape of their own, renders a second of them swaying before \
             a Kinect v1 at 2 to 3 m and before a camera like the Azure Kinect at 2 to 2.5 m, and measures them by the \
             body fit and by sections and proportions. Limits are those of ISO 20685 for the mean error; it is \
             synthetic agreement, not accuracy on people. An interval beyond its limit makes the exit code 3.",
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
                .value_parser(value_parser!(u64).range(2..=MAX_PEOPLE))
                .default_value("100"),
            text("frames", "F", "Frames that each is measured from, at 30 Hz")
                .value_parser(value_parser!(u64).range(1..=MAX_FRAMES))
                .default_value("30"),
            text("sensor", "S", "Camera").value_parser(["kinect", "azure", "both"]).default_value("both"),
            text("seed", "S", "Which people are drawn, and how they stand")
                .value_parser(value_parser!(u64))
                .default_value("1"),
            json(),
            quiet(),
        ])
        .after_help(
            "Example: ten women before the better camera\n  toile bench measure --ansur ANSUR_II_FEMALE.csv --people 10 \
             --sensor azure",
        )
}

pub(super) fn args(matches: &ArgMatches) -> Result<MeasuringArgs, AppError> {
    let count = |name| usize::try_from(required::<u64>(matches, name)?).map_err(AppError::internal);
    let all = [Sensor::Kinect, Sensor::Azure];
    let sensor: String = required(matches, "sensor")?;
    Ok(MeasuringArgs {
        files: matches.get_many("ansur").into_iter().flatten().cloned().collect(),
        people: count("people")?,
        frames: count("frames")?,
        seed: required(matches, "seed")?,
        sensors: all.into_iter().filter(|s| sensor == "both" || sensor == s.name()).collect(),
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_option_arrives_and_both_cameras_are_the_default() {
        let parsed = |line: &str| args(&grammar().try_get_matches_from(line.split_whitespace()).unwrap()).unwrap();
        let all = parsed("measure --ansur a.csv --ansur b.csv --people 7 --frames 3 --sensor azure --seed 9 --json");
        assert_eq!((all.files.len(), all.people, all.frames, all.seed), (2, 7, 3, 9));
        assert_eq!((all.sensors, all.json), (vec![Sensor::Azure], true));
        assert_eq!(parsed("measure --ansur a.csv").sensors.len(), 2);
    }
}
