//! Garments: of the wardrobe, meshes, sewn patterns, packages.

use std::path::Path;
use std::sync::Arc;

use toile_assets::drafting;
use toile_assets::draping::{AS_DRAFTED, TO_MEASURE};
use toile_assets::file::{self, FileKind};
use toile_base::body::{Measures, Sex};
use toile_base::fabric::Fabric;
use toile_fitting::dress::garment_source::{GarmentSource, SourceKind};
use toile_fitting::dress::try_on::RequestedGarment;

use crate::error::{Error, Result};

/// A fabric's file: two dozen lines.
const FABRIC_FILE: FileKind = FileKind {
    name: "a fabric's file",
    max_bytes: 1 << 20,
    cure: "give the name of a built-in fabric, or its TOML file",
};

/// A garment, open and checked. It is put on by [`Scene::dress`](crate::Scene::dress) and judged by
/// [`recommend`](crate::recommend); it can be put on many bodies.
#[derive(Debug, Clone)]
pub struct Garment {
    source: Arc<GarmentSource>,
    size: Option<String>,
}

/// Names of the garments that are built in.
pub fn garment_names() -> Vec<&'static str> {
    drafting::names()
}

/// Names of the fabrics that are built in.
pub fn fabric_names() -> Vec<&'static str> {
    toile_assets::fabric::names()
}

impl Garment {
    /// Opens a garment by the same words as `toile try-on --garment`: a name of [`garment_names`], the path of a mesh (OBJ, glTF,
    /// GLB), of a sewn pattern (GarmentCode or FreeSewing JSON, DXF) or of a garment package; behind a colon a built-in fabric
    /// may stand, `shirt:lawn-gingham`.
    ///
    /// # Errors
    /// A name that is none of these, a file that cannot be used.
    pub fn open(name: &str) -> Result<Self> {
        Ok(Self { source: Arc::new(GarmentSource::find(name)?), size: None })
    }

    /// The same in a size, in place of the one that fits.
    ///
    /// # Errors
    /// A size that is not made.
    pub fn in_size(self, size: &str) -> Result<Self> {
        let refused = || {
            let sizes = self.sizes()?;
            let name = self.name();
            Err(Error::input(match sizes.is_empty() {
                true => format!(
                    "{name} is a mesh in one size; give no size, or its sizes in a TOML file beside it (docs/meshes.md)"
                ),
                false => format!("{name} is not made in size {size}; choose one of {}", sizes.join(", ")),
            }))
        };
        let made = match &self.source.kind {
            SourceKind::Pattern(package) => package.sized(size, &Measures::average(Sex::Female)).is_ok(),
            _ => self.sizes()?.iter().any(|code| code == size),
        };
        if made { Ok(Self { size: Some(size.to_owned()), ..self }) } else { refused() }
    }

    /// The same in another fabric: a name of [`fabric_names`], or the path of a fabric's TOML file.
    ///
    /// # Errors
    /// An unknown fabric, a file that is none.
    pub fn in_fabric(self, fabric: &str) -> Result<Self> {
        let fabric = if fabric.ends_with(".toml") { read_fabric(Path::new(fabric))? } else { built_in(fabric)? };
        let source = Arc::unwrap_or_clone(self.source).in_fabric(fabric);
        Ok(Self { source: Arc::new(source), ..self })
    }

    /// What it was opened by.
    pub fn name(&self) -> &str {
        &self.source.name
    }

    /// The size that was asked for; none is the one that fits.
    pub fn size(&self) -> Option<&str> {
        self.size.as_deref()
    }

    /// The sizes that are made, smallest first; none of a mesh that has no sizes.
    ///
    /// # Errors
    /// Size tables that cannot be used.
    pub fn sizes(&self) -> Result<Vec<String>> {
        let owned = |codes: Vec<&str>| codes.into_iter().map(str::to_owned).collect();
        Ok(match &self.source.kind {
            SourceKind::Mesh(own) => own.sizes.as_ref().map_or_else(Vec::new, |sizes| owned(sizes.table.codes())),
            SourceKind::Pattern(package) => match package.graded().map_err(Error::input)? {
                Some(graded) => {
                    let made = graded.made().into_iter().map(|(code, _)| code);
                    made.chain([TO_MEASURE.to_owned()]).collect()
                }
                None => vec![AS_DRAFTED.to_owned()],
            },
        })
    }

    /// The fabric that it is made of.
    ///
    /// # Errors
    /// An unknown fabric.
    pub fn fabric(&self) -> Result<String> {
        Ok(self.source.fabric()?.name)
    }

    pub(crate) fn source(&self) -> &GarmentSource {
        &self.source
    }

    /// The garment as a request has it.
    pub(crate) fn requested(&self) -> RequestedGarment {
        RequestedGarment::of(self.source.clone(), self.size.clone())
    }
}

fn built_in(name: &str) -> Result<Fabric> {
    toile_assets::fabric::built_in(name)
        .map_err(|error| Error::input(format!("{error}; there are {}", toile_assets::fabric::names().join(", "))))
}

fn read_fabric(path: &Path) -> Result<Fabric> {
    let text = file::read_text(path, &FABRIC_FILE).map_err(Error::input)?;
    let mut fabric = toile_assets::fabric::parse(&path.display().to_string(), &text).map_err(Error::input)?;
    let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
    let picture = |name: &str| file::read(&folder.join(name), &FABRIC_FILE).map_err(|e| e.to_string());
    toile_assets::fabric::read_picture(&mut fabric, picture).map_err(Error::input)?;
    Ok(fabric)
}
