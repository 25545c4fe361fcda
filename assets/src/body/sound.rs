//! Finds where a body's surface crosses itself.

use glam::{DVec3, Vec3};

use toile_base::mesh::Mesh;

fn sides(t: &[u32; 3]) -> [(u32, u32); 3] {
    [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]
}

/// An edge that pierces a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Crossing {
    /// Vertices of the edge.
    pub edge: [u32; 2],
    /// Vertices of the triangle; none of them is the edge's.
    pub triangle: [u32; 3],
}

/// All edges that pierce a triangle that they share no vertex with, once a pair; none on a sound surface.
pub fn crossings(mesh: &Mesh) -> Vec<Crossing> {
    let grid = TriangleGrid::new(mesh);
    // Edges of a border belong to one triangle, which may name them either way round.
    let mut edges: Vec<[u32; 2]> = mesh.triangles.iter().flat_map(sides).map(|(i, j)| [i.min(j), i.max(j)]).collect();
    edges.sort_unstable();
    edges.dedup();
    let mut found = Vec::new();
    edges.into_iter().for_each(|edge| grid.pierced(mesh, edge, &mut found));
    found
}

/// Size of the cells in which triangles are looked up (m): about two edges of a body.
const CELL: f32 = 0.025;

/// Most cells along an axis: a mesh of another size gets larger cells.
const MOST_CELLS: f32 = 128.0;

/// The triangles of a mesh by the cells of space that they touch.
struct TriangleGrid {
    low: Vec3,
    cell: f32,
    count: [usize; 3],
    /// Start of each cell's triangles, and the end `[cells + 1]`.
    start: Vec<u32>,
    triangles: Vec<u32>,
}

impl TriangleGrid {
    fn new(mesh: &Mesh) -> Self {
        let finite = mesh.positions.iter().filter(|p| p.is_finite());
        let (low, high) = finite.fold((Vec3::MAX, Vec3::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
        let extent = (high - low).max(Vec3::ZERO);
        let cell = CELL.max(extent.max_element() / MOST_CELLS);
        let count = (extent / cell).to_array().map(|n| n as usize + 1);
        let mut grid =
            Self { low, cell, count, start: vec![0; count.iter().product::<usize>() + 1], triangles: Vec::new() };
        let boxes: Vec<[[usize; 3]; 2]> =
            mesh.triangles.iter().map(|t| grid.around(&t.map(|v| mesh.positions[v as usize]))).collect();
        let mut places: Vec<(usize, u32)> = Vec::with_capacity(2 * boxes.len());
        for (t, ends) in boxes.iter().enumerate() {
            places.extend(grid.cells(ends).map(|(_, c)| (c, t as u32)));
        }
        places.sort_unstable();
        for (c, _) in &places {
            grid.start[c + 1] += 1;
        }
        for c in 0..grid.start.len() - 1 {
            grid.start[c + 1] += grid.start[c];
        }
        grid.triangles = places.into_iter().map(|p| p.1).collect();
        grid
    }

    /// First and last cell, along each axis, of the box around some points.
    fn around(&self, points: &[Vec3]) -> [[usize; 3]; 2] {
        let (least, most) = points.iter().fold((Vec3::MAX, Vec3::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
        [least, most].map(|p| {
            let place = ((p - self.low) / self.cell).to_array();
            std::array::from_fn(|k| (place[k] as usize).min(self.count[k] - 1))
        })
    }

    /// The cells of a box: their place along each axis, and their number.
    fn cells<'a>(&'a self, [from, to]: &'a [[usize; 3]; 2]) -> impl Iterator<Item = ([usize; 3], usize)> + 'a {
        let [nx, ny, _] = self.count;
        let planes = (from[2]..=to[2]).flat_map(move |z| (from[1]..=to[1]).map(move |y| (y, z)));
        planes.flat_map(move |(y, z)| (from[0]..=to[0]).map(move |x| ([x, y, z], (z * ny + y) * nx + x)))
    }

    /// Adds the triangles that an edge pierces.
    fn pierced(&self, mesh: &Mesh, edge: [u32; 2], found: &mut Vec<Crossing>) {
        let [i, j] = edge;
        let [a, b] = [i, j].map(|v| mesh.positions[v as usize]);
        let own = self.around(&[a, b]);
        for (place, c) in self.cells(&own) {
            for &t in &self.triangles[self.start[c] as usize..self.start[c + 1] as usize] {
                let triangle = mesh.triangles[t as usize];
                if triangle.contains(&i) || triangle.contains(&j) {
                    continue;
                }
                let corners = triangle.map(|v| mesh.positions[v as usize]);
                // A pair that meets in several cells counts in the first of them.
                let theirs = self.around(&corners)[0];
                let first = (0..3).all(|k| place[k] == own[0][k].max(theirs[k]));
                if first && pierces(a, b, corners) {
                    found.push(Crossing { edge, triangle });
                }
            }
        }
    }
}

/// Whether a segment passes through a triangle (signed volumes, in f64).
pub(crate) fn pierces(a: Vec3, b: Vec3, [p, q, r]: [Vec3; 3]) -> bool {
    if p.max(q).max(r).cmplt(a.min(b)).any() || p.min(q).min(r).cmpgt(a.max(b)).any() {
        return false;
    }
    let [a, b, p, q, r] = [a, b, p, q, r].map(Vec3::as_dvec3);
    let side = |u: DVec3, v: DVec3, w: DVec3, x: DVec3| (v - u).cross(w - u).dot(x - u);
    if side(p, q, r, a) * side(p, q, r, b) >= 0.0 {
        return false;
    }
    let [u, v, w] = [side(a, b, p, q), side(a, b, q, r), side(a, b, r, p)];
    (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0)
}
