//! Checks of a body's surface: how rough its surface is, and whether it crosses itself.
//!
//! A surface that meets itself after a short way along it is folded, which no body is; one that meets itself after a
//! long way touches, as the thighs of stout people do.

use glam::{DVec3, Vec3};

use toile_base::mesh::Mesh;

/// Roughness of a surface after Ugur 2008, equation 7.2: the mean distance of a vertex from the mean of its neighbours,
/// as a fraction of the mean length of the edges, so that size alone does not make a body rough. 0 without triangles.
pub fn roughness(mesh: &Mesh) -> f32 {
    let (way, count) = laplacians(mesh);
    let edges: f64 = mesh.triangles.iter().flat_map(sides).map(|(a, b)| length(mesh, a, b)).sum();
    let mean_edge = edges / (3 * mesh.triangles.len()).max(1) as f64;
    let rough: f64 = way.iter().zip(&count).filter(|(_, n)| **n > 0).map(|(d, n)| (d / f64::from(*n)).length()).sum();
    (rough / way.len().max(1) as f64 / mean_edge.max(f64::MIN_POSITIVE)) as f32
}

/// How much the surface was bent by morphing: the mean distance between a vertex's offset from its neighbours' mean and
/// the base's own, as a fraction of the mean edge, with both bodies at the same mean length of edges. 0 for a body that
/// is the base's enlargement. Both meshes have the same triangles.
pub fn unevenness(mesh: &Mesh, base: &Mesh) -> f32 {
    let scaled = |m: &Mesh| {
        let (way, count) = laplacians(m);
        let edges: f64 = m.triangles.iter().flat_map(sides).map(|(a, b)| length(m, a, b)).sum();
        let mean_edge = edges / (3 * m.triangles.len()).max(1) as f64;
        way.into_iter().zip(count).map(move |(d, n)| d / (f64::from(n.max(1)) * mean_edge)).collect::<Vec<_>>()
    };
    let (ours, theirs) = (scaled(mesh), scaled(base));
    let apart: f64 = ours.iter().zip(&theirs).map(|(a, b)| (*a - *b).length()).sum();
    (apart / ours.len().max(1) as f64) as f32
}

fn sides(t: &[u32; 3]) -> [(u32, u32); 3] {
    [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]
}

fn length(mesh: &Mesh, a: u32, b: u32) -> f64 {
    f64::from(mesh.positions[a as usize].distance(mesh.positions[b as usize]))
}

/// Sum of the ways to each vertex's neighbours, and their number; a closed mesh has each edge once each way.
fn laplacians(mesh: &Mesh) -> (Vec<DVec3>, Vec<u32>) {
    let mut way = vec![DVec3::ZERO; mesh.positions.len()];
    let mut count = vec![0; mesh.positions.len()];
    for (a, b) in mesh.triangles.iter().flat_map(sides) {
        way[a as usize] += (mesh.positions[b as usize] - mesh.positions[a as usize]).as_dvec3();
        count[a as usize] += 1;
    }
    (way, count)
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

/// Edges along the surface within which crossing is folding: about 80 mm of way on our bodies.
pub const FOLDED_WITHIN: usize = 6;

/// Those crossings at which the surface is folded: a way of at most [`FOLDED_WITHIN`] edges leads from the edge to the
/// triangle. The others are contact.
pub fn folds(mesh: &Mesh, crossings: &[Crossing]) -> Vec<Crossing> {
    if crossings.is_empty() {
        return Vec::new();
    }
    let mut near: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
    for (a, b) in mesh.triangles.iter().flat_map(sides) {
        near[a as usize].push(b);
    }
    let folded = |c: &&Crossing| {
        let mut reached = c.edge.to_vec();
        let mut from = 0;
        for _ in 0..FOLDED_WITHIN {
            let to = reached.len();
            for k in from..to {
                for &v in &near[reached[k] as usize] {
                    if !reached.contains(&v) {
                        reached.push(v);
                    }
                }
            }
            from = to;
        }
        c.triangle.iter().any(|v| reached.contains(v))
    };
    crossings.iter().filter(folded).copied().collect()
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
