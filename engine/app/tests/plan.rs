//! `toile plan` as a user and a script meet it.

use std::fs;

use crate::common::Scratch;
use serde_json::Value;

fn plan(scratch: &Scratch, args: &[&str]) -> (Option<i32>, Value, String) {
    let output = scratch.toile(&[&["plan", "--json"], args].concat());
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    let object = serde_json::from_slice(&output.stdout);
    (output.status.code(), object.unwrap_or_else(|e| panic!("stdout is not one JSON object ({e}): {words}")), words)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn the_embedded_shopper_is_planned_before_anything_is_played() {
    let scratch = Scratch::new("plan");
    let (code, found, words) = plan(&scratch, &["--garment", "tee", "--garment", "wide-leg-trousers", "--quick"]);
    // The verdict depends on the machine, and the exit code on the verdict.
    let fits = found["verdict"]["fits"].as_bool().unwrap();
    assert_eq!(code, Some(if fits { 0 } else { 3 }), "{words}");
    assert_eq!((found["schema"].as_str(), &found["played"]), (Some("toile.plan/1"), &Value::Null));
    let garments = found["garments"].as_array().unwrap();
    let particles: f64 = garments.iter().map(|g| number(&g["particles"])).sum();
    assert!(garments.len() == 2 && particles >= 5_000.0, "an outfit of {particles} particles");
    for garment in garments {
        let stages: f64 = garment["stages_us"].as_object().unwrap().values().map(number).sum();
        let [one, two] = [0, 1].map(|k| number(&garment["us"][k]));
        assert!((stages - one).abs() < 1e-6 * one && two <= one && two >= 0.4 * one, "{garment}");
    }
    let stages = found["stages"].as_array().unwrap();
    let named: Vec<&str> = stages.iter().map(|s| s["stage"].as_str().unwrap()).collect();
    assert_eq!(named, ["pose", "skin", "place", "cloth", "publish"]);
    let sum: f64 = stages.iter().map(|s| number(&s["predicted_us"])).sum();
    assert!((sum - number(&found["verdict"]["step_us"])).abs() < 1e-6 * sum);
    assert!(stages.iter().all(|s| number(&s["predicted_us"]) > 0.0 && number(&s["budget_us"]) > 0.0));
    let memory = found["memory"].as_array().unwrap();
    assert!(memory.len() == 6 && memory.iter().all(|m| number(&m["bytes"]) > 1e4), "{memory:?}");
    // A sleeve has nothing to do with a leg, nor one leg's cloth with an arm.
    let row = |garment: &str, part: &str| {
        let rows = found["reach"].as_array().unwrap();
        let row = rows.iter().find(|r| r["garment"] == garment && r["part"] == part);
        row.unwrap_or_else(|| panic!("no {part} of {garment} in {rows:?}")).clone()
    };
    let touched = |row: &Value| row["touches"].to_string();
    let sleeve = row("tee", "left arm");
    assert!(touched(&sleeve).contains("left arm") && !touched(&sleeve).contains("leg"), "{sleeve}");
    let leg = row("wide-leg-trousers", "left leg");
    assert!(touched(&leg).contains("left leg") && !touched(&leg).contains("arm"), "{leg}");
    assert!(number(&sleeve["mean"]) <= number(&sleeve["by_length"]));
    assert!(number(&sleeve["by_length"]) <= number(&sleeve["by_part"]));
}

#[test]
fn a_scene_that_fits_is_played_and_its_models_are_weighed() {
    let scratch = Scratch::new("plan-example");
    let (code, found, words) = plan(&scratch, &["--example", "flag-in-wind", "--workers", "1"]);
    assert_eq!(code, Some(0), "{words}");
    let models = found["played"]["models"].as_array().unwrap();
    let of = |name: &str| {
        let model = models.iter().find(|m| m["model"] == name).unwrap_or_else(|| panic!("no {name} in {models:?}"));
        (model["on"].as_bool().unwrap(), number(&model["error_mm"][0]), number(&model["error_mm"][2]))
    };
    // A flag without wind, or that does not shear, is somewhere else soon; nothing is there to rub against.
    let (on, mean, worst) = of("wind");
    assert!(on && mean > 0.1 && worst >= mean, "{mean} mm");
    assert!(of("shear").1 > 0.01);
    assert_eq!(of("friction"), (true, 0.0, 0.0));
    assert!(of("repeated passes over hoops and fibers").0 && !of("tethers in every substep").0);
    let held = &found["held"];
    assert!(number(&held["predicted_us"]) > 0.0 && number(&held["measured_us"][0]) > 0.0, "{held}");
}

#[test]
fn a_scene_that_cannot_fit_is_refused_with_the_cure_and_not_played() {
    let scratch = Scratch::new("plan-refused");
    let scene = "[settings]\nquality = \"fine\"\nsubsteps = 200\n[[garment]]\nname = \"curtain\"\ngrid = { rows = 120, columns \
                 = 120, width = 2.0, height = 2.0 }\n[[garment.pin]]\nvertices = [\"0-119\"]\n";
    fs::write(scratch.path().join("curtain.toml"), scene).unwrap();
    let (code, found, words) = plan(&scratch, &["curtain.toml", "--workers", "1"]);
    assert_eq!(code, Some(3), "{words}");
    let verdict = &found["verdict"];
    assert!(verdict["fits"] == false && number(&verdict["step_us"]) > number(&verdict["period_us"]), "{verdict}");
    assert_eq!(found["played"], Value::Null);
    assert!(words.lines().count() == 1 && words.contains("curtain in a spacing of"), "{words}");
    let coarser: f64 = words.split("spacing of ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(coarser > 2_000.0 / 119.0, "{coarser} mm");
}

#[test]
fn what_does_not_exist_is_named() {
    let scratch = Scratch::new("plan-none");
    for (args, code, expected) in [
        (vec!["plan", "--garment", "toga"], 4, "toga"),
        (vec!["plan", "no.toml"], 4, "no.toml"),
        (vec!["plan", "--example", "none"], 2, "none"),
        (vec!["plan", "a.toml", "--garment", "tee"], 2, "--garment"),
    ] {
        let output = scratch.toile(&args);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {message}");
        assert!(message.contains(expected) && message.lines().count() == 1, "{message}");
    }
}
