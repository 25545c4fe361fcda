//! Correlations of people's measures, which predict measures that were not taken.
//!
//! Means, deviations and correlations of 1,986 women and 4,082 men of ANSUR II (US Army Natick TR-15/007, 2014, public
//! domain), worked out from its files by `cargo run --release -p toile-perf --example people`. A measure that the survey did
//! not take follows the measure next to it, in the proportion that the drawn body has, with a deviation of its own.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

use super::reading::{MeshMeasure, READINGS};
use toile_base::body::Sex;
use toile_base::numeric::linear;
use toile_base::numeric::linear::Pivot;

/// What posing adds to lengths of the arm, which the body holds straight (m).
#[derive(Debug, Clone, Copy)]
pub(super) struct Allowance {
    /// To the arm from the acromion over the elbow to the wrist, when it bends by a right angle.
    pub arm: f32,
    /// To half the shoulders and the arm, when it is raised and bent as for the survey's sleeve.
    pub sleeve: f32,
}

/// The embedded table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurveyStatistics {
    female: SexStatistics,
    male: SexStatistics,
}

/// One sex's statistics; lengths in millimetres.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SexStatistics {
    #[serde(rename = "people")]
    _people: u32,
    arm_bend: f64,
    sleeve_pose: f64,
    column: Vec<SurveyColumn>,
}

/// One measure of the survey: its correlations with the columns before it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurveyColumn {
    name: String,
    mean: f64,
    sd: f64,
    with: Vec<f64>,
}

static TABLES: LazyLock<SurveyStatistics> = LazyLock::new(|| {
    // Part of the program, and read by a test: a failure here is a build that never passed its tests.
    toml::from_str(include_str!("../../data/body/people.toml")).expect("the embedded table of people is well formed")
});

fn table(sex: Sex) -> &'static SexStatistics {
    match sex {
        Sex::Female => &TABLES.female,
        Sex::Male => &TABLES.male,
    }
}

/// Readings that the survey took, by its name.
const TAKEN: [(MeshMeasure, &str); 15] = [
    (MeshMeasure::Stature, "stature"),
    (MeshMeasure::CervicaleHeight, "cervicaleheight"),
    (MeshMeasure::OmphalionHeight, "waistheightomphalion"),
    (MeshMeasure::CrotchHeight, "crotchheight"),
    (MeshMeasure::KneeHeight, "kneeheightmidpatella"),
    (MeshMeasure::NeckGirth, "neckcircumference"),
    (MeshMeasure::ChestGirth, "chestcircumference"),
    (MeshMeasure::OmphalionGirth, "waistcircumference"),
    (MeshMeasure::HipGirth, "buttockcircumference"),
    (MeshMeasure::ThighGirth, "thighcircumference"),
    (MeshMeasure::CalfGirth, "calfcircumference"),
    (MeshMeasure::WristGirth, "wristcircumference"),
    (MeshMeasure::ShoulderBreadth, "biacromialbreadth"),
    (MeshMeasure::SleeveLength, "sleevelengthspinewrist"),
    (MeshMeasure::WaistBackLength, "waistbacklength"),
];

/// Readings whose mean is the drawn body's, in proportion to the one they follow: those that the survey did not take,
/// and breadths and depths, which its calliper takes from compressed flesh. With the column that they vary as, and how
/// far they stray from it (m); for underbust and waist that is about the width of a size in the tables of EN 13402-3.
const FOLLOWING: [(MeshMeasure, MeshMeasure, &str, f64); 11] = [
    (MeshMeasure::ChestBreadth, MeshMeasure::ChestGirth, "chestbreadth", OWN_ERROR),
    (MeshMeasure::ChestDepth, MeshMeasure::ChestGirth, "chestdepth", OWN_ERROR),
    (MeshMeasure::OmphalionBreadth, MeshMeasure::OmphalionGirth, "waistbreadth", OWN_ERROR),
    (MeshMeasure::OmphalionDepth, MeshMeasure::OmphalionGirth, "waistdepth", OWN_ERROR),
    (MeshMeasure::HipBreadth, MeshMeasure::HipGirth, "hipbreadth", OWN_ERROR),
    (MeshMeasure::HipDepth, MeshMeasure::HipGirth, "buttockdepth", OWN_ERROR),
    (MeshMeasure::NeckBaseGirth, MeshMeasure::NeckGirth, "neckcircumferencebase", 5e-3),
    (MeshMeasure::UnderbustGirth, MeshMeasure::ChestGirth, "chestcircumference", 20e-3),
    (MeshMeasure::WaistGirth, MeshMeasure::OmphalionGirth, "waistcircumference", 20e-3),
    (MeshMeasure::UpperArmGirth, MeshMeasure::UpperArmGirth, "bicepscircumferenceflexed", 6e-3),
    (MeshMeasure::BackLength, MeshMeasure::WaistBackLength, "waistbacklength", 8e-3),
];

