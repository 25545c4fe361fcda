//! What there is to choose from of a garment: its sizes with their girths, and the ease that feels right.

use std::f32::consts::TAU;

use toile_assets::adapt::{OwnMesh, dress as own};
use toile_assets::draping::{
    self, AS_DRAFTED, PatternEase, PatternPackage, PatternSizes, SizeGirths, TO_MEASURE, ZoneEase,
};
use toile_assets::pattern::Pattern;
use toile_assets::sizes::{GarmentKind, Girth, SizeBody, SizeError, SizeTable};
use toile_base::body::{Body, Measures, Sex};
use toile_track::measure::Measurements;
use toile_track::recommend::{self, EaseRange, MadeSize, Offer, RecommendError, Recommendation, ZoneGirth};

use crate::FittingError;

/// A garment in its sizes, as a size is chosen by.
#[derive(Debug, Clone, PartialEq)]
pub struct GarmentOffer {
    /// Name of the garment.
    pub garment: String,
    /// What it is.
    pub kind: GarmentKind,
    /// The table that its sizes are designated by.
    pub table: SizeTable,
    /// The sizes that are made, smallest first; one alone need not be in the table.
    pub sizes: Vec<MadeSize>,
    /// Comfortable ease at the zones that matter.
    pub ease: Vec<EaseRange>,
    /// Thickness of its cloth as it lies on other cloth (m): what is worn over it goes around that.
    pub thickness_m: f32,
}

impl GarmentOffer {
    /// A mesh of the user's own; none of one that has no sizes.
    ///
    /// # Errors
    /// A size that there is not.
    pub fn of_mesh(own: &OwnMesh) -> Result<Option<Self>, FittingError> {
        let Some(mesh) = &own.sizes else { return Ok(None) };
        let sizes = made(&mesh.table, |size| own.finished_in(mesh, size)).map_err(FittingError::input)?;
        let ease = ranges(own::comfort(own, mesh.kind));
        let garment = own.measures.name.clone().unwrap_or_else(|| own.path.clone());
        Ok(Some(Self { garment, kind: mesh.kind, table: mesh.table.clone(), sizes, ease, thickness_m: 0.0 }))
    }

    /// A sewn pattern. Its girths are those of its panels: as its package has them, or on the bodies of its sizes where it has any, else on `wearer`.
    ///
    /// # Errors
    /// A pattern that cannot be read, or laid around the body.
    pub fn of_pattern(package: &PatternPackage, wearer: &Body) -> Result<Self, FittingError> {
        match &package.sizes {
            Some(sizes) => in_sizes(package, sizes),
            None => as_drafted(package, wearer),
        }
    }

    /// The same pattern graded for one body's own measures: one size.
    ///
    /// # Errors
    /// As [`Self::of_pattern`]; a pattern that has no sizes.
    pub fn made_to_measure(package: &PatternPackage, wearer: &Body) -> Result<Self, FittingError> {
        let pattern = package.sized(TO_MEASURE, &wearer.measures).map_err(FittingError::input)?;
        let offer = Self::of_pattern(package, wearer)?;
        let judged: Vec<Girth> = offer.table.designation(offer.kind).map_or_else(Vec::new, |d| d.primary.clone());
        let zones = on(package, &pattern, wearer)?.judged(&judged);
        Ok(Self { sizes: vec![made_size(TO_MEASURE.into(), &zones, wearer)], ..offer })
    }

    /// The size that fits, or the one asked for, judged at every zone that the garment reaches.
    ///
    /// # Errors
    /// A size that is not made, a table that does not know what it is.
    pub fn judge(&self, size: Option<&str>, measured: &Measurements) -> Result<Recommendation, FittingError> {
        let Self { garment, kind, table, sizes, ease, .. } = self;
        let offer = Offer { garment, kind: *kind, table, sizes, ease };
        match size {
            None if self.is_single() => recommend::judge_only(measured, &offer),
            Some(size) if self.is_single() && sizes[0].code == size => recommend::judge_only(measured, &offer),
            Some(size) if self.is_single() => Err(RecommendError::NotMade {
                garment: garment.clone(),
                size: size.to_owned(),
                sizes: sizes[0].code.clone(),
            }),
            Some(size) => recommend::evaluate(measured, &offer, size),
            None => recommend::recommend(measured, &offer),
        }
        .map_err(FittingError::input)
    }

    /// The same worn over other garments: what they take of its girth, their thickness all around, is no ease. A shirt of 3 mm
    /// takes 19 mm.
    #[must_use]
    pub fn over(mut self, beneath: &[Self]) -> Self {
        for zone in self.sizes.iter_mut().flat_map(|size| &mut size.zones) {
            let reaches = |other: &&Self| other.sizes.iter().any(|size| size.zones.iter().any(|z| z.zone == zone.zone));
            zone.girth_m -= TAU * beneath.iter().filter(reaches).map(|other| other.thickness_m).sum::<f32>();
        }
        self
    }

    /// Whether there is one size.
    pub const fn is_single(&self) -> bool {
        self.sizes.len() == 1
    }

    /// The comfortable ease at a zone, least and most (m).
    pub fn comfort(&self, zone: Girth) -> Option<[f32; 2]> {
        self.ease.iter().find(|e| e.zone == zone).map(|e| [e.least, e.most])
    }
}

