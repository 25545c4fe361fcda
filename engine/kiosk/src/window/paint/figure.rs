//! Figure: how to stand, shown by a figure that walks to the mark and lifts its arms a little from its sides; or that rolls
//! or sits there.

use std::f32::consts::{PI, TAU};

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use super::palette::Palette;

/// How far arms are lifted from the sides in the end (rad): 30 degrees, so that sleeves and sides are seen apart.
const ARMS: f32 = 0.52;

/// Shares of a round: the way to the mark ends, the arms are lifted.
const ARRIVED: f32 = 0.42;
const LIFTED: f32 = 0.62;

/// A frame of reference: the floor's middle, and the height of a standing figure (pixels).
struct Ground {
    at: Pos2,
    tall: f32,
}

impl Ground {
    /// A point so far to the right and above the floor, in heights of the figure.
    fn point(&self, x: f32, y: f32) -> Pos2 {
        self.at + vec2(x, -y) * self.tall
    }
}

/// Paints it at a phase of its round, 0 .. 1.
pub fn paint(painter: &Painter, rect: Rect, phase: f32, seated: bool, palette: &Palette) {
    let phase = phase.rem_euclid(1.0);
    let tall = rect.height() * 0.86;
    let floor = pos2(rect.center().x, rect.bottom() - rect.height() * 0.07);
    let arrived = ease(phase / ARRIVED);
    mark((painter, palette), floor, tall, arrived);
    // From one side and from a little farther away.
    let from = vec2(-rect.width().min(tall * 1.6) * 0.42, -tall * 0.05);
    let near = 0.88 + 0.12 * arrived;
    let ground = Ground { at: floor + from * (1.0 - arrived), tall: tall * near };
    let stride = if arrived < 1.0 { (phase / ARRIVED * TAU * 2.0).sin() } else { 0.0 };
    let arms = 0.1 + (ARMS - 0.1) * ease((phase - ARRIVED) / (LIFTED - ARRIVED));
    let on = (painter, palette);
    if seated { sit(on, &ground, arms) } else { stand(on, &ground, arms, stride) }
}

/// From 0 to 1, slow at both ends.
fn ease(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The mark on the floor, brighter when a person stands on it.
fn mark((painter, palette): (&Painter, &Palette), floor: Pos2, tall: f32, arrived: f32) {
    let size = vec2(0.3, 0.062) * tall;
    let line = (tall * 0.014).max(2.0);
    let glow = palette.focus.gamma_multiply(0.1 + 0.25 * arrived);
    painter.add(Shape::ellipse_filled(floor, size, glow));
    painter.add(Shape::ellipse_stroke(floor, size, Stroke::new(line, palette.focus)));
}

/// A limb with round ends.
fn limb(painter: &Painter, points: &[Pos2], thick: f32, colour: Color32) {
    for pair in points.windows(2) {
        if let [a, b] = pair {
            painter.line_segment([*a, *b], Stroke::new(thick, colour));
        }
    }
    points.iter().for_each(|p| _ = painter.circle_filled(*p, thick * 0.5, colour));
}

/// Shoulder, elbow and hand of an arm that is lifted so far; `side` is -1 or 1.
fn arm(ground: &Ground, side: f32, shoulder: Vec2, angle: f32) -> [Pos2; 3] {
    let along = |angle: f32, length: f32| vec2(angle.sin() * side, -angle.cos()) * length;
    let elbow = shoulder + along(angle, 0.155);
    let hand = elbow + along(angle * 0.9, 0.15);
    [shoulder, elbow, hand].map(|p| ground.point(p.x, p.y))
}

/// Head, trunk and arms over a hip of this height.
fn trunk((painter, palette): (&Painter, &Palette), ground: &Ground, hip: f32, arms: f32) {
    let (t, ink) = (ground.tall, palette.mark);
    let shoulder = hip + 0.29;
    for side in [-1.0, 1.0] {
        limb(painter, &arm(ground, side, vec2(0.112 * side, shoulder), arms), 0.05 * t, ink);
    }
    let corners =
        [(-0.1, shoulder), (0.1, shoulder), (0.062, hip + 0.12), (0.072, hip), (-0.072, hip), (-0.062, hip + 0.12)];
    let outline: Vec<Pos2> = corners.iter().map(|(x, y)| ground.point(*x, *y)).collect();
    limb(painter, &outline, 0.05 * t, ink);
    limb(painter, &[outline[0], outline[5], outline[4]], 0.05 * t, ink);
    painter.add(Shape::convex_polygon(vec![outline[0], outline[1], outline[2], outline[5]], ink, Stroke::NONE));
    painter.add(Shape::convex_polygon(vec![outline[5], outline[2], outline[3], outline[4]], ink, Stroke::NONE));
    limb(painter, &[ground.point(0.0, shoulder), ground.point(0.0, shoulder + 0.07)], 0.05 * t, ink);
    painter.add(Shape::ellipse_filled(ground.point(0.0, shoulder + 0.128), vec2(0.054, 0.066) * t, ink));
}

fn stand((painter, palette): (&Painter, &Palette), ground: &Ground, arms: f32, stride: f32) {
    let (t, hip) = (ground.tall, 0.52);
    for side in [-1.0, 1.0] {
        let lift = (stride * side).max(0.0) * 0.05;
        let knee = ground.point(0.062 * side, 0.28 + lift);
        let foot = ground.point(0.066 * side, 0.035 + lift);
        limb(painter, &[ground.point(0.048 * side, hip - 0.01), knee, foot], 0.072 * t, palette.mark);
        limb(painter, &[foot, ground.point(0.082 * side, 0.012 + lift)], 0.04 * t, palette.mark);
    }
    trunk((painter, palette), ground, hip, arms);
}

/// From before, in a wheelchair: big wheels edge-on beside, thighs towards the viewer.
fn sit((painter, palette): (&Painter, &Palette), ground: &Ground, arms: f32) {
    let (t, hip) = (ground.tall, 0.3);
    let wheel = Stroke::new((0.018 * t).max(2.0), palette.soft);
    for side in [-1.0, 1.0] {
        painter.add(Shape::ellipse_stroke(ground.point(0.2 * side, 0.17), vec2(0.03, 0.17) * t, wheel));
    }
    trunk((painter, palette), ground, hip, arms.max(PI * 0.08));
    for side in [-1.0, 1.0] {
        let knee = ground.point(0.078 * side, hip - 0.035);
        limb(painter, &[ground.point(0.055 * side, hip), knee], 0.085 * t, palette.mark);
        limb(painter, &[knee, ground.point(0.078 * side, 0.06)], 0.066 * t, palette.mark);
        limb(painter, &[ground.point(0.07 * side, 0.035), ground.point(0.1 * side, 0.03)], 0.04 * t, palette.mark);
    }
}
