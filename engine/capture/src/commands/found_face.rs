//! The points of an unmarked face: MediaPipe's face mesh finds them.

use std::path::Path;

use toile_cli::exit::AppError;
use toile_pose::face_finder::{FaceFault, FaceFinder};
use toile_pose::files;
use toile_sensors::face_points::{MarkedPhotograph, MarkedPhotographs};
use toile_sensors::pictures::read_picture;
use toile_sensors::source::live::ColourImage;

/// Whether a file is a photograph by its name, and no file of points.
pub(super) fn is_picture(path: &Path) -> bool {
    let ends = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    ["jpg", "jpeg", "png"].into_iter().any(ends)
}

/// A photograph with the points that are found, and their standard deviation (px).
///
/// # Errors
/// One sentence where it cannot be read, the network is missing, or no face is found.
pub(super) fn find(path: &Path) -> Result<(MarkedPhotographs, f64), AppError> {
    let photograph = read_picture(path).map_err(AppError::input)?;
    let mut finder = FaceFinder::load(&files::folder()).map_err(|why| AppError::Device(why.to_string()))?;
    let (width, height) = photograph.dimensions();
    let picture = ColourImage { width, height, rgb: photograph.into_raw() };
    let found = finder.find(&picture, None).map_err(|fault| {
        let cure = match fault {
            FaceFault::Unseen => "give one of a face from before, or mark its points in a JSON file",
            FaceFault::TooFar => "cut the face out, or give one that was taken from nearer",
            FaceFault::Turned => "give one of a face from before",
        };
        AppError::input(format!("{}: {fault}; {cure}", path.display()))
    })?;
    let (points, sigma_px) = (found.marked(), found.sigma_px());
    let photograph =
        MarkedPhotograph { picture: path.to_path_buf(), camera: None, focal_px: None, points, outlines: Vec::new() };
    Ok((MarkedPhotographs { photographs: vec![photograph], sequence: false }, sigma_px))
}
