//! The size of a sewn pattern, judged by the girths of its own panels on the shopper's body.

use toile_assets::body::{Body, Sex};
use toile_assets::draping::{self, AS_DRAFTED, GradedPattern, PatternPackage, TO_MEASURE, ZoneEase};
use toile_assets::pattern::Pattern;
use toile_assets::sizes::{GarmentKind, Girth, SizeTable};
use toile_assets::wardrobe::own;
use toile_track::measure::Measurements;
use toile_track::recommend::{self, EaseRange, MadeSize, Offer, Recommendation, ZoneGirth};

use crate::FittingError;

/// A pattern in the sizes that it is made in, and who they are for.
struct Made {
    table: SizeTable,
    kind: GarmentKind,
    sizes: Vec<MadeSize>,
    /// Ease that the drafts leave on the bodies that they are for, in the mean (m); none of a pattern for nobody in particular.
    designed: Vec<(Girth, f64)>,
}

/// The size of a pattern that fits a body, or the one asked for: a code of its table, or `to measure` where it has drafts for
/// sizes. A pattern that has no sizes is judged as it is drafted.
///
/// # Errors
/// A size that is not made, a pattern that cannot be read or laid around the body.
pub fn judge_pattern(
    package: &PatternPackage,
    size: Option<&str>,
    measured: &Measurements,
    body: &Body,
) -> Result<Recommendation, FittingError> {
    let graded = package.graded().map_err(FittingError::input)?;
    let made = match (graded, size) {
        (Some(graded), size) => in_sizes(package, &graded, size, body)?,
        (None, None | Some(AS_DRAFTED)) => as_drafted(package, body)?,
        (None, Some(size)) => {
            package.sized(size, &body.measures).map_err(FittingError::input)?;
            as_drafted(package, body)?
        }
    };
    let ease = comfort(&made)?;
    let Made { table, kind, sizes, .. } = &made;
    let offer = Offer { garment: &package.name, kind: *kind, table, sizes, ease: &ease };
    match size {
        _ if sizes.len() == 1 => recommend::judge_only(measured, &offer),
        Some(size) => recommend::evaluate(measured, &offer, size),
        None => recommend::recommend(measured, &offer),
    }
    .map_err(FittingError::input)
}

/// The ease that feels right: as garments of the kind have it; where the drafts are for bodies of a table, as wide a range
/// around what they leave those.
fn comfort(made: &Made) -> Result<Vec<EaseRange>, FittingError> {
    let usual = own::comfort_of(made.kind).map_err(FittingError::input)?;
    let range = |(zone, [least, most]): (Girth, [f32; 2])| {
        let designed = made.designed.iter().find(|(at, _)| *at == zone).map(|(_, ease)| *ease as f32);
        let shift = designed.map_or(0.0, |designed| designed - 0.5 * (least + most));
        EaseRange { zone, least: least + shift, most: most + shift }
    };
    Ok(usual.into_iter().map(range).collect())
}

/// What the sizes leave on the bodies that they are for, in the mean (m).
fn designed(package: &PatternPackage, sizes: &[(String, Pattern)]) -> Result<Vec<(Girth, f64)>, FittingError> {
    let mut found: Vec<(Girth, f64)> = Vec::new();
    for (code, pattern) in sizes {
        let Some(own) = package.body_of(code).map_err(FittingError::input)? else { continue };
        found.extend(on(package, pattern, &own)?.zones.iter().map(|z| (z.zone, z.ease())));
    }
    let mean = |zone: Girth| {
        let eases: Vec<f64> = found.iter().filter(|(at, _)| *at == zone).map(|(_, ease)| *ease).collect();
        (!eases.is_empty()).then(|| (zone, eases.iter().sum::<f64>() / eases.len() as f64))
    };
    Ok(Girth::ALL.into_iter().filter_map(mean).collect())
}

/// All sizes of a graded pattern, or the one for the body's own measures.
fn in_sizes(
    package: &PatternPackage,
    graded: &GradedPattern,
    size: Option<&str>,
    body: &Body,
) -> Result<Made, FittingError> {
    let made = graded.made();
    let designed = designed(package, &made)?;
    let patterns = match size {
        Some(TO_MEASURE) => vec![(TO_MEASURE.to_owned(), graded.to_measure(&body.measures))],
        _ => made,
    };
    let size = |(code, pattern): (String, Pattern)| {
        let found = on(package, &pattern, body)?;
        Ok(made_size(code, &found.judged(&[graded.girth]), body))
    };
    let sizes = patterns.into_iter().map(size).collect::<Result<_, FittingError>>()?;
    Ok(Made { table: graded.table.clone(), kind: graded.kind, sizes, designed })
}

/// A pattern without sizes: what it is, its panels say.
fn as_drafted(package: &PatternPackage, body: &Body) -> Result<Made, FittingError> {
    let pattern = package.parse().map_err(FittingError::input)?;
    let found = on(package, &pattern, body)?;
    let women = SizeTable::embedded("women").map_err(FittingError::internal)?;
    let men = SizeTable::embedded("men").map_err(FittingError::internal)?;
    // No table sizes men's dresses and skirts.
    let table = if body.sex == Sex::Male && men.designation(found.kind).is_some() { men } else { women };
    let primary = table.designation(found.kind).map_or_else(Vec::new, |d| d.primary.clone());
    let sizes = vec![made_size(AS_DRAFTED.to_owned(), &found.judged(&primary), body)];
    Ok(Made { table, kind: found.kind, sizes, designed: Vec::new() })
}

fn on(package: &PatternPackage, pattern: &Pattern, body: &Body) -> Result<draping::PatternEase, FittingError> {
    draping::ease(pattern, body).map_err(|e| FittingError::Input(format!("{}: {e}", package.name)))
}

/// The girths that leave on the body's own girths what the pattern leaves where it meets the body.
fn made_size(code: String, zones: &[ZoneEase], body: &Body) -> MadeSize {
    let girth = |z: &ZoneEase| ZoneGirth { zone: z.zone, girth_m: z.zone.of(&body.measures) + z.ease() as f32 };
    let zones = zones.iter().map(girth).collect();
    MadeSize { code, zones }
}
