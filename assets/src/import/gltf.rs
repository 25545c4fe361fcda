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
mod tests {
    use super::file::{CHUNK_BIN, CHUNK_JSON, MAGIC};
    use super::*;

    /// Four vertices of a square and two triangles, with and without a node that moves them.
    fn square(uri: &str) -> (String, Vec<u8>) {
        let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mut data: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        data.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
        let json = format!(
            r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
            "nodes": [{{"children": [1], "translation": [0, 1, 0]}}, {{"mesh": 0, "scale": [2, 2, 2]}}],
            "materials": [{{"name": "ClothFree"}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
                {{"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 12}}],
            "buffers": [{{"byteLength": 60{uri}}}]}}"#
        );
        (json, data)
    }

    fn glb() -> Vec<u8> {
        let (json, data) = square("");
        let mut bytes = MAGIC.to_vec();
        for part in [2u32, (20 + json.len() + 8 + data.len()) as u32, json.len() as u32, CHUNK_JSON] {
            bytes.extend(part.to_le_bytes());
        }
        bytes.extend(json.bytes());
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(CHUNK_BIN.to_le_bytes());
        bytes.extend(data);
        bytes
    }

    fn alone(_: &str) -> Result<Vec<u8>, String> {
        Err("nothing lies beside it".into())
    }

    #[test]
    fn positions_indices_transforms_and_materials_are_read_from_all_three_places() {
        let mesh = parse_gltf(&glb(), &alone).unwrap();
        assert_eq!(mesh.positions[2], Vec3::new(2.0, 3.0, 0.0));
        assert_eq!(mesh.faces, [[0, 1, 2, NO_VERTEX], [0, 2, 3, NO_VERTEX]]);
        assert_eq!((mesh.materials[0].as_str(), mesh.face_materials[1]), ("ClothFree", Some(0)));
        let (json, data) = square(r#", "uri": "square.bin""#);
        let beside = |name: &str| if name == "square.bin" { Ok(data.clone()) } else { Err(name.into()) };
        assert_eq!(parse_gltf(json.as_bytes(), &beside).unwrap(), mesh);
        assert!(parse_gltf(json.as_bytes(), &alone).unwrap_err().contains("beside"));
        let text = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA";
        let (json, _) = square(&format!(r#", "uri": "data:application/octet-stream;base64,{text}""#));
        assert_eq!(parse_gltf(json.as_bytes(), &alone).unwrap(), mesh);
    }

    #[test]
    fn texture_coordinates_stay_with_their_corners_and_run_upwards() {
        let text = square(r#", "uri": "square.bin""#).0;
        // The first two numbers of each position serve as texture coordinates too.
        let textured = text
            .replace(r#""POSITION": 0"#, r#""POSITION": 0, "TEXCOORD_0": 2"#)
            .replace(
                r#""type": "SCALAR"}]"#,
                r#""type": "SCALAR"},
                {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"}]"#,
            )
            .replace(
                r#""byteOffset": 48, "byteLength": 12}]"#,
                r#""byteOffset": 48, "byteLength": 12},
                {"buffer": 0, "byteLength": 48, "byteStride": 12}]"#,
            );
        let data = square("").1;
        let mesh = parse_gltf(textured.as_bytes(), &|_| Ok(data.clone())).unwrap();
        assert_eq!(mesh.uvs[0][..3], [Vec2::Y, Vec2::ONE, Vec2::X]);
        assert_eq!(mesh.uvs.len(), mesh.faces.len());
        assert!(parse_gltf(text.as_bytes(), &|_| Ok(data.clone())).unwrap().uvs.is_empty());
    }

    #[test]
    fn broken_files_are_errors_and_never_more() {
        let good = glb();
        for end in 0..good.len() - 1 {
            assert!(parse_gltf(&good[..end], &alone).is_err(), "{end}");
        }
        for at in 0..good.len() {
            for byte in [0, b'9', b'}', 0xff] {
                let mut bytes = good.clone();
                bytes[at] = byte;
                if let Ok(mesh) = parse_gltf(&bytes, &alone) {
                    let count = mesh.positions.len() as u32;
                    assert!(mesh.faces.iter().flatten().all(|v| *v < count || *v == NO_VERTEX));
                }
            }
        }
        let circle = r#"{"scenes": [{"nodes": [0]}], "nodes": [{"children": [0]}]}"#;
        assert!(parse_gltf(circle.as_bytes(), &alone).unwrap_err().contains("holds itself"));
    }
}
