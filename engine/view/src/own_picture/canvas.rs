//! A depth buffer on the processor: which triangle is nearest at each pixel.

use glam::{Vec2, Vec3};
use toile_engine::lanes::{Kernel, Lanes, Width};

use crate::image::Size;

/// A pixel that no triangle covers.
pub const NOTHING: u32 = u32::MAX;

/// Vertices of one surface as a camera sees them: pixels right and down, and one over their distance (1/m). One at or behind the lens has
/// a third number of 0.
pub type Seen = Vec3;

/// Pixels of a row that are looked at together: most triangles of a body or a garment are no wider.
const LANES: usize = 8;

/// Numbers of a row's pixels, from the first that are looked at together.
const LANE: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// The visible faces of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Faces {
    /// Both: cloth.
    Both,
    /// Those whose corners have a positive area in columns and rows: of a closed surface they hide the others. A mirror shows outer faces so, since
    /// it turns left and right, and so does a map whose rows go up.
    Outer,
}

/// The nearest triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Canvas {
    /// Its size (pixels).
    pub size: Size,
    /// One over the distance along the camera's z (1/m), 0 where nothing is `[pixels, and as many as are looked at together]`.
    pub near: Vec<f32>,
    /// Number of the triangle, [`NOTHING`] where there is none `[as many]`.
    pub triangle: Vec<u32>,
    /// Columns and rows that were drawn on: first and one past the last.
    drawn: [[u32; 2]; 2],
}

impl Canvas {
    /// Empties it; it is made anew where its size changes.
    pub fn clear(&mut self, size: Size) {
        let pixels = size.width as usize * size.height as usize + LANES;
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

    /// Draws a surface whose triangles are counted from `first`.
    pub fn draw(&mut self, seen: &[Seen], triangles: &[[u32; 3]], first: u32, faces: Faces) {
        Width::Eight.run(Filling { canvas: self, seen, triangles, first, faces });
    }

    #[inline(always)]
    fn draw_plain(&mut self, seen: &[Seen], triangles: &[[u32; 3]], first: u32, faces: Faces) {
        for (number, triangle) in (first..).zip(triangles) {
            let corners = triangle.map(|v| seen.get(v as usize).copied().unwrap_or(Vec3::ZERO));
            let [a, b, c] = corners;
            let area = edge(a, b, c.truncate());
            if area == 0.0 || (area < 0.0 && faces == Faces::Outer) {
                continue;
            }
            // A triangle through the lens is left out: no shopper stands in it.
            if corners.iter().all(|c| c.z > 0.0 && c.is_finite()) {
                self.fill(corners, area, number);
            }
        }
    }

    #[inline(always)]
    fn fill(&mut self, [a, b, c]: [Vec3; 3], area: f32, number: u32) {
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
            let row = y * self.size.width as usize;
            for x in (x0..=x1).step_by(LANES) {
                let p = Vec2::new(x as f32, y as f32);
                let weights = Vec3::new(edge(b, c, p), edge(c, a, p), edge(a, b, p)) * over;
                let near = weights.x * a.z + weights.y * b.z + weights.z * c.z;
                let run = Run { weights, step, near, near_step, last: (x1 - x) as f32, number };
                run.fill(&mut self.near[row + x..], &mut self.triangle[row + x..]);
            }
        }
    }
}

/// Pixels of a row that are looked at together.
struct Run {
    /// Of the triangle's corners at the first pixel.
    weights: Vec3,
    step: Vec3,
    near: f32,
    near_step: f32,
    /// Number of the last pixel of the row, counted from the first of these.
    last: f32,
    number: u32,
}

