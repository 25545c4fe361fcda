//! How often measured people get the size that their true measures get.

use serde::Serialize;
use toile_base::body::Sex;
use toile_track::estimate::Estimate;
use toile_track::fit::measuring::MEASURES;

use super::standing::TapeMeasures;
use crate::reliability::{SizeCheck, check_size};

/// Who lies nearer to a border between two sizes than this has two right sizes (m).
const BORDER: f32 = 0.010;

/// Sizes that people get by what was measured, against those that they get by what is true: dresses for women, T-shirts for men.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct SizeAgreement {
    /// People who were measured.
    pub people: usize,
    /// Mean of the probabilities that were stated of the size recommended.
    pub stated: f64,
    /// Share for whom it was the size that their true girths get.
    pub right: f64,
    /// Those whose true chest lies at least 10 mm from a border between two sizes.
    pub inside: usize,
    /// Share of these for whom it was right.
    pub inside_right: f64,
}

/// One person: what is true of them, and what was measured.
type SizeCase<'a> = (Sex, &'a TapeMeasures, &'a [Option<Estimate>; MEASURES.len()]);

/// The agreement of one way of measuring.
pub(super) fn sizes<'a>(cases: impl Iterator<Item = SizeCase<'a>>) -> SizeAgreement {
    let places = ["chest_girth", "waist_girth", "hip_girth"].map(|name| MEASURES.iter().position(|m| m.0 == name));
    let [Some(chest), Some(waist), Some(hip)] = places else { return SizeAgreement::default() };
    let check = |(sex, truth, seen): SizeCase| -> Option<SizeCheck> {
        let [a, b, c] = [chest, waist, hip].map(|i| truth[i].zip(seen[i]));
        let ((t0, s0), (t1, s1), (t2, s2)) = (a?, b?, c?);
        check_size(sex, [t0, t1, t2], [s0, s1, s2]).ok()
    };
    let checks: Vec<SizeCheck> = cases.filter_map(check).collect();
    let inside: Vec<&SizeCheck> = checks.iter().filter(|c| c.from_border >= BORDER).collect();
    let share = |right: usize, of: usize| right as f64 / of.max(1) as f64;
    SizeAgreement {
        people: checks.len(),
        stated: checks.iter().map(|c| f64::from(c.stated)).sum::<f64>() / checks.len().max(1) as f64,
        right: share(checks.iter().filter(|c| c.right).count(), checks.len()),
        inside: inside.len(),
        inside_right: share(inside.iter().filter(|c| c.right).count(), inside.len()),
    }
}
