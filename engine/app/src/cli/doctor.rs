//! The grammar of `toile doctor`.

use std::path::PathBuf;

use clap::ArgMatches;

use super::{json, path, required};
use crate::exit::AppError;

/// Arguments of `toile doctor`.
#[derive(Debug, Clone, PartialEq)]
pub struct DoctorArgs {
    /// The folder whose writing is tried.
    pub out: PathBuf,
    /// One JSON object on stdout in place of the table.
    pub json: bool,
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("doctor")
        .about("Say what this machine has, and the exact cure for what is missing")
        .args([path("out", "DIR", "Output folder whose writing is tried").default_value("out"), json()])
        .after_help("Example: see why a kiosk misses its deadline\n  toile doctor")
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<DoctorArgs, AppError> {
    Ok(DoctorArgs { out: required(matches, "out")?, json: matches.get_flag("json") })
}
