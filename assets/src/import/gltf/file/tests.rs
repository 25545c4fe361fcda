//! Tests of the container and of accessors.

use super::*;

fn alone(_: &str) -> Result<Vec<u8>, String> {
    Err("nothing lies beside it".into())
}

/// Three normalised bytes, the second of which a sparse part replaces.
fn sparse(at: u8, view: &str) -> GltfFile {
    let json = format!(
        r#"{{"accessors": [{{{view}"componentType": 5121, "normalized": true, "type": "SCALAR", "count": 3,
        "sparse": {{"count": 1, "indices": {{"bufferView": 1, "componentType": 5121}},
        "values": {{"bufferView": 2}}}}}}],
        "bufferViews": [{{"buffer": 0}}, {{"buffer": 0, "byteOffset": 3}}, {{"buffer": 0, "byteOffset": 4}}]}}"#
    );
    GltfFile { json: serde_json::from_str(&json).unwrap(), buffers: vec![vec![51, 102, 255, at, 153]] }
}

#[test]
fn sparse_elements_replace_stored_ones_and_zeros() {
    assert_eq!(sparse(1, r#""bufferView": 0, "#).floats::<1>(0).unwrap(), [[0.2], [0.6], [1.0]]);
    assert_eq!(sparse(2, "").integers::<1>(0).unwrap(), [[0], [0], [153]]);
    assert!(sparse(3, "").integers::<1>(0).unwrap_err().contains("index 3"));
}

#[test]
fn huge_counts_are_errors_before_they_are_memory() {
    for (view, expected) in [("", "no data"), (r#""bufferView": 0, "#, "shorter")] {
        let mut file = sparse(0, view);
        file.json["accessors"][0]["count"] = 4_000_000_000_000_u64.into();
        assert!(file.floats::<1>(0).unwrap_err().contains(expected));
    }
}

#[test]
fn compressed_files_name_their_compression() {
    let json = br#"{"extensionsRequired": ["KHR_draco_mesh_compression"]}"#;
    assert!(GltfFile::open(json, &alone).err().unwrap().contains("KHR_draco_mesh_compression"));
}
