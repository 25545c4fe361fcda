//! Materials of a mesh: a picture or a colour, from MTL, glTF and MakeHuman's material files.

use std::path::Path;

use serde_json::Value;

use super::gltf::file::{GltfFile, index};

/// The picture or colour of a material.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Paint {
    /// Nothing of its own: the fabric's colour.
    #[default]
    None,
    /// One colour, sRGB.
    Colour([u8; 3]),
    /// A picture in a file of the mesh's own folder.
    File(String),
    /// A picture inside the file.
    Bytes(Vec<u8>),
}

/// Greys that programs write for uncoloured materials lie within this of one another (1).
const GREY: f32 = 0.02;

impl Paint {
    /// A colour, sRGB 0..1; nothing if it is the grey or white that programs write by default.
    fn coloured(rgb: [f32; 3]) -> Self {
        let [least, most] = [rgb.iter().copied().fold(1.0, f32::min), rgb.iter().copied().fold(0.0, f32::max)];
        if most - least < GREY && least > 0.5 {
            return Self::None;
        }
        Self::Colour(rgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8))
    }

    /// A picture by its name. Programs write whole paths of their own machine: the file's name is what is looked for.
    fn named(path: &str) -> Self {
        let name = path.replace('\\', "/");
        Path::new(name.trim()).file_name().map_or(Self::None, |name| Self::File(name.to_string_lossy().into_owned()))
    }
}

/// The materials of an MTL file: their names, and what they show (`newmtl`, `Kd`, `map_Kd`). What cannot be read is passed
/// over: a picture that is not shown is no reason to refuse a garment.
pub fn parse_mtl(text: &str) -> Vec<(String, Paint)> {
    let mut materials: Vec<(String, Paint)> = Vec::new();
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or_default().trim();
        let (key, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        match (key, materials.last_mut()) {
            ("newmtl", _) => materials.push((rest.to_owned(), Paint::None)),
            // Options stand before the name: -s 1 1 1 cloth.png.
            ("map_Kd", Some((_, paint))) if !rest.is_empty() => {
                *paint = Paint::named(if rest.starts_with('-') { last_word(rest) } else { rest });
            }
            ("Kd", Some((_, paint))) if !matches!(paint, Paint::File(_)) => {
                let numbers: Vec<f32> = rest.split_whitespace().filter_map(|w| w.parse().ok()).collect();
                if let [r, g, b] = numbers[..] {
                    *paint = Paint::coloured([r, g, b].map(encoded));
                }
            }
            _ => {}
        }
    }
    materials
}

fn last_word(text: &str) -> &str {
    text.split_whitespace().next_back().unwrap_or_default()
}

/// MTL and glTF state colours in linear light; pictures are sRGB.
fn encoded(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The picture or colour of a MakeHuman material file (`.mhmat`).
pub fn parse_mhmat(text: &str) -> Paint {
    let after = |key: &str| text.lines().find_map(|l| l.trim().strip_prefix(key)).map(str::trim);
    if let Some(file) = after("diffuseTexture ").filter(|file| !file.is_empty()) {
        return Paint::named(file);
    }
    let numbers =
        after("diffuseColor ").map(|l| l.split_whitespace().filter_map(|w| w.parse().ok()).collect::<Vec<f32>>());
    match numbers.as_deref() {
        Some([r, g, b, ..]) => Paint::coloured([*r, *g, *b]),
        _ => Paint::None,
    }
}

/// The picture or colour of a material of a glTF file.
pub(super) fn of_gltf(file: &GltfFile, material: usize) -> Paint {
    let base = &file.json["materials"][material]["pbrMetallicRoughness"];
    let texture = index(&base["baseColorTexture"]["index"]).and_then(|t| index(&file.json["textures"][t]["source"]));
    if let Some(image) = texture.map(|i| &file.json["images"][i]) {
        return match image["uri"].as_str() {
            Some(uri) if uri.starts_with("data:") => {
                super::gltf::file::data_address(uri).map_or(Paint::None, Paint::Bytes)
            }
            Some(uri) => Paint::named(&uri.replace("%20", " ")),
            None => {
                index(&image["bufferView"]).and_then(|v| file.view(v)).map_or(Paint::None, |b| Paint::Bytes(b.into()))
            }
        };
    }
    let factor: Vec<f32> = match base["baseColorFactor"].as_array() {
        Some(list) => list.iter().filter_map(Value::as_f64).map(|x| x as f32).collect(),
        None => Vec::new(),
    };
    match factor[..] {
        [r, g, b, ..] => Paint::coloured([r, g, b].map(encoded)),
        _ => Paint::None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_name_pictures_and_colours() {
        let text = "newmtl Cloth\nKd 0.8 0.8 0.8\nmap_Kd C:\\art\\cloth red.png\nnewmtl Trim\nKd 0.5 0 0\n\
            newmtl Plain\nKd 0.8 0.8 0.8\nnewmtl Scaled\nmap_Kd -s 2 2 1 weave.jpg\n";
        let found = parse_mtl(text);
        assert_eq!(found[0], ("Cloth".into(), Paint::File("cloth red.png".into())));
        assert_eq!(found[1], ("Trim".into(), Paint::Colour([188, 0, 0])));
        assert_eq!(found[2], ("Plain".into(), Paint::None));
        assert_eq!(found[3], ("Scaled".into(), Paint::File("weave.jpg".into())));
        for end in 0..text.len() {
            _ = parse_mtl(text.get(..end).unwrap_or_default());
        }
    }

    #[test]
    fn makehuman_names_its_picture() {
        assert_eq!(parse_mhmat("name A\ndiffuseTexture suit_diffuse.png\n"), Paint::File("suit_diffuse.png".into()));
        assert_eq!(parse_mhmat("diffuseColor 0.2 0.0 1.0\n"), Paint::Colour([51, 0, 255]));
        assert_eq!(parse_mhmat("shininess 0.1\n"), Paint::None);
    }
}
