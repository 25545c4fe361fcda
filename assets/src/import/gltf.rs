//! glTF 2.0 and GLB: the triangles of the default scene, in the order in which its nodes name them.
//!
//! Read are positions, indices, node transforms and material names; buffers inside the file, in a data address, or
//! beside it. Compressed and sparse data are refused with the cure. (Khronos glTF 2.0 specification, sections 3.5 to 3.8
//! and 4.4.)

use glam::{Mat4, Quat, Vec3};
use serde_json::Value;

use super::plain::PlainMesh;
use crate::garment::shape::NO_VERTEX;

/// First bytes of a GLB file.
const MAGIC: &[u8] = b"glTF";

/// Types of the parts of a GLB file.
const CHUNK_JSON: u32 = 0x4e4f_534a;
const CHUNK_BIN: u32 = 0x004e_4942;

/// Deepest nesting of nodes: deeper ones go round in a circle.
const MAX_DEPTH: usize = 64;

/// Most vertices read, counted once for every node that shows them.
const MAX_VERTICES: usize = 4_000_000;

/// Reads a file's bytes; `beside` reads another file of the same folder. An error says the cure, to stand behind the
/// file's name.
pub fn parse_gltf(bytes: &[u8], beside: &dyn Fn(&str) -> Result<Vec<u8>, String>) -> Result<PlainMesh, String> {
    let (json, bin) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
    let json: Value = serde_json::from_slice(json).map_err(|e| format!("{e}; export it as glTF 2.0"))?;
    let buffers = buffers(&json, bin, beside)?;
    let file = File { json: &json, buffers };
    let mut mesh = PlainMesh::default();
    let scene = index(&json["scene"]).unwrap_or(0);
    match json["scenes"][scene]["nodes"].as_array() {
        Some(roots) => roots.iter().try_for_each(|n| file.node(&mut mesh, n, Mat4::IDENTITY, 0))?,
        // A file may hold a mesh without a scene that shows it.
        None => (0..list(&json["meshes"]).len()).try_for_each(|m| file.mesh(&mut mesh, m, Mat4::IDENTITY))?,
    }
    Ok(mesh)
}

/// The JSON and the binary part of a GLB file.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let cut = || "the file ends too early; export it again".to_owned();
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    let (mut json, mut bin, mut at) = (None, None, 12);
    while let Some((size, kind)) = word(at).zip(word(at + 4)) {
        let part = bytes.get(at + 8..at + 8 + size as usize).ok_or_else(cut)?;
        match kind {
            CHUNK_JSON => json = json.or(Some(part)),
            CHUNK_BIN => bin = bin.or(Some(part)),
            _ => {}
        }
        at += 8 + size as usize;
    }
    Ok((json.ok_or_else(cut)?, bin))
}

fn buffers(
    json: &Value,
    bin: Option<&[u8]>,
    beside: &dyn Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<Vec<Vec<u8>>, String> {
    let read = |buffer: &Value| match buffer["uri"].as_str() {
        None => bin.map(Vec::from).ok_or_else(|| "it has a buffer without data; export it again".into()),
        Some(uri) if uri.starts_with("data:") => {
            let text = uri.split_once(";base64,").map(|(_, text)| text);
            text.and_then(base64).ok_or_else(|| "it holds a data address that is not base64; export it again".into())
        }
        Some(uri) => beside(uri),
    };
    list(&json["buffers"]).iter().map(read).collect()
}

struct File<'a> {
    json: &'a Value,
    buffers: Vec<Vec<u8>>,
}

