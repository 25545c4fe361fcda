//! The head of a shop mannequin as one smooth shape: cranium, jaw and chin grown together, with a hint of brow and nose.

use glam::Vec3;

/// How softly two of its balls grow together (mm).
const BLEND_MM: f32 = 30.0;

/// Farthest from the middle of the head that the shape is looked for (mm).
const REACH_MM: f32 = 180.0;

/// Halvings of that: to a hundredth of a millimetre.
const HALVINGS: u32 = 15;

/// From where the shape is looked at: inside of all of it (mm, of the head's space).
pub const MIDDLE_MM: Vec3 = Vec3::new(0.0, -110.0, 22.0);

/// Centre and radii of each ball (mm, of the head's space).
const BALLS: [[Vec3; 2]; 5] = [
    [Vec3::new(0.0, -86.0, 6.0), Vec3::new(74.5, 87.0, 97.0)],
    [Vec3::new(0.0, -136.0, 12.0), Vec3::new(62.0, 50.0, 46.0)],
    [Vec3::new(0.0, -148.0, 38.0), Vec3::new(58.0, 66.0, 59.0)],
    [Vec3::new(0.0, -180.0, 58.0), Vec3::new(42.0, 38.0, 35.0)],
    [Vec3::new(0.0, -197.0, 68.0), Vec3::new(27.0, 24.0, 25.0)],
];

/// How far a point lies outside of an ellipsoid, nearly (mm).
fn outside(p: Vec3, [centre, radii]: [Vec3; 2]) -> f32 {
    let (k, steep) = (((p - centre) / radii).length(), ((p - centre) / (radii * radii)).length());
    if steep > 1e-9 { k * (k - 1.0) / steep } else { -radii.min_element() }
}

/// The least of two, rounded where they meet (polynomial smooth minimum, Quilez).
fn joined(a: f32, b: f32) -> f32 {
    let near = (BLEND_MM - (a - b).abs()).max(0.0) / BLEND_MM;
    a.min(b) - near * near * BLEND_MM * 0.25
}

/// A bell: 1 in the middle, next to nothing at three times its width.
fn bell(x: f32, width: f32) -> f32 {
    (-0.5 * (x / width).powi(2)).exp()
}

/// 0 below `low`, 1 above `high`, level at both ends.
pub fn ease(x: f32, low: f32, high: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// How far the face stands out of the balls at a point of it (mm): the ridge of the nose, and shallow eyes beneath the brow.
fn relief(p: Vec3) -> f32 {
    if p.z < 30.0 {
        return 0.0;
    }
    let along = ease(p.y, -165.0, -146.0) * (1.0 - ease(p.y, -146.0, -98.0));
    let nose = 11.0 * along * bell(p.x, 7.5 + 4.0 * ease(-p.y, 110.0, 150.0));
    let eyes = 4.5 * bell(p.y + 112.0, 11.0) * (bell(p.x - 31.0, 15.0) + bell(p.x + 31.0, 15.0));
    nose - eyes
}

/// The point of the shape in the direction of a point of the head (mm, of the head's space).
pub fn onto(p: Vec3) -> Vec3 {
    let toward = (p - MIDDLE_MM).normalize_or(Vec3::Z);
    let (mut near, mut far) = (0.0, REACH_MM);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (near + far);
        let at = MIDDLE_MM + toward * middle;
        let inside = BALLS.map(|ball| outside(at, ball)).into_iter().reduce(joined).unwrap_or(0.0) < 0.0;
        if inside { near = middle } else { far = middle }
    }
    let at = MIDDLE_MM + toward * near;
    at + toward * relief(at)
}
