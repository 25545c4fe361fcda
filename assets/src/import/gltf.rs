//! glTF 2.0 and GLB: the triangles of the default scene, in the order in which its nodes name them.
//!
//! Read are positions, indices, the first texture coordinates, node transforms, names, colours and pictures of materials; buffers inside the file, in a data address, or
//! beside it. Compressed data are refused with the cure. (Khronos glTF 2.0 specification, sections 3.5 to 3.8 and 4.4.)

pub(crate) mod file;

use glam::{Mat4, Vec2, Vec3};
use serde_json::Value;

use super::paint;
use super::plain::PlainMesh;
pub use file::ReadBeside;
use file::{GltfFile, index, list, transform};
use toile_bake::shape::NO_VERTEX;

/// Deepest nesting of nodes: deeper ones go round in a circle.
const MAX_DEPTH: usize = 64;

/// Most vertices read, counted once for every node that shows them.
const MAX_VERTICES: usize = 4_000_000;

/// Reads a file's bytes; `beside` reads another file of the same folder. An error says the cure, to stand behind the
/// file's name.
pub fn parse_gltf(bytes: &[u8], beside: ReadBeside<'_>) -> Result<PlainMesh, String> {
    let file = GltfFile::open(bytes, beside)?;
    let mut mesh = PlainMesh::default();
    let scene = index(&file.json["scene"]).unwrap_or(0);
    match file.json["scenes"][scene]["nodes"].as_array() {
        Some(roots) => roots.iter().try_for_each(|n| add_node(&file, &mut mesh, n, Mat4::IDENTITY, 0))?,
        // A file may hold a mesh without a scene that shows it.
        None => {
            (0..list(&file.json["meshes"]).len()).try_for_each(|m| add_mesh(&file, &mut mesh, m, Mat4::IDENTITY))?;
        }
    }
    Ok(mesh)
}

fn add_node(file: &GltfFile, mesh: &mut PlainMesh, node: &Value, above: Mat4, depth: usize) -> Result<(), String> {
    let node = index(node).map(|n| &file.json["nodes"][n]).filter(|n| n.is_object() && depth < MAX_DEPTH);
    let node = node.ok_or("it names a node that is not there or holds itself; export it again")?;
    let place = above * transform(node);
    if let Some(m) = index(&node["mesh"]) {
        add_mesh(file, mesh, m, place)?;
    }
    list(&node["children"]).iter().try_for_each(|child| add_node(file, mesh, child, place, depth + 1))
}

fn add_mesh(file: &GltfFile, mesh: &mut PlainMesh, number: usize, place: Mat4) -> Result<(), String> {
    for primitive in list(&file.json["meshes"][number]["primitives"]) {
        match primitive["mode"].as_u64().unwrap_or(4) {
            4 => add_triangles(file, mesh, primitive, place)?,
            0..=3 => {} // points and lines carry no cloth
            _ => return Err("it holds strips or fans of triangles; export plain triangles".into()),
        }
    }
    Ok(())
}

fn add_triangles(file: &GltfFile, mesh: &mut PlainMesh, primitive: &Value, place: Mat4) -> Result<(), String> {
    let missing = "it has a part without plain positions; export without compression";
    let accessor = index(&primitive["attributes"]["POSITION"]).ok_or(missing)?;
    let first = mesh.positions.len();
    if file.count(accessor)? > MAX_VERTICES - first {
        return Err(format!("it has more than {MAX_VERTICES} vertices; reduce it before exporting"));
    }
    let positions = file.floats::<3>(accessor)?;
    mesh.positions.extend(positions.iter().map(|p| place.transform_point3(Vec3::from(*p))));
    let count = mesh.positions.len() - first;
    let corners: Vec<u32> = match index(&primitive["indices"]) {
        Some(accessor) => file.integers::<1>(accessor)?.into_iter().flatten().collect(),
        None => (0..count as u32).collect(),
    };
    // Textures run downwards in glTF and upwards here, as in OBJ.
    let uvs = match index(&primitive["attributes"]["TEXCOORD_0"]) {
        Some(accessor) => file.floats::<2>(accessor)?.iter().map(|[u, v]| Vec2::new(*u, 1.0 - v)).collect(),
        None => Vec::new(),
    };
    let material = index(&primitive["material"]).map(|m| {
        let name = file.json["materials"][m]["name"].as_str().map_or_else(|| format!("material {m}"), str::to_owned);
        let number = mesh.material(&name);
        mesh.paints[number] = paint::of_gltf(file, m);
        number
    });
    for t in corners.chunks_exact(3) {
        if let Some(v) = t.iter().find(|v| **v as usize >= count) {
            return Err(format!("a triangle names vertex {v} of {count}; export it again"));
        }
        let [a, b, c] = [t[0], t[1], t[2]].map(|v| v + first as u32);
        if !uvs.is_empty() {
            // Parts before this one may have none.
            mesh.uvs.resize(mesh.faces.len(), [Vec2::ZERO; 4]);
            let uv = |v: u32| uvs.get(v as usize).copied().unwrap_or_default();
            mesh.uvs.push([uv(t[0]), uv(t[1]), uv(t[2]), Vec2::ZERO]);
        }
        mesh.faces.push([a, b, c, NO_VERTEX]);
        mesh.face_materials.push(material);
    }
    if !mesh.uvs.is_empty() {
        mesh.uvs.resize(mesh.faces.len(), [Vec2::ZERO; 4]);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
