//! `toile try-on`: one whole try-on, from a session to pictures and a report.

use crate::cli::TryOnArgs;
use crate::exit::AppError;
use crate::output::OutputFolder;

/// Runs `toile try-on`.
///
/// # Errors
/// Bad input, an output folder that cannot be written, or a closed stdout.
pub fn run(args: &TryOnArgs) -> Result<(), AppError> {
    let _out = OutputFolder::prepare(&args.out)?;
    Err(AppError::Internal("`toile try-on` is not part of this build".to_owned()))
}
