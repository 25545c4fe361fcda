//! Ease: what a pattern's own lengths leave around a body, and the size that a pattern is for.

use super::arrange::{Arrangement, arrange};
use super::error::DrapeError;
use super::outlines::{outline, width};
use super::panels::Around;
use crate::body::tape;
use crate::pattern::Pattern;
use crate::sizes::{GarmentKind, Girth, SizeTable};
use crate::tailor::{SewnMesh, sew};
use toile_base::body::{Body, Measures, Sex};

use super::limits::LEVELS_M;

/// How a pattern fits at one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneEase {
    /// The zone.
    pub zone: Girth,
    /// How wide the panels are there together, by their outlines (m).
    pub pattern: f64,
    /// Girth of the body (m); what hangs by its upper edge meets it there, which may be below the waist.
    pub body: f64,
}

impl ZoneEase {
    /// What the pattern leaves (m), negative where it is tight.
    pub fn ease(&self) -> f64 {
        self.pattern - self.body
    }
}

/// How a pattern fits, by its own lengths.
#[derive(Debug, Clone, PartialEq)]
pub struct PatternEase {
    /// What the garment is, by what it hangs from and where it ends.
    pub kind: GarmentKind,
    /// The zones that it reaches, from the top down.
    pub zones: Vec<ZoneEase>,
}

impl PatternEase {
    /// The zones by which a fit is judged: those that `primary` names, and others where it does not hang free of the body.
    pub fn judged(&self, primary: &[Girth]) -> Vec<ZoneEase> {
        let judged = |z: &&ZoneEase| primary.contains(&z.zone) || z.pattern < HANGS_FREE * z.body;
        self.zones.iter().filter(judged).copied().collect()
    }
}

/// What is wider than the body by this hangs free by design, as a skirt does at the hip.
const HANGS_FREE: f64 = 1.25;

/// A garment that hangs from the shoulders and ends lower than this below the hip (m) is a dress.
const DRESS_BELOW_HIP_M: f64 = 0.15;

/// How far below the armholes a girth is taken at the highest (m): there the mesh of the panels is whole.
const BELOW_ARMHOLE_M: f64 = 0.01;

/// The ease of a pattern on a body, at the zones that it reaches.
///
/// # Errors
/// As [`super::drape`].
pub fn ease(pattern: &Pattern, body: &Body) -> Result<PatternEase, DrapeError> {
    let sewn = sew(pattern, LEVELS_M[0])?;
    let arranged = arrange(pattern, &sewn, body)?;
    Ok(PatternEase { kind: kind(&sewn, &arranged, body), zones: of_arranged(&sewn, &arranged, body) })
}

fn kind(sewn: &SewnMesh, arranged: &Arrangement, body: &Body) -> GarmentKind {
    if !arranged.shoulders {
        return if arranged.legs.is_some() { GarmentKind::Trousers } else { GarmentKind::Skirt };
    }
    let hung = (0..arranged.panels.len()).filter(|&i| arranged.panels[i].around == Around::Trunk);
    let heights = hung.flat_map(|i| outline(sewn, i).map(move |p| arranged.panels[i].at(p).y));
    let ends = heights.fold(f64::MAX, f64::min) + arranged.lift;
    if arranged.legs.is_some() || ends < f64::from(body.levels.hip) - DRESS_BELOW_HIP_M {
        GarmentKind::Dress
    } else {
        GarmentKind::Tshirt
    }
}

fn of_arranged(sewn: &SewnMesh, arranged: &Arrangement, body: &Body) -> Vec<ZoneEase> {
    let zones = [
        (Girth::Chest, body.levels.chest, body.measures.chest_girth),
        (Girth::Waist, body.levels.waist, body.measures.waist_girth),
        (Girth::Hip, body.levels.hip, body.measures.hip_girth),
    ];
    // What covers the chest goes all around it below the armholes alone.
    let closed = arranged.underarm.filter(|_| arranged.shoulders).map_or(f64::INFINITY, |y| y - BELOW_ARMHOLE_M);
    let width = |level: f32| width(sewn, &arranged.panels, (f64::from(level) - arranged.lift).min(closed), |_| true);
    let zone = |(zone, level, girth): (Girth, f32, f32)| {
        // What hangs by its upper edge has that at the waist, and meets the body where it hangs.
        let edge = zone == Girth::Waist && !arranged.shoulders;
        let hangs = || f64::from(tape::girth(body, (arranged.top + arranged.lift) as f32)).max(f64::from(girth));
        let (pattern, body) = if edge { (arranged.upper_edge, hangs()) } else { (width(level), f64::from(girth)) };
        (pattern > 0.0).then_some(ZoneEase { zone, pattern, body })
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
        let Some(body) = table.size_body(code).ok().and_then(|b| crate::body::build(sex, &Measures::from(b)).ok())
        else {
            continue;
        };
        let eases = of_arranged(&sewn, &arrange(pattern, &sewn, &body)?, &body);
        if eases.iter().all(|e| e.ease() >= LEAST_EASE_M) {
            best = code;
        }
    }
    Ok(best.to_owned())
}
