//! A garment package: a pattern with its seams, spacing and fabric in one file, to be draped on its wearer.

use std::path::Path;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::drape::{DrapedPattern, drape, drape_around, drape_on};
use super::error::DrapeError;
use super::pattern_sizes::{AS_DRAFTED, PatternSizes, TO_MEASURE};
use super::skin_field::SkinField;
use crate::fabric::FabricError;
use crate::file::{self, FileError, FileKind};
use crate::import::pattern::{self, PatternError};
use crate::pattern::Pattern;
use crate::pattern::limits::MAX_PATTERN_BYTES;
use crate::sizes::{Population, SizeError, SizeTable};
use crate::tailor::TailorError;
use crate::tailor::limits::SPACING_M;
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::body::{Body, Measures, Sex};
use toile_base::fabric::Fabric;
use toile_base::garment::Garment;

/// The format of a package.
const SCHEMA: &str = "toile.garment-package/1";

/// Spacing where none is asked for (mm): what the frame has time for.
pub const SPACING_MM: f64 = 15.0;

/// Fabric where none is named.
pub const FABRIC: &str = "cotton-lawn";

/// Layer of a tailored garment that says nothing of it: worn over underwear, beneath jackets.
const LAYER: u8 = 3;

/// From this layer on a garment lies on others by its weight, and the skin carries nothing of it.
const SCARVES: u8 = 6;

/// Limits of a package or pattern file.
const PACKAGE: FileKind = FileKind {
    name: "a pattern or a garment package",
    max_bytes: 4 * MAX_PATTERN_BYTES,
    cure: "export one garment, without pictures",
};

/// Limits of a seam file of a pattern.
const SEAMS: FileKind = FileKind { name: "a seam file", max_bytes: MAX_PATTERN_BYTES, cure: "name each seam once" };

/// A pattern and how it is to be made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatternPackage {
    /// The format's name.
    schema: String,
    /// Name of the garment.
    pub name: String,
    /// Text of the pattern's file.
    pub pattern: String,
    /// Text of its seam file, where its format has no sewing.
    pub seams: Option<String>,
    /// Distance between particles (mm).
    pub spacing_mm: f64,
    /// A fabric that is built in.
    pub fabric: String,
    /// The layer that it is worn in, where it says so: 1 underwear, 2 skirts and trousers, 3 tops and dresses, 4 jackets, 5 coats,
    /// 6 scarves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer: Option<u8>,
    /// For whom its drafts are, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sizes: Option<PatternSizes>,
}

