//! The pictures of a mesh's materials, read from its folder; what cannot be read is told, and the mesh shows its fabric there.

use std::path::Path;
use std::sync::Arc;

use super::mesh::ForeignMesh;
use crate::file::{self, FileKind};
use crate::import::makehuman::clothes::Clothes;
use crate::import::paint::{Paint, parse_mhmat, parse_mtl};
use crate::import::plain::PlainMesh;
use toile_base::texture::Texture;

/// Limits of a picture file.
const PICTURE: FileKind = FileKind { name: "a picture", max_bytes: 64 << 20, cure: "make it smaller" };

/// Limits of a material file.
const MATERIALS: FileKind = FileKind { name: "a material file", max_bytes: 1 << 20, cure: "export the mesh again" };

/// Most pictures of one mesh.
const MOST_PICTURES: usize = 64;

/// Reader of a mesh's materials, from the files of its folder.
#[derive(Debug, Default)]
pub struct MeshPaint {
    /// The file's materials, or one for all faces.
    paints: Vec<Paint>,
    /// The material of each face.
    of_face: Vec<Option<usize>>,
    /// Files of the folder that say so.
    libraries: Vec<String>,
    /// Notes on unreadable files.
    notes: Vec<String>,
}

impl MeshPaint {
    /// Reads the material files that a mesh names.
    pub fn read(plain: &PlainMesh, clothes: Option<&Clothes>, folder: &Path) -> Self {
        let mut paint = Self { paints: plain.paints.clone(), of_face: plain.face_materials.clone(), ..Self::default() };
        for library in &plain.libraries {
            let Some(text) = paint.text(folder, library) else { continue };
            for (name, shown) in parse_mtl(&text) {
                if let Some(m) = plain.materials.iter().position(|m| *m == name) {
                    paint.paints[m] = shown;
                }
            }
        }
        // MakeHuman's clothes have one material, which their OBJ does not name.
        if let Some(library) = clothes.and_then(|c| c.material.as_deref()).filter(|_| paint.is_bare()) {
            let shown = paint.text(folder, library).map_or(Paint::None, |text| parse_mhmat(&text));
            (paint.paints, paint.of_face) = (vec![shown], vec![Some(0); plain.faces.len()]);
        }
        paint
    }

    fn is_bare(&self) -> bool {
        self.paints.iter().all(|p| *p == Paint::None)
    }

    fn text(&mut self, folder: &Path, name: &str) -> Option<String> {
        let file = Path::new(name).file_name()?;
        self.libraries.push(file.to_string_lossy().into_owned());
        match file::read_text(&folder.join(file), &MATERIALS) {
            Ok(text) => Some(text),
            Err(e) => {
                self.notes.push(format!(
                    "its materials {name} are not shown: {}; put the file beside it, or leave it for the fabric's colour",
                    e.reason()
                ));
                None
            }
        }
    }

    /// Files of the folder that it needs: materials and pictures.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        let pictures = self.paints.iter().filter_map(|p| if let Paint::File(name) = p { Some(&**name) } else { None });
        self.libraries.iter().map(String::as_str).chain(pictures)
    }

    /// Reads the pictures and shows them on the mesh, whose faces are still those of its file. What could not be read is
    /// returned, a sentence each.
    pub fn show(mut self, mesh: &mut ForeignMesh, folder: &Path) -> Vec<String> {
        let mut pictures: Vec<Arc<Texture>> = Vec::new();
        let mut shown = vec![0u8; self.paints.len()];
        // The same paint twice is one picture.
        let mut seen: Vec<(Paint, u8)> = Vec::new();
        for (material, paint) in std::mem::take(&mut self.paints).into_iter().enumerate() {
            if let Some((_, number)) = seen.iter().find(|(known, _)| *known == paint) {
                shown[material] = *number;
                continue;
            }
            let read = match &paint {
                Paint::None => Ok(None),
                _ if pictures.len() == MOST_PICTURES => Err(format!(
                    "the picture of material {} is not shown: a mesh has at most {MOST_PICTURES}",
                    material + 1
                )),
                Paint::Colour(colour) => Ok(Some(Texture::plain(*colour))),
                Paint::Bytes(bytes) => decoded("its picture", bytes),
                Paint::File(name) => file::read(&folder.join(name), &PICTURE)
                    .map_err(|e| format!("its picture {name} is not shown: {}; put it beside the mesh", e.reason()))
                    .and_then(|bytes| decoded(&format!("its picture {name}"), &bytes)),
            };
            let number = match read {
                Ok(Some(picture)) => {
                    pictures.push(Arc::new(picture));
                    pictures.len() as u8
                }
                Ok(None) => 0,
                Err(note) => {
                    self.notes.push(note);
                    0
                }
            };
            shown[material] = number;
            seen.push((paint, number));
        }
        mesh.paint(pictures, &self.of_face, &shown);
        self.notes
    }
}

fn decoded(name: &str, bytes: &[u8]) -> Result<Option<Texture>, String> {
    crate::texture::decode(bytes).map(Some).map_err(|reason| format!("{name} is not shown: {reason}"))
}
