//! `toile bench`.

use crate::cli::SkinningArgs;
use crate::exit::AppError;

/// Runs `toile bench skinning`.
///
/// # Errors
/// Only where stdout cannot be written.
pub fn skinning(_args: &SkinningArgs) -> Result<(), AppError> {
    Err(AppError::Internal("`toile bench skinning` is not part of this build".to_owned()))
}
