//! A garment to wear: one of the wardrobe, a mesh, or a sewn pattern, each in its sizes.

use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;

use toile_assets::adapt::{AdaptError, MeshReport, OwnMesh, dress as own, source};
use toile_assets::catalogue::limits::{MAX_PACKAGE_BYTES, MAX_TOML_BYTES};
use toile_assets::catalogue::package::ENDING;
use toile_assets::catalogue::{GarmentPackage, GarmentPhotographs, word};
use toile_assets::drafting;
use toile_assets::draping::{self, AS_DRAFTED, HungPattern, PatternPackage, TO_MEASURE};
use toile_assets::sizes::{Population, SizeTable};
use toile_base::body::{Body, Measures, Sex};
use toile_base::fabric::Fabric;
use toile_base::garment::Garment;
use toile_track::measure::Measurements;
use toile_track::recommend::Recommendation;

use super::offer::GarmentOffer;
use crate::FittingError;

/// Where a garment comes from: opened and checked, in all of its sizes. It can be put on many bodies.
#[derive(Debug, Clone)]
pub struct GarmentSource {
    /// The name that it was found by: one of the wardrobe, or a path. A request finds it again by this name.
    pub name: String,
    /// The data that it is made from.
    pub kind: SourceKind,
    /// A fabric in place of its own.
    pub fabric: Option<Fabric>,
    /// The layer in which a shop has it worn, in place of its own.
    pub layer: Option<u8>,
    /// Photographs that a shop lays on its cloth.
    pub photographs: Option<Arc<GarmentPhotographs>>,
}

/// The data that a garment is made from.
#[derive(Debug, Clone)]
pub enum SourceKind {
    /// A mesh of the user's own.
    Mesh(Box<OwnMesh>),
    /// A garment of the wardrobe, a sewn pattern, or a garment package.
    Pattern(Box<PatternPackage>),
}

/// A garment and its fabric, where a name has both: `shirt:lawn-gingham`. A path may hold a colon too.
fn in_fabric(name: &str) -> Option<(&str, &str)> {
    let (garment, fabric) = name.rsplit_once(':')?;
    let is_word = fabric.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
    (garment.len() > 1 && is_word && !Path::new(name).exists()).then_some((garment, fabric))
}

/// A garment on the body, and how its size fits; a mesh may have no sizes.
#[derive(Debug, Clone)]
pub struct FittedGarment {
    /// The garment, baked; a mesh of several layers becomes one for each, the innermost first.
    pub garments: Vec<Garment>,
    /// Of a mesh of the user's own: the vertex of the repaired mesh that each vertex of a garment's shape is `[garments][vertices]`.
    pub mesh_vertices: Vec<Vec<u32>>,
    /// How it fits; none where it was not recommended.
    pub fit: Option<Recommendation>,
    /// Report on a mesh of the user's own; `None` for any other garment.
    pub mesh: Option<MeshReport>,
}

/// The people whom these garments are made for: the first garment that is made for women or men alone decides.
///
/// # Errors
/// A garment whose size table cannot be used.
pub fn population<'a>(sources: impl IntoIterator<Item = &'a GarmentSource>) -> Result<Population, FittingError> {
    for source in sources {
        let population = source.population()?;
        if population != Population::Mixed {
            return Ok(population);
        }
    }
    Ok(Population::Mixed)
}

impl GarmentSource {
    /// The garment of a name: a pattern by its ending, one of the wardrobe, or else a mesh, where a file of that name exists. Behind a colon its fabric may stand, one that is built in: `shirt:lawn-gingham`.
    ///
    /// # Errors
    /// A name that is none of these, a file that cannot be used.
    pub fn find(name: &str) -> Result<Self, FittingError> {
        let path = Path::new(name);
        if let Some((garment, fabric)) = in_fabric(name) {
            let found = Self::find(garment)?;
            let fabric = toile_assets::fabric::built_in(fabric).map_err(FittingError::input)?;
            return Ok(Self { name: name.to_owned(), ..found.in_fabric(fabric) });
        }
        if name.ends_with(ENDING) {
            return Self::open(path);
        }
        let kind = if draping::is_pattern(name) {
            SourceKind::Pattern(Box::new(draping::read_package(path, None).map_err(FittingError::input)?))
        } else if drafting::style(name).is_none() && (path.exists() || source::is_mesh(name)) {
            SourceKind::Mesh(Box::new(OwnMesh::read(path).map_err(FittingError::input)?))
        } else {
            SourceKind::Pattern(Box::new(drafting::package(name).map_err(FittingError::input)?))
        };
        Ok(Self { name: name.to_owned(), kind, fabric: None, layer: None, photographs: None })
    }

