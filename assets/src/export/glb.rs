//! A dressed body as GLB, the binary form of glTF 2.0: it opens in Blender and in every viewer of the format.
//!
//! The body is skinned to its skeleton (H-Anim names, inverse bind matrices of the rest pose, four weights a vertex), whose
//! nodes stand in the pose asked for; garments lie around it as plain meshes, in the world. Metres, y up, facing +z, as
//! the format has it. Colours are linear, as the format wants them, from the sRGB that fabrics state.

use glam::{Affine3A, Vec3};
use serde_json::{Value, json};

use super::joints;
use super::material::material;
use super::parts::GlbBuffer;
use super::surface::{SurfaceLook, linear};
use toile_base::body::Body;
use toile_base::mesh::vertex_normals;
use toile_base::skeleton::{BONES, Joint};

/// sRGB of the body: the mannequin's warm light grey-beige.
const SKIN_SRGB: [f32; 3] = [0.797, 0.754, 0.711];

/// A body with its garments, to be exported.
#[derive(Debug, Clone, Copy)]
pub struct DressedBody<'a> {
    /// The body in its rest pose.
    pub body: &'a Body,
    /// The pose, as skin matrices (rest to world, rigid) `[BONES]`; `None` is the rest pose.
    pub palette: Option<&'a [Affine3A; BONES]>,
    /// Garments on it, inner first.
    pub worn: &'a [WornGarment<'a>],
}

/// A garment as it lies.
#[derive(Debug, Clone, Copy)]
pub struct WornGarment<'a> {
    /// Name of the garment.
    pub name: &'a str,
    /// Vertex positions, world (m) `[vertices]`.
    pub positions: &'a [Vec3],
    /// Indices into `positions` `[triangles]`.
    pub triangles: &'a [[u32; 3]],
    /// Colour of the garment, sRGB 0..1.
    pub srgb: [f32; 3],
}

/// The GLB file of a dressed body. The same input gives the same bytes.
pub fn glb(dressed: &DressedBody<'_>) -> Vec<u8> {
    let mut parts = GlbBuffer::default();
    let body = dressed.body;
    let joints = joints::nodes(&joints::local_bones(body, dressed.palette), 1);
    let mut nodes = vec![json!({ "name": "body", "mesh": 0, "skin": 0 })];
    nodes.extend(joints);
    let mut meshes = vec![body_mesh(&mut parts, body)];
    let mut materials = vec![material("skin", &SurfaceLook::skin(SKIN_SRGB.map(linear)), None)];
    // The joints' root, the body, then the garments.
    let mut roots = vec![0, 1 + Joint::Pelvis.index()];
    for garment in dressed.worn.iter().filter(|g| !g.triangles.is_empty()) {
        roots.push(nodes.len());
        nodes.push(json!({ "name": garment.name, "mesh": meshes.len() }));
        meshes.push(garment_mesh(&mut parts, garment, materials.len()));
        materials.push(material(garment.name, &SurfaceLook::cloth(garment.srgb), None));
    }
    let bones: Vec<usize> = (1..=BONES).collect();
    let matrices = parts.matrices(&joints::inverse_binds(body));
    let description = json!({
        "asset": { "version": "2.0", "generator": concat!("Toile ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "name": "dressed", "nodes": roots }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "skins": [{
            "name": "skeleton", "joints": bones, "inverseBindMatrices": matrices,
            "skeleton": 1 + Joint::Pelvis.index(),
        }],
    });
    parts.glb(description)
}

/// The mesh of a body in its rest pose, with its joints and weights; its material is the first.
pub(super) fn body_mesh(parts: &mut GlbBuffer, body: &Body) -> Value {
    let joints = body.weights.iter().map(|w| {
        // A joint without weight is named 0, as the format asks.
        std::array::from_fn(|k| if w.weights[k] > 0.0 { w.bones[k] } else { 0 })
    });
    let mut attributes = json!({
        "POSITION": parts.positions(&body.mesh.positions),
        "NORMAL": parts.normals(&body.normals),
        "JOINTS_0": parts.joints(joints),
        "WEIGHTS_0": parts.weights(body.weights.iter().map(|w| w.weights)),
    });
    if !body.mesh.uvs.is_empty() {
        attributes["TEXCOORD_0"] = parts.uvs(&body.mesh.uvs).into();
    }
    let indices = parts.indices(&body.mesh.triangles);
    json!({ "name": "body", "primitives": [{ "attributes": attributes, "indices": indices, "material": 0 }] })
}

fn garment_mesh(parts: &mut GlbBuffer, garment: &WornGarment<'_>, material: usize) -> Value {
    let mut normals = vec![Vec3::ZERO; garment.positions.len()];
    vertex_normals(garment.positions, garment.triangles, &mut normals);
    let attributes = json!({ "POSITION": parts.positions(garment.positions), "NORMAL": parts.normals(&normals) });
    let indices = parts.indices(garment.triangles);
    json!({ "name": garment.name, "primitives": [{ "attributes": attributes, "indices": indices, "material": material }] })
}
