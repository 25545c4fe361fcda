//! A shop's catalogue: a folder of garment packages beside `catalogue.toml`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Deserialize;

use super::error::CatalogueError;
use super::limits::{MAX_GARMENTS, MAX_TOML_BYTES};
use super::manifest::GarmentManifest;
use super::package::{ENDING, GarmentPackage};
use super::theme::{ShopTheme, ThemeFile};
use crate::file::{self, FileKind, FileStamp};
use crate::toml_keys::place;

/// Limits of a catalogue file.
const CATALOGUE: FileKind = FileKind { name: "a catalogue", max_bytes: MAX_TOML_BYTES, cure: "name each package once" };

/// The catalogue's own file.
pub const FILE: &str = "catalogue.toml";

/// Content of `catalogue.toml`.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShopFile {
    /// The shop's name.
    pub shop: String,
    /// The packages in the order in which they are shown; left out, all of the folder by name.
    pub garments: Option<Vec<String>>,
    /// How its screens look; left out, as they do without a catalogue.
    pub theme: Option<ThemeFile>,
}

/// A garment of a catalogue.
#[derive(Debug, Clone, PartialEq)]
pub struct CatalogueItem {
    /// Path of its package.
    pub path: PathBuf,
    /// The shop's entry for it.
    pub manifest: GarmentManifest,
    /// Its package as it was read: one of another stamp is another package.
    pub stamp: FileStamp,
}

/// A package that is left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RefusedPackage {
    /// Its file's name.
    pub package: String,
    /// Why, in one sentence.
    pub why: String,
}

/// A catalogue: what each garment says of itself. Patterns, meshes and photographs stay in their files until they are used.
#[derive(Debug, Clone, PartialEq)]
pub struct Catalogue {
    /// The shop's name.
    pub shop: String,
    /// Its garments, in the order in which they are shown.
    pub items: Vec<CatalogueItem>,
    /// The packages that are left out.
    pub refused: Vec<RefusedPackage>,
    /// How its screens look.
    pub theme: Option<Arc<ShopTheme>>,
}

impl Catalogue {
    /// Reads a catalogue; a package that cannot be used, or has another's article number, is left out and named.
    ///
    /// # Errors
    /// A folder that cannot be read or holds no catalogue, a theme that cannot be used.
    pub fn read(folder: &Path) -> Result<Self, CatalogueError> {
        Self::read_after(folder, None)
    }

    /// The same where it was read before: a package that is still the same is not read again.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_after(folder: &Path, before: Option<&Self>) -> Result<Self, CatalogueError> {
        let wrong = |reason: String| CatalogueError::Folder { folder: folder.display().to_string(), reason };
        if !folder.is_dir() {
            return Err(wrong("it is no folder".into()));
        }
        let text = file::read_text(&folder.join(FILE), &CATALOGUE)?;
        let shop: ShopFile = toml::from_str(&text).map_err(|e| {
            let line = place(&text, e.span().map_or(0, |s| s.start)).0;
            wrong(format!("{FILE}: line {line}: {}", e.message().lines().next().unwrap_or("it is not TOML")))
        })?;
        let names = match shop.garments {
            Some(names) => names,
            None => packages(folder).map_err(|e| wrong(format!("it cannot be read ({e})")))?,
        };
        let theme = shop.theme.map(|theme| ShopTheme::read(folder, FILE, &theme).map(Arc::new)).transpose()?;
        let mut catalogue = Self { shop: shop.shop, items: Vec::new(), refused: Vec::new(), theme };
        let mut known: BTreeMap<&Path, &CatalogueItem> = BTreeMap::new();
        known.extend(before.into_iter().flat_map(|before| &before.items).map(|item| (item.path.as_path(), item)));
        let mut articles: BTreeMap<String, String> = BTreeMap::new();
        for (place, name) in names.into_iter().enumerate() {
            match read_item((folder, &name), place, &known, &articles) {
                Ok(item) => {
                    articles.insert(item.manifest.article.clone(), name);
                    catalogue.items.push(item);
                }
                Err(why) => catalogue.refused.push(RefusedPackage { package: name, why }),
            }
        }
        Ok(catalogue)
    }

    /// Bytes that it holds: manifests and paths.
    pub fn bytes(&self) -> usize {
        let words = |words: &super::manifest::Words| words.iter().map(|(k, v)| k.len() + v.len() + 64).sum::<usize>();
        let of = |item: &CatalogueItem| {
            let m = &item.manifest;
            let files: usize = m.files().map(str::len).sum();
            let colours: usize = m.colours.iter().map(|c| size_of_val(c) + words(&c.name)).sum();
            size_of_val(item) + item.path.as_os_str().len() + m.article.len() + words(&m.names) + files + colours
        };
        self.items.iter().map(of).sum::<usize>()
            + self.theme.as_ref().map_or(0, |theme| theme.bytes())
            + self.refused.iter().map(|r| size_of_val(r) + r.package.len() + r.why.len()).sum::<usize>()
    }
}

/// The packages of a folder by name.
fn packages(folder: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        if name.ends_with(ENDING) {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

fn read_item(
    (folder, name): (&Path, &str),
    place: usize,
    known: &BTreeMap<&Path, &CatalogueItem>,
    articles: &BTreeMap<String, String>,
) -> Result<CatalogueItem, String> {
    if place >= MAX_GARMENTS {
        return Err(format!("{name}: a catalogue has {MAX_GARMENTS} garments at most; divide it"));
    }
    if Path::new(name).components().count() != 1 || !name.ends_with(ENDING) {
        return Err(format!("{name}: it is no name of a package; give one that ends in {ENDING} beside {FILE}"));
    }
    let path = folder.join(name);
    let stamp = file::stamp(&path);
    let same = known.get(path.as_path()).filter(|item| Some(item.stamp) == stamp);
    let manifest = match same {
        Some(item) => item.manifest.clone(),
        None => GarmentPackage::open(&path).and_then(|mut package| package.manifest()).map_err(|e| e.to_string())?,
    };
    let stamp = stamp.filter(|_| file::stamp(&path) == stamp);
    let stamp =
        stamp.ok_or_else(|| format!("{name}: it was changed while it was read; write it anew and rename it"))?;
    if let Some(other) = articles.get(&manifest.article) {
        return Err(format!(
            "{name}: its article number {} is that of {other}; give each garment its own",
            manifest.article
        ));
    }
    Ok(CatalogueItem { path, manifest, stamp })
}
