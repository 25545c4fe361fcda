//! The measures and their priors: the types that every way of measuring shares.

use toile_assets::sizes::Population;

use crate::estimate::Estimate;

/// What is known beforehand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hint {
    /// Whose proportions apply; `Mixed` where nothing is known.
    pub population: Population,
    /// Whether the joints are in metres ([`toile_sensors`]' `Session::raw_scale_known`).
    pub scale_known: bool,
}

impl Default for Hint {
    fn default() -> Self {
        Self { population: Population::Mixed, scale_known: true }
    }
}

/// Where a measure is taken, by its name: levels and definitions of EN 13402-1 and ISO 8559-1, which the tape of the
/// parametric body follows. A girth is the convex hull of a horizontal slice of the torso without arms, or of one thigh.
pub fn definition(name: &str) -> &'static str {
    match name {
        "stature" => "crown to floor; the body fit leaves out what it takes for hair and shoes",
        "shoulder_breadth" => "between the acromions (biacromial), not over the deltoids",
        "arm_length" => "acromion over the bent elbow to the wrist bone",
        "leg_length" | "inseam" => "crotch to floor (inside leg height)",
        "torso_length" => "height of the 7th cervical vertebra less the inside leg height",
        "neck_girth" => "2 cm below the Adam's apple, over the 7th cervical vertebra",
        "chest_girth" => "at the bust points, under the armpits",
        "underbust_girth" => "just below the breasts",
        "waist_girth" => "natural waistline, midway between the lowest rib and the top of the hip bone",
        "hip_girth" => "at the greatest protrusion of the buttocks",
        "thigh_girth" => "one thigh at its greatest, below the crotch",
        _ => "",
    }
}

/// The measures that could be taken; `None` where the sensor did not see what is needed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measures {
    /// Stature as the person stands before the sensor: shoes and hair count.
    pub stature: Option<Estimate>,
    /// Shoulder breadth between the acromions.
    pub shoulder_breadth: Option<Estimate>,
    /// Chest or bust girth.
    pub chest_girth: Option<Estimate>,
    /// Girth at the natural waistline.
    pub waist_girth: Option<Estimate>,
    /// Girth at the greatest protrusion of the buttocks.
    pub hip_girth: Option<Estimate>,
    /// Crotch height, guessed from the stature.
    pub inseam: Option<Estimate>,
    /// Acromion to wrist, guessed from the stature.
    pub arm_length: Option<Estimate>,
}

impl Measures {
    /// Each measure with its name, in the order of the fields.
    pub fn named(&self) -> [(&'static str, Option<Estimate>); 7] {
        [
            ("stature", self.stature),
            ("shoulder_breadth", self.shoulder_breadth),
            ("chest_girth", self.chest_girth),
            ("waist_girth", self.waist_girth),
            ("hip_girth", self.hip_girth),
            ("inseam", self.inseam),
            ("arm_length", self.arm_length),
        ]
    }
}
