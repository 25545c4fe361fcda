//! Garments from OBJ files. Faces whose material name ends in `Free` move; all others stick to the body. A file without
//! any such material moves except for its uppermost edge.

use std::collections::BTreeMap;
use std::path::Path;

use glam::{Vec2, Vec3};
use thiserror::Error;

use super::plain::parse_obj;
use crate::file::{self, FileError, FileKind};
use toile_bake::check::{MeshError, check};
use toile_bake::shape::{Face, NO_VERTEX, Shape};
use toile_base::garment::Part;

/// Largest file that is read (bytes): a quarter of a million vertices and their faces take 40 MiB as text.
pub const MAX_BYTES: u64 = 64 << 20;

/// Material suffix of what moves.
pub(crate) const FREE: &str = "Free";

/// Share of the height from the top that is fixed when no material says what moves.
const FIXED_TOP_SHARE: f32 = 0.06;

/// Error of an OBJ file.
#[derive(Debug, Error)]
pub enum ObjError {
    /// The file cannot be read, or is too large.
    #[error(transparent)]
    File(#[from] FileError),
    /// The text is no OBJ.
    #[error("{path}: {reason}; export the garment as Wavefront OBJ with vertices and faces")]
    Syntax {
        /// The file's path as the user gave it.
        path: String,
        /// The fault of the text, and its place.
        reason: String,
    },
    /// A face with more than four corners.
    #[error("{path}: {face} has {corners} corners; export faces of three or four corners")]
    Polygon {
        /// The file's path as the user gave it.
        path: String,
        /// The face, by its line.
        face: String,
        /// Number of its corners.
        corners: u32,
    },
    /// A mesh that cannot be cloth.
    #[error("{path}: {flaw}")]
    Mesh {
        /// The file's path as the user gave it.
        path: String,
        /// The vertex or face, its fault, and the cure.
        flaw: String,
    },
    /// Not a garment's size.
    #[error("{path}: the mesh is {height} m high; export it in metres, y up, standing on y = 0 like the person in it")]
    Units {
        /// The file's path as the user gave it.
        path: String,
        /// Height of its bounding box (m).
        height: f32,
    },
}

/// Limits of a mesh file of a garment.
const OBJ_FILE: FileKind =
    FileKind { name: "an OBJ file", max_bytes: MAX_BYTES, cure: "reduce the mesh before exporting" };

/// Reads a garment; the weights are left empty. Errors say what is wrong in one sentence.
pub fn read(path: &Path) -> Result<Shape, ObjError> {
    parse(&path.display().to_string(), &file::read_text(path, &OBJ_FILE)?)
}

/// Reads a garment from text; `path` stands in error messages.
pub fn parse(path: &str, text: &str) -> Result<Shape, ObjError> {
    let syntax = |reason: String| ObjError::Syntax { path: path.into(), reason };
    let materials = material_names(text);
    let options = tobj::LoadOptions { single_index: false, ..Default::default() };
    // Only names matter here, so that a missing MTL file is no reason to refuse: each name stands for a material.
    let library = |_: &Path| {
        let list = materials.iter().map(|n| tobj::Material { name: n.clone(), ..Default::default() }).collect();
        Ok((list, materials.iter().enumerate().map(|(i, n)| (n.clone(), i)).collect()))
    };
    let with_library = format!("mtllib names\n{text}");
    let (models, _) = tobj::load_obj_buf(&mut with_library.as_bytes(), &options, library)
        .map_err(|e| syntax(format!("{e}").to_lowercase()))?;
    let mut mesh = WeldedObj::default();
    for model in &models {
        let free = model.mesh.material_id.and_then(|m| materials.get(m)).is_some_and(|name| name.ends_with(FREE));
        mesh.add(path, text, &model.mesh, free)?;
    }
    let shape = mesh.into_shape(path, materials.iter().any(|name| name.ends_with(FREE)))?;
    check(&shape.cut, &shape.faces).map_err(|e| ObjError::Mesh { path: path.into(), flaw: flaw(text, &shape, &e) })?;
    Ok(shape)
}

/// A flaw of the welded mesh in the file's own terms: its vertices by their number and line, its faces by their line.
fn flaw(text: &str, shape: &Shape, error: &MeshError) -> String {
    let Ok(file) = parse_obj(text) else { return error.to_string() };
    // The first vertex of the file at the same place.
    let own = |v: u32| file.positions.iter().position(|p| *p == shape.cut[v as usize]).unwrap_or(usize::MAX);
    file.flaw(error, own, |face| face)
}

/// A face by its line, where the file's faces are counted from 0.
fn face_name(text: &str, face: usize) -> String {
    let line = text.lines().enumerate().filter(|(_, line)| line.trim_start().starts_with("f ")).nth(face);
    line.map_or_else(|| "a face".to_owned(), |(i, _)| format!("the face in line {}", i + 1))
}

/// The material names in order of their first use.
fn material_names(text: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in text.lines().filter_map(|l| l.trim().strip_prefix("usemtl ")).map(|n| n.trim().to_owned()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// All models of a file as one mesh: vertices at the same place are one vertex, so that parts with different materials
/// stay sewn together.
#[derive(Default)]
struct WeldedObj {
    places: BTreeMap<[u32; 3], u32>,
    positions: Vec<Vec3>,
    faces: Vec<Face>,
    /// Texture coordinates of the corners of each face.
    uvs: Vec<[Vec2; 4]>,
    /// True where a face that moves touches the vertex.
    moves: Vec<bool>,
    /// True where a face that does not move touches the vertex.
    sticks: Vec<bool>,
}

impl WeldedObj {
    fn vertex(&mut self, p: Vec3) -> u32 {
        // Adding zero makes -0 and 0 one place.
        let key = (p + Vec3::ZERO).to_array().map(f32::to_bits);
        let next = self.positions.len() as u32;
        let found = *self.places.entry(key).or_insert(next);
        if found == next {
            self.positions.push(p);
            self.moves.push(false);
            self.sticks.push(false);
        }
        found
    }

    fn add(&mut self, path: &str, text: &str, mesh: &tobj::Mesh, free: bool) -> Result<(), ObjError> {
        let triangles = vec![3; if mesh.face_arities.is_empty() { mesh.indices.len() / 3 } else { 0 }];
        let arities = if mesh.face_arities.is_empty() { &triangles } else { &mesh.face_arities };
        let mut at = 0;
        for &corners in arities {
            let ring = &mesh.indices[at..at + corners as usize];
            // A face without texture coordinates has none at any corner.
            let texture = mesh.texcoord_indices.get(at..at + corners as usize).unwrap_or_default();
            at += corners as usize;
            match corners {
                0..=2 => continue, // points and lines carry no cloth
                3 | 4 => {}
                _ => {
                    let face = face_name(text, self.faces.len());
                    return Err(ObjError::Polygon { path: path.into(), face, corners });
                }
            }
            let mut face = [NO_VERTEX; 4];
            for (k, &i) in ring.iter().enumerate() {
                let i = i as usize * 3;
                let Some(p) = mesh.positions.get(i..i + 3) else {
                    let reason = format!("{} names a vertex that is not there", face_name(text, self.faces.len()));
                    return Err(ObjError::Syntax { path: path.into(), reason });
                };
                face[k] = self.vertex(Vec3::new(p[0], p[1], p[2]));
                let touched = if free { &mut self.moves } else { &mut self.sticks };
                touched[face[k] as usize] = true;
            }
            let uv = |&i: &u32| mesh.texcoords.get(i as usize * 2..i as usize * 2 + 2).map(|t| Vec2::new(t[0], t[1]));
            let mut uvs = [Vec2::ZERO; 4];
            uvs.iter_mut().zip(texture).for_each(|(to, i)| *to = uv(i).unwrap_or_default());
            self.uvs.push(uvs);
            self.faces.push(face);
        }
        Ok(())
    }

    /// Where moving and fixed parts meet, the vertex is fixed: the cloth is attached there.
    fn into_shape(self, path: &str, has_free: bool) -> Result<Shape, ObjError> {
        let finite = || self.positions.iter().filter(|p| p.is_finite());
        let low = finite().map(|p| p.y).fold(f32::INFINITY, f32::min);
        let high = finite().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max);
        if !self.faces.is_empty() && !(LEAST_HEIGHT_M..MOST_HEIGHT_M).contains(&(high - low)) {
            return Err(ObjError::Units { path: path.into(), height: high - low });
        }
        let edge = high - FIXED_TOP_SHARE * (high - low);
        let fixed = match has_free {
            true => self.sticks,
            false => self.positions.iter().map(|p| p.y >= edge).collect(),
        };
        let upright = self.faces.into_iter().zip(self.uvs).map(|(f, uv)| warp_upright(&self.positions, f, uv));
        let (faces, uvs) = upright.unzip();
        let parts = vec![Part::All; self.positions.len()];
        Ok(Shape { cut: self.positions.clone(), worn: self.positions, faces, fixed, parts, uvs, ..Shape::default() })
    }
}

/// A garment is between a wristband and a bridal train high (m).
const LEAST_HEIGHT_M: f32 = 0.02;
const MOST_HEIGHT_M: f32 = 3.0;

/// Turns a quad so that its a-b side is the flattest: then warp runs down the garment.
pub(crate) fn warp_upright(positions: &[Vec3], face: Face, uv: [Vec2; 4]) -> (Face, [Vec2; 4]) {
    if face[3] == NO_VERTEX {
        return (face, uv);
    }
    let rise = |i: u32, j: u32| (positions[i as usize].y - positions[j as usize].y).abs();
    let [a, b, c, d] = face;
    if rise(a, b) + rise(c, d) > rise(b, c) + rise(d, a) {
        ([b, c, d, a], [uv[1], uv[2], uv[3], uv[0]])
    } else {
        (face, uv)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKIRT: &str = "o skirt\nv 0 1 0\nv .2 1 0\nv .2 .5 0\nv 0 .5 0\nv .2 0 0\nv 0 0 0\n\
        usemtl Band\nf 4 3 2 1\nusemtl ClothFree\nf 6 5 3 4\n";

    fn read(text: &str) -> Result<Shape, ObjError> {
        parse("test.obj", text)
    }

    #[test]
    fn material_suffix_says_what_moves_and_parts_stay_sewn() {
        let shape = read(SKIRT).unwrap();
        check(&shape.cut, &shape.faces).unwrap();
        assert_eq!(shape.cut.len(), 6);
        let moving: Vec<f32> = (0..6).filter(|&i| !shape.fixed[i]).map(|i| shape.cut[i].y).collect();
        assert_eq!(moving, [0.0, 0.0]);
    }

    #[test]
    fn texture_coordinates_stay_with_their_corners() {
        let text = "v 0 0 0\nv .2 0 0\nv .2 1 0\nvt 0 .5\nvt .4 .5\nvt .4 .9\nf 1/3 2/1 3/2\n";
        let shape = read(text).unwrap();
        assert_eq!(shape.uvs[0][..3], [Vec2::new(0.4, 0.9), Vec2::new(0.0, 0.5), Vec2::new(0.4, 0.5)]);
        // A quad that is turned takes them along; a file without any has none.
        let turned = "v 0 0 0\nv 0 1 0\nv .2 1 0\nv .2 0 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
        let shape = read(turned).unwrap();
        assert_eq!((shape.faces[0], shape.uvs[0][0]), ([1, 2, 3, 0], Vec2::X));
        assert_eq!(read(SKIRT).unwrap().uvs, vec![[Vec2::ZERO; 4]; 2]);
    }

    #[test]
    fn without_materials_the_upper_edge_is_fixed() {
        let shape = read(&SKIRT.replace("usemtl Band\n", "").replace("usemtl ClothFree\n", "")).unwrap();
        assert!((0..6).all(|i| shape.fixed[i] == (shape.cut[i].y > 0.9)));
    }

    #[test]
    fn every_truncation_and_every_broken_byte_is_an_error_or_a_mesh() {
        for end in 0..SKIRT.len() {
            let _ = read(&SKIRT[..end]);
        }
        for (at, byte) in (0..SKIRT.len()).flat_map(|i| [b'9', b'-', b'n', b'\n', b'/', b'e'].map(|b| (i, b))) {
            let mut bytes = SKIRT.as_bytes().to_vec();
            bytes[at] = byte;
            if let Ok(text) = std::str::from_utf8(&bytes) {
                let _ = read(text);
            }
        }
    }

    #[test]
    fn other_files_and_other_units_are_refused_in_one_sentence() {
        for (text, part) in [
            ("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n", "vertex"),
            ("v 0 0 0\nv 100 0 0\nv 100 170 0\nf 1 2 3\n", "metres"),
            ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 .5 0\nf 1 2 3 4 5\n", "5 corners"),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.contains(part) && !message.contains('\n'), "{message}");
        }
        assert!(read("").unwrap_err().to_string().contains("no faces"));
    }

    #[test]
    fn flaws_are_named_by_the_files_own_vertices_and_lines() {
        // The seam's vertices stand twice in the file and are one vertex of the garment.
        let fin = "# a fin\nv 9 9 9\nv 0 0 0\nv 0 1 0\nv 1 0 0\nv -1 0 0\nv 0 0 1\nv 0 0 0\nv 0 1 0\n\
            f 2 3 4\n# between\nf 3 2 5\nf 7 8 6\n";
        let message = read(fin).unwrap_err().to_string();
        assert!(
            message.contains("vertex 2 (line 3) and vertex 3 (line 4)") && message.contains("3 faces"),
            "{message}"
        );
        let thin = "v 0 0 0\nv .2 0 0\nv .2 1 0\nv 0 1 0\nf 1 2 3\n\nf 1 3 3 4\n";
        let message = read(thin).unwrap_err().to_string();
        assert!(message.contains("the face in line 7 has no area"), "{message}");
    }
}
