//! One answer: the same recording gives the same measures, the same size and the same verdicts through every API.

use std::path::{Path, PathBuf};

use crate::common::{Scratch, beside_others};
use crate::recordings;
use serde_json::Value;
use toile_assets::drafting;
use toile_base::body::{Measures, Sex};
use toile_fitting::dress::measured::{self, ShopperFacts};
use toile_fitting::dress::offer::GarmentOffer;
use toile_fitting::dress::session;
use toile_fitting::dress::try_on::{TryOn, Wearer};
use toile_sdk::{Garment, Quality, Recording, TryOnOptions, try_on};

/// The measures of the contract.
const MEASURES: [&str; 5] = ["stature_mm", "shoulder_breadth_mm", "chest_girth_mm", "waist_girth_mm", "hip_girth_mm"];

/// What the program prints as JSON.
fn json(scratch: &Scratch, args: &[&str]) -> Value {
    let (code, printed) = code_and_json(scratch, args);
    assert_eq!(code, 0, "{args:?}: {printed}");
    printed
}

fn code_and_json(scratch: &Scratch, args: &[&str]) -> (i32, Value) {
    let args: Vec<&str> = args.iter().copied().chain(["--json"]).collect();
    let out = scratch.toile(&args);
    let words = String::from_utf8_lossy(&out.stderr);
    let printed = serde_json::from_slice(&out.stdout).unwrap_or_else(|e| panic!("{args:?}: {e}: {words}"));
    (out.status.code().unwrap_or_else(|| panic!("{args:?} was killed: {words}")), printed)
}

/// Zones with ease and verdict, as try-on reports them.
fn zones(recommendation: &Value) -> Vec<(String, f64, String)> {
    let zone = |z: &Value| {
        (z["zone"].as_str().unwrap().into(), z["ease_mm"].as_f64().unwrap(), z["verdict"].as_str().unwrap().into())
    };
    recommendation["zones"].as_array().unwrap().iter().map(zone).collect()
}

/// The way of one call, as an embedder of `toile-fitting` takes it.
fn dressed_in_one_call(path: &Path, garment: &str) -> (String, [f32; 5]) {
    let _cores = beside_others();
    let request = TryOn::of_shopper(&[garment.to_owned()], None, ShopperFacts::default());
    let dressed = request.on_shopper(&session::open(Some(path), None).unwrap()).unwrap();
    let Wearer::Body { measures: m, .. } = dressed.request.wearer else { panic!("no person was measured") };
    let measures = [m.stature, m.shoulder_breadth, m.chest_girth, m.waist_girth, m.hip_girth];
    (dressed.request.garments[0].size.clone().unwrap(), measures)
}

/// The SDK gives the command's measures and size, and every bit of its cloth.
fn by_the_sdk(path: &Path, garment: &str, tried: &Value) {
    let _cores = beside_others();
    let garments = [Garment::open(garment).unwrap()];
    let options = TryOnOptions { quality: Quality::Draft, ..TryOnOptions::default() };
    let own = try_on(&Recording::open(path).unwrap(), &garments, &options).unwrap();
    let file = path.display();
    for name in MEASURES {
        let measure = own.measures.iter().find(|m| m.name == name.trim_end_matches("_mm")).unwrap();
        let printed = &tried["measurements"][name];
        for (own, printed) in [(measure.mm, &printed["value"]), (measure.sigma_mm, &printed["sigma"])] {
            assert!((own - printed.as_f64().unwrap()).abs() < 0.051, "{file}: {name} is {own} and {printed}");
        }
    }
    let fit = own.fits[0].as_ref().unwrap();
    assert_eq!(tried["recommendation"]["size"], fit.size.as_str(), "{file}: sdk");
    let verdicts: Vec<(String, f64, String)> =
        fit.zones.iter().map(|z| (z.zone.into(), (z.ease_mm * 10.0).round() / 10.0, z.verdict.into())).collect();
    assert_eq!(verdicts, zones(&tried["recommendation"]), "{file}: sdk");
    assert_eq!(tried["physics"]["steps"], own.scene.steps(), "{file}: sdk");
    let hash = format!("{:016x}", own.scene.state_hash());
    assert_eq!(tried["state_hash"], hash.as_str(), "{file}: sdk");
}

fn one_answer(path: &Path, garment: &str) {
    let file = path.to_str().unwrap();
    let scratch = Scratch::new(&format!("one-answer-{}-{garment}", path.file_stem().unwrap().display()));
    let measured = json(&scratch, &["measure", file]);
    let worn = ["--session", file, "--garment", garment, "--quality", "draft"];
    let tried = json(&scratch, &[&["try-on", "--no-pictures"], &worn[..]].concat());
    assert!(scratch.path().join("out/report.json").is_file(), "what a command writes goes under out/");
    // On a slow machine the plan is that the scene does not fit: code 3.
    let (code, planned) = code_and_json(&scratch, &[&["plan", "--quick"], &worn[..]].concat());
    assert!(matches!(code, 0 | 3), "plan exits with {code}: {planned}");
    for name in MEASURES {
        assert_eq!(measured["measurements"][name], tried["measurements"][name], "{file}: {name}");
    }
    let recommended = &tried["recommendation"];
    let size_code = recommended["size"].as_str().unwrap();
    assert_eq!(planned["garments"][0]["size"], size_code, "{file}: plan");
    let (own_size, own_body) = dressed_in_one_call(path, garment);
    assert_eq!(own_size, size_code, "{file}: one call");
    // The body that is dressed has the measures that are reported, where no two of them contradict each other.
    for (name, body) in MEASURES.iter().zip(own_body) {
        let printed = tried["measurements"][name]["value"].as_f64().unwrap();
        assert!(
            (f64::from(body) * 1e3 - printed).abs() < 0.1,
            "{file}: {name} {printed} is {body} m on the dressed body"
        );
    }
    // What the window judges by: the same function on the same measures.
    let session = session::open(Some(path), None).unwrap();
    let known = measured::measure(&session, ShopperFacts::default()).unwrap();
    let average = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    let offer = GarmentOffer::of_pattern(&drafting::package(garment).unwrap(), &average).unwrap();
    let judged = offer.judge(None, &known.best).unwrap();
    let by_window: Vec<(String, f64, String)> = judged
        .zones
        .iter()
        .map(|z| (z.zone.name().into(), (f64::from(z.ease) * 1e4).round() / 10.0, z.verdict.name().into()))
        .collect();
    assert_eq!(judged.size, size_code);
    assert_eq!(by_window, zones(recommended), "{file}: verdicts");
    by_the_sdk(path, garment, &tried);
}

#[test]
fn a_recording_with_depth_has_one_answer() {
    let scratch = Scratch::new("one-answer");
    scratch.record_short();
    one_answer(&scratch.path().join("short.mcap"), "wide-leg-trousers");
}

#[test]
fn a_recording_of_joints_alone_has_one_answer() {
    let Some(data) = recordings::folder() else { return };
    let folder = data.join("skeleton/labanotation-kinect2");
    let mut recordings: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    recordings.sort();
    let csv = recordings.iter().find(|path| path.extension().is_some_and(|e| e == "csv")).unwrap();
    one_answer(csv, "strap-dress");
}
