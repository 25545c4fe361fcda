//! Bodies that others made, as our [`Body`]: skinned glTF 2.0 meshes and VRM avatars.

mod animation;
mod carry;
mod error;
mod imported;
mod moving;
pub mod names;
mod nodes;
pub(crate) mod raw;
mod rest;
mod skinned;
pub mod surface;
mod survey;
#[cfg(test)]
pub(crate) mod tests;

use std::path::{Path, PathBuf};

use glam::Vec3;

use crate::file::{self, FileError, FileKind};
use crate::import::gltf::file::GltfFile;
use animation::GltfClip;
pub use carry::PruningLoss;
pub use error::{AvatarError, Flaw};
pub use imported::{ImportReport, ImportedBody};
pub use moving::MovingBody;
use moving::MovingSkin;
use raw::RawBody;
use surface::SurfaceCheck;
use toile_base::body::{Body, Region, Sex};
use toile_base::limits::MAX_BODY_BYTES;
use toile_base::mesh::{Mesh, vertex_normals};
use toile_base::skeleton::{Joint, Skeleton};

/// How a body is to be imported.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportOptions {
    /// Whose garments the body is given: a file does not say it.
    pub sex: Sex,
    /// Names of the meshes to take; empty takes all that are skinned.
    pub meshes: Vec<String>,
    /// Whether the surface may be open outside of the head too.
    pub allow_holes: bool,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self { sex: Sex::Female, meshes: Vec::new(), allow_holes: false }
    }
}

/// Imports the skinned meshes of a `.gltf`, `.glb` or `.vrm` file.
///
/// # Errors
/// [`AvatarError`], which names the file, what is wrong in it, and the cure.
pub fn read(path: &Path, options: &ImportOptions) -> Result<ImportedBody, AvatarError> {
    with_file(path, |bytes, beside| parse(bytes, beside, options))
}

/// The same with one of the file's animations, by its name.
///
/// # Errors
/// [`AvatarError`], which names the file, what is wrong in it, and the cure.
pub fn read_moving(path: &Path, animation: &str, options: &ImportOptions) -> Result<MovingBody, AvatarError> {
    with_file(path, |bytes, beside| parse_moving(bytes, beside, animation, options))
}

