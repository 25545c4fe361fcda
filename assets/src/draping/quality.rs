//! How well a pattern was draped: strain, open seams, what crosses the skin and how deep.

use glam::Vec3;

use super::skin_field::SkinField;
use super::springs::Springs;
use crate::body::Body;
use crate::numeric::statistics::quantile;

/// What is measured on a draped mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrapeQuality {
    /// Mean of how much threads are longer or shorter than as cut (1).
    pub strain_mean: f64,
    /// 99th percentile of it (1).
    pub strain_p99: f64,
    /// Largest of it (1).
    pub strain_max: f64,
    /// Widest gap of a seam when its sides became one (m).
    pub seams_open: f64,
    /// Edges of the cloth that pass through triangles of the skin, and edges of the skin through those of the cloth.
    pub crossings: usize,
    /// Deepest vertex inside of the skin (m), 0 where none is.
    pub penetration: f64,
}

/// Strain of the threads: mean, 99th percentile, largest (1).
pub fn strain(springs: &Springs, at: &[Vec3]) -> [f64; 3] {
    let threads = springs.links.iter().filter(|l| l.thread);
    let mut all: Vec<f64> = threads
        .map(|l| f64::from((at[l.ends[0] as usize].distance(at[l.ends[1] as usize]) / l.rest - 1.0).abs()))
        .collect();
    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
    let largest = all.iter().copied().fold(0.0, f64::max);
    [mean, quantile(&mut all, 0.99).unwrap_or_default(), largest]
}

/// The deepest vertex inside of the skin (m).
pub fn penetration(field: &SkinField, at: &[Vec3]) -> f64 {
    let depth = |p: &Vec3| field.nearest(*p).map_or(0.0, |n| f64::from(-n.distance)).max(0.0);
    at.iter().map(depth).fold(0.0, f64::max)
}

/// Edges of each of two surfaces that pass through triangles of the other.
pub fn crossings(body: &Body, at: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let skin = SurfaceGrid::new(&body.mesh.positions, &body.mesh.triangles);
    let cloth = SurfaceGrid::new(at, triangles);
    skin.pierced(at, triangles) + cloth.pierced(&body.mesh.positions, &body.mesh.triangles)
}

/// Side of a cell (m): the longest edge of the mannequin.
const GRID_M: f32 = 0.03;

/// Triangles by the cells that they reach into.
struct SurfaceGrid {
    cells: std::collections::BTreeMap<[i32; 3], Vec<u32>>,
    triangles: Vec<[Vec3; 3]>,
}

/// The cells that a box reaches into.
fn cells(low: Vec3, high: Vec3) -> impl Iterator<Item = [i32; 3]> {
    let [l, h] = [low, high].map(|p| (p / GRID_M).to_array().map(|c| c.floor() as i32));
    (l[0]..=h[0]).flat_map(move |x| (l[1]..=h[1]).flat_map(move |y| (l[2]..=h[2]).map(move |z| [x, y, z])))
}

impl SurfaceGrid {
    fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let triangles: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(|v| positions[v as usize])).collect();
        let mut grid = std::collections::BTreeMap::<[i32; 3], Vec<u32>>::new();
        for (i, [a, b, c]) in triangles.iter().enumerate() {
            for cell in cells(a.min(*b).min(*c), a.max(*b).max(*c)) {
                grid.entry(cell).or_default().push(i as u32);
            }
        }
        Self { cells: grid, triangles }
    }

    /// How many edges of another surface pass through the triangles.
    fn pierced(&self, positions: &[Vec3], triangles: &[[u32; 3]]) -> usize {
        let sides = triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
        let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let pierces = |edge: &&[u32; 2]| {
            let [p, q] = edge.map(|v| positions[v as usize]);
            let near = cells(p.min(q), p.max(q)).filter_map(|c| self.cells.get(&c)).flatten();
            near.into_iter().any(|&t| passes(p, q, self.triangles[t as usize]))
        };
        edges.iter().filter(pierces).count()
    }
}

/// Whether a segment passes through a triangle (Moeller and Trumbore 1997).
fn passes(p: Vec3, q: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    let [p, q, a, b, c] = [p, q, a, b, c].map(Vec3::as_dvec3);
    let (along, e, f) = (q - p, b - a, c - a);
    let across = along.cross(f);
    let det = e.dot(across);
    if det.abs() < 1e-18 {
        return false;
    }
    let from = p - a;
    let u = from.dot(across) / det;
    let turned = from.cross(e);
    let v = along.dot(turned) / det;
    let t = f.dot(turned) / det;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)
}
