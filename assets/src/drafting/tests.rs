//! Rules that every draft keeps, in every size of its table.

use super::{STYLES, SUCCESSORS, names, style};
use crate::draping::PatternPackage;
use crate::import::pattern::parse;
use crate::pattern::Pattern;
use crate::sizes::SizeTable;
use toile_base::garment::trim::{MAX_TRIMS, TrimKind};

/// The most that one side of a seam may be longer than the other (1), where it is not gathered: what cloth takes by steam.
const EASED: f64 = 1.06;

/// Puffed caps are gathered into their armholes by this (1).
const GATHERED: f64 = 1.16;

/// The most that a point of a graded pattern may lie off its own draft (m): rules with a least value bend where it begins.
const OFF_M: f64 = 0.006;

fn drafted(name: &str, size: &str) -> Pattern {
    let style = style(name).unwrap();
    let draft = style.draft(&SizeTable::embedded(style.table).unwrap(), size).unwrap();
    parse(name, &super::text::garment_code(&draft), None).unwrap_or_else(|e| panic!("{name} {size}: {e}"))
}

#[test]
fn every_draft_reads_in_every_size_and_its_seams_meet() {
    for style in &STYLES {
        let table = SizeTable::embedded(style.table).unwrap();
        let most = if style.name == "blouse" { GATHERED } else { EASED };
        for size in table.codes() {
            let pattern = drafted(style.name, size);
            let draft = style.draft(&table, size).unwrap();
            assert_eq!((pattern.panels().len(), pattern.seams().len()), (draft.panels.len(), draft.seams.len()));
            for [a, b] in &draft.seams {
                let (one, other) = (draft.length(a), draft.length(b));
                let gather = one.max(other) / one.min(other);
                assert!(gather < most, "{} {size}: {a:?} {one} sewn to {b:?} {other}", style.name);
            }
        }
    }
}

#[test]
fn outlines_read_back_as_they_were_drawn() {
    for style in &STYLES {
        let draft = style.draft(&SizeTable::embedded(style.table).unwrap(), style.sizes[1]).unwrap();
        let pattern = drafted(style.name, style.sizes[1]);
        for panel in pattern.panels() {
            let own = draft.panel(&panel.name).unwrap();
            for (edge, length) in own.edges.iter().zip(panel.lengths()) {
                assert!(
                    (own.length(&edge.label) - length).abs() < 1e-5,
                    "{} {} {}",
                    style.name,
                    panel.name,
                    edge.label
                );
            }
            // Seen from outside all of them run counter-clockwise.
            assert!(panel.signed_area() > 0.0 && !panel.behind, "{} {}", style.name, panel.name);
        }
    }
}

#[test]
fn every_size_of_a_table_is_made() {
    for style in &STYLES {
        let package = style.package().unwrap();
        let graded = package.graded().unwrap().unwrap();
        let made: Vec<String> = graded.made().into_iter().map(|(code, _)| code).collect();
        let girths: Vec<&String> = package.sizes.as_ref().unwrap().girths.iter().map(|g| &g.size).collect();
        assert_eq!(made.iter().collect::<Vec<_>>(), girths, "{}", style.name);
        let codes = graded.table.codes();
        let whole = [codes[0], codes[codes.len() - 1]];
        assert_eq!([style.sizes[0], style.sizes[2]], whole, "{}", style.name);
        assert_eq!(made, codes, "{}: a size between drafts of other edges", style.name);
    }
}

#[test]
fn grading_meets_the_drafts_between() {
    let mut worst = (0.0, String::new());
    for style in &STYLES {
        let package = style.package().unwrap();
        for (size, graded) in package.graded().unwrap().unwrap().made() {
            let own = drafted(style.name, &size);
            for (a, b) in graded.panels().iter().zip(own.panels()) {
                for (a, b) in a.edges.iter().zip(&b.edges) {
                    let off = a.curve.start().distance(b.curve.start());
                    if off > worst.0 {
                        worst = (off, format!("{} {size} {:?}", style.name, b.label));
                    }
                }
            }
        }
    }
    println!("worst: {:.1} mm, {}", worst.0 * 1e3, worst.1);
    assert!(worst.0 < OFF_M, "{:.1} mm off: {}", worst.0 * 1e3, worst.1);
}

/// How far beyond its panel's outline a trim may reach (m): what two panels share at a seam, and a fly's lap.
const BEYOND_M: f64 = 0.03;

#[test]
fn trims_lie_on_their_panels_in_every_size_and_on_both_sides_alike() {
    for style in &STYLES {
        for size in SizeTable::embedded(style.table).unwrap().codes() {
            let pattern = drafted(style.name, size);
            let count: usize = pattern.panels().iter().map(|p| p.trims.len()).sum();
            assert!(count <= MAX_TRIMS, "{} has {count} trims", style.name);
            for panel in pattern.panels() {
                let ends = || panel.edges.iter().map(|e| e.curve.start());
                let low = ends().reduce(|a, b| a.min(b)).unwrap() - BEYOND_M;
                let high = ends().reduce(|a, b| a.max(b)).unwrap() + BEYOND_M;
                for trim in &panel.trims {
                    for p in trim.ends {
                        let within = p.cmpge(low).all() && p.cmple(high).all();
                        assert!(within, "{} {size} {}: {trim:?} in {low}, {high}", style.name, panel.name);
                    }
                }
            }
        }
    }
    let shirt = drafted("shirt", "44");
    let buttons = |name: &str| {
        let panel = shirt.panels().iter().find(|p| p.name == name).unwrap();
        panel.trims.iter().filter(|t| t.kind == TrimKind::Button).count()
    };
    // A button in the middle lies half on each front.
    assert_eq!((buttons("left front"), buttons("right front"), buttons("left sleeve")), (7, 7, 1));
}

#[test]
fn names_are_no_files_and_titles_are_words() {
    for name in names() {
        assert!(!crate::draping::is_pattern(name), "{name}");
    }
    assert_eq!(style("mens-tee").unwrap().title(), "Men's tee");
    assert_eq!(style("straight-skirt").unwrap().title(), "Straight skirt");
    assert!(style("crown").is_none());
    for (old, new) in SUCCESSORS {
        assert!(style(old).is_none() && style(new).is_some(), "{old}");
    }
}

#[test]
fn a_package_keeps_its_layer_and_sizes_as_text() {
    let package: PatternPackage = style("blazer").unwrap().package().unwrap();
    let read = crate::draping::parse_package("blazer", package.text(), None).unwrap();
    assert!(read == package && read.layer == Some(4));
}