/// Reads a file; its buffers lie beside it or inside.
fn with_file<T>(
    path: &Path,
    parse: impl FnOnce(&[u8], crate::import::gltf::ReadBeside<'_>) -> Result<T, Flaw>,
) -> Result<T, AvatarError> {
    let bytes = load(path).map_err(|flaw| flaw.of(path))?;
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    let beside = |name: &str| {
        let plain = Path::new(name).components().all(|c| matches!(c, std::path::Component::Normal(_)));
        let file: PathBuf = folder.join(name);
        if !plain {
            return Err(format!("its buffer \"{name}\" lies outside of its folder; put it beside the file"));
        }
        load(&file).map_err(|flaw| format!("its buffer {name}: {flaw}"))
    };
    parse(&bytes, &beside).map_err(|flaw| flaw.of(path))
}

/// A file of a body, or one that it names.
const BODY_FILE: FileKind =
    FileKind { name: "a body", max_bytes: MAX_BODY_BYTES, cure: "reduce its mesh and its pictures" };

/// A file's bytes, if they are no more than a body has.
pub(crate) fn load(path: &Path) -> Result<Vec<u8>, Flaw> {
    file::read(path, &BODY_FILE).map_err(|e| match e {
        FileError::TooLarge { bytes: Some(bytes), .. } => Flaw::TooLarge { bytes },
        other => Flaw::Read { reason: other.reason() },
    })
}

/// Imports a file's bytes; `beside` reads the buffers that lie beside it.
///
/// # Errors
/// [`Flaw`], to stand behind the file's name.
pub fn parse(
    bytes: &[u8],
    beside: crate::import::gltf::ReadBeside<'_>,
    options: &ImportOptions,
) -> Result<ImportedBody, Flaw> {
    let file = GltfFile::open(bytes, beside)?;
    settle(skinned::read(&file, &options.meshes)?.0, options)
}

/// The same with one of the file's animations, by its name.
///
/// # Errors
/// [`Flaw`], to stand behind the file's name.
pub fn parse_moving(
    bytes: &[u8],
    beside: crate::import::gltf::ReadBeside<'_>,
    animation: &str,
    options: &ImportOptions,
) -> Result<MovingBody, Flaw> {
    let file = GltfFile::open(bytes, beside)?;
    let (mut raw, joints) = skinned::read(&file, &options.meshes)?;
    let clip = GltfClip::read(&file, &joints, animation)?;
    let placement = place(&mut raw)?;
    let skin = MovingSkin::new(&raw, joints, clip, placement.2.matrix());
    MovingBody::new(finish(raw, placement, options)?, skin)
}

/// Makes a raw body ours.
pub(crate) fn settle(mut raw: RawBody, options: &ImportOptions) -> Result<ImportedBody, Flaw> {
    let placement = place(&mut raw)?;
    finish(raw, placement, options)
}

/// Checks a raw body and sets it upright in our axes and unit.
fn place(raw: &mut RawBody) -> Result<(Skeleton, Vec<Joint>, rest::RestPlacement), Flaw> {
    raw.check()?;
    rest::stand(raw)
}

fn finish(
    mut raw: RawBody,
    (skeleton, placed, _): (Skeleton, Vec<Joint>, rest::RestPlacement),
    options: &ImportOptions,
) -> Result<ImportedBody, Flaw> {
    let (weights, pruned) = carry::weights(&raw, &skeleton, &placed);
    let surface = SurfaceCheck::of(&raw.positions, &raw.triangles);
    let mesh = Mesh {
        uvs: if raw.has_uvs { std::mem::take(&mut raw.uvs) } else { Vec::new() },
        positions: std::mem::take(&mut raw.positions),
        triangles: std::mem::take(&mut raw.triangles),
    };
    let normals = normals(&mesh, &surface, &raw.normals);
    let survey = survey::survey(&mesh, &weights, &skeleton, options.sex)?;
    if !options.allow_holes {
        check_holes(&mesh, &surface, &survey.regions, skeleton.at(Joint::Neck).y)?;
    }
    let report = ImportReport {
        dialect: raw.reading.dialect,
        joints: found(&raw),
        pruned,
        parts: surface.parts,
        boundary_edges: surface.boundary.len(),
        crowded_edges: surface.crowded,
        notes: raw.notes,
    };
    let survey::BodySurvey { regions, levels, measures } = survey;
    let body = Body { sex: options.sex, mesh, normals, skeleton, weights, regions, levels, measures };
    Ok(ImportedBody { body, report })
}

fn found(raw: &RawBody) -> Vec<(String, String)> {
    let name =
        |j: Joint| Some((names::HANIM.names(j).remove(0), raw.joints[raw.reading.places[j.index()]?].name.clone()));
    Joint::ALL.into_iter().filter_map(name).collect()
}

/// The file's normals; where it has none, those of the surface, smooth across seams.
fn normals(mesh: &Mesh, surface: &SurfaceCheck, given: &[Vec3]) -> Vec<Vec3> {
    let welded: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(|v| surface.first[v as usize])).collect();
    let mut smooth = vec![Vec3::ZERO; mesh.positions.len()];
    vertex_normals(&mesh.positions, &welded, &mut smooth);
    let normal = |(v, n): (usize, &Vec3)| match *n == Vec3::ZERO {
        true => smooth[surface.first[v] as usize].try_normalize().unwrap_or(Vec3::Y),
        false => *n,
    };
    given.iter().enumerate().map(normal).collect()
}

/// Refuses holes where garments lie and tapes go. Eyes, mouths and seams of the head are often open, and do no harm.
fn check_holes(mesh: &Mesh, surface: &SurfaceCheck, regions: &[Region], neck: f32) -> Result<(), Flaw> {
    let on_head = |v: u32| regions[v as usize] == Region::Head || mesh.positions[v as usize].y > neck;
    let open: Vec<&[u32; 2]> = surface.boundary.iter().filter(|e| !e.iter().all(|v| on_head(*v))).collect();
    match open.first() {
        None => Ok(()),
        Some(&&[a, _]) => {
            let p = mesh.positions[a as usize];
            Err(Flaw::Hole { count: open.len(), x: p.x, y: p.y, z: p.z })
        }
    }
}
