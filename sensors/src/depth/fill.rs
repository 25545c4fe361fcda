//! Holes in the shopper filled: what the sensor did not measure, with measured surface to the left, right, above, below.
//!
//! A pixel is filled where all four ends are near, and those of a row or column lie on one surface: the mean of both
//! interpolations, each weighted by the inverse of its length. What is seen through a gap (between arm and body) was
//! measured and is never filled; a shadow at the outline is open to one side and is not filled either.

use crate::segment::same_surface;
use toile_base::frame::DepthFrame;

/// Widest hole that is filled (mm): a crease, a button, a lock of hair.
const WIDEST_MM: f32 = 60.0;

/// State of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u8)]
pub enum Validity {
    /// Not the shopper, or nothing is known.
    #[default]
    Nothing,
    /// The sensor measured it.
    Measured,
    /// A hole that was filled from around.
    Filled,
}

/// One interpolation of a hole's pixel: depth (mm) times weight, and weight; 0 where there is none.
type Guess = [f32; 2];

/// Fills holes; keeps its arrays from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct Fill {
    depth_mm: Vec<u16>,
    validity: Vec<Validity>,
    along: Vec<Guess>,
    /// For each column, the row of the last pixel that was measured, and [`NEVER`].
    last: Vec<u32>,
}

const NEVER: u32 = u32::MAX;

impl Fill {
    /// The shopper's depth (mm), holes filled, 0 elsewhere `[width * height]`.
    pub fn depth_mm(&self) -> &[u16] {
        &self.depth_mm
    }

    /// State of each pixel `[width * height]`.
    pub fn validity(&self) -> &[Validity] {
        &self.validity
    }

    /// Takes the pixels of the mask and fills their holes.
    ///
    /// # Panics
    /// If the mask has another length than the image.
    pub fn run(&mut self, frame: &DepthFrame, mask: &[u8]) {
        assert_eq!(mask.len(), frame.depth_mm.len(), "a mask of the image's size");
        self.depth_mm.clear();
        self.depth_mm.extend(frame.depth_mm.iter().zip(mask).map(|(d, m)| d * u16::from(*m)));
        self.validity.clear();
        self.validity
            .extend(self.depth_mm.iter().map(|d| if *d == 0 { Validity::Nothing } else { Validity::Measured }));
        self.along.clear();
        self.along.resize(mask.len(), [0.0; 2]);
        let [fx, fy] = [frame.intrinsics.fx, frame.intrinsics.fy];
        let width = frame.intrinsics.width as usize;
        self.rows(frame, width, fx);
        self.columns(frame, width, fy);
    }

    /// Interpolates holes along their rows.
    fn rows(&mut self, frame: &DepthFrame, width: usize, focal: f32) {
        let images = self.depth_mm.chunks_exact(width).zip(frame.depth_mm.chunks_exact(width));
        for ((kept, raw), along) in images.zip(self.along.chunks_exact_mut(width)) {
            let mut last: Option<usize> = None;
            for u in 0..width {
                if kept[u] == 0 {
                    // Something else was measured here: whatever lies beyond it is not across a hole.
                    if raw[u] != 0 {
                        last = None;
                    }
                    continue;
                }
                if let Some(begin) = last.filter(|begin| u - begin > 1) {
                    let ends = [kept[begin], kept[u]];
                    if spans(ends, u - begin, focal) {
                        (begin + 1..u).for_each(|x| along[x] = between(ends, [x - begin, u - x]));
                    }
                }
                last = Some(u);
            }
        }
    }

    /// Interpolates holes along their columns, and fills those that both ways agree on.
    fn columns(&mut self, frame: &DepthFrame, width: usize, focal: f32) {
        self.last.clear();
        self.last.resize(width, NEVER);
        for v in 0..self.depth_mm.len() / width {
            for u in 0..width {
                let at = v * width + u;
                if self.validity[at] != Validity::Measured {
                    if frame.depth_mm[at] != 0 {
                        self.last[u] = NEVER;
                    }
                    continue;
                }
                let last = self.last[u];
                self.last[u] = v as u32;
                if last == NEVER || v - last as usize <= 1 {
                    continue;
                }
                let begin = last as usize;
                let ends = [self.depth_mm[begin * width + u], self.depth_mm[at]];
                if spans(ends, v - begin, focal) {
                    (begin + 1..v).for_each(|y| self.fill(y * width + u, between(ends, [y - begin, v - y])));
                }
            }
        }
    }

    fn fill(&mut self, at: usize, [down, weight]: Guess) {
        let [along, also] = self.along[at];
        if also > 0.0 {
            self.depth_mm[at] = ((down + along) / (weight + also)).round() as u16;
            self.validity[at] = Validity::Filled;
        }
    }
}

/// Whether two ends, so many pixels apart, lie on one surface, and near enough.
fn spans(ends: [u16; 2], pixels: usize, focal: f32) -> bool {
    let near = f32::from(ends[0].min(ends[1]));
    let apart = f32::from(ends[0].abs_diff(ends[1]));
    (pixels - 1) as f32 * near < WIDEST_MM * focal && apart < same_surface(near * 1e-3) * 1e3
}

/// The depth between two ends, with the inverse of their distance as its weight.
fn between(ends: [u16; 2], steps: [usize; 2]) -> Guess {
    let [from, to] = steps.map(|s| s as f32);
    let weight = 1.0 / (from + to);
    let depth = (f32::from(ends[0]) * to + f32::from(ends[1]) * from) * weight;
    [depth * weight, weight]
}
