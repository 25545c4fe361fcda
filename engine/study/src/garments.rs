//! The garments of a study: open, in their sizes, each judged on girths alone.

use std::path::Path;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};
use toile_assets::draping::HungPattern;
use toile_assets::sizes::{Girth, Population as MadeFor};
use toile_base::body::{Body, Measures, Sex};
use toile_fitting::dress::garment_source::{FittedGarment, GarmentSource};
use toile_fitting::dress::offer::GarmentOffer;

use crate::error::{Result, StudyError};
use crate::study_file::WantedGarment;

/// A garment that is tried on.
#[derive(Debug, Clone)]
pub struct TriedGarment {
    /// What the study names it by.
    pub name: String,
    /// Where it comes from.
    pub source: GarmentSource,
    /// All sizes that are made, and what is comfortable.
    pub offer: GarmentOffer,
    /// The sizes that are tried: indices into those of the offer, smallest first.
    pub tried: Vec<usize>,
    /// Whose bodies it is made for.
    pub made_for: MadeFor,
    /// How each size of the offer hangs on its own body, once it was asked for; none where it cannot `[sizes]`.
    hung: Vec<OnceLock<Option<HungPattern>>>,
}

toile_base::named! {
    /// What draping begins with.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum DrapeStart {
        /// The garment as it hangs on the body that its size is for.
        Size = "size",
        /// Its panels, laid around each body.
        Panels = "panels",
    }
}

/// How a zone of a size is on a person's true girth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneEase {
    /// Where.
    pub zone: Girth,
    /// Girth of the garment less the body's (m).
    pub ease: f32,
    /// What is comfortable (m), where the zone is judged.
    pub comfort: Option<[f32; 2]>,
}

impl ZoneEase {
    /// `tight`, `good` or `loose`; none where it is not judged.
    pub fn verdict(&self) -> Option<&'static str> {
        self.comfort.map(|[least, most]| match self.ease {
            ease if ease < least => "tight",
            ease if ease > most => "loose",
            _ => "good",
        })
    }
}

/// What a page needs to know of a garment, as a note of the Parquet file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GarmentNote {
    /// What the study names it by.
    pub name: String,
    /// Its kind.
    pub kind: String,
    /// The size table.
    pub table: String,
    /// The girth that its size is designated by.
    pub primary: String,
    /// Zones that it is judged by, with the least and the most comfortable ease (mm).
    pub comfort_mm: Vec<(String, [f64; 2])>,
    /// Weight of each of these zones in the choice of a size.
    pub weight: Vec<f64>,
    /// Each size that is made, smallest first, with its girths at these zones (mm).
    pub sizes: Vec<(String, Vec<Option<f64>>)>,
    /// The sizes that are tried.
    pub tried: Vec<String>,
    /// SHA-256 of the garment's file; none of one that is built in.
    pub sha256: Option<String>,
}

impl TriedGarment {
    /// Opens a garment; paths are from `folder`.
    ///
    /// # Errors
    /// An unknown garment, fabric or size; one that has no sizes.
    pub fn open(wanted: &WantedGarment, folder: &Path) -> Result<Self> {
        let beside = folder.join(&wanted.name);
        let found = if beside.is_file() { beside.display().to_string() } else { wanted.name.clone() };
        let mut source = GarmentSource::find(&found)?;
        if let Some(fabric) = &wanted.fabric {
            let fabric = toile_assets::fabric::built_in(fabric).map_err(|e| {
                StudyError::Input(format!("{e}; there are {}", toile_assets::fabric::names().join(", ")))
            })?;
            source = source.in_fabric(fabric);
        }
        let made_for = source.population()?;
        let sex = if made_for == MadeFor::Men { Sex::Male } else { Sex::Female };
        let body = toile_assets::body::build(sex, &Measures::average(sex)).map_err(StudyError::internal)?;
        let name = wanted.name.clone();
        let offer = source.offer(&body)?.filter(|offer| !offer.is_single()).ok_or_else(|| {
            StudyError::Input(format!(
                "{name} is made in no sizes, of which a study asks; give its sizes (docs/garments.md, docs/meshes.md) or leave it out"
            ))
        })?;
        let codes: Vec<&str> = offer.sizes.iter().map(|size| size.code.as_str()).collect();
        let place = |size: &String| {
            codes.iter().position(|code| code == size).ok_or_else(|| {
                StudyError::Input(format!("{name} is not made in size {size}; choose of {}", codes.join(", ")))
            })
        };
        let mut tried: Vec<usize> = wanted.sizes.iter().map(place).collect::<Result<_>>()?;
        if tried.is_empty() {
            tried = (0..codes.len()).collect();
        }
        tried.sort_unstable();
        tried.dedup();
        let hung = offer.sizes.iter().map(|_| OnceLock::new()).collect();
        Ok(Self { name, source, offer, tried, made_for, hung })
    }

