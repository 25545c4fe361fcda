//! Thick hems: the narrow rows by which modellers give an open edge a thickness are peeled off, so that cloth ends in one layer.

use glam::Vec3;

use super::mesh::ForeignMesh;
use super::report::Repair;
use super::surface::{borders, links};
use toile_bake::check::corners;

/// A rim is at most this wide (m): a seam allowance that is turned in is wider and is a layer of its own.
const WIDEST_RIM_M: f32 = 0.015;

/// Faces whose normals have a smaller cosine between them meet at an edge that was modelled as a fold: 50 degrees.
const FOLD_COS: f32 = 0.64;

/// Rows that are peeled at most: the rim, and what is turned in behind it.
const MOST_ROWS: usize = 3;

/// Peels the rims off every border.
pub fn peel(mesh: &mut ForeignMesh) -> Repair {
    let (mut count, mut at) = (0, Vec::new());
    for _ in 0..MOST_ROWS {
        let rim = rim(mesh);
        let found = rim.iter().filter(|r| **r).count();
        if found == 0 || found == mesh.faces.len() {
            break;
        }
        count += found;
        at.extend((0..rim.len()).filter(|f| rim[*f]).map(|f| mesh.source[mesh.faces[f][0] as usize]));
        mesh.keep(|f| !rim[f]);
    }
    Repair::new("faces of thick hems peeled off", count, at)
}

/// Which faces are a rim: narrow ones at a border that are folded against what lies behind them.
fn rim(mesh: &ForeignMesh) -> Vec<bool> {
    let mut on_border = vec![false; mesh.positions.len()];
    let mut along: Vec<Vec<Vec3>> = vec![Vec::new(); mesh.positions.len()];
    for [a, b] in borders(&mesh.faces) {
        on_border[a as usize] = true;
        on_border[b as usize] = true;
        along[a as usize].push(mesh.positions[b as usize]);
        along[b as usize].push(mesh.positions[a as usize]);
    }
    let touches = |f: usize| corners(&mesh.faces[f]).iter().any(|v| on_border[*v as usize]);
    let row: Vec<bool> = (0..mesh.faces.len()).map(touches).collect();
    let narrow = |f: usize| {
        let ring = corners(&mesh.faces[f]);
        let near = |v: u32| {
            let p = mesh.positions[v as usize];
            let on = ring.iter().filter(|w| on_border[**w as usize]).map(|w| {
                let q = mesh.positions[*w as usize];
                along[*w as usize].iter().map(|r| p.distance(nearest_on(p, q, *r))).fold(p.distance(q), f32::min)
            });
            on.fold(f32::INFINITY, f32::min)
        };
        ring.iter().map(|v| near(*v)).fold(0.0, f32::max) <= WIDEST_RIM_M
    };
    // What lies behind each face of the row: directly, or behind the other half of a split quad.
    let mut behind: Vec<Vec<usize>> = vec![Vec::new(); mesh.faces.len()];
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); mesh.faces.len()];
    for link in links(&mesh.faces) {
        let [f, g] = link.faces.map(|f| f as usize);
        for (f, g) in [(f, g), (g, f)].into_iter().filter(|(f, _)| row[*f]) {
            if row[g] { beside[f].push(g) } else { behind[f].push(g) }
        }
    }
    let folded = |f: usize| {
        let halves = beside[f].iter().filter(|g| mesh.normal(f).dot(mesh.normal(**g)) > FOLD_COS);
        let all = behind[f].iter().chain(halves.filter(|_| behind[f].is_empty()).flat_map(|g| &behind[*g]));
        let normals: Vec3 = all.map(|g| mesh.normal(*g)).sum();
        normals != Vec3::ZERO && mesh.normal(f).dot(normals.normalize_or_zero()) < FOLD_COS
    };
    (0..mesh.faces.len()).map(|f| row[f] && narrow(f) && folded(f)).collect()
}

/// The point between `a` and `b` that is nearest to `p`.
fn nearest_on(p: Vec3, a: Vec3, b: Vec3) -> Vec3 {
    let way = b - a;
    a + way * ((p - a).dot(way) / way.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapt::surface::loops;
    use toile_bake::shape::NO_VERTEX;

    /// A tube of `columns` and `rows` of quads as large as they are wide, radius 1 m.
    fn tube(columns: u32, rows: u32) -> (Vec<Vec3>, Vec<toile_bake::shape::Face>) {
        let at = |r: u32, c: u32| r * columns + c % columns;
        let side = std::f32::consts::TAU / columns as f32;
        let point = |r: u32, c: u32| {
            let (sin, cos) = (side * c as f32).sin_cos();
            Vec3::new(sin, -(r as f32) * side, cos)
        };
        let positions = (0..rows).flat_map(|r| (0..columns).map(move |c| point(r, c))).collect();
        let face = |r, c| [at(r + 1, c), at(r + 1, c + 1), at(r, c + 1), at(r, c)];
        (positions, (0..rows - 1).flat_map(|r| (0..columns).map(move |c| face(r, c))).collect())
    }

    fn mesh((positions, faces): (Vec<Vec3>, Vec<toile_bake::shape::Face>)) -> ForeignMesh {
        let text: String = positions.iter().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect();
        let face = |f: &toile_bake::shape::Face| {
            let ring: Vec<String> = f.iter().filter(|v| **v != NO_VERTEX).map(|v| (v + 1).to_string()).collect();
            format!("f {}\n", ring.join(" "))
        };
        let text = text + &faces.iter().map(face).collect::<String>();
        ForeignMesh::of(&crate::import::plain::parse_obj(&text).unwrap())
    }

    #[test]
    fn a_rim_that_is_turned_in_is_peeled_and_the_tube_is_left() {
        let (mut positions, mut faces) = tube(24, 6);
        let lowest = positions.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
        let hem: Vec<u32> = (0..positions.len() as u32).filter(|v| positions[*v as usize].y < lowest + 1e-4).collect();
        let first = positions.len() as u32;
        for &v in &hem {
            let p = positions[v as usize];
            let inwards = Vec3::new(p.x, 0.0, p.z).normalize() * 0.008;
            positions.push(p - inwards);
        }
        let count = hem.len();
        for k in 0..count {
            let j = (k + 1) % count;
            faces.push([first + k as u32, first + j as u32, hem[j], hem[k]]);
        }
        let mut whole = mesh((positions, faces));
        _ = super::super::surface::settle(&mut whole);
        let before = whole.faces.len();
        let done = peel(&mut whole);
        assert_eq!((done.count, whole.faces.len(), loops(&whole).len()), (count, before - count, 2));
        assert_eq!(peel(&mut whole).count, 0);
    }
}
