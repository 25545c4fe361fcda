//! Sizes of sewn patterns: the recommendation for bodies of known size, by drafts that were made for them.

use std::path::Path;

use toile_assets::draping::{PatternPackage, PatternSizes, SizedDraft, read_package};
use toile_assets::sizes::{GarmentKind, SizeTable};
use toile_base::body::{Body, Measures as BodyMeasures, Sex};
use toile_fitting::dress::garment_source::{GarmentSource, SourceKind};
use toile_track::estimate::Estimate;
use toile_track::measure::{Measurements, Source};
use toile_track::measures::Measures;
use toile_track::recommend::{Recommendation, Verdict, Zone};

/// FreeSewing's drafts of one design for two of its bodies, in a package.
fn package(name: &str, kind: GarmentKind, [small, large]: [&str; 2]) -> PatternPackage {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    let seams = assets.join(format!("data/patterns/{name}.toml"));
    let read = |size: &str| {
        read_package(&assets.join(format!("tests/data/freesewing/{name}{size}.json")), Some(&seams)).unwrap()
    };
    let (mut package, other) = (read(small), read(large));
    let drafts = vec![SizedDraft { size: large.into(), pattern: other.pattern, seams: other.seams }];
    package.sizes =
        Some(PatternSizes { table: "freesewing-women".into(), kind, size: small.into(), drafts, girths: Vec::new() });
    package
}

/// The body of a size, measured to a sigma (m).
fn wearer(size: &str, sigma: f32) -> (Body, Measurements) {
    let table = SizeTable::embedded("freesewing-women").unwrap();
    let body = toile_assets::body::build(Sex::Female, &BodyMeasures::from(table.size_body(size).unwrap())).unwrap();
    let e = |m: f32| Some(Estimate::new(m, sigma));
    let measures = Measures {
        stature: e(body.measures.stature),
        chest_girth: e(body.measures.chest_girth),
        waist_girth: e(body.measures.waist_girth),
        hip_girth: e(body.measures.hip_girth),
        ..Measures::default()
    };
    let notes = Vec::new();
    (body, Measurements { measures, valid_pixels: 1, people: 1, frames: 30, source: Source::Depth, notes })
}

fn source(package: &PatternPackage) -> GarmentSource {
    GarmentSource {
        name: package.name.clone(),
        kind: SourceKind::Pattern(Box::new(package.clone())),
        fabric: None,
        layer: None,
        photographs: None,
    }
}

fn judge(package: &PatternPackage, size: Option<&str>, on: &str) -> Recommendation {
    let (body, measured) = wearer(on, 0.005);
    source(package).judge(size, &measured, &body, &[]).unwrap().unwrap()
}

#[test]
fn the_body_that_a_size_is_drafted_for_is_recommended_that_size() {
    for (name, kind) in [("sandy", GarmentKind::Skirt), ("aaron", GarmentKind::Tshirt)] {
        let package = package(name, kind, ["34", "42"]);
        for size in ["34", "36", "38", "40", "42"] {
            let fit = judge(&package, None, size);
            assert_eq!(fit.size, size, "{name}: {fit:?}");
            assert_eq!(fit.zones[0].verdict, Verdict::Good, "{name} {size}: {fit:?}");
        }
    }
}

#[test]
fn a_wrong_size_is_tight_or_loose_and_names_the_right_one() {
    let package = package("aaron", GarmentKind::Tshirt, ["34", "42"]);
    let fit = judge(&package, Some("34"), "42");
    assert_eq!((fit.zones[0].zone, fit.zones[0].verdict), (Zone::Chest, Verdict::Tight), "{fit:?}");
    assert!(fit.verdict.contains("size 42 would fit better"), "{}", fit.verdict);
    // Made to measure it is right for bodies between the sizes, too.
    for on in ["34", "36", "40"] {
        let fit = judge(&package, Some("to measure"), on);
        assert_eq!(fit.zones[0].verdict, Verdict::Good, "{on}: {fit:?}");
        assert!(fit.verdict.starts_with("There is one size, to measure"), "{}", fit.verdict);
    }
}

#[test]
fn a_pattern_without_sizes_is_judged_by_its_own_lengths() {
    let mut package = package("aaron", GarmentKind::Tshirt, ["34", "42"]);
    package.sizes = None;
    let ease = |on: &str| {
        let fit = judge(&package, None, on);
        assert_eq!((fit.size.as_str(), fit.probability, fit.zones[0].zone), ("as drafted", 1.0, Zone::Chest));
        (fit.zones[0].ease, fit.zones[0].verdict, fit.verdict)
    };
    let (own, larger) = (ease("34"), ease("46"));
    // The panels are the same, so the ease goes as the chest does, up to where its level lies on other statures.
    let [small, large] = ["34", "46"].map(|size| wearer(size, 0.0).0.measures.chest_girth);
    assert!((own.0 - larger.0 - (large - small)).abs() < 0.03, "{own:?} {larger:?} {small} {large}");
    assert_eq!(larger.1, Verdict::Tight);
    assert_eq!(larger.2, "There is one size, as drafted: tight at the chest.");
    let (body, measured) = wearer("34", 0.01);
    assert!(source(&package).judge(Some("40"), &measured, &body, &[]).is_err());
}

#[test]
fn what_is_worn_beneath_takes_its_thickness_all_around() {
    let (body, measured) = wearer("38", 0.005);
    let [shirt, jacket] = ["tee", "blazer"].map(|name| GarmentSource::find(name).unwrap());
    let beneath = vec![shirt.offer(&body).unwrap().unwrap()];
    let thickness = shirt.fabric().unwrap().thickness_mm * 1e-3;
    let ease = |beneath: &[_]| {
        let fit = jacket.judge(Some("38"), &measured, &body, beneath).unwrap().unwrap();
        fit.zones.iter().map(|z| z.ease).collect::<Vec<_>>()
    };
    for (alone, over) in ease(&[]).into_iter().zip(ease(&beneath)) {
        assert!((alone - over - std::f32::consts::TAU * thickness).abs() < 1e-5, "{alone} {over}");
    }
}
