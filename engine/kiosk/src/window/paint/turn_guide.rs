//! The guide for a turn: the shopper from above within a ring of the sides that were seen of them, with an arrow that shows the way.

use std::f32::consts::TAU;

use egui::{Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};

use super::palette::Palette;
use crate::visitor::body_turn::SIDES;

/// Radii of the ring's middle and of the arrow, as shares of half the height.
const RING: f32 = 0.72;
const ARROW: f32 = 0.93;

/// Thickness of the ring, as a share of half the height.
const THICK: f32 = 0.13;

/// Length of the arrow (rad).
const SWEEP: f32 = 1.2;

/// Share of a side that its mark fills; the rest sets it off from the next.
const FILLED: f32 = 0.8;

/// Points of an arc.
const POINTS: usize = 16;

/// A direction so far to the shopper's left of the mirror (rad): the mirror is at the top, and left is left, as seen from above.
fn towards(left: f32) -> Vec2 {
    vec2(-left.sin(), -left.cos())
}

/// Paints it in the middle of a rectangle. `turned` is how far the shopper is turned to their left (rad); the arrow is so far on its way.
pub fn paint(
    (painter, palette): (&Painter, &Palette),
    rect: Rect,
    seen: &[bool; SIDES],
    turned: f32,
    arrow: Option<f32>,
) {
    let (centre, radius) = (rect.center(), rect.height().min(rect.width()) * 0.5);
    let side = TAU / SIDES as f32;
    for (i, seen) in seen.iter().enumerate() {
        let middle = i as f32 * side;
        // Brightness and thickness say the same.
        let (colour, thick) = if *seen { (palette.mark, THICK) } else { (palette.edge, THICK * 0.4) };
        let half = 0.5 * side * FILLED;
        arc(painter, centre, radius * RING, [middle - half, middle + half], Stroke::new(radius * thick, colour));
    }
    shopper((painter, palette), centre, radius, turned);
    if let Some(round) = arrow {
        sweep((painter, palette), centre, radius, round * TAU);
    }
}

fn arc(painter: &Painter, centre: Pos2, radius: f32, [from, to]: [f32; 2], stroke: Stroke) {
    let at = |i: usize| centre + towards(from + (to - from) * i as f32 / (POINTS - 1) as f32) * radius;
    painter.add(Shape::line((0..POINTS).map(at).collect(), stroke));
}

/// Shoulders, head, and the tips of the feet before them.
fn shopper((painter, palette): (&Painter, &Palette), centre: Pos2, radius: f32, turned: f32) {
    let (ahead, left) = (towards(turned), towards(turned + 0.25 * TAU));
    let at = |x: f32, y: f32| centre + (left * x + ahead * y) * radius;
    let ink = palette.mark;
    for x in [-0.11, 0.11] {
        painter.line_segment([at(x, 0.05), at(x * 1.2, 0.24)], Stroke::new(radius * 0.1, palette.soft));
    }
    painter.line_segment([at(-0.28, 0.0), at(0.28, 0.0)], Stroke::new(radius * 0.22, ink));
    for x in [-0.28, 0.28] {
        painter.circle_filled(at(x, 0.0), radius * 0.11, ink);
    }
    painter.circle(at(0.0, 0.02), radius * 0.14, ink, Stroke::new((radius * 0.025).max(1.0), palette.on_ink));
    // Where they face.
    painter.circle_filled(at(0.0, 0.15), radius * 0.035, ink);
}

fn sweep((painter, palette): (&Painter, &Palette), centre: Pos2, radius: f32, from: f32) {
    let line = Stroke::new((radius * 0.05).max(2.0), palette.focus);
    arc(painter, centre, radius * ARROW, [from, from + SWEEP], line);
    let (tip, along) = (from + SWEEP, 0.14);
    let at = |left: f32, out: f32| centre + towards(left) * radius * out;
    let head = vec![at(tip + along, ARROW), at(tip, ARROW + 0.07), at(tip, ARROW - 0.07)];
    painter.add(Shape::convex_polygon(head, palette.focus, Stroke::NONE));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_is_left_and_ahead_is_towards_the_mirror() {
        let near = |a: Vec2, x: f32, y: f32| (a - vec2(x, y)).length() < 1e-5;
        assert!(near(towards(0.0), 0.0, -1.0), "the mirror is at the top");
        assert!(near(towards(0.25 * TAU), -1.0, 0.0) && near(towards(0.5 * TAU), 0.0, 1.0));
    }
}
