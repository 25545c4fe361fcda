//! Pictures as files of an output folder.

use toile_view::image::Image;

use crate::exit::AppError;
use crate::output::OutputFolder;

/// Writes an image as a PNG file of the output folder.
///
/// # Errors
/// [`AppError::Input`] where the folder does not take it.
pub fn write_png(out: &mut OutputFolder, name: &str, image: &Image) -> Result<(), AppError> {
    let mut bytes = Vec::new();
    image.write_png(&mut bytes).map_err(AppError::internal)?;
    Ok(out.write(name, &bytes)?)
}
