//! A small version of `toile validate`: what must stay right, in the production settings, case by case.

use std::sync::OnceLock;

use toile_perf::validate::Level;
use toile_perf::validate::case::ValidationRow;
use toile_perf::validate::run::{ValidationOptions, run};

/// What is run: cheap enough for a build without optimisation.
const QUICK: [(&str, &str); 8] = [
    ("elastica", "P L^2/B 10"),
    ("strip", "E 6000 N/m"),
    ("pendulum", "90 deg"),
    ("spring", "8 substeps"),
    ("free-fall", "1 s"),
    ("stopping", "1 m/s, mu 0.3"),
    ("layer-incline", "mu 0.4"),
    ("layer-weight", "shirt hung by two sides"),
];

fn options(case: &str, parameter: &str) -> ValidationOptions {
    ValidationOptions {
        case: Some(case.into()),
        parameter: Some(parameter.into()),
        levels: vec![Level::GATED],
        ..ValidationOptions::default()
    }
}

/// Their rows, made once.
fn rows() -> &'static [ValidationRow] {
    static ROWS: OnceLock<Vec<ValidationRow>> = OnceLock::new();
    ROWS.get_or_init(|| {
        let one = |(case, parameter): (&str, &str)| {
            run(&options(case, parameter), &|_| {}).expect("the cases' own meshes can be baked").cases
        };
        QUICK.into_iter().flat_map(one).collect()
    })
}

/// The rows of a case that are on a grid or on alternating triangles.
fn regular(name: &str) -> impl Iterator<Item = &'static ValidationRow> {
    rows().iter().filter(move |row| row.name == name && row.mesh != "unstructured")
}

#[test]
fn every_row_is_finite_and_says_how_long_a_step_took() {
    assert!(rows().len() >= QUICK.len(), "only {} rows", rows().len());
    for row in rows() {
        assert!(row.got.is_finite() && row.step_us > 0.0 && row.substeps > 0, "{row:?}");
        assert_eq!(row.pass.is_some(), row.target.is_some());
        assert_eq!(row.cause.is_some(), row.pass == Some(false), "a missed target has its cause: {row:?}");
    }
}

#[test]
fn strips_bend_strings_hang_cloth_slides_and_pendulums_swing_as_they_should() {
    for (name, parameter) in QUICK {
        assert!(regular(name).count() > 0, "{name} {parameter} was not run");
        for row in regular(name) {
            assert_eq!(row.pass, Some(true), "{row:?}");
        }
    }
}

#[test]
fn statics_are_those_of_the_oracle() {
    for row in ["elastica", "strip"].into_iter().flat_map(regular) {
        let error = row.solver_error.expect("statics have an oracle");
        assert!(error.abs() < 2.0, "{error} % from the converged solution of the same mesh: {row:?}");
    }
}

#[test]
fn rows_are_the_same_on_two_threads() {
    let on = |threads| {
        let options = ValidationOptions { threads, parameter: None, every: 3, ..options("spring", "") };
        let rows = run(&options, &|_| {}).expect("the cases' own meshes can be baked").cases;
        rows.into_iter().map(|row| (row.parameter, row.got.to_bits())).collect::<Vec<_>>()
    };
    assert_eq!(on(1), on(2));
}
