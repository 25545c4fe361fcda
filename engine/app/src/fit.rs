//! Fit: the size of each garment and how each zone of it sits, from the room that recommends.

use toile_assets::sizes::{Girth, SizeError, SizeTable};
use toile_assets::wardrobe::style::Style;
use toile_track::measure::Measurements;
use toile_track::recommend::{self, EaseRange, MadeSize, Offer, ZoneGirth};

use crate::exit::AppError;
use crate::report::{Recommendation, SizeChance, Tape, Zone};

/// The size that fits, or the one asked for, judged at every zone that the garment reaches.
///
/// # Errors
/// A garment whose table or sizes cannot be used, a size that is not made.
pub fn judge(
    style: &Style,
    size: Option<&str>,
    measured: &Measurements,
) -> Result<recommend::Recommendation, AppError> {
    let table = style.sizes().map_err(AppError::input)?;
    let sizes = made(style, &table).map_err(AppError::input)?;
    let range = |zone: Girth| style.comfort_mm.at(zone).map(|[least, most]| EaseRange { zone, least, most });
    let ease: Vec<EaseRange> = Girth::ALL.into_iter().filter_map(range).collect();
    let offer = Offer { garment: &style.name, kind: style.kind, table: &table, sizes: &sizes, ease: &ease };
    match size {
        Some(size) => recommend::evaluate(measured, &offer, size),
        None => recommend::recommend(measured, &offer),
    }
    .map_err(AppError::input)
}

/// The same as reports show it.
pub fn choose(style: &Style, size: Option<&str>, measured: &Measurements) -> Result<Recommendation, AppError> {
    let judged = judge(style, size, measured)?;
    let mm = |m: f32| (f64::from(m) * 1e4).round() / 10.0;
    let zones = judged.zones.iter().map(|fit| Zone {
        zone: fit.zone.name().into(),
        ease_mm: mm(fit.ease),
        sigma_mm: mm(fit.sigma),
        verdict: fit.verdict.name().into(),
        sentence: fit.sentence.clone(),
    });
    let share = |p: f32| (f64::from(p) * 1e3).round() / 1e3;
    let sizes = judged.sizes.into_iter().map(|s| SizeChance { size: s.size, probability: share(s.probability) });
    let tape = judged.tape.map(|t| Tape {
        zone: t.zone.name().into(),
        probability: share(t.probability),
        sentence: t.sentence,
    });
    Ok(Recommendation {
        garment: judged.garment,
        size: judged.size,
        probability: share(judged.probability),
        zones: zones.collect(),
        sizes: sizes.collect(),
        uncertain: judged.uncertain,
        tape,
        verdict: judged.verdict,
        runner_up: judged.runner_up.map(|r| r.size),
        note: judged.note,
    })
}

/// The finished girths of every size that is made.
fn made(style: &Style, table: &SizeTable) -> Result<Vec<MadeSize>, SizeError> {
    let size = |code: &str| {
        let finished = style.finished(&table.size_body(code)?);
        let zones = finished.into_iter().map(|(zone, girth_m)| ZoneGirth { zone, girth_m }).collect();
        Ok(MadeSize { code: code.into(), zones })
    };
    table.codes().into_iter().map(size).collect()
}