impl Run {
    /// Fills what is within the triangle and nearest, of rows that are as long as what is looked at together at least.
    #[inline(always)]
    fn fill(&self, near: &mut [f32], triangle: &mut [u32]) {
        let (Some(near), Some(triangle)) = (near.first_chunk_mut::<LANES>(), triangle.first_chunk_mut::<LANES>())
        else {
            return;
        };
        let ([u, v, w], [du, dv, dw]) = (self.weights.to_array(), self.step.to_array());
        // Signs and masks rather than branches, which compilers turn into lanes.
        for i in 0..LANES {
            let lane = LANE[i];
            let here = self.near + lane * self.near_step;
            let weight = |at: f32, step: f32| (at + lane * step + 0.0).to_bits();
            let outside = weight(u, du) | weight(v, dv) | weight(w, dw) | (self.last - lane).to_bits();
            let is_nearer = (near[i] - here).to_bits();
            let mask = ((is_nearer & !outside) as i32 >> 31) as u32;
            near[i] = f32::from_bits((near[i].to_bits() & !mask) | (here.to_bits() & mask));
            triangle[i] = (triangle[i] & !mask) | (self.number & mask);
        }
    }
}

/// A surface to be drawn: plain code, compiled for each width that processors have.
struct Filling<'a> {
    canvas: &'a mut Canvas,
    seen: &'a [Seen],
    triangles: &'a [[u32; 3]],
    first: u32,
    faces: Faces,
}

impl Kernel for Filling<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.canvas.draw_plain(self.seen, self.triangles, self.first, self.faces);
    }
}

/// Weights of a triangle's corners at a pixel, as they are on the surface and not in the picture.
#[inline(always)]
pub fn weights([a, b, c]: [Seen; 3], pixel: Vec2) -> [f32; 3] {
    let area = edge(a, b, c.truncate());
    let flat = Vec3::new(edge(b, c, pixel), edge(c, a, pixel), edge(a, b, pixel)) / area;
    let near = flat * Vec3::new(a.z, b.z, c.z);
    let sum = near.element_sum();
    if sum > 0.0 && sum.is_finite() { (near / sum).to_array() } else { [1.0 / 3.0; 3] }
}

/// Twice the signed area of the triangle a, b, p in the picture.
#[inline(always)]
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
            canvas.draw(&near, &[[0, 1, 2]], 7, Faces::Both);
            canvas.draw(&far, &[[0, 2, 1]], 3, Faces::Both);
            canvas.draw(&behind, &[[0, 1, 2]], 4, Faces::Both);
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
    fn every_pixel_within_is_drawn_once_however_wide_and_nothing_beside_the_picture() {
        let size = Size::new(45, 20);
        let mut canvas = Canvas::default();
        canvas.clear(size);
        // A band that reaches over both sides: a row's last pixels lie beside the next row's first.
        let band = [
            Vec3::new(-9.0, 5.5, 1.0),
            Vec3::new(90.0, 5.5, 1.0),
            Vec3::new(-9.0, 12.25, 1.0),
            Vec3::new(90.0, 12.25, 1.0),
        ];
        canvas.draw(&band, &[[0, 1, 2]], 0, Faces::Both);
        canvas.draw(&band, &[[1, 3, 2]], 1, Faces::Both);
        for (at, (near, triangle)) in canvas.near.iter().zip(&canvas.triangle).enumerate() {
            let is = (6..=12).contains(&(at / 45)) && at < 45 * 20;
            assert_eq!((*near > 0.0, *triangle != NOTHING), (is, is), "column {}, row {}", at % 45, at / 45);
        }
        assert_eq!(canvas.drawn(), [[0, 45], [6, 13]]);
    }

    #[test]
    fn of_a_closed_surface_only_the_outer_faces_are_drawn() {
        let mut canvas = Canvas::default();
        canvas.clear(Size::new(20, 20));
        let corners = [Vec3::new(1.0, 1.0, 0.5), Vec3::new(18.0, 1.0, 0.5), Vec3::new(1.0, 18.0, 0.5)];
        canvas.draw(&corners, &[[0, 2, 1]], 5, Faces::Outer);
        assert!(canvas.triangle.iter().all(|t| *t == NOTHING));
        canvas.draw(&corners, &[[0, 1, 2]], 5, Faces::Outer);
        assert_eq!(canvas.triangle[3 * 20 + 3], 5);
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
