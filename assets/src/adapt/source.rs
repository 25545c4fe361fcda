//! The files of a mesh of the user's own: the mesh, the measures and the clothes file beside it.

use std::path::Path;

use super::error::AdaptError;
use super::measures::GarmentMeasures;
use super::mesh::ForeignMesh;
use super::paint::MeshPaint;
use crate::file::{self, FileKind};
use crate::import::gltf::parse_gltf;
use crate::import::makehuman::clothes::Clothes;
use crate::import::obj::MAX_BYTES;
use crate::import::plain::{PlainMesh, parse_obj};
use toile_bake::check::{MAX_VERTICES, MeshError};

/// Limits of a mesh file of a garment.
const MESH_FILE: FileKind =
    FileKind { name: "an OBJ, glTF or GLB file", max_bytes: MAX_BYTES, cure: "reduce the mesh before exporting" };

/// Measures beside a mesh: two dozen lines.
const MEASURES_FILE: FileKind =
    FileKind { name: "a file of measures", max_bytes: 1 << 16, cure: "give the measures of one garment a file" };

/// Coordinates beyond this are no garment's in any unit, and their products have no room in single precision.
const FARTHEST: f32 = 1e6;

/// Content of a mesh's files.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFiles {
    /// The file, as the user gave it.
    pub path: String,
    /// The mesh as its file has it.
    pub mesh: ForeignMesh,
    /// Its measures; all left out where there is no file.
    pub measures: GarmentMeasures,
    /// How MakeHuman binds it, where there is such a file.
    pub clothes: Option<Clothes>,
    /// What of its pictures could not be read, a sentence each.
    pub notes: Vec<String>,
}

/// The files of its folder that a mesh needs to show its materials; none of a mesh that cannot be read.
pub fn material_files(path: &Path) -> Vec<String> {
    let Ok(plain) = read_plain(path) else { return Vec::new() };
    let clothes = Clothes::read(&path.with_extension("mhclo")).ok();
    let paint = MeshPaint::read(&plain, clothes.as_ref(), path.parent().unwrap_or(Path::new("")));
    paint.files().map(str::to_owned).collect()
}

/// Whether a name may be that of a mesh.
pub fn is_mesh(name: &str) -> bool {
    [".obj", ".gltf", ".glb"].iter().any(|ending| name.to_lowercase().ends_with(ending))
}

/// Reads a mesh and what lies beside it.
///
/// # Errors
/// One sentence: the file and its fault.
pub fn read(path: &Path) -> Result<MeshFiles, AdaptError> {
    let shown = path.display().to_string();
    let plain = read_plain(path)?;
    check(&plain).map_err(|flaw| AdaptError::Mesh { path: shown.clone(), flaw })?;
    let measures = path.with_extension("toml");
    let measures = match measures.is_file() {
        true => GarmentMeasures::parse(&measures.display().to_string(), &file::read_text(&measures, &MEASURES_FILE)?)?,
        false => GarmentMeasures::default(),
    };
    let clothes = path.with_extension("mhclo");
    let clothes = if clothes.is_file() { Some(Clothes::read(&clothes)?) } else { None };
    if let Some(bound) = clothes.as_ref().map(Clothes::vertices).filter(|n| *n != plain.positions.len()) {
        let flaw = format!(
            "the clothes file beside it binds {bound} vertices, and it has {}; put the file there that it was made with",
            plain.positions.len()
        );
        return Err(AdaptError::Mesh { path: shown, flaw });
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut mesh = ForeignMesh::of(&plain);
    let notes = MeshPaint::read(&plain, clothes.as_ref(), folder).show(&mut mesh, folder);
    Ok(MeshFiles { path: shown, mesh, measures, clothes, notes })
}

fn read_plain(path: &Path) -> Result<PlainMesh, AdaptError> {
    let wrong = |flaw: String| AdaptError::Mesh { path: path.display().to_string(), flaw };
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if !matches!(ending.as_str(), "gltf" | "glb") {
        return parse_obj(&file::read_text(path, &MESH_FILE)?).map_err(wrong);
    }
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    let beside = |name: &str| {
        let plain = Path::new(name).components().all(|c| matches!(c, std::path::Component::Normal(_)));
        if !plain {
            return Err(format!("its buffer \"{name}\" lies outside of its folder; put it beside the file"));
        }
        file::read(&folder.join(name), &MESH_FILE).map_err(|e| format!("its buffer {name}: {}", e.reason()))
    };
    parse_gltf(&file::read(path, &MESH_FILE)?, &beside).map_err(wrong)
}

/// Refuses a mesh with errors that cannot be repaired.
fn check(mesh: &PlainMesh) -> Result<(), String> {
    let flaw = |error: MeshError| Err(mesh.flaw(&error, |v| v as usize, |f| f));
    if mesh.faces.is_empty() {
        return flaw(MeshError::Empty);
    }
    if mesh.positions.len() > MAX_VERTICES {
        return flaw(MeshError::TooLarge { count: mesh.positions.len() });
    }
    match mesh.positions.iter().position(|p| !p.is_finite() || p.abs().max_element() > FARTHEST) {
        Some(vertex) if mesh.positions[vertex].is_finite() => {
            let line = mesh.vertex_lines.get(vertex).map_or_else(String::new, |l| format!(" (line {l})"));
            Err(format!("vertex {}{line} lies beyond {FARTHEST} units; export the mesh again, in metres", vertex + 1))
        }
        Some(vertex) => flaw(MeshError::NotFinite { vertex }),
        None => Ok(()),
    }
}
