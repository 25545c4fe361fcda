//! How closely the collision body follows the skin of people of many sizes.

use std::sync::OnceLock;

use toile_assets::body::{Ansur, Wanted};
use toile_assets::rig::{MEAN_GOAL_MM, P95_GOAL_MM, RigReport, Zone};
use toile_assets::{people, rig};
use toile_base::body::{Body, Sex};

/// The 5th, 50th and 95th percentile of ANSUR II (m): stature, neck, chest, waist at the navel, buttocks, crotch height,
/// sleeve from the spine, biacromial breadth.
const PERCENTILES: [(Sex, [[f32; 8]; 3]); 2] = [
    (
        Sex::Female,
        [
            [1.525, 0.302, 0.824, 0.710, 0.901, 0.712, 0.746, 0.335],
            [1.626, 0.328, 0.940, 0.852, 1.018, 0.780, 0.805, 0.365],
            [1.740, 0.363, 1.094, 1.040, 1.156, 0.857, 0.870, 0.396],
        ],
    ),
    (
        Sex::Male,
        [
            [1.648, 0.360, 0.922, 0.768, 0.899, 0.771, 0.831, 0.384],
            [1.755, 0.395, 1.056, 0.937, 1.017, 0.845, 0.895, 0.415],
            [1.870, 0.443, 1.207, 1.131, 1.149, 0.925, 0.963, 0.447],
        ],
    ),
];

/// How closely the collision body follows each of them: judged once for all tests.
fn reports() -> &'static [(String, RigReport)] {
    static REPORTS: OnceLock<Vec<(String, RigReport)>> = OnceLock::new();
    let report = |(name, body): (String, Body)| (name, rig::report(&rig::fit(&body), &body));
    REPORTS.get_or_init(|| people().into_iter().map(report).collect())
}

fn people() -> Vec<(String, Body)> {
    let sized = people::sizes().into_iter().map(|p| (p.name.clone(), p.body().unwrap()));
    let surveyed = PERCENTILES.into_iter().flat_map(|(sex, rows)| rows.map(|row| (sex, row)));
    let surveyed = surveyed.map(|(sex, row)| {
        use Ansur::*;
        let girths = [NeckCircumference, ChestCircumference, WaistCircumferenceOmphalion, ButtockCircumference];
        let lengths = [CrotchHeight, SleeveLengthSpineWrist, BiacromialBreadth];
        let measures = [Stature].into_iter().chain(girths).chain(lengths);
        let wanted = measures.zip(row).fold(Wanted::new(), |w, (m, value)| w.with(m, value));
        (format!("{sex:?} {row:?}"), toile_assets::body::fitted(sex, &wanted).unwrap().body)
    });
    sized.chain(surveyed).collect()
}

#[test]
fn trunk_and_thighs_keep_to_the_goal() {
    for (name, report) in reports() {
        let missed: Vec<_> = report.missed().into_iter().map(|zone| (zone, report.of(zone))).collect();
        assert!(missed.is_empty(), "{name}: {missed:?}");
        assert!(report.trunk.meets(), "{name}: trunk {:?}", report.trunk);
    }
}

/// Zones without a goal, and the worst places of those with one: what is reached must not get worse unseen. Hands and
/// feet are flatter than any capsule; a fold of the skin (between the legs, under the arm) is as deep as it is.
#[test]
fn every_sample_of_the_skin_is_within_bounds() {
    for (name, report) in reports() {
        for (zone, r) in Zone::ALL.into_iter().zip(&report.zones) {
            // Mean, 95th percentile, deepest skin above the union, union above the skin (mm).
            let bounds = match zone {
                Zone::Hand => [15.0, 33.0, 42.0, 45.0],
                Zone::Foot => [8.0, 21.0, 33.0, 36.0],
                Zone::Head => [7.0, 16.0, 32.0, 20.0],
                Zone::Hips => [5.0, 12.0, 22.0, 14.0],
                _ => [5.5, 14.0, 26.0, 19.0],
            };
            let reached = [r.mean_mm, r.p95_mm, r.max_inside_mm, r.cloth_max_above_mm];
            assert!(reached.iter().zip(bounds).all(|(r, b)| *r <= b), "{name}: {} {r:?}", zone.name());
            assert!(r.signed_mean_mm.abs() <= r.mean_mm && r.mean_mm <= r.p95_mm.max(r.max_mm()), "{name}: {r:?}");
        }
    }
}

/// Bodies that the plan was not tuned on. Of the twenty, one short and very stout man misses the 95th percentile at the
/// hips, by the fold between his legs, which the union fills; what cloth lies on there is near the skin all the same.
#[test]
fn strangers_keep_to_the_goal() {
    let mut missed = Vec::new();
    for person in people::strangers(20, 1) {
        let body = person.body().unwrap();
        let report = rig::report(&rig::fit(&body), &body);
        for zone in Zone::HELD {
            let r = report.of(zone);
            assert!(r.mean_mm <= MEAN_GOAL_MM && r.p95_mm <= P95_GOAL_MM + 1.5, "{person:?}: {} {r:?}", zone.name());
            assert!(
                r.cloth_mean_mm <= MEAN_GOAL_MM && r.cloth_p95_mm <= P95_GOAL_MM,
                "{person:?}: {} {r:?}",
                zone.name()
            );
        }
        missed.extend(report.missed().into_iter().map(|zone| (person.name.clone(), zone)));
    }
    assert!(missed.len() <= 1, "{missed:?}");
}

#[test]
fn strangers_are_as_many_as_asked_for_and_the_same_again() {
    assert_eq!(people::strangers(5, 7), people::strangers(9, 7)[..5]);
    assert_ne!(people::strangers(5, 7), people::strangers(5, 8));
}
