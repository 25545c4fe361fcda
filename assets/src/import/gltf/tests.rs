//! Tests of reading meshes from glTF.

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