fn ranges(comfort: impl IntoIterator<Item = (Girth, [f32; 2])>) -> Vec<EaseRange> {
    comfort.into_iter().map(|(zone, [least, most])| EaseRange { zone, least, most }).collect()
}

/// Every size of a table with the finished girths of the garment.
fn made(table: &SizeTable, finished: impl Fn(&SizeBody) -> Vec<(Girth, f32)>) -> Result<Vec<MadeSize>, SizeError> {
    let size = |code: &str| {
        let finished = finished(&table.size_body(code)?);
        let zones = finished.into_iter().map(|(zone, girth_m)| ZoneGirth { zone, girth_m }).collect();
        Ok(MadeSize { code: code.into(), zones })
    };
    table.codes().into_iter().map(size).collect()
}

/// The girths of every size of a pattern, by its panels on the bodies that the sizes are for; none of a pattern without sizes.
///
/// # Errors
/// A pattern that cannot be read, or laid around a body.
pub fn girths(package: &PatternPackage) -> Result<Vec<SizeGirths>, FittingError> {
    let Some(graded) = package.graded().map_err(FittingError::input)? else { return Ok(Vec::new()) };
    let mut girths = Vec::new();
    for (size, pattern) in graded.made() {
        let Some(own) = package.body_of(&size).map_err(FittingError::input)? else { continue };
        let made = made_size(size, &on(package, &pattern, &own)?.judged(&[graded.girth]), &own);
        let at = |zone: Girth| {
            let girth = made.zones.iter().find(|z| z.zone == zone).map(|z| f64::from(z.girth_m));
            girth.map(|m| (m * 1e4).round() * 0.1)
        };
        let [chest_mm, waist_mm, hip_mm] = [Girth::Chest, Girth::Waist, Girth::Hip].map(at);
        girths.push(SizeGirths { size: made.code, chest_mm, waist_mm, hip_mm });
    }
    Ok(girths)
}

/// All sizes of a graded pattern. As wide a range of ease as garments of its kind have feels right around what the sizes leave
/// the bodies that they are for, in the mean.
fn in_sizes(package: &PatternPackage, sizes: &PatternSizes) -> Result<GarmentOffer, FittingError> {
    let table = SizeTable::embedded(&sizes.table).map_err(FittingError::input)?;
    let girths = if sizes.girths.is_empty() { girths(package)? } else { sizes.girths.clone() };
    let (mut made, mut eases) = (Vec::new(), Vec::new());
    for size in &girths {
        let own = Measures::from(table.size_body(&size.size).map_err(FittingError::input)?);
        let zone = |zone: Girth| size.at(zone).map(|girth| ZoneGirth { zone, girth_m: girth as f32 });
        let zones: Vec<ZoneGirth> = Girth::ALL.into_iter().filter_map(zone).collect();
        eases.extend(zones.iter().map(|z| (z.zone, z.girth_m - z.zone.of(&own))));
        made.push(MadeSize { code: size.size.clone(), zones });
    }
    let around = sizes.kind.comfort().iter().map(|&(zone, [least, most])| {
        let at: Vec<f32> = eases.iter().filter(|(at, _)| *at == zone).map(|(_, ease)| *ease).collect();
        let mean = at.iter().sum::<f32>() / at.len().max(1) as f32;
        let shift = if at.is_empty() { 0.0 } else { mean - 0.5 * (least + most) };
        (zone, [least + shift, most + shift])
    });
    let ease = ranges(around);
    Ok(GarmentOffer { garment: package.name.clone(), kind: sizes.kind, table, sizes: made, ease, thickness_m: 0.0 })
}

/// A pattern without sizes: what it is, its panels say.
fn as_drafted(package: &PatternPackage, wearer: &Body) -> Result<GarmentOffer, FittingError> {
    let pattern = package.parse().map_err(FittingError::input)?;
    let found = on(package, &pattern, wearer)?;
    let women = SizeTable::embedded("women").map_err(FittingError::internal)?;
    let men = SizeTable::embedded("men").map_err(FittingError::internal)?;
    // No table sizes men's dresses and skirts.
    let table = if wearer.sex == Sex::Male && men.designation(found.kind).is_some() { men } else { women };
    let primary = table.designation(found.kind).map_or_else(Vec::new, |d| d.primary.clone());
    let sizes = vec![made_size(AS_DRAFTED.to_owned(), &found.judged(&primary), wearer)];
    let ease = ranges(found.kind.comfort().iter().copied());
    Ok(GarmentOffer { garment: package.name.clone(), kind: found.kind, table, sizes, ease, thickness_m: 0.0 })
}

fn on(package: &PatternPackage, pattern: &Pattern, body: &Body) -> Result<PatternEase, FittingError> {
    draping::ease(pattern, body).map_err(|e| FittingError::Input(format!("{}: {e}", package.name)))
}

/// The girths that leave on a body's own girths what the pattern leaves where it meets the body.
fn made_size(code: String, zones: &[ZoneEase], body: &Body) -> MadeSize {
    let girth = |z: &ZoneEase| ZoneGirth { zone: z.zone, girth_m: z.zone.of(&body.measures) + z.ease() as f32 };
    let zones = zones.iter().map(girth).collect();
    MadeSize { code, zones }
}
