//! The grammar of `toile body --colliders`.

use std::path::PathBuf;

use clap::ArgMatches;

use super::body::BodyArgs;
use super::required;
use crate::exit::AppError;

/// Arguments of `toile body --colliders`.
#[derive(Debug, Clone, PartialEq)]
pub struct CollidersArgs {
    /// A body that others made; `None` takes our own of all sizes.
    pub body: Option<BodyArgs>,
    /// Bodies of random measures besides the sizes.
    pub strangers: usize,
    /// Which.
    pub seed: u64,
    /// Where the picture goes; `None` makes none.
    pub out: Option<PathBuf>,
    /// One JSON object on stdout in place of the table.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// What a matched line of `toile body` with `--colliders` asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<CollidersArgs, AppError> {
    let file = matches.contains_id("file").then(|| super::body::args(matches)).transpose()?;
    let out = if matches.get_flag("no-pictures") { None } else { Some(required(matches, "out")?) };
    Ok(CollidersArgs {
        body: file,
        strangers: required::<u64>(matches, "strangers")? as usize,
        seed: required(matches, "seed")?,
        out,
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}
