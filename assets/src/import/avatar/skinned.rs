//! The skinned meshes of a glTF file in their bind pose, and the joints that they are bound to.
//!
//! A skin's inverse bind matrices say where each joint stood when the mesh was bound: `inverse(B)` is that place in the
//! mesh's own space, and `J B`, with `J` the joint's place in the scene, carries the mesh from its space to the scene
//! (Khronos glTF 2.0, section 3.7.3). The hips' `J B` is used for the whole mesh, so that its unit and axes are the
//! scene's but its pose is the one it was bound in. A skin without these matrices has, by the specification, identity:
//! its mesh is then taken as the scene's own pose shows it.

use std::collections::BTreeSet;

use glam::{Mat3, Mat4, Vec2, Vec3};
use serde_json::Value;

use super::error::Flaw;
use super::names;
use super::nodes::GltfNodes;
use super::raw::{RawBody, RawInfluences, RawJoint};
use crate::import::gltf::file::{GltfFile, index, list};
use toile_base::limits::MAX_BODY_VERTICES;
use toile_base::skeleton::Joint;

/// Attribute sets of joints and weights that are read: eight influences.
const SETS: [[&str; 2]; 2] = [["JOINTS_0", "WEIGHTS_0"], ["JOINTS_1", "WEIGHTS_1"]];

/// A node that shows a skinned mesh.
struct SkinnedNode {
    mesh: usize,
    skin: usize,
}

/// One skin: its joints, and how each carries the mesh.
struct GltfSkin {
    joints: Vec<usize>,
    /// None where the file has none: identity.
    inverse: Option<Vec<Mat4>>,
    /// From the mesh's space to the scene, in the bind pose.
    place: Mat4,
}

/// The joints of a raw body as the file has them, in the order of the raw ones.
pub(super) struct BoundJoints {
    /// All nodes of the file.
    pub nodes: GltfNodes,
    /// The node of each joint.
    pub of: Vec<usize>,
    /// Where each stood when the mesh was bound, in the file's space.
    pub bound: Vec<Mat4>,
}

/// Reads the skinned meshes of a file, or those of the names `wanted` where there are any.
pub(super) fn read(file: &GltfFile, wanted: &[String]) -> Result<(RawBody, BoundJoints), Flaw> {
    let nodes = GltfNodes::read(&file.json)?;
    let shown = shown(&file.json, wanted)?;
    let used: BTreeSet<usize> = shown.iter().map(|s| s.skin).collect();
    let mut bones = BTreeSet::new();
    for &skin in &used {
        bones.extend(joint_list(file, &nodes, skin)?);
    }
    let bones = nodes.with_ancestors(&bones);
    nodes.check_scales(&bones)?;
    let called: Vec<&str> = bones.iter().map(|&n| nodes.called(n)).collect();
    let reading = names::read(&called);
    let hips = reading.places[Joint::Pelvis.index()].map(|k| bones[k]);
    let mut skins: Vec<Option<GltfSkin>> = list(&file.json["skins"]).iter().map(|_| None).collect();
    for &skin in &used {
        skins[skin] = Some(open_skin(file, &nodes, skin, hips)?);
    }
    let bound = bound(&nodes, &bones, &skins);
    let mut raw = RawBody { joints: raw_joints(&nodes, &bones, &bound), reading, ..RawBody::default() };
    if skins.iter().flatten().any(|skin| skin.inverse.is_none()) {
        raw.notes.push("it has no inverse bind matrices, so its rest pose is the one that its nodes show".into());
    }
    let left_out = left_out(&file.json);
    if left_out > 0 {
        raw.notes.push(format!("{left_out} meshes without a skin are left out"));
    }
    for item in &shown {
        let Some(skin) = &skins[item.skin] else { continue };
        for primitive in list(&file.json["meshes"][item.mesh]["primitives"]) {
            add(file, &nodes, &bones, skin, primitive, &mut raw)?;
        }
    }
    Ok((raw, BoundJoints { nodes, of: bones, bound }))
}

/// The nodes that show a skinned mesh.
fn shown(json: &Value, wanted: &[String]) -> Result<Vec<SkinnedNode>, Flaw> {
    let mut shown = Vec::new();
    let mut known = Vec::new();
    for node in list(&json["nodes"]) {
        let (Some(mesh), Some(skin)) = (index(&node["mesh"]), index(&node["skin"])) else { continue };
        if !json["meshes"][mesh].is_object() || !json["skins"][skin].is_object() {
            return Err(Flaw::syntax("a node names a mesh or a skin that is not there; export it again"));
        }
        let names = [&node["name"], &json["meshes"][mesh]["name"]].map(|n| n.as_str().unwrap_or_default());
        if wanted.is_empty() || names.iter().any(|n| wanted.iter().any(|w| w == n)) {
            shown.push(SkinnedNode { mesh, skin });
        }
        known.push(names[0].to_owned());
    }
    match (shown.is_empty(), wanted.first()) {
        (false, _) => Ok(shown),
        (true, Some(name)) if !known.is_empty() => Err(Flaw::NoMesh { name: name.clone(), known: known.join(", ") }),
        (true, _) => Err(Flaw::NoSkin),
    }
}

