//! Masks of several cameras, frame by frame: a folder of numbered pictures for each camera.

use std::path::Path;

use image::DynamicImage;

use super::{Mask, by_itself, check, covered, less_background, pictures, read};
use crate::calibration::CalibratedCamera;
use crate::error::SourceError;
use crate::pictures::PictureSequence;

/// The masks of a moving person.
#[derive(Debug, Clone)]
pub struct MaskSequence {
    pictures: PictureSequence,
    cameras: Vec<CalibratedCamera>,
    /// The pictures without the person, one a camera, or none.
    behind: Vec<DynamicImage>,
}

impl MaskSequence {
    /// Whether a folder holds folders of frames, and not one picture a camera.
    pub fn is_in(folder: &Path) -> bool {
        let inner = std::fs::read_dir(folder).into_iter().flatten().flatten();
        inner.filter(|entry| entry.path().is_dir()).count() > 1
    }

    /// Lists the frames of a folder for these cameras; `backgrounds` holds one picture a camera without the person.
    ///
    /// # Errors
    /// One sentence where there is no folder for each camera, a frame is missing, or a background is no picture of its camera.
    pub fn open(folder: &Path, backgrounds: Option<&Path>, cameras: &[CalibratedCamera]) -> Result<Self, SourceError> {
        let behind = match backgrounds {
            Some(folder) => {
                let files = pictures(folder, cameras.len())?;
                files.iter().zip(cameras).map(|(path, camera)| read(path, camera)).collect::<Result<_, _>>()?
            }
            None => Vec::new(),
        };
        let pictures = PictureSequence::open(folder, cameras.len())?;
        Ok(Self { pictures, cameras: cameras.to_vec(), behind })
    }

    /// Frames of each camera.
    pub fn frames(&self) -> usize {
        self.pictures.frames()
    }

    /// Number of the first frame in the files' names.
    pub const fn first(&self) -> u64 {
        self.pictures.first()
    }

    /// The masks of the first frame, in which every camera has to see the person.
    ///
    /// # Errors
    /// One sentence if a picture cannot be read, or shows no person or nothing else.
    pub fn begin(&self) -> Result<Vec<Mask>, SourceError> {
        let all = (0..self.cameras.len()).map(|camera| {
            let mask = self.mask(camera, 0)?;
            check(&mask).map_err(|fault| fault.at(&self.pictures.file(camera, 0).display().to_string()))?;
            Ok(mask)
        });
        all.collect()
    }

    /// The masks of a frame; none of a camera that sees no person, or nothing else.
    ///
    /// # Errors
    /// One sentence where a picture cannot be read.
    pub fn read(&self, frame: usize) -> Result<Vec<Option<Mask>>, SourceError> {
        let all = (0..self.cameras.len()).map(|camera| {
            let mask = self.mask(camera, frame)?;
            Ok(covered(&mask).is_person().then_some(mask))
        });
        all.collect()
    }

    fn mask(&self, camera: usize, frame: usize) -> Result<Mask, SourceError> {
        let seen = read(self.pictures.file(camera, frame), &self.cameras[camera])?;
        Ok(self.behind.get(camera).map_or_else(|| by_itself(&seen), |behind| less_background(&seen, behind)))
    }
}
