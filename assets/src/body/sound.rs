//! Whether a body looks right: how rough its surface is, and whether it crosses itself.

use glam::{DVec3, Vec3};

use crate::mesh::Mesh;

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

/// Number of edges that pierce a triangle that they share no vertex with: 0 for a surface that does not cross itself.
pub fn crossings(mesh: &Mesh) -> usize {
    let at = |v: u32| mesh.positions[v as usize];
    let floor = |t: &[u32; 3]| t.iter().map(|&v| at(v).y).fold(f32::MAX, f32::min);
    let mut by_height = mesh.triangles.clone();
    by_height.sort_by(|a, b| floor(a).total_cmp(&floor(b)));
    let floors: Vec<f32> = by_height.iter().map(floor).collect();
    let tall =
        by_height.iter().map(|t| t.iter().map(|&v| at(v).y).fold(f32::MIN, f32::max) - floor(t)).fold(0.0, f32::max);
    let mut count = 0;
    for t in &mesh.triangles {
        for (i, j) in sides(t).into_iter().filter(|(i, j)| i < j) {
            let (a, b) = (at(i), at(j));
            let from = floors.partition_point(|&f| f < a.y.min(b.y) - tall);
            let near = by_height[from..].iter().zip(&floors[from..]).take_while(|(_, f)| **f <= a.y.max(b.y));
            count += near.filter(|(o, _)| !o.contains(&i) && !o.contains(&j) && pierces(a, b, o.map(at))).count();
        }
    }
    count
}

/// Whether a segment passes through a triangle (signed volumes, in f64).
fn pierces(a: Vec3, b: Vec3, [p, q, r]: [Vec3; 3]) -> bool {
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
