//! `toile fabric`: the list, the loops of a fabric's curves, and that a sheet becomes a file or is refused by its line.

use crate::common::{Scratch, object, refusal, stdout};

const SHEET: &str =
    "LT, 0.712\nWT, 9.0, 10.0\nRT, 54\nB, 0.118, 0.102\n2HB, 0.124, 0.110\nG, 0.8\n2HG, 1.5\nW, 12\nT, 0.6\n";

#[test]
fn every_fabric_is_listed_and_those_of_published_figures_say_where() {
    let listed = object(&Scratch::new("fabric-list").toile(&["fabric", "list", "--json"]));
    let fabrics = listed["fabrics"].as_array().unwrap();
    let sourced = fabrics.iter().filter(|f| f["source"].is_string()).count();
    assert!(fabrics.len() >= 28 && sourced >= 14, "{} fabrics, {sourced} with a source", fabrics.len());
}

#[test]
fn the_curves_of_a_fabric_reproduce_its_loop() {
    let scratch = Scratch::new("fabric-show");
    let shown = object(&scratch.toile(&["fabric", "show", "cotton-broad", "--picture", "loop.png", "--json"]));
    let bending = &shown["loops"][0];
    for k in 0..2 {
        let [measured, read] = ["measured", "read"].map(|key| bending[key][k].as_f64().unwrap());
        assert!((read / measured - 1.0).abs() < 0.01, "{read} of {measured}");
    }
    let stays = shown["fabric"]["residual_curvature_per_m"][0].as_f64().unwrap();
    assert!((stays - 52.54).abs() < 0.02, "{stays}");
    assert!(std::fs::read(scratch.path().join("loop.png")).unwrap().starts_with(b"\x89PNG"));
    let words = refusal(&scratch.toile(&["fabric", "show", "interlock", "--picture", "no.png"]), 4);
    assert!(words.contains("interlock") && words.contains("--picture"), "{words}");
}

#[test]
fn a_sheet_becomes_a_fabric_and_what_is_none_is_refused_by_its_line() {
    let scratch = Scratch::new("fabric-import");
    let put = |name: &str, text: &str| std::fs::write(scratch.path().join(name), text).unwrap();
    put("sheet.csv", SHEET);
    let import =
        |sheet: &str| scratch.toile(&["fabric", "import", sheet, "--name", "mine", "--out", "mine.toml", "--json"]);
    let made = object(&import("sheet.csv"));
    assert_eq!(made["fabric"]["source"], "sheet.csv");
    let shown = scratch.toile(&["fabric", "show", "mine.toml"]);
    assert!(stdout(&shown).contains("52.5"), "{}", stdout(&shown));
    put("sheet.csv", "B, 0.118\nSHINE, 2\n");
    assert!(refusal(&import("sheet.csv"), 4).contains("line 2"));
    assert!(refusal(&import("absent.csv"), 4).contains("absent.csv"));
    assert!(refusal(&scratch.toile(&["fabric", "show", "tin"]), 4).contains("tin"));
}
