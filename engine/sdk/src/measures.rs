//! Measures by their names, in millimetres.

use serde::Serialize;
use toile_assets::body::{En, Vocabulary};

use crate::error::{Error, Result};

/// The measures of a body, by EN 13402-1 and ISO 8559-1, each with its name here.
const NAMES: [(&str, En); 16] = [
    ("stature", En::Stature),
    ("cervical_height", En::CervicalHeight),
    ("inside_leg_height", En::InsideLegHeight),
    ("knee_height", En::KneeHeight),
    ("neck_girth", En::NeckGirth),
    ("chest_girth", En::BustGirth),
    ("underbust_girth", En::UnderbustGirth),
    ("waist_girth", En::WaistGirth),
    ("hip_girth", En::HipGirth),
    ("thigh_girth", En::ThighGirth),
    ("calf_girth", En::CalfGirth),
    ("upper_arm_girth", En::UpperArmGirth),
    ("wrist_girth", En::WristGirth),
    ("shoulder_breadth", En::ShoulderBreadth),
    ("arm_length", En::ArmLength),
    ("back_length", En::BackLength),
];

/// Words that mean the same, beside the names without their last part: `chest` is `chest_girth`.
const WORDS: [(&str, En); 9] = [
    ("height", En::Stature),
    ("bust", En::BustGirth),
    ("hips", En::HipGirth),
    ("seat", En::HipGirth),
    ("collar", En::NeckGirth),
    ("shoulders", En::ShoulderBreadth),
    ("inseam", En::InsideLegHeight),
    ("inside_leg", En::InsideLegHeight),
    ("leg_length", En::InsideLegHeight),
];

/// A measure of a measured person.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Measure {
    /// Its name, such as `waist_girth`.
    pub name: &'static str,
    /// The value (mm).
    pub mm: f64,
    /// Standard deviation of the value (mm).
    pub sigma_mm: f64,
    /// Whether it was seen; where it was not, it is what a body with the others has on average, with the sigma of that.
    pub seen: bool,
    /// Where it is taken.
    pub definition: &'static str,
}

/// The names of the measures that a body has.
pub fn measure_names() -> Vec<&'static str> {
    NAMES.iter().map(|(name, _)| *name).collect()
}

/// The measures in the order of their names.
pub(crate) fn all() -> [(&'static str, En); 16] {
    NAMES
}

/// The measure that a word means, and its name.
pub(crate) fn named(word: &str) -> Result<(&'static str, En)> {
    let plain = word.trim().to_lowercase().replace([' ', '-'], "_");
    let short =
        |name: &str| ["_girth", "_breadth", "_length", "_height"].iter().any(|e| name.strip_suffix(e) == Some(&plain));
    let known = NAMES.into_iter().find(|(name, _)| *name == plain || short(name));
    let meant = || {
        let measure = WORDS.iter().find(|(word, _)| *word == plain)?.1;
        NAMES.into_iter().find(|(_, of)| *of == measure)
    };
    known.or_else(meant).ok_or_else(|| {
        let names = measure_names().join(", ");
        Error::input(format!("there is no measure named {word:?}; give one of {names}"))
    })
}

/// The name here of a measure as the standard calls it.
pub(crate) fn name_of(standard: &str) -> &'static str {
    NAMES.iter().find(|(_, measure)| measure.name() == standard).map_or("measure", |(name, _)| name)
}
