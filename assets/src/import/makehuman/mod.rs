//! MakeHuman's base mesh `hm08`, its targets, rigs and weights, as our [`Body`](toile_base::body::Body).

pub mod clothes;
mod files;
pub mod girths;
mod mesh;
mod rig;

use std::path::Path;

use glam::{Vec2, Vec3};

use super::avatar::raw::{RawBody, RawInfluences, RawJoint};
use super::avatar::{AvatarError, Flaw, ImportOptions, ImportedBody, names, settle};
use files::{json_gz, targets};
use girths::MakehumanGirths;
pub use mesh::BODY_VERTICES;
use mesh::MakehumanMesh;
use toile_bake::shape::NO_VERTEX;
use toile_base::limits::IMPORT_INFLUENCES;

/// Choices that make a body.
#[derive(Debug, Clone, PartialEq)]
pub struct MakehumanOptions {
    /// Targets by their file's name, and how much of each; they add up.
    pub targets: Vec<(String, f32)>,
    /// The rig that carries the body: `game_engine` or `cmu_mb`.
    pub rig: String,
}

impl Default for MakehumanOptions {
    fn default() -> Self {
        Self { targets: Vec::new(), rig: "game_engine".into() }
    }
}

/// A body, what was found in its files, and MakeHuman's own measures of it.
#[derive(Debug, Clone, PartialEq)]
pub struct MakehumanBody {
    /// The body and its report.
    pub imported: ImportedBody,
    /// The girths by MakeHuman's rows of vertices.
    pub girths: MakehumanGirths,
}

/// Makes a body of a folder's files. Texture coordinates are left out: they belong to corners, not to vertices, and
/// cutting the mesh along their seams would open its closed surface.
///
/// # Errors
/// [`AvatarError`], which names the file, what is wrong in it, and the cure.
pub fn read(folder: &Path, choice: &MakehumanOptions, options: &ImportOptions) -> Result<MakehumanBody, AvatarError> {
    check_rig(folder, &choice.rig)?;
    let mut base = MakehumanMesh::read(folder)?;
    targets(folder, &choice.targets, &mut base.positions)?;
    let girths = MakehumanGirths::of(&base.positions, &base.faces).map_err(|flaw| flaw.of(&folder.join("base.obj")))?;
    let raw = raw(folder, &choice.rig, &base)?;
    let imported = settle(raw, options).map_err(|flaw| flaw.of(folder))?;
    Ok(MakehumanBody { imported, girths })
}

/// Where the origin of the base is in a body that was read from it (m): clothes are given about the origin.
///
/// # Errors
/// As [`read`].
pub fn origin(folder: &Path, choice: &MakehumanOptions, body: &toile_base::body::Body) -> Result<Vec3, AvatarError> {
    let mut base = MakehumanMesh::read(folder)?;
    targets(folder, &choice.targets, &mut base.positions)?;
    Ok(base.positions[0] * girths::DECIMETRE - body.mesh.positions[0])
}

/// A rig's name is part of a file's name, and leads to no other folder.
fn check_rig(folder: &Path, rig: &str) -> Result<(), AvatarError> {
    if !rig.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
        let reason = format!("a rig has no name like \"{rig}\"; name one of the folder's rig.*.json files");
        return Err(Flaw::Syntax { reason }.of(folder));
    }
    Ok(())
}

fn raw(folder: &Path, rig: &str, base: &MakehumanMesh) -> Result<RawBody, AvatarError> {
    let joints = rig::joints(&folder.join(format!("rig.{rig}.json")), base)?;
    let influences = influences(&folder.join(format!("weights.{rig}.json.gz")), &joints)?;
    let called: Vec<&str> = joints.iter().map(|j| j.name.as_str()).collect();
    let reading = names::read(&called);
    let positions = base.positions[..BODY_VERTICES].to_vec();
    let triangles = base.faces.iter().flat_map(|&[a, b, c, d]| {
        let second = (d != NO_VERTEX).then_some([a, c, d]);
        std::iter::once([a, b, c]).chain(second)
    });
    Ok(RawBody {
        normals: vec![Vec3::ZERO; positions.len()],
        uvs: vec![Vec2::ZERO; positions.len()],
        triangles: triangles.collect(),
        positions,
        joints,
        reading,
        influences,
        ..RawBody::default()
    })
}

/// The weights of the body's vertices: the file lists the vertices of each bone.
fn influences(path: &Path, joints: &[RawJoint]) -> Result<Vec<RawInfluences>, AvatarError> {
    let wrong = |reason: String| Flaw::Syntax { reason }.of(path);
    let json = json_gz(path)?;
    let bones =
        json["weights"].as_object().ok_or_else(|| wrong("it has no weights; use MakeHuman's own file".into()))?;
    let mut out = vec![RawInfluences::default(); BODY_VERTICES];
    let mut used = vec![0usize; BODY_VERTICES];
    for (name, pairs) in bones {
        let Some(pairs) = pairs.as_array().filter(|p| !p.is_empty()) else { continue };
        let joint = joints.iter().position(|j| j.name == *name);
        let joint =
            joint.ok_or_else(|| wrong(format!("its bone \"{name}\" is not in the rig; use the rig's weights")))?;
        for pair in pairs {
            let vertex = pair[0].as_u64().map_or(usize::MAX, |v| v as usize);
            let weight = pair[1].as_f64().unwrap_or(f64::NAN) as f32;
            if vertex >= BODY_VERTICES || weight == 0.0 {
                continue;
            }
            if used[vertex] == IMPORT_INFLUENCES {
                return Err(wrong(format!(
                    "vertex {vertex} has weights for more than {IMPORT_INFLUENCES} bones; limit them to that"
                )));
            }
            out[vertex].0[used[vertex]] = (joint as u16, weight);
            used[vertex] += 1;
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests;
