//! Double-sided shells: where a modeller gave the whole cloth a thickness, the layer that looks inwards is dropped.

use std::collections::{BTreeMap, HashMap};

use glam::Vec3;

use super::mesh::ForeignMesh;
use super::report::Repair;
use super::sets::DisjointSets;
use super::surface::links;
use crate::body::sound::pierces;
use crate::rig::skin::closest;

/// Layers of one cloth lie at most this far apart (m): the thickest wadded coat.
const THICKEST_M: f32 = 0.012;

/// Cosine between the normals of two sides of one cloth: they look away from each other.
const OPPOSITE_COS: f32 = -0.6;

/// Regions end where faces meet at more than 60 degrees.
const CREASE_COS: f32 = 0.5;

/// Share of a region that must have another layer behind it.
const PAIRED_SHARE: f32 = 0.7;

/// Share of its faces that must look into the garment.
const INWARD_SHARE: f32 = 0.6;

/// How far a face is asked to look (m): across a trunk.
const VIEW_M: f32 = 0.7;

/// Faces of a region that are asked.
const ASKED: usize = 48;

/// Regions that are looked at, the largest first: linings are large.
const MOST_REGIONS: usize = 64;

/// Entries that the grid of triangles may hold: beyond them faces are too uneven for it, and no layer is looked for.
const MOST_ENTRIES: usize = 4_000_000;

/// Drops inner layers; none where the mesh is too uneven to be searched.
pub fn drop_inner(mesh: &mut ForeignMesh) -> Repair {
    let inner = inner_faces(mesh).unwrap_or_default();
    let at: Vec<u32> = inner.iter().map(|f| mesh.source[mesh.faces[*f][0] as usize]).collect();
    let mut keep = vec![true; mesh.faces.len()];
    inner.iter().for_each(|f| keep[*f] = false);
    mesh.keep(|f| keep[f]);
    Repair::new("faces of inner layers dropped", inner.len(), at)
}

fn inner_faces(mesh: &ForeignMesh) -> Option<Vec<usize>> {
    let grid = FaceGrid::new(mesh)?;
    let paired: Vec<bool> = (0..mesh.faces.len()).map(|f| grid.has_other_side(mesh, f)).collect();
    let regions = regions(mesh);
    let area = |faces: &[usize]| faces.iter().map(|f| mesh.area_normal(*f).length()).sum::<f32>();
    let mut dropped = Vec::new();
    for region in regions.iter().take(MOST_REGIONS) {
        let both: Vec<usize> = region.iter().copied().filter(|f| paired[*f]).collect();
        if area(&both) >= PAIRED_SHARE * area(region) && grid.looks_inwards(mesh, region) {
            dropped.extend(region);
        }
    }
    dropped.sort_unstable();
    // A mesh that looks inwards everywhere is no shell.
    Some(if 2 * dropped.len() > mesh.faces.len() + mesh.faces.len() / 4 { Vec::new() } else { dropped })
}

/// Faces that continue each other without a crease, the largest region first.
fn regions(mesh: &ForeignMesh) -> Vec<Vec<usize>> {
    let mut sets = DisjointSets::new(mesh.faces.len());
    for link in links(&mesh.faces) {
        let [f, g] = link.faces.map(|f| mesh.normal(f as usize));
        if f.dot(g) > CREASE_COS {
            sets.join(link.faces[0], link.faces[1]);
        }
    }
    let mut of: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    (0..mesh.faces.len()).for_each(|f| of.entry(sets.find(f as u32)).or_default().push(f));
    let mut regions: Vec<Vec<usize>> = of.into_values().collect();
    regions.sort_by_key(|r| (std::cmp::Reverse(r.len()), r[0]));
    regions
}

/// Triangles by the cells of a grid that they lie in.
struct FaceGrid {
    cell: f32,
    /// Corners of each triangle and the face that it is of.
    triangles: Vec<([Vec3; 3], usize)>,
    cells: HashMap<[i32; 3], Vec<u32>>,
}

impl FaceGrid {
    fn new(mesh: &ForeignMesh) -> Option<Self> {
        let triangles: Vec<([Vec3; 3], usize)> = (0..mesh.faces.len())
            .flat_map(|f| {
                let p: Vec<Vec3> = mesh.points(f).collect();
                (2..p.len()).map(move |k| ([p[0], p[k - 1], p[k]], f))
            })
            .collect();
        let sizes = triangles.iter().map(|([a, b, c], _)| a.distance(*b).max(b.distance(*c)).max(c.distance(*a)));
        let cell = toile_base::numeric::statistics::median_of(sizes)?.max(2.0 * THICKEST_M);
        let mut grid = Self { cell, triangles, cells: HashMap::new() };
        let mut entries = 0;
        for t in 0..grid.triangles.len() {
            let [a, b, c] = grid.triangles[t].0;
            let (low, high) = (grid.at(a.min(b).min(c)), grid.at(a.max(b).max(c)));
            entries += (0..3).map(|k| (high[k] - low[k] + 1) as usize).product::<usize>();
            if entries > MOST_ENTRIES {
                return None;
            }
            cells(low, high).for_each(|at| grid.cells.entry(at).or_default().push(t as u32));
        }
        Some(grid)
    }

