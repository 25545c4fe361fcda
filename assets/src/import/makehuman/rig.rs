//! MakeHuman's rigs: each bone begins at the middle of a marking cube, of some vertices, or at one vertex.

use std::path::Path;

use glam::Vec3;
use serde_json::Value;

use super::files::text;
use super::mesh::MakehumanMesh;
use crate::import::avatar::raw::RawJoint;
use crate::import::avatar::{AvatarError, Flaw};
use toile_base::limits::MAX_BODY_NODES;

/// The bones of a rig, each where it begins on the base (dm).
pub(super) fn joints(path: &Path, base: &MakehumanMesh) -> Result<Vec<RawJoint>, AvatarError> {
    let wrong = |reason: String| Flaw::Syntax { reason }.of(path);
    let json: Value =
        serde_json::from_str(&text(path)?).map_err(|e| wrong(format!("{e}; use MakeHuman's own file")))?;
    let bones = json["bones"].as_object().or(json.as_object());
    let bones = bones
        .filter(|b| b.len() <= MAX_BODY_NODES)
        .ok_or_else(|| wrong("it is no rig; use MakeHuman's own file".into()))?;
    let names: Vec<&str> = bones.keys().map(String::as_str).collect();
    let joint = |(name, bone): (&String, &Value)| {
        let parent = match bone["parent"].as_str().filter(|p| !p.is_empty()) {
            Some(parent) => Some(names.iter().position(|n| *n == parent).ok_or(format!(
                "the parent of bone \"{name}\", \"{parent}\", is not there; use MakeHuman's own file"
            ))?),
            None => None,
        };
        let at = head(&bone["head"], base)
            .ok_or(format!("bone \"{name}\" begins nowhere on the base; use MakeHuman's own file"))?;
        Ok(RawJoint { name: name.clone(), parent, at })
    };
    let joints: Vec<RawJoint> = bones.iter().map(joint).collect::<Result<_, String>>().map_err(wrong)?;
    for joint in &joints {
        let mut next = joint.parent;
        for _ in 0..=joints.len() {
            next = next.and_then(|p| joints[p].parent);
        }
        if next.is_some() {
            return Err(Flaw::Cycle { node: joint.name.clone() }.of(path));
        }
    }
    Ok(joints)
}

/// Start of a bone (dm).
fn head(head: &Value, base: &MakehumanMesh) -> Option<Vec3> {
    let number = |v: &Value| v.as_u64().and_then(|v| u32::try_from(v).ok());
    let vertices: Vec<u32> = match head["strategy"].as_str()? {
        "CUBE" => base.cubes.iter().find(|(name, _)| Some(name.as_str()) == head["cube_name"].as_str())?.1.clone(),
        "MEAN" => head["vertex_indices"].as_array()?.iter().map(number).collect::<Option<_>>()?,
        "VERTEX" => vec![number(&head["vertex_index"])?],
        _ => return None,
    };
    let sum = vertices.iter().map(|v| base.positions.get(*v as usize).copied()).sum::<Option<Vec3>>()?;
    (!vertices.is_empty()).then(|| sum / vertices.len() as f32)
}
