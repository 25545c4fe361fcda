//! Bodies have the requested measures, and measures have their known errors.

use std::collections::BTreeSet;

use crate::first_second;
use toile_assets::body::{En, Vocabulary};
use toile_sdk::{Body, Sex, Shopper, measure_names};

#[test]
fn a_body_from_measures_has_those_measures() {
    for (sex, mm) in [
        (Sex::Female, [("stature", 1720.0), ("chest", 920.0), ("waist", 760.0), ("hip", 1000.0), ("inseam", 800.0)]),
        (Sex::Male, [("height", 1800.0), ("chest_girth", 1020.0), ("waist", 880.0), ("seat", 1010.0), ("neck", 390.0)]),
    ] {
        let body = Body::from_measures_mm(sex, &mm).unwrap();
        assert_eq!(body.sex(), sex);
        for (name, wanted) in mm {
            let got = body.measure_mm(name).unwrap();
            assert!((got - wanted).abs() < 2.0, "{name}: {got} mm and not {wanted}");
        }
        let names: Vec<&str> = body.measures_mm().iter().map(|(name, _)| *name).collect();
        assert_eq!(names, measure_names());
        let tall = body.positions().iter().map(|p| f64::from(p.y) * 1e3).fold(f64::MIN, f64::max);
        assert!((tall - body.measure_mm("stature").unwrap()).abs() < 5.0, "{tall}");
        assert!(body.faces().iter().flatten().all(|v| (*v as usize) < body.positions().len()));
    }
}

#[test]
fn what_is_not_given_follows_what_is() {
    let waist = |stature: f64| {
        let body = Body::from_measures_mm(Sex::Female, &[("stature", stature), ("hip", 1000.0)]).unwrap();
        (body.measure_mm("waist").unwrap(), body.measure_mm("inside leg").unwrap())
    };
    let ((_, short), (_, tall)) = (waist(1550.0), waist(1800.0));
    assert!(tall > short + 80.0, "{short} {tall}");
    assert!(Body::from_measures_mm(Sex::Male, &[]).is_ok());
}

#[test]
fn what_is_measured_says_how_sure_it_is_and_a_tape_makes_it_surer() {
    let recording = first_second();
    let seen = recording.measure(&Shopper::default()).unwrap().measures();
    let waist = |all: &[toile_sdk::Measure]| *all.iter().find(|m| m.name == "waist_girth").unwrap();
    assert!(seen.iter().all(|m| m.mm > 200.0 && m.sigma_mm > 0.0 && !m.definition.is_empty()), "{seen:?}");
    let by_tape = vec![("waist".to_owned(), waist(&seen).mm)];
    let taken = recording.measure(&Shopper { by_tape_mm: by_tape, ..Shopper::default() }).unwrap().measures();
    assert!(waist(&taken).sigma_mm < 6.0 && waist(&taken).sigma_mm < waist(&seen).sigma_mm, "{taken:?}");
    let names: Vec<&str> = seen.iter().map(|m| m.name).collect();
    assert!(
        ["stature", "shoulder_breadth", "chest_girth", "waist_girth", "hip_girth"].iter().all(|n| names.contains(n))
    );
}

#[test]
fn words_mean_what_people_mean() {
    let body = Body::average(Sex::Female).unwrap();
    for (word, name) in [
        ("chest", "chest_girth"),
        ("Bust", "chest_girth"),
        ("hip girth", "hip_girth"),
        ("shoulder-breadth", "shoulder_breadth"),
        ("height", "stature"),
        ("inseam", "inside_leg_height"),
        ("upper arm", "upper_arm_girth"),
    ] {
        assert_eq!(body.measure_mm(word).unwrap(), body.measure_mm(name).unwrap(), "{word}");
    }
    let refused = body.measure_mm("wasit").unwrap_err();
    assert!(refused.sentence().contains("waist_girth"), "{refused}");
}

#[test]
fn every_measure_of_the_standard_has_a_name_of_its_own() {
    let names: BTreeSet<&str> = measure_names().into_iter().collect();
    assert_eq!(names.len(), En::ALL.len());
    assert!(!names.contains("measure"), "a measure of the standard has no name: {names:?}");
}
