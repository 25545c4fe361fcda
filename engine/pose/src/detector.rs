//! Finds a person in a whole picture.
//!
//! The network gives 2,254 boxes, each with the middle of the hips and a point of the circle around the whole body.

use toile_sensors::source::live::ColourImage;

use crate::boxes::{BoxLayout, BoxReader};
use crate::network::Network;
use crate::region::{Border, Region};
use crate::tflite::NetworkFault;

/// Side of the network's image (px).
const SIDE: usize = 224;

/// Numbers of a box: its middle, its size, four points.
const NUMBERS: usize = 12;

/// Its boxes, and the least score of a person.
const LAYOUT: BoxLayout = BoxLayout { side: SIDE, grids: &[(8, 2), (16, 2), (32, 6)], least_score: 0.5 };

/// Most people who are detected in a picture.
const MOST_PEOPLE: usize = 8;

/// A person in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// How sure it is, 0.5 to 1.
    pub score: f32,
    /// The square in which the body is sought.
    pub region: Region,
}

/// Finds people in whole pictures.
#[derive(Debug)]
pub struct Detector {
    network: Network,
    boxes: BoxReader<NUMBERS>,
    people: Vec<Detection>,
}

impl Detector {
    /// Of the detector's file. Called at load: it allocates.
    ///
    /// # Errors
    /// A file of another network.
    pub fn load(bytes: &[u8]) -> Result<Self, NetworkFault> {
        let boxes = BoxReader::new(LAYOUT);
        let network = Network::load(bytes, &[&[1, boxes.count(), NUMBERS], &[1, boxes.count(), 1]])?;
        network.takes_square(SIDE)?;
        Ok(Self { network, boxes, people: Vec::with_capacity(MOST_PEOPLE) })
    }

    /// Every person in an upright square of a picture, the largest first.
    pub fn find(&mut self, picture: &ColourImage, square: &Region) -> &[Detection] {
        square.sample(picture, Border::Black, [2.0, -1.0], self.network.input(), SIDE);
        self.network.run();
        self.boxes.take(&self.network);
        self.people.clear();
        while self.people.len() < MOST_PEOPLE
            && let Some(found) = self.boxes.next()
        {
            let [hips, above] = [2, 3].map(|point| square.pixel(found.pair(point)));
            let region = Region::of_points(hips, above);
            if region.is_within(picture.width, picture.height) {
                self.people.push(Detection { score: found.score, region });
            }
        }
        self.people.sort_unstable_by(|a, b| b.region.side.total_cmp(&a.region.side));
        &self.people
    }
}
