//! `toile record`.

use crate::cli::RecordArgs;
use crate::exit::AppError;

/// Runs `toile record`.
///
/// # Errors
/// Bad input, an output folder that cannot be written, or a closed stdout.
pub fn run(_args: &RecordArgs) -> Result<(), AppError> {
    Err(AppError::Internal("`toile record` is not part of this build".to_owned()))
}
