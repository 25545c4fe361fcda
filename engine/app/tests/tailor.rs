//! `toile tailor` as a user or a script meets it, and the sizes of what it makes.

use std::path::Path;

use crate::common::{Scratch, sentence, stdout};
use serde_json::Value;

/// A draft of FreeSewing's circle skirt, and the seams of all of them.
fn sandy(size: &str) -> String {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    assets.join(format!("tests/data/freesewing/sandy{size}.json")).display().to_string()
}

fn seams() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/data/patterns/sandy.toml").display().to_string()
}

fn json(scratch: &Scratch, line: &[&str]) -> Value {
    let output = scratch.toile(line);
    assert_eq!(output.status.code(), Some(0), "{line:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_str(&stdout(&output)).expect("stdout is exactly one JSON object")
}

fn waist(report: &Value) -> f64 {
    let zones = report["ease"].as_array().unwrap();
    zones.iter().find(|z| z["zone"] == "waist").unwrap()["pattern_mm"].as_f64().unwrap()
}

#[test]
fn drafts_of_two_sizes_become_a_package_in_all_between() {
    let scratch = Scratch::new("tailor-sizes");
    let (small, large, seams) = (sandy("34"), sandy("42"), seams());
    let large = format!("42={large}");
    let line = [
        &["tailor", &small, "--seams", &seams, "--table", "freesewing-women", "--drafted-for", "34", "--draft", &large]
            [..],
        &["--spacing", "30", "--out", "sandy.toile.json", "--json"],
    ]
    .concat();
    let own = json(&scratch, &line);
    assert_eq!((&own["schema"], &own["size"]), (&"toile.tailor/1".into(), &"34".into()));
    let graded = json(&scratch, &["tailor", "sandy.toile.json", "--size", "38", "--json"]);
    assert_eq!(graded["size"], "38");
    // FreeSewing's own draft for 38 has a waistband of 942.97 mm.
    assert!((waist(&graded) - 942.97).abs() < 1.0 && waist(&own) < 860.0, "{graded}");
    std::fs::write(scratch.path().join("me.json"), r#"{"stature": 1700, "chest": 930, "waist": 787, "seat": 1045}"#)
        .unwrap();
    let measured = json(&scratch, &["tailor", "sandy.toile.json", "--measures", "me.json", "--json"]);
    assert!(measured["size"].as_str().unwrap().starts_with("to measure"), "{measured}");
    assert!(waist(&measured) > waist(&own) + 20.0 && waist(&measured) < waist(&graded) - 20.0, "{measured}");

    let baked = json(&scratch, &["bake", "sandy.toile.json", "--size", "36", "--json"]);
    assert_eq!(baked["size"], "36");
    let refused: [(&[&str], &str); 5] = [
        (&["tailor", "sandy.toile.json", "--size", "44"], "34, 36, 38, 40, 42"),
        (&["try-on", "--garment", "sandy.toile.json", "--size", "44"], "44"),
        (&["tailor", &small, "--seams", &seams, "--drafted-for", "34", "--draft", "42"], "SIZE=FILE"),
        (&["tailor", &small, "--seams", &seams, "--drafted-for", "3"], "size 3"),
        (&["tailor", &small, "--seams", &seams, "--drafted-for", "34", "--draft", "36=sandy.toile.json"], "draft"),
    ];
    for (line, word) in refused {
        let output = scratch.toile(line);
        assert_eq!(output.status.code(), Some(4), "{line:?}");
        let message = sentence(&output);
        assert!(message.contains(word) && message.contains("; "), "{line:?}: {message}");
    }
}

#[test]
fn a_package_is_tried_on_in_the_size_that_fits() {
    let scratch = Scratch::new("tailor-try-on");
    let (small, large, seams) = (sandy("34"), format!("42={}", sandy("42")), seams());
    let sizes = ["--table", "freesewing-women", "--drafted-for", "34", "--draft", &large, "--spacing", "30"];
    let line = [&["tailor", &small, "--seams", &seams, "--out", "sandy.toile.json", "--json"][..], &sizes].concat();
    json(&scratch, &line);
    let worn = json(&scratch, &["try-on", "--garment", "sandy.toile.json", "--no-pictures", "--json", "--quiet"]);
    let fit = &worn["recommendation"];
    assert_eq!((&fit["size"], fit["sizes"].as_array().map(Vec::len)), (&"34".into(), Some(5)), "{fit}");
    assert_eq!((&fit["zones"][0]["zone"], &fit["zones"][0]["verdict"]), (&"waist".into(), &"good".into()), "{fit}");
}
