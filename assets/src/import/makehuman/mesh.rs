//! The base mesh `hm08`: its vertices, the faces of the body, the cubes that mark joints.

use std::collections::BTreeMap;
use std::path::Path;

use glam::Vec3;

use super::files::text;
use crate::import::avatar::{AvatarError, Flaw};
use crate::import::plain::parse_obj;
use toile_bake::shape::NO_VERTEX;

/// Vertices of the body: those after them are helpers, eyes, teeth and the cubes that mark joints.
pub const BODY_VERTICES: usize = 13_380;

/// The base with targets added.
pub(super) struct MakehumanMesh {
    /// All vertices (dm).
    pub(super) positions: Vec<Vec3>,
    /// Faces of the body.
    pub(super) faces: Vec<[u32; 4]>,
    /// The vertices of each group that marks a joint.
    pub(super) cubes: Vec<(String, Vec<u32>)>,
}

impl MakehumanMesh {
    pub(super) fn read(folder: &Path) -> Result<Self, AvatarError> {
        let path = folder.join("base.obj");
        let text = text(&path)?;
        let wrong = |reason: String| Flaw::Syntax { reason }.of(&path);
        let mesh = parse_obj(&text).map_err(wrong)?;
        if mesh.positions.len() <= BODY_VERTICES {
            let count = mesh.positions.len();
            return Err(wrong(format!("it has {count} vertices, too few for hm08; give the folder of that base mesh")));
        }
        let body = |face: &&[u32; 4]| face.iter().all(|v| (*v as usize) < BODY_VERTICES || *v == NO_VERTEX);
        let faces = mesh.faces.iter().filter(body).copied().collect();
        Ok(Self { positions: mesh.positions, faces, cubes: cubes(&text) })
    }
}

/// The vertices of each group of faces that marks a joint.
fn cubes(obj: &str) -> Vec<(String, Vec<u32>)> {
    let mut groups: BTreeMap<&str, Vec<u32>> = BTreeMap::new();
    let mut group = "";
    for line in obj.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("g") => group = words.next().unwrap_or_default(),
            Some("f") if group.starts_with("joint-") => {
                let corners = words.filter_map(|w| w.split('/').next()?.parse::<u32>().ok()?.checked_sub(1));
                groups.entry(group).or_default().extend(corners);
            }
            _ => {}
        }
    }
    let sorted = |(name, mut vertices): (&str, Vec<u32>)| {
        vertices.sort_unstable();
        vertices.dedup();
        (name.to_owned(), vertices)
    };
    groups.into_iter().map(sorted).collect()
}
