//! The grammar of `toile bench depth`.

use clap::ArgMatches;

use super::{flag, json};

/// Arguments of `toile bench depth`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DepthArgs {
    /// One JSON object on stdout in place of the table.
    pub json: bool,
}

pub(super) fn grammar() -> clap::Command {
    clap::Command::new("depth")
        .about("Time every stage from a depth frame to the shopper's clean points, with the errors of the same run")
        .long_about(
            "Renders people in a room as depth cameras of three sizes see them, with a Kinect's noise, and tells the time of \
             each stage (shopper found, holes filled, noise smoothed, points and normals), and the noise before and \
             after, the blur of an edge, pixels of others that leak in, and pixels of the shopper that are missed.",
        )
        .args([flag("table", "As a table, which is how it is told anyway"), json()])
        .after_help("Example: the table of docs/depth.md\n  toile bench depth --table")
}

pub(super) fn parse(matches: &ArgMatches) -> DepthArgs {
    DepthArgs { json: matches.get_flag("json") }
}
