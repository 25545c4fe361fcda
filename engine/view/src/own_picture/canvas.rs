//! A depth buffer on the processor: which triangle is nearest at each pixel.

use glam::{Vec2, Vec3};

use crate::image::Size;

/// A pixel that no triangle covers.
pub const NOTHING: u32 = u32::MAX;

/// Vertices of one surface as a camera sees them: pixels right and down, and one over their distance (1/m). One at or behind the lens has
/// a third number of 0.
pub type Seen = Vec3;

/// The nearest triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Canvas {
    /// Its size (pixels).
    pub size: Size,
    /// One over the distance along the camera's z (1/m), 0 where nothing is `[pixels]`.
    pub near: Vec<f32>,
    /// Number of the triangle, [`NOTHING`] where there is none `[pixels]`.
    pub triangle: Vec<u32>,
    /// Columns and rows that were drawn on: first and one past the last.
    drawn: [[u32; 2]; 2],
}

impl Default for Canvas {
    fn default() -> Self {
        Self { size: Size::new(0, 0), near: Vec::new(), triangle: Vec::new(), drawn: [[0; 2]; 2] }
    }
}

impl Canvas {
    /// Empties it; it is made anew where its size changes.
    pub fn clear(&mut self, size: Size) {
        let pixels = size.width as usize * size.height as usize;
        if self.size == size {
            // Only what was drawn on.
            let [[x0, x1], [y0, y1]] = self.drawn;
            for y in y0..y1 {
                let row = y as usize * size.width as usize;
                self.near[row + x0 as usize..row + x1 as usize].fill(0.0);
                self.triangle[row + x0 as usize..row + x1 as usize].fill(NOTHING);
            }
        } else {
            self.size = size;
            self.near.clear();
            self.near.resize(pixels, 0.0);
            self.triangle.clear();
            self.triangle.resize(pixels, NOTHING);
        }
        self.drawn = [[size.width, 0], [size.height, 0]];
    }

    /// Columns and rows that hold triangles: first and one past the last of each.
    pub fn drawn(&self) -> [[u32; 2]; 2] {
        let [[x0, x1], [y0, y1]] = self.drawn;
        [[x0.min(x1), x1], [y0.min(y1), y1]]
    }

    /// Draws a surface whose triangles are counted from `first`; both of their faces are seen.
    pub fn draw(&mut self, seen: &[Seen], triangles: &[[u32; 3]], first: u32) {
        for (number, triangle) in (first..).zip(triangles) {
            let corners = triangle.map(|v| seen.get(v as usize).copied().unwrap_or(Vec3::ZERO));
            // A triangle through the lens is left out: nobody stands in it.
            if corners.iter().all(|c| c.z > 0.0 && c.is_finite()) {
                self.fill(corners, number);
            }
        }
    }

    fn fill(&mut self, [a, b, c]: [Vec3; 3], number: u32) {
        let area = edge(a, b, c.truncate());
        if area == 0.0 {
            return;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let last = |n: u32| n as f32 - 1.0;
        let (x0, x1) = (low.x.ceil().max(0.0), high.x.floor().min(last(self.size.width)));
        let (y0, y1) = (low.y.ceil().max(0.0), high.y.floor().min(last(self.size.height)));
        if x0 > x1 || y0 > y1 {
            return;
        }
        // Weights and depth are linear across the picture: each pixel adds a step to them.
        let over = 1.0 / area;
        let step = Vec3::new(b.y - c.y, c.y - a.y, a.y - b.y) * over;
        let near_step = step.x * a.z + step.y * b.z + step.z * c.z;
        let (x0, x1, y0, y1) = (x0 as usize, x1 as usize, y0 as usize, y1 as usize);
        let [[dx0, dx1], [dy0, dy1]] = &mut self.drawn;
        (*dx0, *dx1) = ((*dx0).min(x0 as u32), (*dx1).max(x1 as u32 + 1));
        (*dy0, *dy1) = ((*dy0).min(y0 as u32), (*dy1).max(y1 as u32 + 1));
        for y in y0..=y1 {
            let p = Vec2::new(x0 as f32, y as f32);
            let mut weights = Vec3::new(edge(b, c, p), edge(c, a, p), edge(a, b, p)) * over;
            let mut near = weights.x * a.z + weights.y * b.z + weights.z * c.z;
            let row = y * self.size.width as usize;
            let pixels = self.near[row + x0..=row + x1].iter_mut().zip(&mut self.triangle[row + x0..=row + x1]);
            for (nearest, triangle) in pixels {
                if weights.min_element() >= 0.0 && near > *nearest {
                    (*nearest, *triangle) = (near, number);
                }
                weights += step;
                near += near_step;
            }
        }
    }
}

/// Weights of a triangle's corners at a pixel, as they are on the surface and not in the picture.
pub fn weights([a, b, c]: [Seen; 3], pixel: Vec2) -> [f32; 3] {
    let area = edge(a, b, c.truncate());
    let flat = Vec3::new(edge(b, c, pixel), edge(c, a, pixel), edge(a, b, pixel)) / area;
    let near = flat * Vec3::new(a.z, b.z, c.z);
    let sum = near.element_sum();
    if sum > 0.0 && sum.is_finite() { (near / sum).to_array() } else { [1.0 / 3.0; 3] }
}

/// Twice the signed area of the triangle a, b, p in the picture.
fn edge(a: Vec3, b: Vec3, p: Vec2) -> f32 {
    (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearer_triangle_is_seen_and_only_where_it_lies() {
        let mut canvas = Canvas::default();
        let size = Size::new(40, 30);
        for _ in 0..2 {
            canvas.clear(size);
            let far = [Vec3::new(0.0, 0.0, 0.2), Vec3::new(39.0, 0.0, 0.2), Vec3::new(0.0, 29.0, 0.2)];
            let near = [Vec3::new(2.0, 2.0, 0.5), Vec3::new(8.0, 2.0, 0.5), Vec3::new(2.0, 8.0, 0.5)];
            let behind = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(39.0, 0.0, 0.9), Vec3::new(0.0, 29.0, 0.9)];
            canvas.draw(&near, &[[0, 1, 2]], 7);
            canvas.draw(&far, &[[0, 2, 1]], 3);
            canvas.draw(&behind, &[[0, 1, 2]], 4);
            let at = |x: usize, y: usize| canvas.triangle[y * 40 + x];
            assert_eq!((at(3, 3), at(20, 3), at(39, 29), at(9, 9)), (7, 3, NOTHING, 3));
            assert!((canvas.near[3 * 40 + 20] - 0.2).abs() < 1e-6);
            assert_eq!(canvas.drawn(), [[0, 40], [0, 30]]);
        }
        canvas.clear(size);
        assert!(canvas.triangle.iter().all(|t| *t == NOTHING) && canvas.near.iter().all(|n| *n == 0.0));
        assert_eq!(canvas.drawn(), [[0, 0], [0, 0]]);
    }

    #[test]
    fn weights_are_those_of_the_surface() {
        // A corner three times as far away counts for a quarter in the middle of the picture's line.
        let corners = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(10.0, 0.0, 1.0 / 3.0), Vec3::new(0.0, 10.0, 1.0)];
        let [a, b, c] = weights(corners, Vec2::new(5.0, 0.0));
        assert!((a - 0.75).abs() < 1e-6 && (b - 0.25).abs() < 1e-6 && c.abs() < 1e-6);
        assert_eq!(weights([Vec3::ZERO; 3], Vec2::ONE), [1.0 / 3.0; 3]);
    }
}
