//! The grid over trunk, neck and head, with its ears.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::cage::{ABOVE_HOLE, HALF, HOLE, HOLE_ROWS, Lattice, cast};
use super::chart::Chart;
use crate::form::{Form, GridRow};
use toile_base::body::Region;

/// The ear's column of quads and its rows, in the head's rings.
const EAR_COLUMN: usize = 8;
const EAR_ROWS: [usize; 2] = [5, 11];

impl Lattice {
    /// Trunk, neck and head; the trunk's rows from the groin up.
    pub(super) fn lay_trunk(&mut self, form: &Form) -> Vec<[u32; HALF]> {
        let grid = &form.drawing.grid;
        let even: [f32; HALF] = std::array::from_fn(|c| c as f32 * PI / 12.0);
        let face = grid.face.map(f32::to_radians);
        let last = grid.trunk.len() - 1;
        let hole = last - ABOVE_HOLE - HOLE_ROWS;
        let mut rows = Vec::new();
        for (r, row) in grid.trunk.iter().enumerate() {
            let inside = r > hole && r < hole + HOLE_ROWS;
            let lay = |c: usize| !(inside && (HOLE + 1..HOLE + HOLE_ROWS).contains(&c));
            rows.push(self.ring(form, row, &even, Region::Torso, 0.5, lay));
        }
        let trunk = rows.clone();
        let base = rows.len();
        for (r, row) in grid.head.iter().enumerate() {
            // The columns gather in front of the face by and by.
            let t = ((r + 1) as f32 / 4.0).min(1.0);
            let angles: [f32; HALF] = std::array::from_fn(|c| even[c] + (face[c] - even[c]) * t);
            let region = if r < 2 { Region::Torso } else { Region::Head };
            rows.push(self.ring(form, row, &angles, region, if r < 3 { 0.4 } else { 0.06 }, |_| true));
        }
        for pair in 0..rows.len() - 1 {
            for c in 0..HALF - 1 {
                let corners = [rows[pair][c], rows[pair][c + 1], rows[pair + 1][c + 1], rows[pair + 1][c]];
                let head = pair.checked_sub(base);
                let ear = c == EAR_COLUMN && head.is_some_and(|h| (EAR_ROWS[0]..EAR_ROWS[1]).contains(&h));
                let armhole = (hole..hole + HOLE_ROWS).contains(&pair) && (HOLE..HOLE + HOLE_ROWS).contains(&c);
                if ear || armhole {
                    continue;
                }
                let chart = match (head.is_some_and(|h| h >= 2), c) {
                    (true, 0..8) => Chart::Face,
                    (true, _) => Chart::Nape,
                    (false, 0..6) => Chart::Front,
                    (false, _) => Chart::Back,
                };
                self.quad(corners, chart);
            }
        }
        self.grow_ear(form, &rows[base..]);
        self.close_crown(form, &rows[rows.len() - 1]);
        trunk
    }

    fn ring(
        &mut self,
        form: &Form,
        row: &GridRow,
        angles: &[f32; HALF],
        region: Region,
        slide: f32,
        lay: impl Fn(usize) -> bool,
    ) -> [u32; HALF] {
        std::array::from_fn(|c| {
            if !lay(c) {
                return u32::MAX;
            }
            let (sin, cos) = angles[c].sin_cos();
            let [front, side, back] = row.y;
            let y = side + (front - side) * cos.max(0.0).powi(2) + (back - side) * cos.min(0.0).powi(2);
            let from = Vec3::new(0.0, y, row.z);
            let way = if c == 0 || c == HALF - 1 { Vec3::Z * cos.signum() } else { Vec3::new(sin, 0.0, cos) };
            let p = cast(from, way, |p| form.trunk(p));
            assert!(c % (HALF - 1) == 0 || p.x > 1.0, "the grid's row at {y} mm starts outside the form");
            self.push(p, region, slide)
        })
    }

    /// A patch of 6 by 6 on the crown, its left half.
    fn close_crown(&mut self, form: &Form, rim: &[u32; HALF]) {
        // Rows of the patch run from front to back, columns from the middle out: the rim is its front, side and back.
        let mut patch = [[0u32; 4]; 7];
        for k in 0..4 {
            patch[0][k] = rim[k];
            patch[6][k] = rim[12 - k];
        }
        for r in 1..6 {
            patch[r][3] = rim[3 + r];
        }
        let at = |v: u32, points: &[Vec3]| points[v as usize];
        for r in 1..6 {
            for c in 0..3 {
                let t = r as f32 / 6.0;
                let along = at(patch[0][c], &self.points).lerp(at(patch[6][c], &self.points), t);
                let edge = at(patch[r][3], &self.points);
                let mut p = Vec3::new(edge.x * c as f32 / 3.0, edge.y, along.z + (edge.z - along.z) * c as f32 / 3.0);
                p = cast(Vec3::new(p.x, edge.y - 20.0, p.z), Vec3::Y, |p| form.trunk(p));
                patch[r][c] = self.push(p, Region::Head, 0.4);
            }
        }
        for r in 0..6 {
            for c in 0..3 {
                self.quad([patch[r][c], patch[r][c + 1], patch[r + 1][c + 1], patch[r + 1][c]], Chart::Nape);
            }
        }
    }

    /// Draws the ear out of one column of the head.
    fn grow_ear(&mut self, form: &Form, head: &[[u32; HALF]]) {
        let (front, back) = (EAR_COLUMN, EAR_COLUMN + 1);
        let up = EAR_ROWS[0]..=EAR_ROWS[1];
        let rim: Vec<u32> = up.clone().map(|r| head[r][front]).chain(up.rev().map(|r| head[r][back])).collect();
        let middle = rim.iter().map(|&v| self.points[v as usize]).sum::<Vec3>() / rim.len() as f32;
        let [y, z, out] = form.drawing.grid.ear;
        let mut ring = rim;
        for (spread, away) in [(0.98, 0.4), (0.8, 1.0)] {
            let to = ring
                .iter()
                .map(|&v| {
                    let p = self.points[v as usize];
                    let flat = Vec2::new(p.y - middle.y, p.z - middle.z) * spread;
                    // It leans back, and its rear stands further out.
                    Vec3::new(middle.x + out * away, y, z) + Vec3::new(-0.4 * flat.y, flat.x, flat.y)
                })
                .collect::<Vec<_>>();
            let to: Vec<u32> = to.into_iter().map(|p| self.push(p, Region::Head, 0.08)).collect();
            self.band(&ring, &to, |_| Chart::Ear(false));
            ring = to;
        }
        let rows = EAR_ROWS[1] - EAR_ROWS[0];
        for r in 0..rows {
            let opposite = |r: usize| ring[2 * rows + 1 - r];
            self.quad([ring[r], ring[r + 1], opposite(r + 1), opposite(r)], Chart::Ear(false));
        }
    }
}
