//! Names: a type's name stands once in its crate, and everything has the word that the field has for it.

use std::collections::{BTreeMap, BTreeSet};

use toile_workspace::exceptions;
use toile_workspace::imports::CrateFiles;
use toile_workspace::items::{self, ItemKind};
use toile_workspace::scan;
use toile_workspace::tree::{self, CRATES};

/// Names that each module of a crate may have: a reader of `contact::Settings` knows what it is.
const CONVENTIONAL: [&str; 2] = ["Error", "Settings"];

/// Words of the theatre and the workshop, of which none says what a part of a program does.
const FORBIDDEN: [&str; 22] = [
    "atelier",
    "backstage",
    "cast",
    "desk",
    "eye",
    "glass",
    "laps",
    "life",
    "lives",
    "manager",
    "podium",
    "stagehand",
    "tape",
    "told",
    "upset",
    "usher",
    "util",
    "utils",
    "helper",
    "varnish",
    "wing",
    "wings",
];

/// Words that are good ones of a type (a stage of a pipeline), but name no module.
const NO_MODULE: [&str; 1] = ["stage"];

/// The words of a name in either case, in small letters: `TapeError` and `tape_error` are `tape`, `error`.
fn words(name: &str) -> Vec<String> {
    let mut found: Vec<String> = vec![String::new()];
    let mut small = false;
    for c in name.chars() {
        if !c.is_alphanumeric() || (c.is_uppercase() && small) {
            found.push(String::new());
        }
        small = c.is_lowercase() || c.is_numeric();
        if c.is_alphanumeric() {
            found.last_mut().expect("there is a word").extend(c.to_lowercase());
        }
    }
    found.retain(|word| !word.is_empty());
    found
}

fn is_forbidden(name: &str, module: bool) -> bool {
    let words = words(name);
    // What starts and watches a service is called so: systemd, launchd.
    if words == ["service", "manager"] {
        return false;
    }
    // A body has eyes, and rays are cast: in company such a word may say what it means.
    let alone = ["eye", "cast", "glass", "tape"];
    words.iter().any(|w| FORBIDDEN.contains(&w.as_str()) && (words.len() == 1 || !alone.contains(&w.as_str())))
        || (module && words.len() == 1 && NO_MODULE.contains(&words[0].as_str()))
}

/// The types of a crate outside tests, each with the files that define one of its name.
fn types(folder: &str) -> BTreeMap<String, BTreeSet<String>> {
    let files = CrateFiles::read(folder);
    let mut found = BTreeMap::<String, BTreeSet<String>>::new();
    for place in files.modules().map(|m| files.place(m)) {
        for name in type_names(&tree::read(&tree::root().join(place))) {
            found.entry(name).or_default().insert(place.to_owned());
        }
    }
    found
}

fn type_names(source: &str) -> Vec<String> {
    let items = items::items(&scan::without_tests(&scan::tokens(source)));
    items.into_iter().filter(|i| i.kind == ItemKind::Type).map(|i| i.name).collect()
}

#[test]
fn a_type_has_its_name_alone_in_its_crate() {
    let mut found = BTreeSet::new();
    for (folder, name) in CRATES {
        for (of, places) in types(folder) {
            if places.len() > 1 && !CONVENTIONAL.contains(&of.as_str()) {
                println!("{name} {of}: {places:?}");
                found.insert(format!("{name} {of}"));
            }
        }
    }
    exceptions::hold("type_names", &found);
}

#[test]
fn names_are_the_fields_own() {
    let mut found = BTreeSet::new();
    for (folder, name) in CRATES {
        for (of, _) in types(folder).into_iter().filter(|(of, _)| is_forbidden(of, false)) {
            found.insert(format!("{name} {of}"));
        }
        for file in tree::crate_files(folder) {
            let inside = file.strip_prefix(tree::root().join(folder)).expect("a file of the crate").with_extension("");
            if inside.iter().any(|part| is_forbidden(&part.to_string_lossy(), true)) {
                found.insert(tree::name(&file));
            }
            for module in modules(&tree::read(&file)).iter().filter(|module| is_forbidden(module, true)) {
                found.insert(format!("{} mod {module}", tree::name(&file)));
            }
        }
    }
    exceptions::hold("names_of_no_field", &found);
}

/// The modules that a source holds within itself; those of files are known by their files.
fn modules(source: &str) -> Vec<String> {
    let items = items::items(&scan::tokens(source));
    items.into_iter().filter(|i| i.kind == ItemKind::Module && i.lines() > 1).map(|i| i.name).collect()
}

#[test]
fn types_are_found_and_those_of_tests_are_not() {
    let source = "struct A; #[cfg(test)] mod tests { struct B; } trait C { type D; } type E = u8; #[cfg(all(test, x))] enum F {}";
    assert_eq!(type_names(source), ["A", "C", "E"]);
}

#[test]
fn words_without_a_field_are_found() {
    assert_eq!(words("TapeError"), ["tape", "error"]);
    assert_eq!(words("wall_2_x"), ["wall", "2", "x"]);
    assert!(is_forbidden("Podium", false) && is_forbidden("lives", true) && is_forbidden("DeskManager", false));
    assert!(is_forbidden("stage", true) && !is_forbidden("Stage", false) && !is_forbidden("stage_times", true));
    assert!(is_forbidden("cast", true) && !is_forbidden("ray_cast", true) && !is_forbidden("broadcast", true));
}