    /// The garment in a size on a body: sewn up around it, or taken over from the body of its size (what that is depends on the
    /// garment and the size alone, so that every worker computes the same row).
    ///
    /// # Errors
    /// A garment that cannot be laid on this body.
    pub fn dress(&self, size: &str, body: &Body, start: DrapeStart) -> Result<FittedGarment> {
        let at = self.offer.sizes.iter().position(|made| made.code == size);
        let hung = at.filter(|_| start == DrapeStart::Size).and_then(|at| {
            // What does not hang on its own body is sewn up around each.
            self.hung[at].get_or_init(|| self.source.hang(size).ok().flatten()).as_ref()
        });
        // So is what does not come over.
        let carried = hung.and_then(|hung| self.source.dress_from(hung, body).ok());
        carried.map_or_else(|| Ok(self.source.dress(Some(size), body)?), Ok)
    }

    /// Whether it is made for a person of a sex.
    pub fn is_for(&self, sex: Sex) -> bool {
        !matches!((self.made_for, sex), (MadeFor::Women, Sex::Male) | (MadeFor::Men, Sex::Female))
    }

    /// The zones of a size on true girths.
    pub fn eases(&self, size: usize, body: &Measures) -> Vec<ZoneEase> {
        let zones = self.offer.sizes[size].zones.iter();
        zones
            .map(|z| ZoneEase { zone: z.zone, ease: z.girth_m - z.zone.of(body), comfort: self.offer.comfort(z.zone) })
            .collect()
    }

    /// The girth that its size is designated by.
    pub fn primary(&self) -> Girth {
        let designation = self.offer.table.designation(self.offer.kind);
        designation.and_then(|d| d.primary.first().copied()).unwrap_or(Girth::Chest)
    }

    /// The size whose range in the table holds the girth that designates it.
    pub fn by_table(&self, body: &Measures) -> Option<&str> {
        let girth = self.primary();
        let inside = |code: &&str| {
            self.offer.table.size(code).is_ok_and(|size| {
                let [least, most] = size.range(girth);
                (least..most).contains(&girth.of(body))
            })
        };
        self.offer.sizes.iter().map(|size| size.code.as_str()).find(inside)
    }

    /// What a page needs to know of it.
    pub fn note(&self, sha256: Option<String>) -> GarmentNote {
        let mm = |m: f32| f64::from(m) * 1e3;
        let zones: Vec<Girth> = self.offer.ease.iter().map(|e| e.zone).collect();
        let girths = |size: &toile_track::recommend::MadeSize| {
            let at = |zone: &Girth| size.zones.iter().find(|z| z.zone == *zone).map(|z| mm(z.girth_m));
            (size.code.clone(), zones.iter().map(at).collect())
        };
        let designation = self.offer.table.designation(self.offer.kind);
        let weight = |zone: &Girth| match designation {
            Some(d) if d.primary.contains(zone) => toile_track::recommend::WEIGHTS[0],
            Some(d) if d.secondary.contains(zone) => toile_track::recommend::WEIGHTS[1],
            _ => toile_track::recommend::WEIGHTS[2],
        };
        GarmentNote {
            name: self.name.clone(),
            kind: self.offer.kind.name().to_owned(),
            table: self.offer.table.name.clone(),
            primary: self.primary().name().to_owned(),
            comfort_mm: self.offer.ease.iter().map(|e| (e.zone.name().to_owned(), [mm(e.least), mm(e.most)])).collect(),
            weight: zones.iter().map(|zone| f64::from(weight(zone))).collect(),
            sizes: self.offer.sizes.iter().map(girths).collect(),
            tried: self.tried.iter().map(|size| self.offer.sizes[*size].code.clone()).collect(),
            sha256,
        }
    }
}
