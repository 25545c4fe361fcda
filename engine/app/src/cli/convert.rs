//! The grammar of `toile convert`.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, value_parser};

use super::{json, path, quiet, required, text};
use crate::exit::AppError;

/// Arguments of `toile convert`.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvertArgs {
    /// The recording: a file or a folder.
    pub input: PathBuf,
    /// Camera of depth images.
    pub camera: Option<PathBuf>,
    /// The session file to write.
    pub out: PathBuf,
    /// Which depth is kept.
    pub depth: KeptDepth,
    /// Whether a recording without joints gets those of the body fitted to its depth.
    pub fit: bool,
    /// One JSON object on stdout in place of the summary.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// Which depth a converted session keeps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum KeptDepth {
    /// None: nothing that shows a person is written.
    #[default]
    None,
    /// The shopper's pixels alone; frames without one are empty.
    Shopper,
    /// Whole images.
    All,
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("convert")
        .about("Turn any supported recording into a Toile session")
        .long_about(
            "Reads a recording of joints or depth, sets it into Toile's world (metres, y up, floor at y = 0), and writes \
             it as a session (MCAP). Joints alone are kept unless --depth asks for more: depth images show a person.",
        )
        .args([
            Arg::new("input")
                .value_name("IN")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("Recording, or folder of depth images"),
            path("out", "F.mcap", "Session file to write").required(true),
            path("camera", "J", "Camera of depth images, as JSON [default: the recording's own]"),
            text("depth", "D", "Depth to keep: none, the shopper's alone, or all")
                .value_parser(["none", "shopper", "all"])
                .default_value("none"),
            Arg::new("fit")
                .long("fit")
                .action(ArgAction::SetTrue)
                .help("Where there are no joints, fit the body to the depth and keep its joints"),
            json(),
            quiet(),
        ])
        .after_help(
            "Example: keep the joints of a recording, and no picture of anybody\n  toile convert shopper.csv --out \
             shopper.mcap\nExample: the same of depth images alone\n  toile convert frames --fit --out shopper.mcap",
        )
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<ConvertArgs, AppError> {
    let depth = match required::<String>(matches, "depth")?.as_str() {
        "all" => KeptDepth::All,
        "shopper" => KeptDepth::Shopper,
        _ => KeptDepth::None,
    };
    Ok(ConvertArgs {
        input: required(matches, "input")?,
        camera: matches.get_one("camera").cloned(),
        out: required(matches, "out")?,
        depth,
        fit: matches.get_flag("fit"),
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}
