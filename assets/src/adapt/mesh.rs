//! A foreign mesh while it becomes a garment: every vertex and face remembers what it was in the file.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::import::obj::FREE;
use crate::import::plain::PlainMesh;
use toile_bake::check::corners;
use toile_bake::shape::{Face, NO_VERTEX};
use toile_base::texture::Texture;

/// Material of a face.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FaceMaterial {
    /// Whether it moves, by the material's name; never where no name ends in `Free`.
    pub free: bool,
    /// The picture that it shows, counted from 1; 0 is none.
    pub picture: u8,
}

/// A mesh on its way from a file to a garment. Faces, texture coordinates and materials have the same length.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ForeignMesh {
    /// Vertex positions, in the file's unit until it is recognised, then in metres `[vertices]`.
    pub positions: Vec<Vec3>,
    /// The file's vertex that each comes from, counted from 1 as OBJ does `[vertices]`.
    pub source: Vec<u32>,
    /// Faces of three or four corners.
    pub faces: Vec<Face>,
    /// Texture coordinates of the corners of each face `[faces]`; zeros where the file has none.
    pub uvs: Vec<[Vec2; 4]>,
    /// The material of each face `[faces]`.
    pub materials: Vec<FaceMaterial>,
    /// The pictures that materials show.
    pub pictures: Vec<Arc<Texture>>,
    /// Whether any material's name ends in `Free`, so that the file itself says what moves.
    pub says_what_moves: bool,
}

impl ForeignMesh {
    /// The mesh as its file has it, without the pictures of its materials.
    pub fn of(mesh: &PlainMesh) -> Self {
        let moves: Vec<bool> = mesh.materials.iter().map(|name| name.ends_with(FREE)).collect();
        let material = |m: usize| FaceMaterial { free: moves[m], picture: 0 };
        let mut uvs = mesh.uvs.clone();
        uvs.resize(mesh.faces.len(), [Vec2::ZERO; 4]);
        Self {
            positions: mesh.positions.clone(),
            source: (1..=mesh.positions.len() as u32).collect(),
            faces: mesh.faces.clone(),
            uvs,
            materials: mesh.face_materials.iter().map(|m| m.map_or_else(FaceMaterial::default, &material)).collect(),
            pictures: Vec::new(),
            says_what_moves: moves.contains(&true),
        }
    }

    /// Shows pictures: `materials` are those of the file's faces, and `shown` says which picture each material has, counted from
    /// 1. To be called before faces are dropped.
    pub fn paint(&mut self, pictures: Vec<Arc<Texture>>, materials: &[Option<usize>], shown: &[u8]) {
        for (face, material) in self.materials.iter_mut().zip(materials) {
            face.picture = material.and_then(|m| shown.get(m)).copied().unwrap_or(0);
        }
        self.pictures = pictures;
    }

    /// Lowest and highest corner of the box around all vertices that faces use.
    pub fn bounds(&self) -> [Vec3; 2] {
        let start = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        let used = self.faces.iter().flat_map(corners).map(|v| self.positions[*v as usize]);
        used.fold(start, |[low, high], p| [low.min(p), high.max(p)])
    }

    /// Keeps the faces that `keep` names and the vertices that these use.
    pub fn keep(&mut self, keep: impl Fn(usize) -> bool) {
        let kept: Vec<bool> = (0..self.faces.len()).map(keep).collect();
        let mut of = kept.iter();
        self.faces.retain(|_| of.next() == Some(&true));
        let mut of = kept.iter();
        self.uvs.retain(|_| of.next() == Some(&true));
        let mut of = kept.iter();
        self.materials.retain(|_| of.next() == Some(&true));
        self.drop_loose();
    }

    /// Drops the vertices that no face uses and returns the file's numbers of them.
    pub fn drop_loose(&mut self) -> Vec<u32> {
        let mut to = vec![NO_VERTEX; self.positions.len()];
        self.faces.iter().flat_map(corners).for_each(|v| to[*v as usize] = 0);
        let loose = (0..to.len()).filter(|v| to[*v] == NO_VERTEX).map(|v| self.source[v]).collect();
        for (place, next) in to.iter_mut().filter(|place| **place == 0).zip(0..) {
            *place = next;
        }
        let mut used = to.iter();
        self.positions.retain(|_| used.next() != Some(&NO_VERTEX));
        let mut used = to.iter();
        self.source.retain(|_| used.next() != Some(&NO_VERTEX));
        for v in self.faces.iter_mut().flatten().filter(|v| **v != NO_VERTEX) {
            *v = to[*v as usize];
        }
        loose
    }

