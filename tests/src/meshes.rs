//! Flat meshes of every kind that can be baked: cells left out, quads beside triangles, corners that are not right, in
//! any plane.

use glam::{Quat, Vec2, Vec3};
use toile_bake::Shape;
use toile_bake::shape::NO_VERTEX;
use toile_base::garment::Part;
use toile_base::mesh::SkinWeights;

/// Length of a cell (m).
pub const CELL_M: f32 = 0.03;

/// How a cell of the grid is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell {
    /// The cell is left empty.
    Hole,
    /// The cell is meshed by a quad.
    Quad,
    /// By two triangles along the rising diagonal.
    Rising,
    /// By two triangles along the falling diagonal.
    Falling,
}

/// What a mesh is made of.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Cells side by side.
    pub columns: usize,
    /// How each is filled, row by row.
    pub cells: Vec<Cell>,
    /// How far each vertex is from its place, up to 1 each way `[vertices]`; those past its end are where they should be.
    pub off: Vec<Vec2>,
    /// Which vertices are held; those past its end are free `[vertices]`.
    pub fixed: Vec<bool>,
    /// How the plane of the mesh lies.
    pub turn: Quat,
}

impl Plan {
    /// The shape, with vertices that no cell uses left out; without a face where all cells are holes.
    pub fn shape(&self) -> Shape {
        let width = self.columns + 1;
        let mut vertex = vec![None; width * (self.cells.len() / self.columns + 1)];
        let mut shape = Shape::default();
        for (i, cell) in self.cells.iter().enumerate().filter(|(_, cell)| **cell != Cell::Hole) {
            let corner = i / self.columns * width + i % self.columns;
            let [a, b, c, d] = [corner, corner + 1, corner + width + 1, corner + width].map(|v| {
                *vertex[v].get_or_insert_with(|| {
                    let off = self.off.get(v).copied().unwrap_or(Vec2::ZERO) * 0.2;
                    let flat = (Vec2::new((v % width) as f32, (v / width) as f32) + off) * CELL_M;
                    let p = self.turn * flat.extend(0.0);
                    shape.weights.push(SkinWeights { bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
                    shape.push(p, p, self.fixed.get(v).copied().unwrap_or(false), Part::All)
                })
            });
            match cell {
                Cell::Rising => shape.faces.extend([[a, b, c, NO_VERTEX], [a, c, d, NO_VERTEX]]),
                Cell::Falling => shape.faces.extend([[a, b, d, NO_VERTEX], [b, c, d, NO_VERTEX]]),
                _ => shape.faces.push([a, b, c, d]),
            }
        }
        shape
    }
}

/// Area of a shape (m2): a flat quad's is that of its two triangles.
pub fn area(shape: &Shape) -> f64 {
    let p = |v: u32| shape.cut[v as usize].as_dvec3();
    let triangle = |[a, b, c]: [u32; 3]| 0.5 * (p(b) - p(a)).cross(p(c) - p(a)).length();
    shape.triangles().into_iter().map(triangle).sum()
}

/// Where a vertex goes when a sheet is folded in half along the line through its middle: half of it lies on the other.
pub fn folded(p: Vec3, middle: Vec3, across: Vec3) -> Vec3 {
    let beyond = (p - middle).dot(across).max(0.0);
    p - 2.0 * beyond * across
}
