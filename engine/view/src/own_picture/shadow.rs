//! The garment's soft shadow, on skin and floor and on itself: a depth map seen from where most light comes from.

use glam::{Vec2, Vec3};

use super::canvas::{Canvas, Faces, Seen};
use crate::image::Size;

/// Side of a map (pixels): 10 mm each over a whole person.
const SIDE: u32 = 192;

/// A surface is shaded by what is so much nearer to the light (m): less is itself.
const GAP_M: f32 = 0.012;

/// Farther than this a shadow is too soft to be seen (m).
const REACH_M: f32 = 1.1;

/// Places around a point that are looked at (pixels of the map): a sunflower's seeds.
const PLACES: [[f32; 2]; 8] =
    [[0.9, 0.0], [-0.8, 0.75], [0.1, -1.7], [1.3, 1.7], [-2.4, -0.4], [2.2, -1.5], [-0.7, 2.9], [-1.6, -2.7]];

/// Depth map of the cloth that casts the shadow.
#[derive(Debug, Clone, Default)]
pub struct ShadowMap {
    canvas: Canvas,
    right: Vec3,
    up: Vec3,
    toward: Vec3,
    middle: Vec3,
    /// Pixels a metre.
    scale: f32,
    seen: Vec<Seen>,
}

impl ShadowMap {
    /// Looks from a direction (unit) at what lies within a ball (m).
    pub fn begin(&mut self, toward: Vec3, middle: Vec3, radius: f32) {
        let (right, up) = toward.any_orthonormal_pair();
        // A frame of the right hand, so that outer faces are counter-clockwise.
        (self.right, self.up) = if right.cross(up).dot(toward) > 0.0 { (right, up) } else { (up, right) };
        (self.toward, self.middle) = (toward, middle);
        self.scale = SIDE as f32 / (2.0 * radius.max(0.1));
        self.canvas.clear(Size::new(SIDE, SIDE));
    }

    /// Draws a surface (m).
    pub fn draw(&mut self, points: &[Vec3], triangles: &[[u32; 3]], faces: Faces) {
        let mut seen = std::mem::take(&mut self.seen);
        seen.clear();
        seen.extend(points.iter().map(|p| self.place(*p)));
        self.canvas.draw(&seen, triangles, 0, faces);
        self.seen = seen;
    }

    /// Columns, rows, and a number that grows towards the light.
    fn place(&self, p: Vec3) -> Seen {
        let off = p - self.middle;
        let half = 0.5 * SIDE as f32;
        Vec3::new(
            off.dot(self.right) * self.scale + half,
            off.dot(self.up) * self.scale + half,
            100.0 + off.dot(self.toward),
        )
    }

    /// Share of the light that arrives at a place (m), 0 to 1.
    pub fn open(&self, p: Vec3) -> f32 {
        let at = self.place(p);
        let mut dark = 0.0;
        for [dx, dy] in PLACES {
            let place = at.truncate() + Vec2::new(dx, dy) + 0.5;
            let within = place.x >= 0.0 && place.y >= 0.0 && place.x < SIDE as f32 && place.y < SIDE as f32;
            if within {
                let near = self.canvas.near[place.y as usize * SIDE as usize + place.x as usize];
                let above = near - at.z;
                if above > GAP_M {
                    dark += (1.0 - above / REACH_M).clamp(0.0, 1.0);
                }
            }
        }
        1.0 - dark / PLACES.len() as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_below_a_sheet_is_shaded_and_what_lies_beside_or_above_is_not() {
        let mut map = ShadowMap::default();
        let sheet = [
            Vec3::new(-0.3, 1.0, -0.3),
            Vec3::new(0.3, 1.0, -0.3),
            Vec3::new(0.3, 1.0, 0.3),
            Vec3::new(-0.3, 1.0, 0.3),
        ];
        map.begin(Vec3::Y, Vec3::Y, 1.0);
        map.draw(&sheet, &[[0, 1, 2], [0, 2, 3]], Faces::Both);
        assert!(map.open(Vec3::new(0.0, 0.8, 0.0)) < 0.25);
        assert_eq!((map.open(Vec3::new(0.0, 1.2, 0.0)), map.open(Vec3::new(0.6, 0.8, 0.0))), (1.0, 1.0));
        let edge = map.open(Vec3::new(0.3, 0.9, 0.0));
        assert!((0.2..0.9).contains(&edge), "the edge is soft: {edge}");
        assert!(map.open(Vec3::ZERO) > map.open(Vec3::new(0.0, 0.8, 0.0)), "farther below it is lighter");
    }
}
