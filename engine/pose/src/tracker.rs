//! A person followed from picture to picture: found once in the whole of it, then in the region of the last picture.

use toile_base::limits::MAX_SIDE;
use toile_sensors::limits::MAX_COLOUR_PIXELS;
use toile_sensors::person_mask::PersonMask;
use toile_sensors::source::live::ColourImage;

use std::path::Path;

use crate::detector::Detector;
use crate::files::{PoseError, PoseFile};
use crate::landmarks::{Landmarker, Landmarks};
use crate::plausible;
use crate::region::Region;
use crate::sides::SideKeeper;
use crate::smoothing::LandmarkFilter;

/// Least presence of a person in a region.
const LEAST_PRESENCE: f32 = 0.5;

/// Pictures in which a person was implausible, one after the other, after which they are sought anew.
const IMPLAUSIBLE: u32 = 5;

toile_base::named! {
    /// Which of the two networks finds the landmarks.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum PoseModel {
        /// The small one.
        Lite = "lite",
        /// The larger one.
        Full = "full",
    }
}

/// A picture that cannot be looked at.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a picture {what}; choose another mode of the camera, or another file")]
pub struct PictureFault {
    what: String,
}

/// What was counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TrackerCounts {
    /// Pictures in which a person was sought.
    pub searched: u64,
    /// Regions in which landmarks were found.
    pub followed: u64,
    /// Bodies that no person has.
    pub implausible: u64,
    /// Pictures in which the network exchanged left and right.
    pub exchanged: u64,
    /// People in the last picture that was searched.
    pub people: u64,
}

/// Follows one person.
#[derive(Debug)]
pub struct PoseTracker {
    detector: Detector,
    landmarker: Landmarker,
    region: Option<Region>,
    /// Size of the last picture (px).
    size: [u32; 2],
    sides: SideKeeper,
    filter: LandmarkFilter,
    implausible: u32,
    /// Searches since a person was last seen.
    tries: u32,
    /// What was counted.
    pub counts: TrackerCounts,
}

impl PoseTracker {
    /// With the network's files of a folder; with the person's mask, which takes a little longer, or without. Called at load: it allocates.
    ///
    /// # Errors
    /// Files that are missing or others than those that are known.
    pub fn load(folder: &Path, model: PoseModel, with_mask: bool) -> Result<Self, PoseError> {
        let file = if model == PoseModel::Lite { PoseFile::Lite } else { PoseFile::Full };
        let unfit = |file: PoseFile| move |fault: crate::tflite::NetworkFault| file.another(folder, fault.to_string());
        Ok(Self {
            detector: Detector::load(&PoseFile::Detector.read(folder)?).map_err(unfit(PoseFile::Detector))?,
            landmarker: Landmarker::load(&file.read(folder)?, with_mask).map_err(unfit(file))?,
            region: None,
            size: [0; 2],
            sides: SideKeeper::default(),
            filter: LandmarkFilter::default(),
            implausible: 0,
            tries: 0,
            counts: TrackerCounts::default(),
        })
    }

    /// Forgets the person who was seen.
    pub fn reset(&mut self) {
        self.region = None;
        (self.implausible, self.tries) = (0, 0);
        self.sides.reset();
        self.filter.reset();
        self.landmarker.wipe_mask();
    }

    /// Which parts of the last picture show the person; none where that was not wanted.
    pub fn mask(&self) -> Option<&PersonMask> {
        self.landmarker.mask()
    }

    /// Where the person of the next picture is expected.
    pub fn region(&self) -> Option<Region> {
        self.region
    }

    /// Looks at a picture that was taken at a time (ns): smoothed landmarks; none where no person is seen, or the landmarks could be no person's. Of several
    /// people the largest is followed, until they are gone.
    ///
    /// # Errors
    /// A picture of no size, of too many pixels, or of other bytes than its size says.
    pub fn push(&mut self, picture: &ColourImage, time_ns: u64) -> Result<Option<Landmarks>, PictureFault> {
        check(picture).inspect_err(|_| self.reset())?;
        let size = [picture.width, picture.height];
        if self.size != size {
            // Pixels of the last picture say nothing about those of this one.
            self.reset();
            self.size = size;
        }
        let Some(region) = self.region.or_else(|| self.search(picture)) else { return Ok(None) };
        let mut landmarks = self.landmarker.find(picture, &region);
        self.counts.followed += 1;
        if !landmarks.is_finite() || landmarks.presence < LEAST_PRESENCE {
            self.reset();
            return Ok(None);
        }
        let [hips, above] = landmarks.next;
        if !Region::of_points(hips, above).is_within(picture.width, picture.height) {
            self.reset();
            return Ok(None);
        }
        if !plausible::is_body(&landmarks) {
            self.counts.implausible += 1;
            self.implausible += 1;
            if self.implausible >= IMPLAUSIBLE {
                self.reset();
            }
            return Ok(None);
        }
        self.implausible = 0;
        self.counts.exchanged += u64::from(self.sides.keep(&mut landmarks, time_ns));
        self.filter.push(&mut landmarks, region.side, time_ns);
        let next = Region::of_points(landmarks.next[0], landmarks.next[1]);
        self.region = Some(if region.is_like(&next) { region } else { next });
        Ok(Some(landmarks))
    }

    /// The largest person of a picture. In the whole of a wide one people are small, and the detector misses them: every second search is
    /// of the middle square, where a shopper stands.
    fn search(&mut self, picture: &ColourImage) -> Option<Region> {
        let whole = Region::around(picture);
        let middle = Region { side: picture.width.min(picture.height) as f32, ..whole };
        let square = if self.tries.is_multiple_of(2) { whole } else { middle };
        self.tries = self.tries.wrapping_add(1);
        let people = self.detector.find(picture, &square);
        self.counts.searched += 1;
        self.counts.people = people.len() as u64;
        people.first().map(|found| found.region)
    }
}

/// Whether a picture can be looked at.
///
/// # Errors
/// A picture of no size, of too many pixels, or of other bytes than its size says.
pub fn check(picture: &ColourImage) -> Result<(), PictureFault> {
    let ColourImage { width, height, .. } = *picture;
    let pixels = u64::from(width) * u64::from(height);
    let fault = |what: String| Err(PictureFault { what });
    if width == 0 || height == 0 {
        return fault("has no pixels".to_owned());
    }
    if width > MAX_SIDE || height > MAX_SIDE || pixels > MAX_COLOUR_PIXELS {
        return fault(format!(
            "of {width} x {height} pixels is larger than {MAX_SIDE} a side and {MAX_COLOUR_PIXELS} in all"
        ));
    }
    if picture.rgb.len() as u64 != 3 * pixels {
        return fault(format!("of {width} x {height} pixels has {} bytes", picture.rgb.len()));
    }
    Ok(())
}
