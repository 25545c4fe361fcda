//! Finds a face in a square of a picture: MediaPipe's short-range detector.
//!
//! The network gives 896 boxes, each with six points, of which the first two are the eyes.

use toile_sensors::source::live::ColourImage;

use crate::boxes::{BoxLayout, BoxReader};
use crate::network::Network;
use crate::region::{Border, Region};
use crate::tflite::NetworkFault;

/// Side of the network's image (px).
const SIDE: usize = 128;

/// Numbers of a box: its middle, its size, six points.
const NUMBERS: usize = 16;

/// Its boxes; the three grids of 8 x 8 places are one with as many boxes a place. The least score is MediaPipe's for this network.
const LAYOUT: BoxLayout = BoxLayout { side: SIDE, grids: &[(8, 2), (16, 6)], least_score: 0.5 };

/// Share of the box's longer side that the square of a face has: the box ends at brows and chin (MediaPipe's
/// `face_detection_front_detection_to_roi`).
const AROUND: f32 = 1.5;

/// Finds a face in a square.
#[derive(Debug)]
pub struct FaceDetector {
    network: Network,
    boxes: BoxReader<NUMBERS>,
}

impl FaceDetector {
    /// Of the detector's bytes. Called at load: it allocates.
    ///
    /// # Errors
    /// A file of another network.
    pub fn load(bytes: &[u8]) -> Result<Self, NetworkFault> {
        let boxes = BoxReader::new(LAYOUT);
        let network = Network::load(bytes, &[&[1, boxes.count(), NUMBERS], &[1, boxes.count(), 1]])?;
        network.takes_square(SIDE)?;
        Ok(Self { network, boxes })
    }

    /// The square around the largest face in an upright square of a picture, however small.
    pub fn find(&mut self, picture: &ColourImage, square: &Region) -> Option<Region> {
        square.sample(picture, Border::Black, [2.0, -1.0], self.network.input(), SIDE);
        self.network.run();
        self.boxes.take(&self.network);
        let mut largest: Option<Region> = None;
        while let Some(found) = self.boxes.next() {
            let [middle, right, left] = [0, 2, 3].map(|pair| square.pixel(found.pair(pair)));
            let region = Region::of_eyes(middle, found.pair(1) * square.side, [right, left], AROUND);
            if region.side.is_finite() && largest.is_none_or(|l| l.side < region.side) {
                largest = Some(region);
            }
        }
        largest
    }

    /// Overwrites what it has of the last picture.
    pub fn wipe(&mut self) {
        self.network.wipe();
    }
}
