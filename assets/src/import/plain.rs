//! Meshes as their file has them: every vertex in the file's own order, so that results can be laid beside it.
//!
//! The garment reader of [`super::obj`] welds and reorders while it reads; here that is left to the caller.

use glam::{Vec2, Vec3};

use super::paint::Paint;
use toile_bake::check::MeshError;
use toile_bake::shape::{Face, NO_VERTEX};

/// A mesh in its file's order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PlainMesh {
    /// Vertex positions in the file's unit `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Faces of three or four corners.
    pub faces: Vec<Face>,
    /// Texture coordinates of the corners of each face `[faces]`, or empty.
    pub uvs: Vec<[Vec2; 4]>,
    /// True where a quad is split along b-d, as in [`toile_bake::Shape`].
    pub split: Vec<bool>,
    /// Index of each face's material among `materials` `[faces]`.
    pub face_materials: Vec<Option<usize>>,
    /// Names of the materials in the order of their first use.
    pub materials: Vec<String>,
    /// The picture or colour of each `[materials]`.
    pub paints: Vec<Paint>,
    /// Files that say what materials show, as OBJ names them.
    pub libraries: Vec<String>,
    /// Line of the file, from 1, of each vertex `[vertices]`; empty where the format has no lines.
    pub vertex_lines: Vec<u32>,
    /// The same of each face `[faces]`.
    pub face_lines: Vec<u32>,
}

impl PlainMesh {
    /// The index of a material's name, which is added if it is new.
    pub(crate) fn material(&mut self, name: &str) -> usize {
        self.materials.iter().position(|m| m == name).unwrap_or_else(|| {
            self.materials.push(name.to_owned());
            self.paints.push(Paint::None);
            self.materials.len() - 1
        })
    }

    /// What is wrong with a mesh made from this one, in the user's own terms: the file's vertices and lines, or places (m)
    /// where the format has no lines. `vertex` and `face` say which of this mesh's are meant.
    pub(crate) fn flaw(
        &self,
        error: &MeshError,
        vertex: impl Fn(u32) -> usize,
        face: impl Fn(usize) -> usize,
    ) -> String {
        let place =
            |v: usize| self.positions.get(v).map_or_else(String::new, |p| format!(" at ({}, {}, {})", p.x, p.y, p.z));
        let vertex_name = |v: u32| match self.vertex_lines.get(vertex(v)) {
            Some(line) => format!("vertex {} (line {line})", vertex(v) + 1),
            None => format!("the vertex{}", place(vertex(v))),
        };
        let face_name = |f: usize| match (self.face_lines.get(face(f)), self.faces.get(face(f))) {
            (Some(line), _) => format!("the face in line {line}"),
            (None, Some(corners)) => format!("the face with a corner{}", place(corners[0] as usize)),
            (None, None) => "a face".to_owned(),
        };
        error.described(vertex_name, face_name)
    }
}

/// Reads Wavefront OBJ text: `v`, `vt`, `f`, `usemtl` and `mtllib`; everything else that OBJ may hold is passed over. An error says the
/// line and the cure, to stand behind the file's name.
pub fn parse_obj(text: &str) -> Result<PlainMesh, String> {
    let mut mesh = PlainMesh::default();
    let mut material = None;
    let mut textures = Vec::new();
    let mut corners = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((i, line)) = lines.next() {
        let mut line = line.split('#').next().unwrap_or_default().trim().to_owned();
        while line.ends_with('\\') {
            line.pop();
            line.push_str(lines.next().map_or("", |(_, more)| more.trim()));
        }
        let mut words = line.split_whitespace();
        let read = match words.next() {
            Some("v") => {
                mesh.vertex_lines.push(i as u32 + 1);
                vertex(&mut mesh, words)
            }
            Some("vt") => {
                // Never a reason to refuse: what cannot be read as a number is taken as 0.
                let mut number = || words.next().and_then(|w| w.parse().ok()).unwrap_or(0.0);
                textures.push(Vec2::new(number(), number()));
                Ok(())
            }
            Some("f") => {
                corners.push(texture_corners(words.clone(), textures.len()));
                mesh.face_lines.push(i as u32 + 1);
                face(&mut mesh, words, material)
            }
            Some("mtllib") => {
                mesh.libraries.push(words.collect::<Vec<_>>().join(" "));
                Ok(())
            }
            Some("usemtl") => {
                material = Some(mesh.material(&words.collect::<Vec<_>>().join(" ")));
                Ok(())
            }
            _ => Ok(()),
        };
        read.map_err(|message| format!("line {}: {message}", i + 1))?;
    }
    if !textures.is_empty() {
        let at = |i: Option<usize>| i.and_then(|i| textures.get(i)).copied().unwrap_or_default();
        mesh.uvs = corners.into_iter().map(|ring| ring.map(at)).collect();
    }
    // Faces may stand before their vertices, so that these are counted at the end.
    let count = mesh.positions.len();
    for (line, face) in mesh.face_lines.iter().zip(&mesh.faces) {
        if let Some(v) = face.iter().find(|v| **v != NO_VERTEX && **v as usize >= count) {
            let v = u64::from(*v) + 1;
            return Err(format!("line {line}: a face names vertex {v} of {count}; export the mesh again"));
        }
    }
    Ok(mesh)
}

