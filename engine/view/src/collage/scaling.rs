//! Scaling in two passes: vertically, then horizontally, each by a filter of a tent as wide as a pixel of the smaller picture.
//!
//! Pixels are colour times opacity, so that what is transparent lends no colour. The horizontal pass may stretch each row: that is how a
//! garment's outline is laid on the body's. What lies beyond that outline, the sleeves, goes along and keeps its size.

use toile_assets::catalogue::Picture;

/// A picture of colours times opacity, and opacity, 0 to 1, at a place of another picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Pixels, rows from the top `[height x width]`.
    pub pixels: Vec<[f32; 4]>,
}

/// Where a row of a picture comes to lie, and how it is stretched, left and right of the picture's anchor each by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowSpan {
    /// Place of the anchor (px of what it is laid on).
    pub middle: f32,
    /// Pixels of what it is laid on across one of the picture.
    pub scale: f32,
    /// How much what lies within the edges is stretched beyond that.
    pub stretch: [f32; 2],
    /// How far the outline that is stretched reaches from the anchor (px of the picture).
    pub edges: [f32; 2],
}

impl RowSpan {
    /// The place of the picture that comes to lie so far right of the anchor (px, right of its own), and pixels across one of its there.
    fn seen_at(&self, off: f32) -> (f32, f32) {
        let side = usize::from(off > 0.0);
        let [within, beyond] = [(self.scale * self.stretch[side]).max(1e-3), self.scale.max(1e-3)];
        let edge = self.edges[side].max(0.0);
        let far = off.abs();
        let (at, by) =
            if far <= edge * within { (far / within, within) } else { (edge + (far - edge * within) / beyond, beyond) };
        (at.copysign(off), by)
    }
}

impl Layer {
    /// The pixels of a picture that `share` keeps, 0 to 1 of each.
    pub fn of(picture: &Picture, share: impl Fn(usize) -> f32) -> Self {
        let pixels = picture.pixels.iter().enumerate().map(|(i, p)| p.map(|c| f32::from(c) / 255.0 * share(i)));
        Self { width: picture.width as usize, height: picture.height as usize, pixels: pixels.collect() }
    }
}

/// Weights of a tent around a place: first pixel, and what each counts.
fn tent(at: f32, reach: f32, count: usize) -> (usize, Vec<f32>) {
    let reach = reach.max(1.0);
    let first = (at - reach).ceil().max(0.0) as usize;
    let last = ((at + reach).floor().max(0.0) as usize).min(count.saturating_sub(1));
    let weights: Vec<f32> = (first..=last.max(first)).map(|i| (1.0 - (i as f32 - at).abs() / reach).max(0.0)).collect();
    let whole: f32 = weights.iter().sum();
    if whole <= 0.0 {
        return (first.min(count.saturating_sub(1)), vec![1.0]);
    }
    (first, weights.into_iter().map(|w| w / whole).collect())
}

/// First pass: all rows from `top` on, `scale` rows of the result to one of the picture, on `rows` rows.
fn vertically(layer: &Layer, top: f32, scale: f32, rows: usize) -> Layer {
    let mut pixels = vec![[0.0; 4]; layer.width * rows];
    for y in 0..rows {
        let at = (y as f32 + 0.5 - top) / scale - 0.5;
        if at < -0.5 || at > layer.height as f32 - 0.5 {
            continue;
        }
        let (first, weights) = tent(at, 1.0 / scale, layer.height);
        for (k, w) in weights.iter().enumerate().filter(|(k, _)| first + k < layer.height) {
            let from = &layer.pixels[(first + k) * layer.width..][..layer.width];
            for (to, p) in pixels[y * layer.width..][..layer.width].iter_mut().zip(from) {
                to.iter_mut().zip(p).for_each(|(t, c)| *t += w * c);
            }
        }
    }
    Layer { width: layer.width, height: rows, pixels }
}

/// A picture laid on another of so many columns and rows: its rows from `top` on at `scale`, each stretched by itself; `anchor` is the
/// column of the picture that lies at the middle of each.
pub fn scaled(
    layer: &Layer,
    [columns, rows]: [usize; 2],
    (top, scale): (f32, f32),
    anchor: f32,
    spans: &[RowSpan],
) -> Layer {
    let tall = vertically(layer, top, scale, rows);
    let mut pixels = vec![[0.0; 4]; columns * rows];
    let width = layer.width as f32;
    for (y, span) in spans.iter().enumerate().take(rows) {
        let row = &tall.pixels[y * layer.width..][..layer.width];
        if row.iter().all(|p| p[3] == 0.0) {
            continue;
        }
        for x in 0..columns {
            let (off, by) = span.seen_at(x as f32 + 0.5 - span.middle);
            let at = anchor + off - 0.5;
            if at < -0.5 || at > width - 0.5 {
                continue;
            }
            let (first, weights) = tent(at, 1.0 / by, layer.width);
            let sum = &mut pixels[y * columns + x];
            for (k, w) in weights.iter().enumerate().filter(|(k, _)| first + k < layer.width) {
                sum.iter_mut().zip(row[first + k]).for_each(|(s, c)| *s += w * c);
            }
        }
    }
    Layer { width: columns, height: rows, pixels }
}