/// Why a package or pattern cannot be worn.
#[derive(Debug, Error)]
pub enum PackageError {
    /// A file that cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A package that is none, or holds what cannot be used.
    #[error("{file}: {reason}; write the package again with toile tailor --out")]
    Content {
        /// The file as the user named it.
        file: String,
        /// The fault.
        reason: String,
    },
    /// A pattern that cannot be read.
    #[error(transparent)]
    Pattern(#[from] PatternError),
    /// A fabric that is not there.
    #[error(transparent)]
    Fabric(#[from] FabricError),
    /// A size of a table that is not there.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// A size that the pattern is not made in.
    #[error("{name} is not made in size {size}; choose one of {made}")]
    NotMade {
        /// Name of the garment.
        name: String,
        /// The size asked for.
        size: String,
        /// Those that there are.
        made: String,
    },
    /// A pattern that cannot be draped on this body.
    #[error("{name}: {source}")]
    Drape {
        /// Name of the garment.
        name: String,
        /// Panel or seam, and the cure.
        source: DrapeError,
    },
}

/// Whether a file is taken for a package or a pattern, by its name: .json, .jsonc, .dxf.
pub fn is_pattern(name: &str) -> bool {
    let name = name.to_lowercase();
    [".json", ".jsonc", ".dxf"].iter().any(|end| name.ends_with(end))
}

/// Reads a package, or a pattern as one with the usual spacing and fabric. The seams of a draft are named, or lie beside it
/// under its own name with the ending .toml.
///
/// # Errors
/// One sentence: the file, what is wrong, and the cure.
pub fn read_package(path: &Path, seams: Option<&Path>) -> Result<PatternPackage, PackageError> {
    let text = pattern::read_text(path, &PACKAGE)?;
    let shown = path.display().to_string();
    let beside = path.with_extension("toml");
    let seams = seams.or_else(|| beside.is_file().then_some(beside.as_path()));
    let seams = seams.map(|s| file::read_text(s, &SEAMS)).transpose()?;
    parse_package(&shown, text, seams)
}

/// The same from text; `shown` stands in error messages, and its last part is the garment's name.
///
/// # Errors
/// As [`read_package`].
pub fn parse_package(shown: &str, text: String, seams: Option<String>) -> Result<PatternPackage, PackageError> {
    let shown = shown.to_owned();
    if text.contains(SCHEMA) {
        let wrong = |reason: String| PackageError::Content { file: shown.clone(), reason };
        let package: PatternPackage = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
        if package.schema != SCHEMA {
            return Err(wrong(format!("its schema is {}, not {SCHEMA}", package.schema)));
        }
        if !SPACING_M.contains(&(package.spacing_mm * 1e-3)) {
            return Err(PackageError::Drape {
                name: shown,
                source: TailorError::Spacing { spacing: package.spacing_mm * 1e-3 }.into(),
            });
        }
        return Ok(package);
    }
    let name = Path::new(&shown).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    Ok(PatternPackage { seams, ..PatternPackage::new(name.unwrap_or(shown), text) })
}

/// A pattern in a size as it hangs on the body that the size is for.
#[derive(Debug, Clone)]
pub struct HungPattern {
    size: String,
    body: Body,
    fabric: Fabric,
    pattern: Pattern,
    draped: DrapedPattern,
}

impl PatternPackage {
    /// A pattern that says how it is sewn, with the usual spacing and fabric, without sizes.
    pub fn new(name: String, pattern: String) -> Self {
        Self {
            schema: SCHEMA.into(),
            name,
            pattern,
            seams: None,
            spacing_mm: SPACING_MM,
            fabric: FABRIC.into(),
            layer: None,
            sizes: None,
        }
    }

    /// The checked pattern.
    ///
    /// # Errors
    /// What is wrong with its text or its seams.
    pub fn parse(&self) -> Result<Pattern, PatternError> {
        let seams = format!("the seams of {}", self.name);
        pattern::parse(&self.name, &self.pattern, self.seams.as_deref().map(|text| (seams.as_str(), text)))
    }

    /// The package as text.
    pub fn text(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// The checked pattern in a size: `as drafted` or one that it is drafted for, `to measure` for the body that is given,
    /// or one between two drafts.
    ///
    /// # Errors
    /// As [`Self::parse`]; a size that is not made.
    pub fn sized(&self, size: &str, body: &Measures) -> Result<Pattern, PackageError> {
        if size == AS_DRAFTED {
            return Ok(self.parse()?);
        }
        let not_made = || PackageError::NotMade { name: self.name.clone(), size: size.into(), made: AS_DRAFTED.into() };
        self.graded()?.ok_or_else(not_made)?.sized(&self.name, size, body)
    }

    /// The size that its own draft is for.
    pub fn own_size(&self) -> &str {
        self.sizes.as_ref().map_or(AS_DRAFTED, |sizes| &sizes.size)
    }

    /// Whose bodies it is made for.
    ///
    /// # Errors
    /// A table that there is not.
    pub fn population(&self) -> Result<Population, SizeError> {
        self.sizes.as_ref().map_or(Ok(Population::Mixed), |s| Ok(SizeTable::embedded(&s.table)?.population))
    }

    /// The body that a size of its table is for; none for a size that is no code of a table.
    ///
    /// # Errors
    /// A table or size that there is not, a size of which no body can be made.
    pub fn body_of(&self, size: &str) -> Result<Option<Body>, PackageError> {
        let Some(sizes) = self.sizes.as_ref().filter(|_| size != AS_DRAFTED && size != TO_MEASURE) else {
            return Ok(None);
        };
        let table = SizeTable::embedded(&sizes.table)?;
        let sex = if table.population == Population::Men { Sex::Male } else { Sex::Female };
        let body = crate::body::build(sex, &Measures::from(table.size_body(size)?));
        body.map(Some).map_err(|e| PackageError::Content { file: self.name.clone(), reason: e.to_string() })
    }

    /// A pattern draped on a body, in a fabric.
    ///
    /// # Errors
    /// The panel or seam that is at fault.
    pub fn drape(&self, pattern: &Pattern, body: &Body, fabric: &Fabric) -> Result<DrapedPattern, PackageError> {
        drape(pattern, body, fabric, self.spacing_mm * 1e-3).map_err(|e| self.not_draped(e))
    }

    fn not_draped(&self, source: DrapeError) -> PackageError {
        PackageError::Drape { name: self.name.clone(), source }
    }

    /// The garment in a size on the body that the size is for, from which many others can be dressed sooner
    /// ([`Self::dress_from`]); none where the size is for no body of a table.
    ///
    /// # Errors
    /// As [`Self::sized`] and [`Self::drape`].
    pub fn hang(&self, fabric: Option<&Fabric>, size: &str) -> Result<Option<HungPattern>, PackageError> {
        let Some(body) = self.body_of(size)? else { return Ok(None) };
        let fabric = fabric.map_or_else(|| crate::fabric::built_in(&self.fabric), |f| Ok(f.clone()))?;
        let pattern = self.sized(size, &body.measures)?;
        let draped = self.drape(&pattern, &body, &fabric)?;
        Ok(Some(HungPattern { size: size.to_owned(), body, fabric, pattern, draped }))
    }

    /// The garment on a body, baked, from where it hangs on the body of its size: in a fraction of the time of
    /// [`Self::dress`], with folds that may lie another way.
    ///
    /// # Errors
    /// As [`Self::drape`].
    pub fn dress_from(&self, hung: &HungPattern, body: &Body) -> Result<Garment, PackageError> {
        let HungPattern { size, body: from, fabric, pattern, draped } = hung;
        let field = SkinField::new(body);
        let draped = drape_on((draped, from), pattern, (body, &field), fabric).map_err(|e| self.not_draped(e))?;
        self.baked(&self.worn(&draped, body, &field), size, fabric)
    }

    /// The garment's shape on a body, in a size.
    ///
    /// # Errors
    /// As [`Self::sized`] and [`Self::drape`].
    pub fn draft(&self, size: &str, body: &Body, fabric: &Fabric) -> Result<Shape, PackageError> {
        let pattern = self.sized(size, &body.measures)?;
        let field = SkinField::new(body);
        let draped =
            drape_around(&pattern, (body, &field), fabric, self.spacing_mm * 1e-3).map_err(|e| self.not_draped(e))?;
        Ok(self.worn(&draped, body, &field))
    }

    /// A draped pattern as it is worn.
    fn worn(&self, draped: &DrapedPattern, body: &Body, field: &SkinField) -> Shape {
        let mut shape = draped.shape(body, field);
        // Carried by the skin a scarf would press what is worn beneath it down to the skin.
        if self.layer.is_some_and(|layer| layer >= SCARVES) {
            shape.fixed.fill(false);
            shape.weights.fill(Default::default());
        }
        shape
    }

    /// The garment on a body, in a size, baked.
    ///
    /// # Errors
    /// As [`Self::draft`].
    pub fn dress(&self, size: &str, body: &Body) -> Result<Garment, PackageError> {
        self.dress_in(&crate::fabric::built_in(&self.fabric)?, size, body)
    }

    /// The same in another fabric.
    ///
    /// # Errors
    /// As [`Self::draft`].
    pub fn dress_in(&self, fabric: &Fabric, size: &str, body: &Body) -> Result<Garment, PackageError> {
        self.baked(&self.draft(size, body, fabric)?, size, fabric)
    }

    fn baked(&self, shape: &Shape, size: &str, fabric: &Fabric) -> Result<Garment, PackageError> {
        let baked = bake(&self.name, size, shape, fabric);
        let mut garment = baked.map_err(|e| self.not_draped(DrapeError::Mesh(e)))?;
        garment.set_layer(self.layer.unwrap_or(LAYER));
        Ok(garment)
    }
}