fn vertex<'t>(mesh: &mut PlainMesh, words: impl Iterator<Item = &'t str>) -> Result<(), String> {
    let mut p = [0.0; 3];
    let mut found = 0;
    // What follows the three coordinates is a weight or a colour.
    for (to, word) in p.iter_mut().zip(words) {
        *to = word.parse().map_err(|_| format!("\"{word}\" is no coordinate; export the mesh again"))?;
        found += 1;
    }
    if found < 3 {
        return Err(format!("a vertex has {found} of three coordinates; export the mesh again"));
    }
    mesh.positions.push(p.into());
    Ok(())
}

/// The texture coordinates that the corners of a face name, counted from 0; `known` stand before it.
fn texture_corners<'t>(words: impl Iterator<Item = &'t str>, known: usize) -> [Option<usize>; 4] {
    let mut ring = [None; 4];
    for (to, word) in ring.iter_mut().zip(words) {
        let number: i64 = word.split('/').nth(1).and_then(|n| n.parse().ok()).unwrap_or(0);
        let index = if number > 0 { number - 1 } else { known as i64 + number };
        *to = if number == 0 { None } else { usize::try_from(index).ok() };
    }
    ring
}

fn face<'t>(mesh: &mut PlainMesh, words: impl Iterator<Item = &'t str>, material: Option<usize>) -> Result<(), String> {
    let mut ring = [NO_VERTEX; 4];
    let mut corners = 0;
    for word in words {
        // The first of `vertex/texture/normal`.
        let number: i64 = word.split('/').next().unwrap_or_default().parse().unwrap_or(0);
        // From 1 on, or backwards from the last vertex so far.
        let index = if number > 0 { number - 1 } else { mesh.positions.len() as i64 + number };
        if number == 0 || !(0..i64::from(NO_VERTEX)).contains(&index) {
            return Err(format!("\"{word}\" is no corner; export the mesh again"));
        }
        if corners < 4 {
            ring[corners] = index as u32;
        }
        corners += 1;
    }
    if !(3..=4).contains(&corners) {
        return Err(format!("a face has {corners} corners; export faces of three or four corners"));
    }
    mesh.faces.push(ring);
    mesh.face_materials.push(material);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# two faces\nmtllib a.mtl\no cloth\nf 3//1 2 1\nv 0 0 0\nv 1 0 0 1 .5 .5\nv 1 1e0 0\n\
        usemtl A Free\nv 0 1 0 # last\ns 1\nf -1/1 -4/2/3 -2 \\\n-3\n";

    #[test]
    fn vertices_keep_the_order_of_the_file() {
        let mesh = parse_obj(TEXT).unwrap();
        assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
        assert_eq!(mesh.faces, [[2, 1, 0, NO_VERTEX], [3, 0, 2, 1]]);
        assert_eq!((mesh.materials, mesh.face_materials), (vec!["A Free".to_owned()], vec![None, Some(0)]));
        assert_eq!((mesh.libraries, mesh.paints), (vec!["a.mtl".to_owned()], vec![Paint::None]));
    }

    #[test]
    fn texture_coordinates_are_those_of_each_corner() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt .5 0\nvt 0 .25 1\nf 1/1 2/2 3/-1\nf 3 2 1\n";
        let uvs = parse_obj(text).unwrap().uvs;
        assert_eq!(uvs[0], [Vec2::ZERO, Vec2::new(0.5, 0.0), Vec2::new(0.0, 0.25), Vec2::ZERO]);
        assert_eq!(uvs[1], [Vec2::ZERO; 4]);
        assert!(parse_obj(TEXT).unwrap().uvs.is_empty());
    }

    #[test]
    fn flaws_are_told_with_their_line() {
        for (text, expected) in [
            ("v 1 2\n", "line 1: a vertex has 2"),
            ("v 1 2 x\n", "line 1: \"x\""),
            ("v 0 0 0\nf 1 1\n", "line 2: a face has 2"),
            ("v 0 0 0\nf 1 1 1 1 1\n", "line 2: a face has 5"),
            ("f 0 1 2\n", "line 1: \"0\""),
            ("f -1 -2 -3\n", "line 1: \"-1\""),
            ("v 0 0 0\nf 1 1 2\n", "names vertex 2 of 1"),
        ] {
            let error = parse_obj(text).unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
        assert_eq!(parse_obj("").unwrap(), PlainMesh::default());
    }

    #[test]
    fn every_truncation_and_every_broken_byte_is_an_error_or_a_mesh() {
        for end in 0..TEXT.len() {
            let _ = parse_obj(&TEXT[..end]);
        }
        for at in 0..TEXT.len() {
            for byte in [b'9', b'-', b'\n', b'/', b'\\'] {
                let mut bytes = TEXT.as_bytes().to_vec();
                bytes[at] = byte;
                let Ok(mesh) = parse_obj(std::str::from_utf8(&bytes).unwrap()) else { continue };
                assert!(mesh.faces.iter().flatten().all(|v| *v == NO_VERTEX || (*v as usize) < mesh.positions.len()));
            }
        }
    }
}
