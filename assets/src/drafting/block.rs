//! Lengths of a body by its girths and stature, after the usual block drafts.
//!
//! A block draft takes few measures and finds the rest in proportion: heights go with stature, widths and depths with girths.
//! The proportions here are linear rules of that kind, with their constants fitted to the bodies of the size tables, largest and
//! smallest; the armhole's depth is an eighth of the chest and a constant, the crotch's width goes by the hip, and so on.

use crate::sizes::SizeBody;
use toile_base::body::Sex;

/// The lengths that drafts are drawn by, all in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DraftBlock {
    /// Whose body it is.
    pub sex: Sex,
    /// Girth of the chest.
    pub chest: f64,
    /// Girth of the waist.
    pub waist: f64,
    /// Girth of the hip.
    pub hip: f64,
    /// Stature.
    pub stature: f64,
    /// From the middle to the shoulder's tip.
    pub shoulder: f64,
    /// From the middle to where the neck meets the shoulder.
    pub neck: f64,
    /// From there down to the armhole's lowest point.
    pub armhole: f64,
    /// From there down to the waist.
    pub to_waist: f64,
    /// From there down to the hip.
    pub neck_to_hip: f64,
    /// From where skirts and trousers sit, a woman's waist and below a man's, down to the hip.
    pub to_hip: f64,
    /// From there down to the crotch.
    pub to_crotch: f64,
    /// From there down to the knee.
    pub to_knee: f64,
    /// From there down to the floor.
    pub to_floor: f64,
    /// From the shoulder's tip to the wrist.
    pub arm: f64,
    /// Girth of the trunk a waistband below the waist.
    pub below_waist: f64,
}

/// How far below the waist [`DraftBlock::below_waist`] is taken (m): a waistband's breadth.
pub const BAND_M: f64 = 0.035;

/// Differences between women's and men's proportions.
struct BlockRules {
    /// Height of the waist: part of stature, less part of the waist's girth.
    waist: [f64; 2],
    /// Height of the hip: part of stature, less part of the hip's girth.
    hip: [f64; 2],
    /// Height of the crotch, as the hip's.
    crotch: [f64; 2],
    /// Height of the neck's point at the shoulder (part of stature).
    neck: f64,
    /// Girth below the waist: part of the waist's, and of what the hip is wider.
    below: [f64; 2],
    /// Depth of the armhole: part of the chest's girth, and a constant (m).
    armhole: [f64; 2],
    /// How far below the waist skirts and trousers sit (m).
    sits: f64,
}

const WOMEN: BlockRules = BlockRules {
    waist: [0.673, 0.085],
    hip: [0.5756, 0.1],
    crotch: [0.5446, 0.1],
    neck: 0.852,
    below: [1.07, 0.0],
    armhole: [0.125, 0.1],
    sits: 0.0,
};

const MEN: BlockRules = BlockRules {
    waist: [0.661, 0.0754],
    hip: [0.578, 0.1257],
    crotch: [0.5545, 0.1257],
    neck: 0.855,
    below: [1.0, 0.17],
    armhole: [0.1, 0.134],
    sits: 0.04,
};

/// Height of the knee (part of stature).
const KNEE: f64 = 0.279;

/// Length of an arm from the shoulder's tip to the wrist (part of stature).
const ARM: f64 = 0.337;

impl DraftBlock {
    /// The block of a body.
    pub fn new(sex: Sex, body: &SizeBody) -> Self {
        let [stature, chest, waist, hip] =
            [body.stature, body.chest_girth, body.waist_girth, body.hip_girth].map(f64::from);
        let own = if sex == Sex::Male { &MEN } else { &WOMEN };
        let height = |[a, b]: [f64; 2], girth: f64| a * stature - b * girth;
        let at_waist = height(own.waist, waist);
        let band = at_waist - own.sits;
        Self {
            sex,
            chest,
            waist,
            hip,
            stature,
            shoulder: 0.5 * f64::from(body.shoulder_breadth) + 0.008,
            neck: chest / 32.0 + 0.047,
            armhole: own.armhole[0] * chest + own.armhole[1],
            to_waist: own.neck * stature - at_waist,
            neck_to_hip: own.neck * stature - height(own.hip, hip),
            to_hip: band - height(own.hip, hip),
            to_crotch: band - height(own.crotch, hip),
            to_knee: band - KNEE * stature,
            to_floor: band,
            arm: ARM * stature,
            below_waist: own.below[0] * waist + own.below[1] * (hip - waist).max(0.0),
        }
    }
}
