//! Whether the probabilities that are stated of sizes are true, of real women.

use toile_assets::sizes::{GarmentKind, SizeTable};
use toile_perf::reliability::{ansur, reliability};
use toile_track::recommend::{EaseRange, MadeSize, Offer, Zone, ZoneGirth};

/// A dress with 6 cm of ease at the chest, 8 at the waist and 10 at the hip over the body of each size.
fn dress(table: &SizeTable) -> Vec<MadeSize> {
    let made = |code: &str| {
        let body = table.size_body(code).unwrap();
        let zones = [
            (Zone::Chest, body.chest_girth + 0.06),
            (Zone::Waist, body.waist_girth + 0.08),
            (Zone::Hip, body.hip_girth + 0.10),
        ];
        MadeSize { code: code.to_owned(), zones: zones.map(|(zone, girth_m)| ZoneGirth { zone, girth_m }).to_vec() }
    };
    table.codes().into_iter().map(made).collect()
}

const EASE: [EaseRange; 3] = [
    EaseRange { zone: Zone::Chest, least: 0.03, most: 0.09 },
    EaseRange { zone: Zone::Waist, least: 0.03, most: 0.15 },
    EaseRange { zone: Zone::Hip, least: 0.05, most: 0.20 },
];

fn with(test: impl Fn(&Offer)) {
    let table = SizeTable::embedded("women").unwrap();
    let sizes = dress(&table);
    test(&Offer { garment: "sun-dress", kind: GarmentKind::Dress, table: &table, sizes: &sizes, ease: &EASE });
}

/// Of the sizes said to be right with some probability that share is right, on real women measured with errors.
#[test]
fn stated_probabilities_are_true_of_real_people() {
    let Some(folder) = std::env::var_os("TOILE_DATA") else {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "TOILE_DATA must name the shared data where CI=true");
        eprintln!("skipped: TOILE_DATA does not name the folder of shared data");
        return;
    };
    let file = std::path::Path::new(&folder).join("anthropometry/ansur2/ANSUR_II_FEMALE.csv");
    let people = ansur(&String::from_utf8_lossy(&std::fs::read(file).unwrap())).unwrap();
    assert_eq!(people.len(), 1986);
    let some: Vec<_> = people.into_iter().step_by(5).collect();
    with(|offer| {
        for sigma in [0.01, 0.02] {
            let r = reliability(&some, offer, sigma, 3).unwrap();
            let [stated, right, error] = r.all.rates();
            assert!((stated - right).abs() < 3.0 * error, "{sigma}: {stated} said, {right} +- {error} right");
            for bin in r.bins.iter().filter(|b| b.people >= 30) {
                let [stated, right, error] = bin.rates();
                assert!((stated - right).abs() < 3.5 * error.max(0.03), "{sigma}: {bin:?}");
            }
            let [promised, came, error] = r.taped.rates();
            assert!(r.taped.people > 30 && (promised - came).abs() < 3.0 * error + 0.02, "{sigma}: {:?}", r.taped);
            assert!(came > r.untaped.rates()[1] + 0.1, "{sigma}: {:?} {:?}", r.untaped, r.taped);
        }
    });
}
