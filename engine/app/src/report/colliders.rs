//! Distance of the collision body from the skin, as `toile body` reports it.

use serde::Serialize;
use toile_assets::rig::{RigReport, Zone, ZoneReport};

/// Distances in one zone, skin to union and union to skin (mm).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Followed {
    /// The part of the body.
    pub zone: &'static str,
    /// Mean distance (mm).
    pub mean_mm: f64,
    /// Mean with its sign, positive where the union stands out of the skin.
    pub signed_mean_mm: f64,
    /// 95th percentile of the distance.
    pub p95_mm: f64,
    /// The furthest that the union stands out of the skin.
    pub max_outside_mm: f64,
    /// The furthest that the union stays below the skin.
    pub max_inside_mm: f64,
    /// Mean distance of the union's surface from the skin.
    pub cloth_mean_mm: f64,
    /// Its 95th percentile.
    pub cloth_p95_mm: f64,
    /// The highest that the union's surface lies above the skin.
    pub cloth_max_above_mm: f64,
    /// The deepest that it lies below.
    pub cloth_max_below_mm: f64,
    /// Whether the zone is held to the goal, and meets it.
    pub meets: Option<bool>,
}

impl Followed {
    /// Zone by zone, then the trunk as a whole.
    pub fn of(report: &RigReport) -> Vec<Self> {
        let zones = Zone::ALL.into_iter().map(|zone| {
            let held = Zone::HELD.contains(&zone);
            Self::one(zone.name(), report.of(zone), held)
        });
        zones.chain([Self::one("trunk", &report.trunk, true)]).collect()
    }

    fn one(zone: &'static str, r: &ZoneReport, held: bool) -> Self {
        let round = |mm: f32| (f64::from(mm) * 100.0).round() / 100.0;
        Self {
            zone,
            mean_mm: round(r.mean_mm),
            signed_mean_mm: round(r.signed_mean_mm),
            p95_mm: round(r.p95_mm),
            max_outside_mm: round(r.max_outside_mm),
            max_inside_mm: round(r.max_inside_mm),
            cloth_mean_mm: round(r.cloth_mean_mm),
            cloth_p95_mm: round(r.cloth_p95_mm),
            cloth_max_above_mm: round(r.cloth_max_above_mm),
            cloth_max_below_mm: round(r.cloth_max_below_mm),
            meets: held.then(|| r.meets()),
        }
    }
}
