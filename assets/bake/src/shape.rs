//! The shape of one garment in one size: its faces, its measure as cut, and where it starts on a shopper.

use glam::{Vec2, Vec3};
use toile_base::garment::Part;
use toile_base::garment::look::MeshPicture;
use toile_base::garment::trim::ClothTrim;
use toile_base::mesh::{Influences, SkinWeights};

use crate::overrides::Overrides;

/// In the fourth place of a [`Face`]: the face is a triangle.
pub const NO_VERTEX: u32 = u32::MAX;

/// A quad `[a, b, c, d]` or a triangle `[a, b, c, NO_VERTEX]`, counter-clockwise seen from outside. In a quad the
/// sides a-b and d-c run along the weft, a-d and b-c along the warp.
pub type Face = [u32; 4];

/// A garment as drafted or imported, before it is baked. All vertex arrays have the same length.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shape {
    /// Vertex positions on the body the garment was cut for (m): rest lengths and areas come from these.
    pub cut: Vec<Vec3>,
    /// Where each vertex starts on the shopper, in the rest pose (m).
    pub worn: Vec<Vec3>,
    /// Triangles and quads, by the indices of their vertices.
    pub faces: Vec<Face>,
    /// True where the vertex sticks to the body and is skinned, false where it is simulated.
    pub fixed: Vec<bool>,
    /// The part of the body that each vertex lies on.
    pub parts: Vec<Part>,
    /// Skin weights; only those of fixed vertices are read.
    pub weights: Vec<SkinWeights>,
    /// True where a quad is split along b-d rather than a-c `[faces]`; faces past its end are split along a-c.
    pub split: Vec<bool>,
    /// How many times heavier than its fabric each vertex is, a weight sewn into a hem for example `[vertices]`;
    /// vertices past its end have the fabric's mass.
    pub heavier: Vec<f32>,
    /// Texture coordinates of the corners of each face `[faces]`, or empty. Where they are a pattern laid out flat, its
    /// warp along v, they say which way the threads of triangles run.
    pub uvs: Vec<[Vec2; 4]>,
    /// The corners of each face as cut, laid flat (m): weft along x, warp down along -y `[faces]`; or empty. Where they are
    /// given, rest lengths, areas and angles come from them and not from `cut`: a vertex of a seam lies in several panels,
    /// and has another place in each.
    pub flat: Vec<[Vec2; 4]>,
    /// The panel that each face is cut from `[faces]`, or empty: faces of different panels meet at seams.
    pub panels: Vec<u32>,
    /// What is put on the panels' cloth, where `flat` has it: at most [`MAX_TRIMS`](toile_base::garment::trim::MAX_TRIMS).
    pub trims: Vec<ClothTrim>,
    /// The picture that a mesh brings, by the triangles of [`Self::triangles`].
    pub picture: Option<MeshPicture>,
    /// Solvers that its garment file has chosen.
    pub solver: Overrides,
}

impl Shape {
    /// Adds a vertex and returns its index.
    pub fn push(&mut self, cut: Vec3, worn: Vec3, fixed: bool, part: Part) -> u32 {
        self.parts.push(part);
        self.cut.push(cut);
        self.worn.push(worn);
        self.fixed.push(fixed);
        (self.cut.len() - 1) as u32
    }

    /// A rectangle of quads, the piece of cloth that needs no file. Vertex (row, column) is `row * columns + column`;
    /// `place` gives where it is (m) and whether it is held. Weft runs along the rows, warp down the columns. What is held
    /// follows the root bone.
    pub fn sheet(rows: u32, columns: u32, place: impl Fn(u32, u32) -> (Vec3, bool)) -> Self {
        let mut shape = Self::default();
        for (row, column) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
            let (at, held) = place(row, column);
            shape.push(at, at, held, Part::All);
        }
        let root = Influences::strongest([(0, 1.0)]).0;
        shape.weights = vec![root; shape.cut.len()];
        let quads = (1..rows).flat_map(|r| (1..columns).map(move |c| (r * columns, c)));
        shape.faces = quads.map(|(row, c)| [row + c - 1, row + c, row - columns + c, row - columns + c - 1]).collect();
        shape
    }

    /// The corners of a face as cut (m), where they are flat in their plane; the fourth of a triangle is its first.
    pub fn face_as_cut(&self, face: usize) -> [Vec3; 4] {
        match self.flat.get(face) {
            Some(flat) => flat.map(|p| p.extend(0.0)),
            None => self.faces[face].map(|v| self.cut[if v == NO_VERTEX { self.faces[face][0] } else { v } as usize]),
        }
    }

    /// Area of a face as cut (m2).
    pub fn face_area(&self, face: usize) -> f32 {
        let laid = self.face_as_cut(face);
        area(if self.faces[face][3] == NO_VERTEX { &laid[..3] } else { &laid })
    }

    /// The corners of the triangles as cut (m), in the order of [`Self::triangles`].
    pub fn triangles_as_cut(&self) -> Vec<[Vec3; 3]> {
        let mut out = Vec::with_capacity(self.faces.len() * 2);
        for i in 0..self.faces.len() {
            let [a, b, c, d] = self.face_as_cut(i);
            out.extend(self.split_face(i, [a, b, c, d]).into_iter().flatten());
        }
        out
    }

    /// What belongs to the corners of the faces, for the corners of the triangles, in the order of [`Self::triangles`].
    pub fn corners<T: Copy>(&self, of_faces: &[[T; 4]]) -> Vec<[T; 3]> {
        of_faces
            .iter()
            .enumerate()
            .flat_map(|(i, corners)| self.split_face(i, *corners).into_iter().flatten())
            .collect()
    }

    /// One triangle of a face, or the two that a quad is split into.
    fn split_face<T: Copy>(&self, face: usize, [a, b, c, d]: [T; 4]) -> [Option<[T; 3]>; 2] {
        if self.faces[face][3] == NO_VERTEX {
            [Some([a, b, c]), None]
        } else if self.split.get(face).copied().unwrap_or(false) {
            [Some([a, b, d]), Some([b, c, d])]
        } else {
            [Some([a, b, c]), Some([a, c, d])]
        }
    }

    /// The faces as triangles; a quad is split along a-c, or along b-d where `split` says so.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let mut out = Vec::with_capacity(self.faces.len() * 2);
        for (i, &face) in self.faces.iter().enumerate() {
            out.extend(self.split_face(i, face).into_iter().flatten());
        }
        out
    }
}

/// Area of a polygon by the triangles around its first corner (m2).
pub fn area(ring: &[Vec3]) -> f32 {
    (2..ring.len()).map(|k| 0.5 * (ring[k - 1] - ring[0]).cross(ring[k] - ring[0]).length()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_faces_the_viewer_and_its_weft_runs_along_the_rows() {
        let shape = Shape::sheet(3, 4, |r, c| (Vec3::new(c as f32, -(r as f32), 0.0), r == 0));
        assert_eq!((shape.cut.len(), shape.weights.len(), shape.faces.len()), (12, 12, 6));
        assert_eq!(shape.fixed.iter().filter(|held| **held).count(), 4);
        for [a, b, c, d] in shape.faces.iter().map(|face| face.map(|v| shape.cut[v as usize])) {
            assert_eq!([b - a, c - d, d - a, c - b], [Vec3::X, Vec3::X, Vec3::Y, Vec3::Y]);
        }
    }
}
