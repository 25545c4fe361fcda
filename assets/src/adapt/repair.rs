//! Repairs of single vertices and faces: duplicates joined, faces without area cut or dropped.

use std::collections::{BTreeMap, HashMap};

use glam::{Vec2, Vec3};

use super::mesh::ForeignMesh;
use super::report::Repair;
use toile_bake::check::{LEAST_AREA_M2, corners};
use toile_bake::shape::{Face, NO_VERTEX};

/// Vertices this near to each other are one (m): a twentieth of a millimetre, far below the thickness of any fabric.
const WELD_M: f32 = 5e-5;

/// Repairs a mesh in metres; gives what was done.
pub fn repair(mesh: &mut ForeignMesh) -> Vec<Repair> {
    let mut done = Vec::new();
    let mut note = |repair: Repair| {
        if repair.count > 0 {
            done.push(repair);
        }
    };
    let loose = mesh.drop_loose();
    note(Repair::new("vertices without a face dropped", loose.len(), loose));
    note(weld(mesh));
    note(clean(mesh));
    note(drop_doubles(mesh));
    mesh.drop_loose();
    done
}

/// Joins vertices at the same place: exporters split them along seams of texture and material.
fn weld(mesh: &mut ForeignMesh) -> Repair {
    let cell = |p: Vec3| (p / WELD_M).floor().to_array().map(|x| x as i32);
    let mut first: HashMap<[i32; 3], u32> = HashMap::new();
    let mut to: Vec<u32> = Vec::with_capacity(mesh.positions.len());
    let mut joined = Vec::new();
    for (i, &p) in mesh.positions.iter().enumerate() {
        let at = cell(p);
        let around = (0..27).map(|k| [k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1]);
        let near = around.filter_map(|step| first.get(&std::array::from_fn(|k| at[k].saturating_add(step[k]))));
        let known = near.copied().filter(|v| mesh.positions[*v as usize].distance(p) <= WELD_M).min();
        to.push(known.unwrap_or(i as u32));
        match known {
            Some(_) => joined.push(mesh.source[i]),
            None => _ = first.entry(at).or_insert(i as u32),
        }
    }
    for v in mesh.faces.iter_mut().flatten().filter(|v| **v != NO_VERTEX) {
        *v = to[*v as usize];
    }
    Repair::new("duplicate vertices joined", joined.len(), joined)
}

/// Cuts quads with a corner on a line into triangles, and drops what has no area.
fn clean(mesh: &mut ForeignMesh) -> Repair {
    let faces = std::mem::take(&mut mesh.faces);
    let (uvs, materials) = (std::mem::take(&mut mesh.uvs), std::mem::take(&mut mesh.materials));
    let (mut count, mut at) = (0, Vec::new());
    for ((face, uv), material) in faces.into_iter().zip(uvs).zip(materials) {
        let pieces = whole(&face, |v| mesh.positions[v as usize]);
        if pieces.len() != 1 || pieces[0].iter().map(|k| face[*k]).ne(corners(&face).iter().copied()) {
            count += 1;
            at.push(mesh.source[face[0] as usize]);
        }
        for piece in pieces {
            let mut ring = [NO_VERTEX; 4];
            let mut corner_uvs = [Vec2::ZERO; 4];
            for (to, k) in piece.into_iter().enumerate() {
                (ring[to], corner_uvs[to]) = (face[k], uv[k]);
            }
            mesh.faces.push(ring);
            mesh.uvs.push(corner_uvs);
            mesh.materials.push(material);
        }
    }
    Repair::new("faces without area cut or dropped", count, at)
}

/// The parts of a face that have an area, by the places of their corners: the face itself, a triangle or two of it, or none.
fn whole(face: &Face, at: impl Fn(u32) -> Vec3) -> Vec<Vec<usize>> {
    let ring = corners(face);
    let mut places: Vec<usize> = Vec::new();
    (0..ring.len()).filter(|k| !ring[..*k].contains(&ring[*k])).for_each(|k| places.push(k));
    let wide = |[i, j, k]: [usize; 3]| {
        let [a, b, c] = [i, j, k].map(|k| at(ring[k]));
        (b - a).cross(c - a).length() * 0.5 >= LEAST_AREA_M2
    };
    match places[..] {
        [a, b, c] if wide([a, b, c]) => vec![places],
        [a, b, c, d] if wide([a, b, c]) && wide([a, c, d]) => vec![places],
        [a, b, c, d] => [[b, c, d], [b, d, a]].into_iter().filter(|t| wide(*t)).map(Vec::from).collect(),
        _ => Vec::new(),
    }
}

/// Drops all but the first of the faces between the same corners: what is drawn twice, or from both sides.
fn drop_doubles(mesh: &mut ForeignMesh) -> Repair {
    let mut seen: BTreeMap<[u32; 4], usize> = BTreeMap::new();
    let mut keep = vec![true; mesh.faces.len()];
    let mut at = Vec::new();
    for (i, face) in mesh.faces.iter().enumerate() {
        let mut key = *face;
        key.sort_unstable();
        if *seen.entry(key).or_insert(i) != i {
            keep[i] = false;
            at.push(mesh.source[face[0] as usize]);
        }
    }
    mesh.keep(|i| keep[i]);
    Repair::new("doubled faces dropped", at.len(), at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::plain::parse_obj;
    use toile_bake::check::check;

    const SOUND: &str = "v 0 0 0\nv .2 0 0\nv .2 1 0\nv 0 1 0\nf 1 2 3 4\n";

    /// The repairs, their number, and the file's vertices.
    type Done = (&'static str, usize, Vec<u32>);

    fn repaired(text: &str) -> (ForeignMesh, Vec<Done>) {
        let mut mesh = ForeignMesh::of(&parse_obj(text).unwrap());
        let done = repair(&mut mesh).into_iter().map(|r| (r.what, r.count, r.vertices)).collect();
        check(&mesh.positions, &mesh.faces).unwrap();
        (mesh, done)
    }

    #[test]
    fn a_sound_mesh_is_left_as_it_is() {
        assert_eq!(repaired(SOUND), (ForeignMesh::of(&parse_obj(SOUND).unwrap()), vec![]));
    }

    #[test]
    fn each_flaw_is_repaired_and_named_by_the_files_vertices() {
        let text =
            format!("{SOUND}v 7 7 7\nv .2 0 .00003\nv .2 1 0\nv .4 0 0\nf 6 8 7\nf 1 4 3 2\nf 1 2 2\nf 1 1 1 2\n");
        let (mesh, done) = repaired(&text);
        assert_eq!(
            done,
            [
                ("vertices without a face dropped", 1, vec![5]),
                ("duplicate vertices joined", 2, vec![6, 7]),
                ("faces without area cut or dropped", 2, vec![1]),
                ("doubled faces dropped", 1, vec![1]),
            ]
        );
        assert_eq!((mesh.faces.len(), mesh.source), (2, vec![1, 2, 3, 4, 8]));
    }

    #[test]
    fn a_quad_with_a_corner_on_a_line_becomes_triangles() {
        let (mesh, done) = repaired("v 0 0 0\nv .1 0 0\nv .2 0 0\nv 0 1 0\nf 1 2 3 4\n");
        assert_eq!((mesh.faces.len(), done[0].1), (2, 1));
        let area: f32 = (0..2).map(|f| mesh.area_normal(f).length() * 0.5).sum();
        assert!((area - 0.1).abs() < 1e-6, "{area}");
    }
}