    /// The corners of a face as points.
    pub fn points(&self, face: usize) -> impl Iterator<Item = Vec3> + '_ {
        corners(&self.faces[face]).iter().map(|v| self.positions[*v as usize])
    }

    /// The middle of a face's corners.
    pub fn middle(&self, face: usize) -> Vec3 {
        self.points(face).sum::<Vec3>() / corners(&self.faces[face]).len() as f32
    }

    /// Twice the area of a face along its normal: half the cross product of a quad's diagonals is its area.
    pub fn area_normal(&self, face: usize) -> Vec3 {
        let at = |v: u32| self.positions[v as usize];
        let [a, b, c, d] = self.faces[face];
        if d == NO_VERTEX { (at(b) - at(a)).cross(at(c) - at(a)) } else { (at(c) - at(a)).cross(at(d) - at(b)) }
    }

    /// Unit normal of a face, or nothing of a face without area.
    pub fn normal(&self, face: usize) -> Vec3 {
        self.area_normal(face).normalize_or_zero()
    }

    /// Turns a face over; the side a-b of a quad stays along the weft.
    pub fn turn(&mut self, face: usize) {
        let quad = self.faces[face][3] != NO_VERTEX;
        self.faces[face].swap(0, 1);
        self.uvs[face].swap(0, 1);
        if quad {
            self.faces[face].swap(2, 3);
            self.uvs[face].swap(2, 3);
        }
    }

    /// The vertices beside each vertex, in order.
    pub fn neighbours(&self) -> Vec<Vec<u32>> {
        let mut beside: Vec<Vec<u32>> = vec![Vec::new(); self.positions.len()];
        for [a, b] in self.faces.iter().flat_map(sides) {
            beside[a as usize].push(b);
            beside[b as usize].push(a);
        }
        beside.iter_mut().for_each(|list| {
            list.sort_unstable();
            list.dedup();
        });
        beside
    }
}

/// The sides of a face, each from one corner to the next.
pub fn sides(face: &Face) -> impl Iterator<Item = [u32; 2]> + use<> {
    let count = corners(face).len();
    let face = *face;
    (0..count).map(move |k| [face[k], face[(k + 1) % count]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::plain::parse_obj;

    fn free(mesh: &ForeignMesh) -> Vec<bool> {
        mesh.materials.iter().map(|m| m.free).collect()
    }

    #[test]
    fn vertices_remember_their_number_in_the_file() {
        let text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\nusemtl AFree\nf 2 3 4 5\nusemtl B\nf 5 4 6\n";
        let mut mesh = ForeignMesh::of(&parse_obj(text).unwrap());
        assert_eq!(mesh.bounds(), [Vec3::ZERO, Vec3::new(1.0, 2.0, 0.0)]);
        assert_eq!(mesh.drop_loose(), [1]);
        assert_eq!((mesh.source.as_slice(), mesh.faces[1]), (&[2, 3, 4, 5, 6][..], [3, 2, 4, NO_VERTEX]));
        assert_eq!((free(&mesh), mesh.says_what_moves), (vec![true, false], true));
        mesh.keep(|face| face == 1);
        assert_eq!((mesh.source.as_slice(), free(&mesh)), (&[4, 5, 6][..], vec![false]));
    }

    #[test]
    fn a_turned_face_looks_the_other_way() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n";
        let mut mesh = ForeignMesh::of(&parse_obj(text).unwrap());
        for face in 0..2 {
            assert_eq!(mesh.normal(face), Vec3::Z);
            mesh.turn(face);
            assert_eq!(mesh.normal(face), Vec3::NEG_Z);
        }
        assert_eq!(mesh.neighbours()[0], [1, 2, 3]);
    }
}