/// Meshes that are bound to no skeleton.
fn left_out(json: &Value) -> usize {
    list(&json["nodes"]).iter().filter(|n| index(&n["mesh"]).is_some() && index(&n["skin"]).is_none()).count()
}

fn joint_list(file: &GltfFile, nodes: &GltfNodes, skin: usize) -> Result<Vec<usize>, Flaw> {
    let joints: Vec<usize> = list(&file.json["skins"][skin]["joints"]).iter().filter_map(index).collect();
    if joints.is_empty() {
        return Err(Flaw::syntax(format!("its skin {skin} has no joints; export the body with its armature")));
    }
    match joints.iter().find(|j| **j >= nodes.len()) {
        Some(j) => {
            Err(Flaw::syntax(format!("its skin {skin} names the joint {j} of {}; export it again", nodes.len())))
        }
        None => Ok(joints),
    }
}

fn open_skin(file: &GltfFile, nodes: &GltfNodes, skin: usize, hips: Option<usize>) -> Result<GltfSkin, Flaw> {
    let joints = joint_list(file, nodes, skin)?;
    let Some(accessor) = index(&file.json["skins"][skin]["inverseBindMatrices"]) else {
        return Ok(GltfSkin { joints, inverse: None, place: Mat4::IDENTITY });
    };
    let inverse: Vec<Mat4> = file.floats::<16>(accessor)?.iter().map(Mat4::from_cols_array).collect();
    if inverse.len() < joints.len() {
        let (have, need) = (inverse.len(), joints.len());
        return Err(Flaw::syntax(format!(
            "its skin {skin} has {have} inverse bind matrices for {need} joints; export it again"
        )));
    }
    for (matrix, &joint) in inverse.iter().zip(&joints) {
        let usable = matrix.is_finite() && matrix.row(3) == glam::Vec4::W && matrix.inverse().is_finite();
        if !usable || matrix.determinant() <= 0.0 {
            return Err(Flaw::InverseBind { joint: nodes.name(joint).into() });
        }
    }
    let anchor = joints.iter().position(|j| Some(*j) == hips).unwrap_or(0);
    let place = nodes.global(joints[anchor]) * inverse[anchor];
    Ok(GltfSkin { joints, inverse: Some(inverse), place })
}

/// Where each joint stood when the first skin that has it was bound; what no skin has stands where the file's nodes show it.
fn bound(nodes: &GltfNodes, bones: &[usize], skins: &[Option<GltfSkin>]) -> Vec<Mat4> {
    let bound = |node: usize| {
        skins.iter().flatten().find_map(|skin| {
            let k = skin.joints.iter().position(|j| *j == node)?;
            Some(skin.place * skin.inverse.as_ref()?[k].inverse())
        })
    };
    bones.iter().map(|&node| bound(node).unwrap_or_else(|| nodes.global(node))).collect()
}

/// The joints and what is above them, where they were bound.
fn raw_joints(nodes: &GltfNodes, bones: &[usize], bound: &[Mat4]) -> Vec<RawJoint> {
    let joint = |(&node, bound): (&usize, &Mat4)| RawJoint {
        name: nodes.name(node).into(),
        parent: nodes.parent(node).and_then(|p| bones.binary_search(&p).ok()),
        at: bound.transform_point3(Vec3::ZERO),
    };
    bones.iter().zip(bound).map(joint).collect()
}

