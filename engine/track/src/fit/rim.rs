//! The outline of the shopper in a depth frame, below the size of a pixel, and the body's rim that belongs to it.
//!
//! A front view shows a body's breadth by its outline alone. Where pixels with and without surface meet, the middles of the
//! edges between them are averaged over a cell, which makes of their stairs a line: its place is known to a fraction
//! of a pixel, and its outward normal is the mean of the edges' own.

use std::ops::Range;

use glam::Vec2;

/// A stretch of outline, one cell long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RimPoint {
    /// Its middle (px).
    pub at: Vec2,
    /// Unit normal in the image, away from the shopper.
    pub out: Vec2,
}

/// Pixels with surface around a pixel, itself included, from which on it counts as surface: single pixels that are lost, or
/// that fly, make no outline.
const MAJORITY: u32 = 5;

/// Least length of the mean of the edges' normals: a straight edge has 0.7 or more, a speckle next to nothing.
const STRAIGHT: f32 = 0.55;

/// A picture's surface pixels, smoothed by a majority of nine `[width * height]`, within a range of columns and rows.
#[derive(Debug, Default)]
pub(super) struct SurfaceMask {
    width: usize,
    mask: Vec<bool>,
}

impl SurfaceMask {
    /// Reads the pixels with surface; all others are none.
    pub(super) fn read(&mut self, depth_mm: &[u16], width: usize, [columns, rows]: [Range<usize>; 2]) {
        self.width = width;
        self.mask.clear();
        self.mask.resize(depth_mm.len(), false);
        let height = depth_mm.len() / width.max(1);
        for v in rows.start.max(1)..rows.end.min(height.saturating_sub(1)) {
            for u in columns.start.max(1)..columns.end.min(width.saturating_sub(1)) {
                let row = |v: usize| {
                    let from = v * width + u - 1;
                    depth_mm[from..from + 3].iter().map(|mm| u32::from(*mm != 0)).sum::<u32>()
                };
                self.mask[v * width + u] = row(v - 1) + row(v) + row(v + 1) >= MAJORITY;
            }
        }
    }

    /// The outline within a block of pixels, if a straight stretch of it passes there. Its normal is taken over twice the block,
    /// because the stairs of few pixels have any.
    pub(super) fn stretch(&self, columns: Range<usize>, rows: Range<usize>) -> Option<RimPoint> {
        let height = self.mask.len() / self.width.max(1);
        let around = columns.len().div_ceil(2);
        let wider = |r: &Range<usize>, end: usize| {
            r.start.saturating_sub(around).max(2)..(r.end + around).min(end.saturating_sub(2))
        };
        let (mut middle, mut own, mut out, mut all) = (Vec2::ZERO, 0, Vec2::ZERO, 0);
        for v in wider(&rows, height) {
            for u in wider(&columns, self.width) {
                let here = v * self.width + u;
                if !self.mask[here] {
                    continue;
                }
                let inside = rows.contains(&v) && columns.contains(&u);
                let beside = [
                    (here - 1, -Vec2::X),
                    (here + 1, Vec2::X),
                    (here - self.width, -Vec2::Y),
                    (here + self.width, Vec2::Y),
                ];
                for (_, way) in beside.into_iter().filter(|(other, _)| !self.mask[*other]) {
                    (out, all) = (out + way, all + 1);
                    if inside {
                        (middle, own) = (middle + Vec2::new(u as f32, v as f32) + 0.5 * way, own + 1);
                    }
                }
            }
        }
        let mean = out / (all as f32).max(1.0);
        (own >= around && mean.length() >= STRAIGHT)
            .then(|| RimPoint { at: middle / own as f32, out: mean.normalize() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk's outline is where the disk ends, whatever the pixels are.
    #[test]
    fn the_outline_of_a_disk_is_found_below_a_pixel() {
        let (width, height, step) = (160usize, 120usize, 4usize);
        let (centre, radius) = (Vec2::new(80.3, 60.7), 41.4f32);
        let mut image = vec![0u16; width * height];
        for v in 0..height {
            for u in 0..width {
                if Vec2::new(u as f32, v as f32).distance(centre) < radius {
                    image[v * width + u] = 2_000;
                }
            }
        }
        // A lost pixel and one that flies change nothing.
        image[60 * width + 80] = 0;
        image[5 * width + 5] = 2_000;
        let mut mask = SurfaceMask::default();
        mask.read(&image, width, [0..width, 0..height]);
        let (mut worst, mut sum, mut count) = (0.0f32, 0.0f32, 0);
        for r in 0..height / step {
            for c in 0..width / step {
                let Some(p) = mask.stretch(c * step..(c + 1) * step, r * step..(r + 1) * step) else { continue };
                let off = p.at.distance(centre) - radius;
                worst = worst.max(off.abs());
                sum += off;
                count += 1;
                let along = p.out.dot((p.at - centre).normalize());
                assert!(along > 0.93, "{p:?}: {along}");
            }
        }
        assert!(count > 50, "{count}");
        assert!(worst < 0.75 && (sum / count as f32).abs() < 0.1, "{worst} {}", sum / count as f32);
    }
}