    fn at(&self, p: Vec3) -> [i32; 3] {
        (p / self.cell).floor().to_array().map(|x| x as i32)
    }

    /// Whether another face lies close behind a face and looks the other way.
    fn has_other_side(&self, mesh: &ForeignMesh, face: usize) -> bool {
        let (p, n) = (mesh.middle(face), mesh.normal(face));
        let reach = Vec3::splat(THICKEST_M);
        cells(self.at(p - reach), self.at(p + reach)).filter_map(|at| self.cells.get(&at)).flatten().any(|t| {
            let (corners, of) = self.triangles[*t as usize];
            let way = closest(p, corners) - p;
            of != face && mesh.normal(of).dot(n) < OPPOSITE_COS && way.length() < THICKEST_M && way.dot(n) <= 0.0
        })
    }

    /// Whether most faces of a region look at the garment itself: its inside.
    fn looks_inwards(&self, mesh: &ForeignMesh, region: &[usize]) -> bool {
        let stride = region.len().div_ceil(ASKED);
        let asked: Vec<usize> = region.iter().step_by(stride).copied().collect();
        let looks = asked.iter().filter(|f| {
            let n = mesh.normal(**f);
            let from = mesh.middle(**f) + n * 1e-3;
            self.triangles.iter().any(|(corners, of)| of != *f && pierces(from, from + n * VIEW_M, *corners))
        });
        looks.count() as f32 >= INWARD_SHARE * asked.len() as f32
    }
}

/// All cells of a box, both corners included.
fn cells(low: [i32; 3], high: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    let range = move |k: usize| low[k]..=high[k];
    range(0).flat_map(move |x| range(1).flat_map(move |y| range(2).map(move |z| [x, y, z])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_bake::shape::NO_VERTEX;

    /// A tube, one layer or two that are joined at both ends.
    fn shell(layers: &[f32]) -> ForeignMesh {
        const N: u32 = 24;
        const ROWS: u32 = 9;
        let mut mesh = ForeignMesh::default();
        for (k, radius) in layers.iter().enumerate() {
            for (r, c) in (0..ROWS).flat_map(|r| (0..N).map(move |c| (r, c))) {
                let (s, x) = (c as f32 / N as f32 * std::f32::consts::TAU).sin_cos();
                mesh.positions.push(Vec3::new(radius * x, 0.1 * r as f32, -radius * s));
            }
            let at = |r: u32, c: u32| k as u32 * N * ROWS + r * N + c % N;
            for (r, c) in (1..ROWS).flat_map(|r| (0..N).map(move |c| (r, c))) {
                mesh.faces.push([at(r - 1, c), at(r - 1, c + 1), at(r, c + 1), at(r, c)]);
            }
        }
        if layers.len() == 2 {
            for (row, c) in [0, ROWS - 1].into_iter().flat_map(|row| (0..N).map(move |c| (row, c))) {
                let at = |k: u32, c: u32| k * N * ROWS + row * N + c % N;
                mesh.faces.push([at(0, c), at(0, c + 1), at(1, c + 1), at(1, c)]);
            }
        }
        mesh.source = (1..=mesh.positions.len() as u32).collect();
        mesh.uvs = vec![Default::default(); mesh.faces.len()];
        mesh.materials = vec![Default::default(); mesh.faces.len()];
        _ = super::super::surface::settle(&mut mesh);
        assert!(mesh.faces.iter().all(|f| f[3] != NO_VERTEX));
        mesh
    }

    #[test]
    fn the_inner_layer_of_a_shell_is_dropped_and_a_single_one_is_kept() {
        let mut two = shell(&[0.2, 0.195]);
        let done = drop_inner(&mut two);
        assert_eq!(done.count, 8 * 24);
        // What is left of the inner layer hangs on the rims alone.
        let wide = |f: usize| Vec3::new(two.middle(f).x, 0.0, two.middle(f).z).length() > 0.195;
        assert_eq!((0..two.faces.len()).filter(|f| wide(*f)).count(), 8 * 24 + 48);
        assert_eq!(drop_inner(&mut shell(&[0.2])).count, 0);
    }

    #[test]
    fn two_garments_in_layers_are_no_shell() {
        // Both look outwards.
        let mut apart = shell(&[0.2]);
        let inner = shell(&[0.195]);
        let first = apart.positions.len() as u32;
        apart.positions.extend(&inner.positions);
        apart.source.extend(&inner.source);
        apart.uvs.extend(&inner.uvs);
        apart.materials.extend(&inner.materials);
        apart.faces.extend(inner.faces.iter().map(|f| f.map(|v| v + first)));
        assert_eq!(drop_inner(&mut apart).count, 0);
    }
}
