//! Boxes that a detector gives, each relative to a place of a grid (an anchor). Those that lie on each other are of one: they are averaged,
//! weighted by their scores.

use glam::Vec2;

use crate::network::{Network, logistic};

/// Largest score before the logistic function.
const LARGEST_RAW: f32 = 100.0;

/// Share of their common area from which on two boxes are of one.
const SAME: f32 = 0.3;

/// Most boxes that are looked at, the best first: of ten people with as many boxes each as they get.
const MOST_BOXES: usize = 128;

/// One box, in shares of the network's image.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FoundBox {
    /// How sure it is, 0 to 1.
    pub score: f32,
    /// Middle and size, and its first two points: x, y of each.
    pub numbers: [f32; 8],
}

impl FoundBox {
    /// One of its four pairs: middle, size, first point, second point.
    pub fn pair(&self, at: usize) -> Vec2 {
        Vec2::new(self.numbers[2 * at], self.numbers[2 * at + 1])
    }

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

/// What a detector gives: its image, its grids, how sure a box has to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxLayout {
    /// Side of the network's image (px).
    pub side: usize,
    /// Grids: pixels between two places, boxes a place.
    pub grids: &'static [(usize, usize)],
    /// Least score that counts, 0 to 1.
    pub least_score: f32,
}

impl BoxLayout {
    /// The grids' places, in shares of the image: the middle of each of their squares.
    fn anchors(&self) -> Box<[Vec2]> {
        let mut all = Vec::new();
        for (stride, boxes) in self.grids {
            let side = self.side / stride;
            for place in 0..side * side {
                let middle = Vec2::new((place % side) as f32 + 0.5, (place / side) as f32 + 0.5) / side as f32;
                all.extend(std::iter::repeat_n(middle, *boxes));
            }
        }
        all.into()
    }
}

/// Reads the boxes of a network whose boxes have `N` numbers: middle, size, points.
#[derive(Debug)]
pub struct BoxReader<const N: usize> {
    layout: BoxLayout,
    anchors: Box<[Vec2]>,
    boxes: Vec<FoundBox>,
}

impl<const N: usize> BoxReader<N> {
    /// Called at load: it allocates.
    pub fn new(layout: BoxLayout) -> Self {
        let anchors = layout.anchors();
        Self { layout, boxes: Vec::with_capacity(anchors.len()), anchors }
    }

    /// How many boxes the network gives.
    pub fn count(&self) -> usize {
        self.anchors.len()
    }

    /// Takes what the network gave last: numbers as its first output, scores as its second.
    pub fn take(&mut self, network: &Network) {
        self.boxes.clear();
        let (numbers, scores) = (network.output(0), network.output(1));
        for ((raw, score), anchor) in numbers.as_chunks::<N>().0.iter().zip(scores).zip(&self.anchors) {
            let score = logistic(score.clamp(-LARGEST_RAW, LARGEST_RAW));
            if score >= self.layout.least_score && raw.iter().all(|x| x.is_finite()) {
                self.boxes.push(found_box(raw, *anchor, score, self.layout.side));
            }
        }
        self.boxes.sort_unstable_by(|a, b| b.score.total_cmp(&a.score));
        self.boxes.truncate(MOST_BOXES);
    }

    /// One of all boxes that lie on the best one, with its score, which are then gone; none where there are none left.
    pub fn next(&mut self) -> Option<FoundBox> {
        let best = self.boxes.first().copied()?;
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
        Some(FoundBox { score: best.score, numbers: sum.map(|x| x / weight) })
    }
}

/// A box with its first two points, in shares of the image.
fn found_box(raw: &[f32], anchor: Vec2, score: f32, side: usize) -> FoundBox {
    let mut numbers = [0.0; 8];
    for (i, (to, x)) in numbers.iter_mut().zip(raw).enumerate() {
        let from = if (2..4).contains(&i) { 0.0 } else { anchor[i % 2] };
        *to = x / side as f32 + from;
    }
    FoundBox { score, numbers }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_an_anchor_for_each_box() {
        let layout = BoxLayout { side: 224, grids: &[(8, 2), (16, 2), (32, 6)], least_score: 0.5 };
        let all = layout.anchors();
        assert_eq!(all.len(), 2_254);
        assert_eq!((all[0], all[1]), (Vec2::splat(0.5 / 28.0), Vec2::splat(0.5 / 28.0)));
        assert_eq!(all[2_253], Vec2::splat(6.5 / 7.0));
    }

    #[test]
    fn boxes_overlap_by_their_common_area() {
        let at = |x: f32| FoundBox { score: 1.0, numbers: [x, 0.5, 0.2, 0.2, 0.0, 0.0, 0.0, 0.0] };
        assert!((at(0.3).overlap(&at(0.3)) - 1.0).abs() < 1e-5);
        assert!((at(0.3).overlap(&at(0.4)) - 1.0 / 3.0).abs() < 1e-5);
        assert_eq!(at(0.3).overlap(&at(0.8)), 0.0);
        let none = FoundBox::default();
        assert_eq!(none.overlap(&none), 0.0);
    }
}
