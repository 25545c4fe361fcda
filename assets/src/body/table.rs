//! The mannequins' drawings: points on the surface at each sex's mean stature, read from the embedded tables.

use std::sync::LazyLock;

use serde::Deserialize;

use super::Sex;

/// One sex's drawing; lengths in millimetres, x left, y up, z forwards.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Table {
    pub stature: f32,
    pub torso: Vec<TorsoRow>,
    pub head: Head,
    pub crotch: Crotch,
    pub arm: Arm,
    pub leg: Vec<LegRow>,
    pub foot: Foot,
    pub joints: Joints,
}

/// A ring of the torso, the neck or the head: the left half, from the front's middle to the back's.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TorsoRow {
    /// What the row is called, for the reader of the table.
    #[serde(rename = "name")]
    pub _name: String,
    /// Share of the growth of chest, waist, hip and shoulders.
    pub follow: [f32; 4],
    pub points: Vec<[f32; 3]>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Head {
    /// Front, crown and back of the top of the head.
    pub top: [[f32; 3]; 3],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Crotch {
    pub point: [f32; 3],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Arm {
    /// Shoulder to elbow, elbow to wrist, wrist to knuckles.
    pub upper: f32,
    pub fore: f32,
    pub hand: f32,
    /// Below the horizontal, then forwards: upper arm, forearm.
    pub degrees_down: [f32; 2],
    pub degrees_forward: [f32; 2],
    pub ring: Vec<ArmRow>,
    pub tip: Tip,
    pub thumb: Thumb,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArmRow {
    /// Way down the arm from the shoulder's centre.
    pub along: f32,
    /// Up, front, down, back.
    pub radii: [f32; 4],
    /// Share of the trunk's growth.
    pub grow: f32,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tip {
    pub along: f32,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Thumb {
    /// Along from the wrist, up, front.
    pub rings: [[[f32; 3]; 4]; 2],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LegRow {
    pub y: f32,
    /// x, z.
    pub centre: [f32; 2],
    /// Outwards, front, inwards, back.
    pub radii: [f32; 4],
    /// Share of the hip's growth.
    pub grow: f32,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Foot {
    /// Outwards, up, forwards, from below the ankle.
    pub rings: [[[f32; 3]; 8]; 4],
    pub tip: [f32; 3],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Joints {
    pub pelvis: [f32; 3],
    pub spine: [f32; 3],
    pub chest: [f32; 3],
    pub neck: [f32; 3],
    pub head: [f32; 3],
    pub clavicle: [f32; 3],
    pub shoulder: [f32; 3],
    pub hip: [f32; 3],
    pub knee: [f32; 3],
    pub ankle: [f32; 3],
    pub toe: [f32; 3],
}

static FEMALE: LazyLock<Table> = LazyLock::new(|| parse(include_str!("../../data/body/sweep-female.toml")));
static MALE: LazyLock<Table> = LazyLock::new(|| parse(include_str!("../../data/body/sweep-male.toml")));

/// The tables are part of the program: a test parses both, so a failure here is a build that never passed its tests.
fn parse(text: &str) -> Table {
    toml::from_str(text).expect("the embedded body table is well formed")
}

impl Table {
    /// The drawing of one sex, parsed on first use.
    pub(super) fn of(sex: Sex) -> &'static Self {
        match sex {
            Sex::Female => &FEMALE,
            Sex::Male => &MALE,
        }
    }
}
