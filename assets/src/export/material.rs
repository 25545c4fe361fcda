//! Looks as materials of glTF.

use serde_json::{Value, json};

use super::surface::SurfaceLook;

/// The material of a look; `texture` is the number of its picture, where it has one.
pub(super) fn material(name: &str, look: &SurfaceLook, texture: Option<usize>) -> Value {
    // A picture has the colour in it.
    let [r, g, b] = if texture.is_some() { [1.0; 3] } else { look.colour };
    let mut material = json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, look.opacity], "metallicFactor": 0.0, "roughnessFactor": look.roughness,
        },
        "doubleSided": look.double_sided,
    });
    if let Some(texture) = texture {
        material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
    }
    if look.opacity < 1.0 {
        material["alphaMode"] = "BLEND".into();
    }
    material
}
