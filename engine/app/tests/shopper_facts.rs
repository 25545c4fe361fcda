//! Facts that a shopper gives: measures by tape count in every command, a child changes no measure, and impossible measures are named.

use crate::common::{Scratch, object, refusal};
use serde_json::Value;

/// A second of the synthetic shopper.
fn recorded(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    assert!(scratch.toile(&["record", "--out", "in.mcap", "--seconds", "1", "--quiet"]).status.success());
    scratch
}

fn figure(report: &Value, measure: &str, part: &str) -> f64 {
    report["measurements"][measure][part].as_f64().unwrap_or_else(|| panic!("{measure} in {report}"))
}

#[test]
fn a_chest_by_tape_is_believed_and_the_other_girths_follow() {
    let scratch = recorded("tape-measure");
    let plain = object(&scratch.toile(&["measure", "in.mcap", "--json"]));
    let chest = figure(&plain, "chest_girth_mm", "value") + 30.0;
    let words = format!("chest={chest:.0}");
    let tape = object(&scratch.toile(&["measure", "in.mcap", "--json", "--measure", &words]));
    assert!((figure(&tape, "chest_girth_mm", "value") - chest).abs() < 3.0, "{tape}");
    assert!(figure(&tape, "chest_girth_mm", "sigma") <= 5.0);
    assert!(figure(&tape, "waist_girth_mm", "value") > figure(&plain, "waist_girth_mm", "value") + 3.0);
    assert!(figure(&tape, "waist_girth_mm", "sigma") < figure(&plain, "waist_girth_mm", "sigma"));
    // Inches are the same chest, and a plan takes it too.
    let inches = format!("bust={:.3}in", chest / 25.4);
    let same = object(&scratch.toile(&["measure", "in.mcap", "--json", "--measure", &inches]));
    assert!((figure(&same, "chest_girth_mm", "value") - figure(&tape, "chest_girth_mm", "value")).abs() < 1.0);
}

#[test]
fn wrong_units_and_contradictions_are_named() {
    let scratch = recorded("tape-wrong");
    let refused = |words: &[&str]| {
        let measures: Vec<&str> = words.iter().flat_map(|w| ["--measure", w]).collect();
        refusal(&scratch.toile(&[&["measure", "in.mcap"], &measures[..]].concat()), 2)
    };
    assert!(refused(&["chest=91"]).contains("centimetres"));
    assert!(refused(&["chest=36"]).contains("inches"));
    assert!(refused(&["elbow=300"]).contains("chest_girth"));
    assert!(refused(&["chest=800", "underbust=1150"]).contains("does not go with"));
    let sex = refusal(&scratch.toile(&["measure", "in.mcap", "--sex", "child"]), 2);
    assert!(sex.contains("female"), "{sex}");
}

#[test]
fn the_child_estimate_moves_no_measure() {
    let scratch = recorded("age");
    let of = |words: &[&str]| object(&scratch.toile(&[&["measure", "in.mcap", "--json"], words].concat()));
    let (guessed, child) = (of(&[]), of(&["--age", "child"]));
    assert!(guessed["body"]["child"].as_f64().expect("odds") < 0.05, "{guessed}");
    assert_eq!(child["body"]["child"], 1.0);
    assert_eq!(of(&["--age", "adult"])["body"]["child"], 0.0);
    assert_eq!(guessed["measurements"], child["measurements"]);
    let notes = |report: &Value| report["session"]["notes"].to_string();
    assert!(notes(&child).contains("probably a child") && !notes(&guessed).contains("child"), "{child}");
}
