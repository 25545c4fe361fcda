//! The manifest of a garment package, `garment.toml`: what a shop says of a garment.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::limits::{MAX_ARTICLE, MAX_COLOURS, MAX_NAME};
use super::photographed::PhotographedGarment;
use super::price::Price;
use crate::drafting::{self, WardrobeError};
use crate::draping;
use crate::toml_keys::place;

/// Words by the tag of their language, `en` or `de`.
pub type Words = BTreeMap<String, String>;

/// A shop's entry for a garment.
#[derive(Debug, Clone, PartialEq)]
pub struct GarmentManifest {
    /// Article number, unlike that of any other garment of the catalogue.
    pub article: String,
    /// A garment of the wardrobe, or the package's file that it is made from: a pattern or a mesh.
    pub garment: String,
    /// Seam file of a draft, where its format has no sewing.
    pub seams: Option<String>,
    /// Its name in each language.
    pub names: Words,
    /// Its price.
    pub price: Option<Price>,
    /// A fabric that is built in, or the package's fabric file.
    pub fabric: Option<String>,
    /// Layer in which it is worn, 1 (underwear) to 6 (scarves).
    pub layer: Option<u8>,
    /// Colours that it comes in, in place of its fabric's own; none is the fabric's.
    pub colours: Vec<ManifestColour>,
    /// The package's photographs of it.
    pub photographs: Vec<String>,
    /// Its pictures that are laid on the cloth.
    pub image: Option<PhotographedGarment>,
}

/// A colour with its names.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestColour {
    /// Its name in each language.
    pub name: Words,
    /// sRGB, 0 .. 1.
    pub srgb: [f32; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawManifest {
    article: String,
    garment: String,
    seams: Option<String>,
    name: Words,
    price: Option<String>,
    fabric: Option<String>,
    layer: Option<u8>,
    #[serde(default)]
    colours: Vec<ManifestColour>,
    #[serde(default)]
    photographs: Vec<String>,
    image: Option<PhotographedGarment>,
}

/// What a mesh's file is called by its ending; what goes by its name comes with it, a `.mhclo` too.
const MESHES: [&str; 3] = [".obj", ".gltf", ".glb"];

impl GarmentManifest {
    /// Reads and checks a manifest.
    ///
    /// # Errors
    /// The fault and its cure.
    pub fn parse(text: &str) -> Result<Self, String> {
        let raw: RawManifest = toml::from_str(text).map_err(|e| {
            let line = place(text, e.span().map_or(0, |s| s.start)).0;
            format!("line {line}: {}; see docs/catalogue.md", e.message().lines().next().unwrap_or("it is not TOML"))
        })?;
        let manifest = Self {
            price: raw.price.as_deref().map(str::parse).transpose()?,
            article: raw.article,
            garment: raw.garment,
            seams: raw.seams,
            names: raw.name,
            fabric: raw.fabric,
            layer: raw.layer,
            colours: raw.colours,
            photographs: raw.photographs,
            image: raw.image,
        };
        manifest.check()?;
        Ok(manifest)
    }

    fn check(&self) -> Result<(), String> {
        let printable = |text: &str| !text.trim().is_empty() && !text.chars().any(char::is_control);
        if !printable(&self.article) || self.article.chars().count() > MAX_ARTICLE {
            return Err(format!("the article number must have 1 to {MAX_ARTICLE} printable characters; correct it"));
        }
        check_words("name", &self.names)?;
        if let Some(layer) = self.layer.filter(|layer| !(1..=6).contains(layer)) {
            return Err(format!("layer is {layer}; give 1 (underwear) to 6 (scarves)"));
        }
        if self.colours.len() > MAX_COLOURS {
            return Err(format!(
                "it has {} colours, and {MAX_COLOURS} can be shown; leave some out",
                self.colours.len()
            ));
        }
        for colour in &self.colours {
            check_words("colours.name", &colour.name)?;
            if !colour.srgb.iter().all(|c| (0.0..=1.0).contains(c)) {
                return Err("a colour's srgb must be three numbers from 0 to 1; correct it".into());
            }
        }
        self.image.as_ref().map_or(Ok(()), PhotographedGarment::check)?;
        if self.image.is_some() && self.is_mesh() {
            return Err(
                "image lays photographs on a cut, and a mesh has its own picture; name a pattern or a built-in garment"
                    .into(),
            );
        }
        if let Err(replaced @ WardrobeError::Replaced { .. }) = drafting::named(&self.garment) {
            return Err(replaced.to_string());
        }
        if !self.is_built_in() && !self.is_pattern() && !self.is_mesh() {
            return Err(format!(
                "garment is {:?}; name a file of the package that ends in .json, .dxf, .obj, .gltf or .glb, or one of {}",
                self.garment,
                drafting::names().join(", ")
            ));
        }
        Ok(())
    }

    /// Whether it is a garment of the wardrobe under a shop's own name.
    pub fn is_built_in(&self) -> bool {
        drafting::style(&self.garment).is_some()
    }

    /// Whether it is made from a pattern.
    pub fn is_pattern(&self) -> bool {
        draping::is_pattern(&self.garment)
    }

    /// Whether it is a mesh.
    pub fn is_mesh(&self) -> bool {
        let name = self.garment.to_lowercase();
        MESHES.iter().any(|end| name.ends_with(end))
    }

    /// The files of the package that it names.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        let own = (!self.is_built_in()).then_some(self.garment.as_str());
        let fabric = self.fabric.as_deref().filter(|name| name.ends_with(".toml"));
        let others = own.into_iter().chain(self.seams.as_deref()).chain(fabric);
        let laid_on = self.image.iter().flat_map(PhotographedGarment::files);
        others.chain(self.photographs.iter().map(String::as_str)).chain(laid_on)
    }
}