    /// The same garment in another fabric.
    #[must_use]
    pub fn in_fabric(self, fabric: Fabric) -> Self {
        Self { fabric: Some(fabric), ..self }
    }

    /// The garment of a package.
    ///
    /// # Errors
    /// A package that cannot be read, a pattern, mesh or fabric in it that cannot be used.
    pub fn open(path: &Path) -> Result<Self, FittingError> {
        let package = GarmentPackage::open(path).map_err(FittingError::input)?;
        Self::of_package(package, &path.display().to_string())
    }

    /// The garment of a package that is open; `shown` is its name.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn of_package(mut package: GarmentPackage, shown: &str) -> Result<Self, FittingError> {
        let manifest = package.manifest().map_err(FittingError::input)?;
        let inside = |e: &dyn Display| FittingError::Input(format!("{shown}: {e}"));
        let kind = if manifest.is_built_in() {
            SourceKind::Pattern(Box::new(drafting::package(&manifest.garment).map_err(FittingError::input)?))
        } else if manifest.is_pattern() {
            let text = package.text(&manifest.garment, MAX_PACKAGE_BYTES).map_err(FittingError::input)?;
            let seams = manifest.seams.as_deref().map(|seams| package.text(seams, MAX_TOML_BYTES)).transpose();
            let seams = seams.map_err(FittingError::input)?;
            let mut pattern = draping::parse_package(&manifest.garment, text, seams).map_err(|e| inside(&e))?;
            pattern.name.clone_from(&manifest.garment);
            pattern.parse().map_err(|e| inside(&e))?;
            pattern.name = word(&manifest.names, "en").to_owned();
            SourceKind::Pattern(Box::new(pattern))
        } else {
            let unpacked = package.unpack().map_err(FittingError::input)?;
            // The author of the package does not know the folder that it is unpacked into.
            let folder = format!("{}/", unpacked.path.display());
            let named = |e: AdaptError| FittingError::Input(format!("{shown}: {}", e.to_string().replace(&folder, "")));
            let mut mesh = OwnMesh::read(&unpacked.path.join(&manifest.garment)).map_err(named)?;
            mesh.measures.name.get_or_insert_with(|| word(&manifest.names, "en").to_owned());
            SourceKind::Mesh(Box::new(mesh))
        };
        let fabric = manifest.fabric.as_deref().map(|fabric| match fabric.ends_with(".toml") {
            true => {
                let text = package.text(fabric, MAX_TOML_BYTES).map_err(FittingError::input)?;
                let mut fabric = toile_assets::fabric::parse(fabric, &text).map_err(|e| inside(&e))?;
                let picture = |name: &str| package.bytes(name, MAX_PACKAGE_BYTES).map_err(|e| e.to_string());
                toile_assets::fabric::read_picture(&mut fabric, picture).map_err(|e| inside(&e))?;
                Ok(fabric)
            }
            false => toile_assets::fabric::built_in(fabric).map_err(|e| inside(&e)),
        });
        let fabric = fabric.transpose()?;
        let picture = |name: &str| package.bytes(name, MAX_PACKAGE_BYTES).map_err(|e| e.to_string());
        let photographs = manifest.image.as_ref().map(|image| image.read(picture).map(Arc::new)).transpose();
        let photographs = photographs.map_err(|e| inside(&e))?;
        Ok(Self { name: shown.to_owned(), kind, fabric, layer: manifest.layer, photographs })
    }

    /// The population that it is made for; a garment that names none is made for women and men.
    ///
    /// # Errors
    /// A size table that cannot be used.
    pub fn population(&self) -> Result<Population, FittingError> {
        match &self.kind {
            SourceKind::Mesh(own) => Ok(own.sex.into()),
            SourceKind::Pattern(package) => package.population().map_err(FittingError::input),
        }
    }

    /// The fabric that it is made of.
    ///
    /// # Errors
    /// An unknown fabric.
    pub fn fabric(&self) -> Result<Fabric, FittingError> {
        let named = match (&self.fabric, &self.kind) {
            (Some(fabric), _) => return Ok(fabric.clone()),
            (None, SourceKind::Mesh(own)) => own.measures.fabric.as_deref().unwrap_or(draping::FABRIC),
            (None, SourceKind::Pattern(package)) => &package.fabric,
        };
        toile_assets::fabric::built_in(named).map_err(FittingError::input)
    }

    /// Its sizes; `None` for a mesh without sizes. A pattern without sizes is judged on `wearer`.
    ///
    /// # Errors
    /// Sizes that cannot be used, a pattern that cannot be laid around a body.
    pub fn offer(&self, wearer: &Body) -> Result<Option<GarmentOffer>, FittingError> {
        let offer = match &self.kind {
            SourceKind::Mesh(own) => GarmentOffer::of_mesh(own),
            SourceKind::Pattern(package) => GarmentOffer::of_pattern(package, wearer).map(Some),
        };
        let thickness_m = self.fabric()?.thickness_mm * 1e-3;
        Ok(offer?.map(|offer| GarmentOffer { thickness_m, ..offer }))
    }

    /// The body that it is shown on where no person is measured, and its size there. This is the body of its middle size. A pattern without
    /// sizes is shown on a body on which it has ease, and a mesh without sizes on the body that it is made for.
    ///
    /// # Errors
    /// As [`Self::offer`].
    pub fn shown_on(&self) -> Result<(Sex, Measures, String), FittingError> {
        let sex = if self.population()? == Population::Men { Sex::Male } else { Sex::Female };
        let of_size = |table: &SizeTable, code: &str| {
            let measures = Measures::from(table.size_body(code).map_err(FittingError::input)?);
            Ok((sex, measures, code.to_owned()))
        };
        let middle = |codes: &[&str]| codes.get(codes.len() / 2).map_or_else(String::new, |code| (*code).to_owned());
        match &self.kind {
            SourceKind::Mesh(own) => match &own.sizes {
                Some(sizes) => of_size(&sizes.table, &middle(&sizes.table.codes())),
                None => Ok((own.made_for.body.sex, own.made_for.body.measures, own::UNKNOWN.to_owned())),
            },
            SourceKind::Pattern(package) => match package.graded().map_err(FittingError::input)? {
                Some(graded) => {
                    let made = graded.made();
                    let codes: Vec<&str> = made.iter().map(|(code, _)| code.as_str()).collect();
                    of_size(&graded.table, &middle(&codes))
                }
                None => {
                    let women = SizeTable::embedded("women").map_err(FittingError::internal)?;
                    let pattern = package.parse().map_err(FittingError::input)?;
                    let code = draping::fitting_size(&pattern, &women, sex).map_err(FittingError::input)?;
                    Ok((sex, of_size(&women, &code)?.1, AS_DRAFTED.to_owned()))
                }
            },
        }
    }

    /// Measures of the body that a size is for; none where it is a size of no table.
    ///
    /// # Errors
    /// A size that is not made.
    pub fn body_of(&self, size: &str) -> Result<Option<Measures>, FittingError> {
        let table = match &self.kind {
            SourceKind::Mesh(own) => own.sizes.as_ref().map(|sizes| sizes.table.clone()),
            SourceKind::Pattern(package) => {
                return Ok(package.body_of(size).map_err(FittingError::input)?.map(|body| body.measures));
            }
        };
        table.map(|table| table.size_body(size).map(Measures::from)).transpose().map_err(FittingError::input)
    }

    /// The size that fits over the garments beneath, or the fit of the requested size; `None` for a mesh without sizes.
    ///
    /// # Errors
    /// A size that is not made; as [`Self::offer`].
    pub fn judge(
        &self,
        size: Option<&str>,
        measured: &Measurements,
        wearer: &Body,
        beneath: &[GarmentOffer],
    ) -> Result<Option<Recommendation>, FittingError> {
        let offer = match (&self.kind, size) {
            (SourceKind::Pattern(package), Some(TO_MEASURE)) => Some(GarmentOffer::made_to_measure(package, wearer)?),
            _ => self.offer(wearer)?,
        };
        offer.map(|offer| offer.over(beneath).judge(size, measured)).transpose()
    }

    /// The garment in a size on a body, baked; a mesh without sizes has `unknown` or none.
    ///
    /// # Errors
    /// A size that is not made, a mesh or pattern that cannot be laid on the body.
    pub fn dress(&self, size: Option<&str>, wearer: &Body) -> Result<FittedGarment, FittingError> {
        let mut worn = FittedGarment { garments: Vec::new(), mesh_vertices: Vec::new(), fit: None, mesh: None };
        match &self.kind {
            SourceKind::Mesh(mesh) => {
                let size = size.filter(|size| *size != own::UNKNOWN);
                let dressed = own::dress_in(mesh, self.fabric.as_ref(), size, wearer);
                let dressed = dressed.map_err(FittingError::input)?;
                worn.mesh_vertices = dressed.vertices;
                (worn.garments, worn.mesh) = (dressed.garments, Some(dressed.report));
            }
            SourceKind::Pattern(package) => {
                let size = size.unwrap_or_else(|| package.own_size());
                let dressed = match &self.fabric {
                    Some(fabric) => package.dress_in(fabric, size, wearer),
                    None => package.dress(size, wearer),
                };
                worn.garments.push(dressed.map_err(FittingError::input)?);
            }
        }
        self.finished(worn, wearer)
    }

    /// The garment in a size as it hangs on the body that the size is for: what [`Self::dress_from`] begins with. None where it is
    /// not sewn, or the size is for no body of a table.
    ///
    /// # Errors
    /// A pattern that cannot be laid on that body.
    pub fn hang(&self, size: &str) -> Result<Option<HungPattern>, FittingError> {
        match &self.kind {
            SourceKind::Pattern(package) => package.hang(self.fabric.as_ref(), size).map_err(FittingError::input),
            SourceKind::Mesh(_) => Ok(None),
        }
    }

    /// As [`Self::dress`], from where it hangs on the body of its size: sooner, with folds that may lie another way.
    ///
    /// # Errors
    /// A pattern that cannot be laid on the body; one that hangs and is not this garment's.
    pub fn dress_from(&self, hung: &HungPattern, wearer: &Body) -> Result<FittedGarment, FittingError> {
        let SourceKind::Pattern(package) = &self.kind else {
            return Err(FittingError::Internal(format!("{} is not sewn", self.name)));
        };
        let garment = package.dress_from(hung, wearer).map_err(FittingError::input)?;
        self.finished(
            FittedGarment { garments: vec![garment], mesh_vertices: Vec::new(), fit: None, mesh: None },
            wearer,
        )
    }

    /// Garments in the shop's layer and with its photographs.
    fn finished(&self, mut worn: FittedGarment, wearer: &Body) -> Result<FittedGarment, FittingError> {
        for garment in &mut worn.garments {
            garment.set_layer(self.layer.unwrap_or(garment.layer));
            if let Some(photographs) = &self.photographs {
                photographs.lay_on(garment, wearer).map_err(|e| FittingError::Input(format!("{}: {e}", self.name)))?;
            }
        }
        Ok(worn)
    }

    /// Sizes the garment for measures, over the garments beneath, and bakes it onto a body.
    ///
    /// # Errors
    /// As [`Self::judge`] and [`Self::dress`].
    pub fn put_on(
        &self,
        size: Option<&str>,
        measured: &Measurements,
        wearer: &Body,
        beneath: &[GarmentOffer],
    ) -> Result<FittedGarment, FittingError> {
        if let Some(photographs) = &self.photographs {
            let refused = |e| FittingError::Input(format!("{} cannot be worn: {e}; choose another garment", self.name));
            photographs.manifest().worn_by(&wearer.measures).map_err(refused)?;
        }
        let fit = self.judge(size, measured, wearer, beneath)?;
        let worn = self.dress(fit.as_ref().map(|fit| fit.size.as_str()).or(size), wearer)?;
        Ok(FittedGarment { fit, ..worn })
    }
}