/// Adds the triangles of one primitive.
fn add(
    file: &GltfFile,
    nodes: &GltfNodes,
    bones: &[usize],
    skin: &GltfSkin,
    primitive: &Value,
    raw: &mut RawBody,
) -> Result<(), Flaw> {
    match primitive["mode"].as_u64().unwrap_or(4) {
        4 => {}
        0..=3 => return Ok(()),
        _ => return Err(Flaw::syntax("it holds strips or fans of triangles; export plain triangles")),
    }
    let attribute = |name: &str| index(&primitive["attributes"][name]);
    let missing = "it has a part without plain positions; export without compression";
    let accessor = attribute("POSITION").ok_or_else(|| Flaw::syntax(missing))?;
    let first = raw.positions.len();
    let count = file.count(accessor)?;
    if count > MAX_BODY_VERTICES - first {
        return Err(Flaw::Vertices { count: first.saturating_add(count) });
    }
    let influences = influences(file, bones, skin, primitive, first, count)?;
    let positions = file.floats::<3>(accessor)?.into_iter().map(Vec3::from);
    let carry = |(v, p): (usize, Vec3)| skin.carry(nodes, bones, &influences[v]).transform_point3(p);
    let placed: Vec<Vec3> = positions.enumerate().map(carry).collect();
    let equal = |what: &str, have: usize| match have == count {
        true => Ok(()),
        false => Err(Flaw::syntax(format!("it has {have} {what} for {count} positions; export it again"))),
    };
    match attribute("NORMAL") {
        Some(accessor) => {
            let normals = file.floats::<3>(accessor)?;
            equal("normals", normals.len())?;
            let turn = |(v, n): (usize, [f32; 3])| {
                let carrier = Mat3::from_mat4(skin.carry(nodes, bones, &influences[v]));
                (carrier.inverse().transpose() * Vec3::from(n)).normalize_or_zero()
            };
            raw.normals.extend(normals.into_iter().enumerate().map(turn));
        }
        None => raw.normals.resize(first + count, Vec3::ZERO),
    }
    match attribute("TEXCOORD_0") {
        Some(accessor) => {
            let uvs = file.floats::<2>(accessor)?;
            equal("texture coordinates", uvs.len())?;
            raw.uvs.extend(uvs.into_iter().map(Vec2::from));
            raw.has_uvs = true;
        }
        None => raw.uvs.resize(first + count, Vec2::ZERO),
    }
    raw.positions.extend(placed);
    raw.influences.extend(influences);
    add_triangles(file, primitive, first, count, raw)
}

fn add_triangles(
    file: &GltfFile,
    primitive: &Value,
    first: usize,
    count: usize,
    raw: &mut RawBody,
) -> Result<(), Flaw> {
    let corners: Vec<u32> = match index(&primitive["indices"]) {
        Some(accessor) => file.integers::<1>(accessor)?.into_iter().flatten().collect(),
        None => (0..count as u32).collect(),
    };
    if let Some(v) = corners.iter().find(|v| **v as usize >= count) {
        return Err(Flaw::syntax(format!("a triangle names vertex {v} of {count}; export it again")));
    }
    raw.triangles.extend(corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|v| v + first as u32)));
    Ok(())
}

/// The joints and weights of each vertex, as indices of the raw joints.
fn influences(
    file: &GltfFile,
    bones: &[usize],
    skin: &GltfSkin,
    primitive: &Value,
    first: usize,
    count: usize,
) -> Result<Vec<RawInfluences>, Flaw> {
    let mut out = vec![RawInfluences::default(); count];
    for (set, names) in SETS.iter().enumerate() {
        let [joints, weights] = names.map(|name| index(&primitive["attributes"][name]));
        let (Some(joints), Some(weights)) = (joints, weights) else {
            if set == 0 {
                return Err(Flaw::syntax(
                    "a part of the mesh has no joints or weights; bind all of it to its armature",
                ));
            }
            break;
        };
        let (joints, weights) = (file.integers::<4>(joints)?, file.floats::<4>(weights)?);
        if joints.len() != count || weights.len() != count {
            let have = joints.len().min(weights.len());
            return Err(Flaw::syntax(format!(
                "it has weights of {have} vertices for {count} positions; export it again"
            )));
        }
        for (v, (joints, weights)) in joints.iter().zip(&weights).enumerate() {
            for k in 0..4 {
                if weights[k] == 0.0 {
                    continue;
                }
                let missing = Flaw::JointRange { vertex: first + v, joint: joints[k], joints: skin.joints.len() };
                let node = skin.joints.get(joints[k] as usize).ok_or(missing)?;
                // Every joint of a used skin is among the bones.
                let bone = bones.binary_search(node).unwrap_or(0);
                out[v].0[4 * set + k] = (bone as u16, weights[k]);
            }
        }
    }
    Ok(out)
}

impl GltfSkin {
    /// What carries a vertex from its mesh's space to the scene.
    fn carry(&self, nodes: &GltfNodes, bones: &[usize], influences: &RawInfluences) -> Mat4 {
        if self.inverse.is_some() {
            return self.place;
        }
        let weighted = influences.0.iter().map(|(bone, w)| nodes.global(bones[*bone as usize]) * *w);
        weighted.fold(Mat4::ZERO, |sum, m| sum + m)
    }
}
