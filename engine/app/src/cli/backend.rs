//! The option `--backend` that several commands share.

use clap::{Arg, ArgMatches};
use toile_gpu::stepper::Backend;

use super::{required, text};
use crate::exit::AppError;

/// The option.
pub(super) fn backend() -> Arg {
    text(
        "backend",
        "B",
        "What steps the cloth: cpu; gpu, a graphics device, in a build with `--features gpu`; auto, whichever measures faster \
         at the start. Where there is no device the processor steps, and says so",
    )
    .value_parser(Backend::ALL.map(Backend::name))
    .default_value(Backend::Cpu.name())
}

/// What a matched line asks for.
pub(super) fn asked_backend(matches: &ArgMatches) -> Result<Backend, AppError> {
    required::<String>(matches, "backend")?.parse().map_err(AppError::internal)
}