impl File<'_> {
    fn node(&self, mesh: &mut PlainMesh, node: &Value, above: Mat4, depth: usize) -> Result<(), String> {
        let node = index(node).map(|n| &self.json["nodes"][n]).filter(|n| n.is_object() && depth < MAX_DEPTH);
        let node = node.ok_or("it names a node that is not there or holds itself; export it again")?;
        let place = above * transform(node);
        if let Some(m) = index(&node["mesh"]) {
            self.mesh(mesh, m, place)?;
        }
        list(&node["children"]).iter().try_for_each(|child| self.node(mesh, child, place, depth + 1))
    }

    fn mesh(&self, mesh: &mut PlainMesh, number: usize, place: Mat4) -> Result<(), String> {
        for primitive in list(&self.json["meshes"][number]["primitives"]) {
            match primitive["mode"].as_u64().unwrap_or(4) {
                4 => self.triangles(mesh, primitive, place)?,
                0..=3 => {} // points and lines carry no cloth
                _ => return Err("it holds strips or fans of triangles; export plain triangles".into()),
            }
        }
        Ok(())
    }

    fn triangles(&self, mesh: &mut PlainMesh, primitive: &Value, place: Mat4) -> Result<(), String> {
        let missing = "it has a part without plain positions; export without compression";
        let accessor = index(&primitive["attributes"]["POSITION"]).ok_or(missing)?;
        let first = mesh.positions.len();
        for p in self.elements(accessor, "VEC3")? {
            let p = [0, 4, 8].map(|k| f32::from_le_bytes([p[k], p[k + 1], p[k + 2], p[k + 3]]));
            mesh.positions.push(place.transform_point3(Vec3::from(p)));
        }
        let count = mesh.positions.len() - first;
        if mesh.positions.len() > MAX_VERTICES {
            return Err(format!("it has more than {MAX_VERTICES} vertices; reduce it before exporting"));
        }
        let corners: Vec<u32> = match index(&primitive["indices"]) {
            Some(accessor) => self.elements(accessor, "SCALAR")?.map(little_endian).collect(),
            None => (0..count as u32).collect(),
        };
        let name = index(&primitive["material"]).and_then(|m| self.json["materials"][m]["name"].as_str());
        let material = name.map(|n| mesh.material(n));
        for t in corners.chunks_exact(3) {
            if let Some(v) = t.iter().find(|v| **v as usize >= count) {
                return Err(format!("a triangle names vertex {v} of {count}; export it again"));
            }
            let [a, b, c] = [t[0], t[1], t[2]].map(|v| v + first as u32);
            mesh.faces.push([a, b, c, NO_VERTEX]);
            mesh.face_materials.push(material);
        }
        Ok(())
    }

    /// The bytes of each element of an accessor.
    fn elements(&self, accessor: usize, kind: &str) -> Result<impl Iterator<Item = &[u8]>, String> {
        let accessor = &self.json["accessors"][accessor];
        let wrong = |what: &str| format!("it has {what}; export without compression");
        if accessor["type"] != kind || !accessor["sparse"].is_null() {
            return Err(wrong("sparse data, or data of another type than it says"));
        }
        let size = match (kind, accessor["componentType"].as_u64()) {
            ("VEC3", Some(5126)) => 12,
            ("SCALAR", Some(5121)) => 1,
            ("SCALAR", Some(5123)) => 2,
            ("SCALAR", Some(5125)) => 4,
            _ => return Err(wrong("numbers of a type that positions and indices do not have")),
        };
        let view =
            index(&accessor["bufferView"]).map(|v| &self.json["bufferViews"][v]).ok_or(wrong("no plain data"))?;
        let buffer = index(&view["buffer"]).and_then(|b| self.buffers.get(b)).ok_or(wrong("a view of no buffer"))?;
        let stride = index(&view["byteStride"]).unwrap_or(size).max(size);
        let start = index(&view["byteOffset"]).unwrap_or(0).saturating_add(index(&accessor["byteOffset"]).unwrap_or(0));
        let count = index(&accessor["count"]).unwrap_or(0);
        let end = count.saturating_sub(1).saturating_mul(stride).saturating_add(start).saturating_add(size);
        if count == 0 || end > buffer.len() {
            return Err(wrong("a buffer that is shorter than its data"));
        }
        Ok((0..count).map(move |i| &buffer[start + i * stride..][..size]))
    }
}

/// A node's transform: a matrix, or scale, then rotation, then translation.
fn transform(node: &Value) -> Mat4 {
    if let Some(matrix) = numbers::<16>(&node["matrix"]) {
        return Mat4::from_cols_array(&matrix);
    }
    let scale = numbers(&node["scale"]).map_or(Vec3::ONE, Vec3::from_array);
    let turn = numbers(&node["rotation"]).map_or(Quat::IDENTITY, |q| Quat::from_array(q).normalize());
    Mat4::from_scale_rotation_translation(scale, turn, numbers(&node["translation"]).map_or(Vec3::ZERO, Vec3::from))
}

fn numbers<const N: usize>(value: &Value) -> Option<[f32; N]> {
    let found: Vec<f32> = value.as_array()?.iter().filter_map(|v| v.as_f64().map(|x| x as f32)).collect();
    found.try_into().ok()
}

fn index(value: &Value) -> Option<usize> {
    value.as_u64().and_then(|i| usize::try_from(i).ok())
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Up to four bytes, least first.
fn little_endian(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |sum, b| sum << 8 | u32::from(*b))
}

/// Base64 (RFC 4648, section 4).
fn base64(text: &str) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut held) = (0u32, 0u32);
    for byte in text.trim_end_matches('=').bytes() {
        let six = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        held = held << 6 | u32::from(six);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            out.push((held >> bits) as u8);
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
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
