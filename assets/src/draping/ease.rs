//! Ease: what a pattern's own lengths leave around a body, and the size that a pattern is for.

use super::arrange::{Arrangement, arrange};
use super::error::DrapeError;
use super::outlines::width;
use crate::body::{Body, Measures, Sex};
use crate::pattern::Pattern;
use crate::sizes::{Girth, SizeTable};
use crate::tailor::{SewnMesh, sew};

use super::limits::LEVELS_M;

/// How a pattern fits at one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneEase {
    /// The zone.
    pub zone: Girth,
    /// How wide the panels are there together, by their outlines (m).
    pub pattern: f64,
    /// Girth of the body (m).
    pub body: f64,
}

impl ZoneEase {
    /// What the pattern leaves (m), negative where it is tight.
    pub fn ease(&self) -> f64 {
        self.pattern - self.body
    }
}

/// The ease of a pattern on a body, at the zones that it reaches.
///
/// # Errors
/// As [`super::drape`].
pub fn ease(pattern: &Pattern, body: &Body) -> Result<Vec<ZoneEase>, DrapeError> {
    let sewn = sew(pattern, LEVELS_M[0])?;
    Ok(of_arranged(&sewn, &arrange(pattern, &sewn, body)?, body))
}

fn of_arranged(sewn: &SewnMesh, arranged: &Arrangement, body: &Body) -> Vec<ZoneEase> {
    let zones = [
        (Girth::Chest, body.levels.chest, body.measures.chest_girth),
        (Girth::Waist, body.levels.waist, body.measures.waist_girth),
        (Girth::Hip, body.levels.hip, body.measures.hip_girth),
    ];
    let width = |level: f32| width(sewn, &arranged.panels, f64::from(level) - arranged.lift, |_| true);
    let zone = |(zone, level, girth): (Girth, f32, f32)| {
        // What hangs by its upper edge has that at the waist.
        let edge = zone == Girth::Waist && !arranged.shoulders;
        let pattern = if edge { arranged.upper_edge } else { width(level) };
        (pattern > 0.0).then_some(ZoneEase { zone, pattern, body: f64::from(girth) })
    };
    zones.into_iter().filter_map(zone).collect()
}

/// Woven cloth that goes on a body without stretching has at least this much ease (m): contact keeps it from the skin all round,
/// by a circle's girth over [`CONTACT_M`](super::limits::CONTACT_M).
const LEAST_EASE_M: f64 = 0.025;

/// The largest size of a table on whose body a pattern has ease everywhere; the first where it has it on none.
///
/// # Errors
/// As [`super::drape`]; sizes of which no body can be made are passed over.
pub fn fitting_size(pattern: &Pattern, table: &SizeTable, sex: Sex) -> Result<String, DrapeError> {
    let sewn = sew(pattern, LEVELS_M[0])?;
    let codes = table.codes();
    let mut best = codes.first().copied().unwrap_or_default();
    for code in codes {
        let Some(body) = table.size_body(code).ok().and_then(|b| Body::build(sex, &Measures::from(b)).ok()) else {
            continue;
        };
        let eases = of_arranged(&sewn, &arrange(pattern, &sewn, &body)?, &body);
        if eases.iter().all(|e| e.ease() >= LEAST_EASE_M) {
            best = code;
        }
    }
    Ok(best.to_owned())
}