/// How far a reading of the mesh may differ from the survey's for the same person (m): the definitions are not quite
/// the mesh's, and without it strong correlations would turn that difference into a strange body.
const OWN_ERROR: f64 = 6e-3;

/// Mean and spread of a sex's readings.
pub(super) struct People {
    /// Readings of the mean person (m).
    pub mean: [f64; READINGS],
    /// Lower Cholesky factor of their covariance (m).
    pub factor: [[f64; READINGS]; READINGS],
}

/// Posing's part in the arm's lengths.
pub(super) fn allowance(sex: Sex) -> Allowance {
    let t = table(sex);
    Allowance { arm: (t.arm_bend * 1e-3) as f32, sleeve: (t.sleeve_pose * 1e-3) as f32 }
}

impl People {
    /// The people of a sex, given what is read on its drawn body.
    pub(super) fn new(sex: Sex, drawn: &[f32; READINGS]) -> Self {
        let table = table(sex);
        let place: BTreeMap<&str, usize> = table.column.iter().enumerate().map(|(i, c)| (c.name.as_str(), i)).collect();
        let column = |name: &str| *place.get(name).expect("the embedded table has every column");
        let covariance = |i: usize, j: usize| {
            let (a, b) = (i.max(j), i.min(j));
            let together = if a == b { 1.0 } else { table.column[a].with[b] };
            together * table.column[i].sd * table.column[j].sd * 1e-6
        };
        // Each reading is a weighted sum of columns, with an error of its own.
        let mut made_of: [Vec<(usize, f64)>; READINGS] = std::array::from_fn(|_| Vec::new());
        let mut stray = [OWN_ERROR; READINGS];
        for (reading, name) in TAKEN {
            made_of[reading.index()] = vec![(column(name), 1.0)];
        }
        for (reading, beside, name, deviation) in FOLLOWING {
            let source = column(name);
            let of = if reading == beside {
                table.column[source].mean * 1e-3
            } else {
                f64::from(drawn[beside.index()]) * table.column[source].mean * 1e-3 / mean_of(table, beside, &place)
            };
            made_of[reading.index()] = vec![(source, f64::from(drawn[reading.index()]) / of)];
            stray[reading.index()] = deviation;
        }
        let arm = [(column("sleevelengthspinewrist"), 1.0), (column("biacromialbreadth"), -0.5)];
        made_of[MeshMeasure::ArmLength.index()] = arm.to_vec();
        let mut mean = made_of.each_ref().map(|m| m.iter().map(|&(c, w)| w * table.column[c].mean * 1e-3).sum());
        mean[MeshMeasure::ArmLength.index()] += (table.arm_bend - table.sleeve_pose) * 1e-3;
        let mut spread = [[0.0; READINGS]; READINGS];
        for i in 0..READINGS {
            for j in 0..READINGS {
                let pairs = made_of[i].iter().flat_map(|p| made_of[j].iter().map(move |q| (p, q)));
                spread[i][j] = pairs.map(|(p, q)| p.1 * q.1 * covariance(p.0, q.0)).sum();
            }
            spread[i][i] += stray[i] * stray[i];
        }
        Self { mean, factor: lower_factor(spread) }
    }
}

/// The survey's mean of the reading that another follows (m).
fn mean_of(table: &SexStatistics, reading: MeshMeasure, place: &BTreeMap<&str, usize>) -> f64 {
    let name = TAKEN.iter().find(|t| t.0 == reading).expect("a reading that the survey took").1;
    table.column[place[name]].mean * 1e-3
}

/// Lower factor of a positive definite matrix; 0 above the diagonal.
fn lower_factor(mut a: [[f64; READINGS]; READINGS]) -> [[f64; READINGS]; READINGS] {
    // Rounded correlations are at most 5e-4 off, far less than each reading's own error makes up for.
    linear::factor(&mut a, Pivot::AtLeast(1e-8));
    a.iter_mut().enumerate().for_each(|(i, row)| row[i + 1..].fill(0.0));
    a
}