/// Checks names by language.
pub(super) fn check_words(key: &str, words: &Words) -> Result<(), String> {
    if words.is_empty() {
        return Err(format!("{key} is empty; give it in one language at least, as {key} = {{ en = \"...\" }}"));
    }
    for (tag, word) in words {
        if !(2..=3).contains(&tag.len()) || !tag.bytes().all(|b| b.is_ascii_lowercase()) {
            return Err(format!("{key}.{tag} is no language; write the tag as en or de"));
        }
        if word.trim().is_empty() || word.chars().count() > MAX_NAME || word.chars().any(char::is_control) {
            return Err(format!("{key}.{tag} must have 1 to {MAX_NAME} printable characters; correct it"));
        }
    }
    Ok(())
}

/// A word in a language: in that one, else in English, else in the first that there is.
pub fn word<'a>(words: &'a Words, language: &str) -> &'a str {
    let found = words.get(language).or_else(|| words.get("en")).or_else(|| words.values().next());
    found.map_or("", String::as_str)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"
article = "SK-1001"
garment = "skirt.json"
name = { en = "Circle skirt", de = "Tellerrock" }
price = "49.90 EUR"
fabric = "linen-twill"
photographs = ["front.png"]
[[colours]]
name = { en = "Moss" }
srgb = [0.3, 0.4, 0.2]
"#;

    #[test]
    fn a_manifest_is_read_and_names_its_files() {
        let manifest = GarmentManifest::parse(GOOD).unwrap();
        assert_eq!(manifest.files().collect::<Vec<_>>(), ["skirt.json", "front.png"]);
        assert_eq!(word(&manifest.names, "de"), "Tellerrock");
        assert_eq!(word(&manifest.names, "tr"), "Circle skirt");
        assert!(manifest.is_pattern() && !manifest.is_mesh() && !manifest.is_built_in());
        let dress = GarmentManifest::parse(&GOOD.replace("skirt.json", "strap-dress")).unwrap();
        assert!(dress.is_built_in());
    }

    #[test]
    fn what_is_wrong_is_named_with_the_cure() {
        for (from, to, word) in [
            ("SK-1001", "", "article number"),
            ("SK-1001", &"x".repeat(60), "article number"),
            ("skirt.json", "skirt.exe", ".obj"),
            ("skirt.json", "sun-dress", "strap-dress"),
            ("49.90 EUR", "free", "49.90 EUR"),
            ("0.3, 0.4", "3, 4", "0 to 1"),
            ("de = ", "german = ", "name.german"),
            ("Tellerrock", "", "name.de"),
            ("article", "artikel", "line 2"),
            ("fabric = ", "layer = 9\nfabric = ", "1 (underwear)"),
        ] {
            let refused = GarmentManifest::parse(&GOOD.replace(from, to)).unwrap_err();
            assert!(refused.contains(word) && !refused.contains('\n'), "{to}: {refused}");
        }
    }
}
