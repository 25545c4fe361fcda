//! Where somebody is in a whole picture.
//!
//! The network gives 2,254 boxes, each relative to a place of a grid (an anchor), with the middle of the hips and a point of the
//! circle around the whole body. Boxes that lie on each other are one person: they are averaged, weighted by their scores.

use glam::Vec2;
use toile_sensors::source::live::ColourImage;

use crate::network::{Network, logistic};
use crate::region::{Border, Region};
use crate::tflite::NetworkFault;

/// Side of the network's image (px).
const SIDE: usize = 224;

/// Numbers of a box: its middle, its size, four points.
const NUMBERS: usize = 12;

/// Boxes of the network.
const BOXES: usize = 2_254;

/// Grids of boxes: pixels between two places, boxes a place.
const GRIDS: [(usize, usize); 3] = [(8, 2), (16, 2), (32, 6)];

/// Least score of a person.
const LEAST_SCORE: f32 = 0.5;

/// Largest score before the logistic function.
const LARGEST_RAW: f32 = 100.0;

/// Share of their common area from which on two boxes are one person.
const SAME: f32 = 0.3;

/// Most boxes that are looked at, the best first: of ten people with as many boxes each as they get.
const MOST_BOXES: usize = 128;

/// Most people who are detected in a picture.
const MOST_PEOPLE: usize = 8;

/// Somebody in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// How sure it is, 0.5 to 1.
    pub score: f32,
    /// The square in which the body is sought.
    pub region: Region,
}

/// One box, in shares of the network's image.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct RawBox {
    score: f32,
    /// Middle and size, the middle of the hips, the point of the circle.
    numbers: [f32; 8],
}

impl RawBox {
    fn overlap(&self, other: &Self) -> f32 {
        let side = |of: &Self, axis: usize| {
            let half = 0.5 * of.numbers[axis + 2].max(0.0);
            (of.numbers[axis] - half, of.numbers[axis] + half)
        };
        let common = |axis: usize| {
            let ((a, b), (c, d)) = (side(self, axis), side(other, axis));
            (b.min(d) - a.max(c)).max(0.0)
        };
        let area = |of: &Self| of.numbers[2].max(0.0) * of.numbers[3].max(0.0);
        let both = common(0) * common(1);
        both / (area(self) + area(other) - both).max(1e-9)
    }
}

/// Finds people in whole pictures.
#[derive(Debug)]
pub struct Detector {
    network: Network,
    anchors: Box<[Vec2]>,
    boxes: Vec<RawBox>,
    people: Vec<Detection>,
}

impl Detector {
    /// Of the detector's file. Called at load: it allocates.
    ///
    /// # Errors
    /// A file of another network.
    pub fn load(bytes: &[u8]) -> Result<Self, NetworkFault> {
        let network = Network::load(bytes, &[&[1, BOXES, NUMBERS], &[1, BOXES, 1]])?;
        let shape = network.input_shape();
        if [shape.height, shape.width, shape.channels] != [SIDE, SIDE, 3] {
            return Err(NetworkFault::new(format!("it takes an image of {} x {} pixels", shape.width, shape.height)));
        }
        let boxes = Vec::with_capacity(BOXES);
        Ok(Self { network, anchors: anchors(), boxes, people: Vec::with_capacity(MOST_PEOPLE) })
    }

    /// Everybody in an upright square of a picture, the largest first.
    pub fn find(&mut self, picture: &ColourImage, square: &Region) -> &[Detection] {
        square.sample(picture, Border::Black, [2.0, -1.0], self.network.input(), SIDE);
        self.network.run();
        self.boxes.clear();
        let (numbers, scores) = (self.network.output(0), self.network.output(1));
        for ((raw, score), anchor) in numbers.as_chunks::<NUMBERS>().0.iter().zip(scores).zip(&self.anchors) {
            let score = logistic(score.clamp(-LARGEST_RAW, LARGEST_RAW));
            if score >= LEAST_SCORE && raw.iter().all(|x| x.is_finite()) {
                self.boxes.push(raw_box(raw, *anchor, score));
            }
        }
        self.merge(square, picture);
        &self.people
    }

    /// One person of all boxes that lie on the best one, then of the rest.
    fn merge(&mut self, square: &Region, picture: &ColourImage) {
        self.people.clear();
        self.boxes.sort_unstable_by(|a, b| b.score.total_cmp(&a.score));
        self.boxes.truncate(MOST_BOXES);
        while let Some(best) = self.boxes.first().copied() {
            if self.people.len() == MOST_PEOPLE {
                break;
            }
            let (mut sum, mut weight) = ([0.0; 8], 0.0);
            self.boxes.retain(|one| {
                // The best lies on itself, whatever its area.
                let same = *one == best || one.overlap(&best) > SAME;
                if same {
                    weight += one.score;
                    sum.iter_mut().zip(one.numbers).for_each(|(sum, x)| *sum += x * one.score);
                }
                !same
            });
            let [.., hips_x, hips_y, above_x, above_y] = sum.map(|x| x / weight);
            let [hips, above] = [Vec2::new(hips_x, hips_y), Vec2::new(above_x, above_y)].map(|p| square.pixel(p));
            let region = Region::of_points(hips, above);
            if region.is_within(picture.width, picture.height) {
                self.people.push(Detection { score: best.score, region });
            }
        }
        self.people.sort_unstable_by(|a, b| b.region.side.total_cmp(&a.region.side));
    }
}

/// A box with its first two points, in shares of the image.
fn raw_box(raw: &[f32; NUMBERS], anchor: Vec2, score: f32) -> RawBox {
    let mut numbers = [0.0; 8];
    for (i, (to, x)) in numbers.iter_mut().zip(raw).enumerate() {
        let from = if (2..4).contains(&i) { 0.0 } else { anchor[i % 2] };
        *to = x / SIDE as f32 + from;
    }
    RawBox { score, numbers }
}

/// The grids' places, in shares of the image: the middle of each of their squares.
fn anchors() -> Box<[Vec2]> {
    let mut all = Vec::with_capacity(BOXES);
    for (stride, boxes) in GRIDS {
        let side = SIDE / stride;
        for place in 0..side * side {
            let middle = Vec2::new((place % side) as f32 + 0.5, (place / side) as f32 + 0.5) / side as f32;
            all.extend(std::iter::repeat_n(middle, boxes));
        }
    }
    all.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_an_anchor_for_each_box() {
        let all = anchors();
        assert_eq!(all.len(), BOXES);
        assert_eq!((all[0], all[1]), (Vec2::splat(0.5 / 28.0), Vec2::splat(0.5 / 28.0)));
        assert_eq!(all[BOXES - 1], Vec2::splat(6.5 / 7.0));
    }

    #[test]
    fn boxes_overlap_by_their_common_area() {
        let at = |x: f32| RawBox { score: 1.0, numbers: [x, 0.5, 0.2, 0.2, 0.0, 0.0, 0.0, 0.0] };
        assert!((at(0.3).overlap(&at(0.3)) - 1.0).abs() < 1e-5);
        assert!((at(0.3).overlap(&at(0.4)) - 1.0 / 3.0).abs() < 1e-5);
        assert_eq!(at(0.3).overlap(&at(0.8)), 0.0);
        let none = RawBox::default();
        assert_eq!(none.overlap(&none), 0.0);
    }
}
