//! A drawing as pixels: what is nearer to a mark than half a pixel is covered by it.

use crate::image::{Image, Size};
use crate::text::{TextSize, draw};

use super::{Anchor, BLACK, Colour, Drawing, Mark};

/// Lengths of a dash and of the gap behind it (pixels).
const DASH: [f64; 2] = [7.0, 5.0];

/// Half the width of a ring's line (pixels).
const RING: f64 = 1.0;

/// The picture on white.
pub fn image(drawing: &Drawing) -> Image {
    let mut image = Image::filled(Size::new(drawing.size[0], drawing.size[1]), [255; 3]);
    for mark in &drawing.marks {
        match mark {
            Mark::Line { points, colour, width, dashed } => {
                for ends in points.windows(2) {
                    let pieces = if *dashed { dashes(ends[0], ends[1]) } else { vec![[ends[0], ends[1]]] };
                    pieces.into_iter().for_each(|piece| line(&mut image, piece, *width, *colour));
                }
            }
            Mark::Dot { at, radius, colour, ring } => dot(&mut image, *at, *radius, *colour, *ring),
            Mark::Text { at, anchor, words, large } => text(&mut image, *at, *anchor, words, *large),
        }
    }
    image
}

fn text(image: &mut Image, at: [f64; 2], anchor: Anchor, words: &str, large: bool) {
    let size = if large { TextSize::Large } else { TextSize::Small };
    let width = f64::from(size.width(words));
    let left = match anchor {
        Anchor::Left => at[0],
        Anchor::Middle => at[0] - 0.5 * width,
        Anchor::Right => at[0] - width,
    };
    let top = at[1] - 0.5 * f64::from(size.height());
    draw(image, left.round() as i32, top.round() as i32, words, size, BLACK);
}

fn line(image: &mut Image, [a, b]: [[f64; 2]; 2], width: f64, colour: Colour) {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length2 = along[0].powi(2) + along[1].powi(2);
    let distance = |p: [f64; 2]| {
        let from = [p[0] - a[0], p[1] - a[1]];
        let t = if length2 > 0.0 { (from[0] * along[0] + from[1] * along[1]) / length2 } else { 0.0 };
        let t = t.clamp(0.0, 1.0);
        (from[0] - t * along[0]).hypot(from[1] - t * along[1])
    };
    let low = [a[0].min(b[0]), a[1].min(b[1])];
    let high = [a[0].max(b[0]), a[1].max(b[1])];
    cover(image, [low, high], width, colour, |p| 0.5 * width - distance(p));
}

fn dot(image: &mut Image, at: [f64; 2], radius: f64, colour: Colour, ring: bool) {
    let inside = |p: [f64; 2]| {
        let r = (p[0] - at[0]).hypot(p[1] - at[1]);
        if ring { RING - (r - radius).abs() } else { radius - r }
    };
    cover(image, [at, at], radius + RING, colour, inside);
}

/// Lays colour on every pixel near a box by how deep it is inside of a mark (pixels), half at its edge.
fn cover(image: &mut Image, [low, high]: [[f64; 2]; 2], room: f64, colour: Colour, inside: impl Fn([f64; 2]) -> f64) {
    let first = |v: f64| (v - room - 1.0).floor().max(0.0) as u32;
    let last = |v: f64, most: u32| ((v + room + 1.0).ceil().max(0.0) as u32).min(most.saturating_sub(1));
    let size = image.size();
    for y in first(low[1])..=last(high[1], size.height) {
        for x in first(low[0])..=last(high[0], size.width) {
            let share = (inside([f64::from(x) + 0.5, f64::from(y) + 0.5]) + 0.5).clamp(0.0, 1.0);
            if let (Some(old), true) = (image.pixel(x, y), share > 0.0) {
                let mixed = |k: usize| (f64::from(old[k]) * (1.0 - share) + f64::from(colour[k]) * share).round() as u8;
                image.fill(x as i32, y as i32, Size::new(1, 1), [mixed(0), mixed(1), mixed(2)]);
            }
        }
    }
}

/// The dashes of a line.
fn dashes(a: [f64; 2], b: [f64; 2]) -> Vec<[[f64; 2]; 2]> {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let at = |s: f64| [a[0] + (b[0] - a[0]) * s / length, a[1] + (b[1] - a[1]) * s / length];
    let count = (length / (DASH[0] + DASH[1])).ceil() as u32;
    let start = |k: u32| f64::from(k) * (DASH[0] + DASH[1]);
    (0..count).map(|k| [at(start(k)), at((start(k) + DASH[0]).min(length))]).collect()
}
