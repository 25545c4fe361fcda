//! Cloth on cloth where the answer is known: the cases of `toile validate`, as a shop shows them and in `fine`.

use toile_engine::cloth::Quality;
use toile_gpu::backend::Backends;

use super::row::{ContactError, ContactRow};
use crate::validate::cases::layered;
use crate::validate::{CaseSetup, Level};

/// The slope at which sheet slides on sheet.
pub fn incline() -> Result<Vec<ContactRow>, ContactError> {
    rows("layer-incline", "incline, sheet on sheet")
}

/// The ratio of pulls at which a strip slips over half a turn of a sheet.
pub fn capstan() -> Result<Vec<ContactRow>, ContactError> {
    rows("layer-capstan", "capstan, strip over a sheet on a cylinder")
}

/// What bears the weight of a coat on a shirt.
pub fn weight() -> Result<Vec<ContactRow>, ContactError> {
    rows("layer-weight", "coat of 600 g on a shirt")
}

/// How far the cases of a name are from what is exact, as a shop shows it and as `toile validate` holds it.
fn rows(name: &str, called: &str) -> Result<Vec<ContactRow>, ContactError> {
    let backends = Backends::cpu();
    let mut rows = Vec::new();
    for case in layered::cases().into_iter().filter(|case| case.name == name) {
        for quality in [Quality::Shop, Quality::Fine] {
            let got = (case.run)(CaseSetup { level: Level::Production(quality), backends: &backends })?.got;
            let off = 100.0 * (got / case.expected - 1.0).abs();
            let of = format!("{:.3} {}", case.expected, case.unit);
            let what = format!("{called}, {}, {}: {got:.3} is off {of} by", case.parameter, quality.name());
            rows.push(ContactRow::at_most(what, case.target.unwrap_or(0.0), off, "%"));
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strip_slips_over_a_sheet_at_the_ratio_of_the_rope_around_a_post() {
        let backends = Backends::cpu();
        let capstans = layered::cases().into_iter().filter(|case| case.name == "layer-capstan");
        let rope = capstans.min_by(|a, b| a.parameter.cmp(&b.parameter)).unwrap();
        let got = (rope.run)(CaseSetup { level: Level::GATED, backends: &backends }).unwrap().got;
        assert!((got / rope.expected - 1.0).abs() < 0.03, "{}: {got} for {}", rope.parameter, rope.expected);
    }

    #[test]
    fn sheet_slides_on_sheet_at_the_angle_of_friction() {
        let rows = incline().unwrap();
        assert!(rows.len() == 6 && rows.iter().all(|row| row.pass == Some(true)), "{rows:?}");
    }
}
