//! Placing of a photographed garment on a body: the level at which it stays, two points of known distance, the girths that it
//! stretches to (Ugur 2008, section 6.2).

use glam::Vec2;
use serde::Deserialize;

use toile_base::body::{Levels, Measures};

/// Where a garment stays in place on the body while the rest of it stretches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FittingLevel {
    /// The neck.
    Neck,
    /// The tips of the shoulders.
    Shoulders,
    /// The bust.
    Bust,
    /// Below the bust.
    UnderBust,
    /// The waist.
    Waist,
    /// Between the legs.
    Crotch,
    /// The floor.
    Feet,
}

impl FittingLevel {
    /// Its height on a body (m).
    pub fn height(self, levels: &Levels) -> f32 {
        match self {
            Self::Neck => levels.neck,
            Self::Shoulders => levels.shoulder,
            Self::Bust => levels.chest,
            Self::UnderBust => levels.underbust,
            Self::Waist => levels.waist,
            Self::Crotch => levels.crotch,
            Self::Feet => 0.0,
        }
    }
}

/// Girths of the bodies that a garment stretches to (mm), from and to.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StretchLimits {
    /// Around the chest.
    pub chest: Option<[f32; 2]>,
    /// Around the waist.
    pub waist: Option<[f32; 2]>,
    /// Around the hip.
    pub hip: Option<[f32; 2]>,
}

/// Distances between two points that are believed (mm).
const DISTANCE_MM: std::ops::RangeInclusive<f32> = 20.0..=2_000.0;

/// Least distance of the points in the picture (pixels): a registration by fewer is off by percents.
const LEAST_PIXELS: f32 = 16.0;

/// Checks two points of a picture at its level and how far apart they are (mm); `table` is where they stand.
///
/// # Errors
/// The fault and its cure.
pub(super) fn check_registration(points: &[[f32; 2]; 2], distance_mm: f32, table: &str) -> Result<(), String> {
    let apart = Vec2::from(points[0]).distance(Vec2::from(points[1]));
    if !points.as_flattened().iter().all(|p| p.is_finite() && *p >= 0.0) || apart.is_nan() || apart < LEAST_PIXELS {
        return Err(format!(
            "{table}.points must be two pixels of the picture, {LEAST_PIXELS} apart at least; mark them again"
        ));
    }
    if !DISTANCE_MM.contains(&distance_mm) {
        let [low, high] = [DISTANCE_MM.start(), DISTANCE_MM.end()];
        return Err(format!(
            "{table}.distance_mm must lie from {low} to {high}; measure it on the garment, in millimetres"
        ));
    }
    Ok(())
}

impl StretchLimits {
    /// Checks the girths; `table` is where they stand.
    ///
    /// # Errors
    /// The fault and its cure.
    pub(super) fn check(&self, table: &str) -> Result<(), String> {
        for (name, limits) in [("chest", self.chest), ("waist", self.waist), ("hip", self.hip)] {
            if limits.is_some_and(|[from, to]| !(from > 0.0 && to >= from && to < 4_000.0)) {
                return Err(format!(
                    "{table}.stretches.{name} must be two girths in mm, the smaller first; correct it"
                ));
            }
        }
        Ok(())
    }

    /// Whether a body can wear what has these limits.
    ///
    /// # Errors
    /// The girth that is outside of them.
    pub fn hold(&self, body: &Measures) -> Result<(), String> {
        for (name, limits, girth) in [
            ("chest", self.chest, body.chest_girth),
            ("waist", self.waist, body.waist_girth),
            ("hip", self.hip, body.hip_girth),
        ] {
            let mm = girth * 1e3;
            if let Some([from, to]) = limits.filter(|[from, to]| !(*from..=*to).contains(&mm)) {
                return Err(format!("its {name} is for girths of {from} to {to} mm, and this one is {mm:.0} mm"));
            }
        }
        Ok(())
    }

    /// How much wider than its narrowest a garment may be, by the widest of the limits; none without limits.
    pub fn most(&self) -> Option<f32> {
        [self.chest, self.waist, self.hip].into_iter().flatten().map(|[from, to]| to / from).reduce(f32::max)
    }
}
