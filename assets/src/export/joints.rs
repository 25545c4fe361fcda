//! The skeleton as a tree of nodes: where each bone stands beside its parent.

use glam::{Affine3A, DMat4, DQuat, DVec3, Mat4, Quat, Vec3};
use serde_json::{Value, json};

use toile_base::body::Body;
use toile_base::skeleton::{BONES, Joint, bone_joint, bone_name};

/// Where a bone stands beside its parent: the pelvis, in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LocalBone {
    /// From its parent's origin (m).
    pub translation: Vec3,
    pub rotation: Quat,
}

/// Parent of each bone; the pelvis has none.
pub(super) fn parent(bone: usize) -> Option<usize> {
    match Joint::ALL.get(bone) {
        Some(joint) => joint.parent().map(Joint::index),
        None => bone_joint(bone).map(Joint::index),
    }
}

/// Each bone beside its parent in a pose, given as skin matrices (rest to world, rigid); `None` is the rest pose. In f64, so that
/// a hand at the end of its chain is where the matrices have it.
pub(super) fn local_bones(body: &Body, palette: Option<&[Affine3A; BONES]>) -> [LocalBone; BONES] {
    let rest = body.skeleton.bone_origins();
    let world: [DMat4; BONES] = std::array::from_fn(|b| {
        let skin = palette.map_or(Mat4::IDENTITY, |p| Mat4::from(p[b])).as_dmat4();
        skin * DMat4::from_translation(rest[b].as_dvec3())
    });
    std::array::from_fn(|b| {
        let local = parent(b).map_or(world[b], |p| world[p].inverse() * world[b]);
        let (_, turn, at): (DVec3, DQuat, DVec3) = local.to_scale_rotation_translation();
        LocalBone { translation: at.as_vec3(), rotation: turn.normalize().as_quat() }
    })
}

/// Inverse bind matrices of the rest pose.
pub(super) fn inverse_binds(body: &Body) -> Vec<Mat4> {
    body.skeleton.bone_origins().iter().map(|p| Mat4::from_translation(-*p)).collect()
}

/// The nodes of the bones, in their order, of which the first has this number.
pub(super) fn nodes(bones: &[LocalBone; BONES], first: usize) -> Vec<Value> {
    let node = |(bone, local): (usize, &LocalBone)| {
        let children: Vec<usize> = (0..BONES).filter(|b| parent(*b) == Some(bone)).map(|b| b + first).collect();
        let mut node =
            json!({ "name": bone_name(bone).unwrap_or_default(), "translation": local.translation.to_array() });
        let turn = local.rotation;
        if turn.x != 0.0 || turn.y != 0.0 || turn.z != 0.0 {
            node["rotation"] = json!(turn.to_array());
        }
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        node
    };
    bones.iter().enumerate().map(node).collect()
}
