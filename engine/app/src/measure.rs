//! `toile measure`.

use crate::cli::MeasureArgs;
use crate::exit::AppError;

/// Runs `toile measure`.
///
/// # Errors
/// Bad input, an output folder that cannot be written, or a closed stdout.
pub fn run(_args: &MeasureArgs) -> Result<(), AppError> {
    Err(AppError::Internal("`toile measure` is not part of this build".to_owned()))
}
