//! From a mesh as its file has it to a shape that can be cloth: seams closed, faces turned the same way round.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};

use crate::import::obj::warp_upright;
use crate::import::plain::PlainMesh;
use toile_bake::Shape;
use toile_bake::check::corners;
use toile_bake::shape::{Face, NO_VERTEX};
use toile_base::garment::Part;

/// The shape of a mesh, and which of its vertices each of the mesh is. Vertices at the very same place become one,
/// because exporters split them along seams of texture and material; those that no face uses are left out.
pub(super) fn shape(mesh: &PlainMesh, weld: bool) -> (Shape, Vec<u32>) {
    let mut used = vec![false; mesh.positions.len()];
    mesh.faces.iter().flatten().filter(|v| **v != NO_VERTEX).for_each(|v| used[*v as usize] = true);
    let mut places: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let mut shape = Shape::default();
    let mut to_shape = vec![NO_VERTEX; used.len()];
    for (i, &p) in mesh.positions.iter().enumerate().filter(|(i, _)| used[*i]) {
        // Adding zero makes -0 and 0 one place.
        let key = (p + Vec3::ZERO).to_array().map(f32::to_bits);
        let known = if weld { places.get(&key).copied() } else { None };
        to_shape[i] = known.unwrap_or_else(|| shape.push(p, p, false, Part::All));
        places.insert(key, to_shape[i]);
    }
    let face = |face: &Face| face.map(|v| if v == NO_VERTEX { v } else { to_shape[v as usize] });
    shape.split = mesh.split.clone();
    let mut faces: Vec<Face> = mesh.faces.iter().map(face).collect();
    let mut uvs = mesh.uvs.clone();
    uvs.resize(faces.len(), [Vec2::ZERO; 4]);
    orient(&mut faces, &mut uvs);
    let upright = faces.into_iter().zip(uvs).map(|(face, uv)| warp_upright(&shape.cut, face, uv));
    (shape.faces, shape.uvs) = upright.unzip();
    if mesh.uvs.is_empty() {
        shape.uvs = Vec::new();
    }
    (shape, to_shape)
}

/// Turns faces over until those that share an edge run round the same way, as far as that is possible: programs export
/// faces that a modeller drew from the other side. Where a mesh has none to turn it is left as it is.
fn orient(faces: &mut [Face], uvs: &mut [[Vec2; 4]]) {
    // The faces at each edge, each with whether it runs from the smaller vertex to the larger.
    let mut edges: BTreeMap<[u32; 2], Vec<(usize, bool)>> = BTreeMap::new();
    let sides = |face: &Face| {
        let ring = corners(face);
        (0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]).collect::<Vec<_>>()
    };
    for (i, face) in faces.iter().enumerate() {
        for [a, b] in sides(face) {
            edges.entry([a.min(b), a.max(b)]).or_default().push((i, a < b));
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; faces.len()];
    for first in 0..faces.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut open = vec![first];
        while let Some(i) = open.pop() {
            for [a, b] in sides(&faces[i]) {
                // Where more than two faces meet there is no same way round; the check refuses it.
                let Some(&[one, two]) = edges.get(&[a.min(b), a.max(b)]).map(Vec::as_slice) else { continue };
                let (own, other) = if one.0 == i { (one, two) } else { (two, one) };
                if turned[other.0].is_none() {
                    turned[other.0] = Some((own.1 == other.1) != turned[i].unwrap_or(false));
                    open.push(other.0);
                }
            }
        }
    }
    for ((face, uv), _) in faces.iter_mut().zip(uvs).zip(turned).filter(|(_, turned)| *turned == Some(true)) {
        // The side a-b of a quad stays along the weft.
        face.swap(0, 1);
        uv.swap(0, 1);
        if face[3] != NO_VERTEX {
            face.swap(2, 3);
            uv.swap(2, 3);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_bake::check::check;

    #[test]
    fn faces_drawn_from_the_other_side_are_turned_and_sound_ones_left() {
        let at = |r: u32, c: u32| r * 4 + c;
        let positions: Vec<Vec3> = (0..16).map(|i| Vec3::new((i % 4) as f32, -(i / 4) as f32, 0.0)).collect();
        let quads = (0..9u32).map(|i| (i / 3, i % 3));
        let sound: Vec<Face> = quads.map(|(r, c)| [at(r + 1, c), at(r + 1, c + 1), at(r, c + 1), at(r, c)]).collect();
        let mut faces = sound.clone();
        orient(&mut faces, &mut [[Vec2::ZERO; 4]; 9]);
        assert_eq!(faces, sound);
        for i in [1, 4, 5] {
            faces[i].reverse();
        }
        assert!(check(&positions, &faces).is_err());
        orient(&mut faces, &mut [[Vec2::ZERO; 4]; 9]);
        assert_eq!(check(&positions, &faces), Ok(()));
        for [a, b, ..] in &faces {
            assert_eq!(positions[*a as usize].y, positions[*b as usize].y, "a-b runs along the weft");
        }
    }

    #[test]
    fn a_fin_cannot_be_turned_and_is_refused() {
        let mut positions = vec![Vec3::ZERO, Vec3::X];
        positions.extend([Vec3::Y, Vec3::Z, Vec3::NEG_Z]);
        let mut faces = [[0, 1, 2, NO_VERTEX], [1, 0, 3, NO_VERTEX], [0, 1, 4, NO_VERTEX]];
        orient(&mut faces, &mut [[Vec2::ZERO; 4]; 9]);
        assert!(check(&positions, &faces).is_err());
    }
}
