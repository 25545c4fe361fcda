//! Imports point upstream only: a crate imports earlier crates, a module earlier modules, a file no file that
//! imports it back.

use std::collections::{BTreeMap, BTreeSet};

use toile_workspace::exceptions;
use toile_workspace::imports::{self, Arrow, CrateFiles, Module};
use toile_workspace::scan::{self, NamedPath};
use toile_workspace::tree::{self, CRATES};

/// Place in the order of the crates of the crate that a path names.
fn rank_of(path: &NamedPath) -> Option<usize> {
    let first = path.segments.first()?.replace('_', "-");
    CRATES.iter().position(|(_, name)| *name == first)
}

/// The arrows between modules that do not lead to an earlier group of the crate's root.
fn against_the_flow<'a>(arrows: &'a BTreeSet<Arrow>, groups: &[Vec<String>]) -> Vec<&'a Arrow> {
    let group = |module: &String| groups.iter().position(|group| group.contains(module));
    let mut wrong = Vec::new();
    for arrow in arrows {
        // The root names every module, and what it defines has no group.
        let (Some(from), Some(to)) = (arrow.from.first(), arrow.to.first()) else { continue };
        if from != to && group(to) >= group(from) {
            wrong.push(arrow);
        }
    }
    wrong
}

/// Whether an arrow leads to a parent of the file: to the module that holds the file's own, or one further up.
fn leads_to_a_parent(arrow: &Arrow) -> bool {
    arrow.from.len() > arrow.to.len() && arrow.from.starts_with(&arrow.to)
}

fn pairs<'a>(arrows: impl Iterator<Item = &'a Arrow>) -> Vec<(Module, Module)> {
    arrows.map(|a| (a.from.clone(), a.to.clone())).collect()
}

/// The circles of files, arrows to a file's own parents left out.
fn file_circles(arrows: &BTreeSet<Arrow>) -> Vec<BTreeSet<Module>> {
    imports::circles(&pairs(arrows.iter().filter(|a| !leads_to_a_parent(a))))
}

/// The parents that define what a file below them uses, while they use that file, straight or by way of others: each
/// with the arrows from below.
fn parents_in_circles(arrows: &BTreeSet<Arrow>) -> BTreeMap<Module, Vec<&Arrow>> {
    let circles = imports::circles(&pairs(arrows.iter()));
    let together = |a: &Arrow| circles.iter().any(|circle| circle.contains(&a.from) && circle.contains(&a.to));
    let mut found = BTreeMap::<Module, Vec<&Arrow>>::new();
    for arrow in arrows.iter().filter(|a| leads_to_a_parent(a) && together(a)) {
        found.entry(arrow.to.clone()).or_default().push(arrow);
    }
    found
}

#[test]
fn crates_import_only_earlier_crates() {
    let mut wrong = Vec::new();
    for (rank, (folder, name)) in CRATES.iter().enumerate() {
        for file in tree::crate_files(folder) {
            for path in scan::paths(&scan::tokens(&tree::read(&file))) {
                if rank_of(&path).is_some_and(|to| to > rank) {
                    wrong.push(format!("{}:{} {name} imports {}", tree::name(&file), path.line, path.segments[0]));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "imports that point up:\n{}", wrong.join("\n"));
}

/// The benchmarks' crate: evidence for developers, nothing that another crate needs.
const BENCHMARKS: &str = "toile-perf";

#[test]
fn only_perf_and_tests_import_the_benchmarks() {
    for (folder, name) in CRATES.iter().filter(|(_, name)| ![BENCHMARKS, "toile-workspace"].contains(name)) {
        let table: toml::Table = tree::read(&tree::root().join(folder).join("Cargo.toml")).parse().unwrap();
        assert!(!dependencies(&table).iter().any(|d| d == BENCHMARKS), "{name} depends on the benchmarks");
    }
}

/// The project's crates that a manifest depends on in any way, for all targets.
fn dependencies(manifest: &toml::Table) -> Vec<String> {
    let mut found = Vec::new();
    for (key, value) in manifest {
        let Some(table) = value.as_table() else { continue };
        if key.ends_with("dependencies") {
            found.extend(table.keys().filter(|k| k.starts_with("toile")).cloned());
        } else if key == "target" {
            found.extend(table.values().filter_map(toml::Value::as_table).flat_map(dependencies));
        }
    }
    found
}

/// The dependencies of a manifest that are not before it.
fn upward(manifest: &str, rank: usize) -> Vec<String> {
    let table: toml::Table = manifest.parse().expect("a manifest is TOML");
    let below: BTreeSet<&str> = CRATES[..rank].iter().map(|(_, name)| *name).collect();
    dependencies(&table).into_iter().filter(|d| !below.contains(d.as_str())).collect()
}

#[test]
fn manifests_depend_only_on_earlier_crates() {
    for (rank, (folder, name)) in CRATES.iter().enumerate() {
        let wrong = upward(&tree::read(&tree::root().join(folder).join("Cargo.toml")), rank);
        assert!(wrong.is_empty(), "{name} depends on {wrong:?}, which is not below it");
    }
}

#[test]
fn every_crate_has_its_place_in_the_order() {
    let table: toml::Table = tree::read(&tree::root().join("Cargo.toml")).parse().expect("a manifest is TOML");
    let members: BTreeSet<&str> =
        table["workspace"]["members"].as_array().unwrap().iter().map(|m| m.as_str().unwrap()).collect();
    assert_eq!(members, CRATES.iter().map(|(folder, _)| *folder).collect());
}

#[test]
fn modules_import_only_upstream() {
    let mut found = BTreeSet::new();
    for (folder, name) in CRATES {
        let Ok(root) = std::fs::read_to_string(tree::root().join(folder).join("src/lib.rs")) else { continue };
        let arrows = CrateFiles::read(folder).arrows();
        for arrow in against_the_flow(&arrows, &imports::groups(&root)) {
            println!("{} -> {}::{}", arrow.place, arrow.to.join("::"), arrow.item);
            found.insert(format!("{name} {} -> {}", arrow.from[0], arrow.to[0]));
        }
    }
    exceptions::hold("modules_against_the_flow", &found);
}

#[test]
fn files_import_in_no_circle() {
    let mut found = BTreeSet::new();
    for (folder, _) in CRATES {
        let files = CrateFiles::read(folder);
        let circles = file_circles(&files.arrows());
        found.extend(circles.iter().map(|c| c.iter().map(|m| files.place(m)).collect::<Vec<_>>().join(", ")));
    }
    exceptions::hold("circles_of_files", &found);
}

#[test]
fn parents_define_nothing_for_files_they_use() {
    let mut found = BTreeSet::new();
    for (folder, _) in CRATES {
        let files = CrateFiles::read(folder);
        for (parent, from) in parents_in_circles(&files.arrows()) {
            let items: BTreeSet<&str> = from.iter().map(|a| a.item.as_str()).collect();
            println!("{} defines for files that it uses: {items:?}", files.place(&parent));
            found.insert(files.place(&parent).to_owned());
        }
    }
    exceptions::hold("circles_by_way_of_a_parent", &found);
}

/// The rules against made-up sources: a forbidden arrow is found however it is written.
mod the_rule_itself {
    use super::*;

    const ROOT: &str = "pub mod lanes;\n\npub mod body;\n\npub mod skin;\n\n#[cfg(x)]\npub(crate) mod cloth;\n\n\
                        pub use cloth::state::{Cloth, Step};";

    fn made_up(sources: &[(&str, &str)]) -> BTreeSet<Arrow> {
        let module = |name: &str| name.split("::").filter(|part| !part.is_empty()).map(str::to_owned).collect();
        let files = sources.iter().map(|(name, text)| (module(name), format!("{name}.rs"), (*text).to_owned()));
        CrateFiles::new(&files.collect::<Vec<_>>()).arrows()
    }

    fn wrong(module: &str, source: &str) -> usize {
        let mut sources = vec![
            ("", ROOT),
            ("lanes", "pub struct F32x8; pub fn add() {}"),
            ("body", "pub struct Pose;"),
            ("skin", ""),
            ("skin::palette", ""),
            ("cloth", "mod contact; pub mod state; pub fn step() {}"),
            ("cloth::contact", ""),
            ("cloth::state", "pub struct Cloth; pub struct Step;"),
        ];
        let place = sources.iter().position(|(name, _)| *name == module).unwrap();
        let source = [sources[place].1, source].concat();
        sources[place].1 = &source;
        against_the_flow(&made_up(&sources), &imports::groups(ROOT)).len()
    }

    #[test]
    fn arrows_against_the_flow_are_found() {
        let forbidden = [
            ("body", "use crate::cloth::state::Cloth;"),
            ("skin", "use crate::{lanes::F32x8, cloth}; fn f() { cloth::step() }"),
            ("skin", "use super::cloth::state::Step;"),
            ("skin::palette", "use super::super::cloth; fn f(c: cloth::state::Cloth) {}"),
            ("body", "fn f(c: &crate::cloth::state::Cloth) {}"),
            ("body", "use crate::Cloth;"),
            ("skin::palette", "use crate::{lanes, Step as Moment};"),
        ];
        for (module, source) in forbidden {
            assert_eq!(wrong(module, source), 1, "{source}");
        }
    }

    #[test]
    fn arrows_with_the_flow_and_inside_a_module_pass() {
        let allowed = [
            ("skin", "use crate::body::Pose;"),
            ("cloth", "use crate::lanes; fn f() { lanes::add() }"),
            ("cloth::contact", "use super::state::Cloth;"),
            ("cloth::contact", "use crate::Cloth;"),
            ("body", "// use crate::cloth::state::Cloth;"),
            ("body", "#[cfg(test)] mod tests { use crate::cloth::state::Cloth; }"),
            ("", "use crate::cloth::state::Cloth;"),
        ];
        for (module, source) in allowed {
            assert_eq!(wrong(module, source), 0, "{source}");
        }
    }

    #[test]
    fn modules_of_one_group_stay_apart() {
        let arrows = made_up(&[("", ""), ("a", "use crate::b::B;"), ("b", "pub struct B;")]);
        assert_eq!(against_the_flow(&arrows, &imports::groups("mod a;\nmod b;")).len(), 1);
        assert_eq!(against_the_flow(&arrows, &imports::groups("mod b;\n\nmod a;")).len(), 0);
        assert_eq!(against_the_flow(&arrows, &imports::groups("mod a;\n\nmod b;")).len(), 1);
    }

    #[test]
    fn circles_are_found_through_parents_and_aliases() {
        let circle = [
            ("", "pub mod part;"),
            ("part", "mod a; mod b; mod c; pub use a::A; pub use b::B;"),
            ("part::a", "use super::b; pub struct A(b::B);"),
            ("part::b", "use crate::part::A; pub struct B; fn f(c: super::c::C) {}"),
            ("part::c", "pub struct C;"),
        ];
        let found = file_circles(&made_up(&circle));
        assert_eq!(found.len(), 1);
        let names: Vec<&String> = found[0].iter().filter_map(|m| m.last()).collect();
        assert_eq!(names, ["a", "b"]);
        assert!(parents_in_circles(&made_up(&circle)).is_empty());
    }

    #[test]
    fn a_parent_may_not_define_for_what_it_calls() {
        let child = ("part::a", "use super::Kind; pub fn open(kind: Kind) {}");
        let shows = [
            ("part", "mod a; mod kind; pub use a::open; pub use kind::Kind;"),
            child,
            ("part::kind", "pub enum Kind {}"),
        ];
        let calls = [("part", "mod a; mod kind; pub use kind::Kind; pub fn all() { a::open() }"), child, shows[2]];
        let defines = [("part", "mod a; pub enum Kind {}"), child];
        for fine in [&shows[..], &calls, &defines] {
            let arrows = made_up(fine);
            assert!(parents_in_circles(&arrows).is_empty() && file_circles(&arrows).is_empty(), "{}", fine[0].1);
        }
        let both = [("part", "mod a; pub enum Kind {} pub fn all(kind: Kind) { a::open(kind) }"), child];
        let again = [("part", "mod a; pub use a::open; pub enum Kind {} pub fn all(kind: Kind) { open(kind) }"), child];
        for wrong in [&both[..], &again] {
            let arrows = made_up(wrong);
            assert_eq!(parents_in_circles(&arrows).len(), 1, "{}", wrong[0].1);
        }
    }

    #[test]
    fn files_of_tests_make_no_circle() {
        let arrows = made_up(&[
            ("", "mod a; mod b; #[cfg(test)] mod made;"),
            ("a", "pub struct A; #[cfg(test)] mod tests;"),
            ("a::tests", "use crate::b::B;"),
            ("b", "use crate::a::A; pub struct B;"),
            ("made", "use crate::b::B;"),
        ]);
        assert_eq!(arrows.len(), 1);
    }

    #[test]
    fn upward_crates_are_found() {
        let path = &scan::paths(&scan::tokens("use toile_view::Image;"))[0];
        assert_eq!(rank_of(path), CRATES.iter().position(|(_, name)| *name == "toile-view"));
        let manifest =
            "[dependencies]\ntoile-assets.workspace = true\n[dev-dependencies]\ntoile-engine.workspace = true";
        let sculpt = CRATES.iter().position(|(_, name)| *name == "toile-sculpt").expect("a crate");
        assert_eq!(upward(manifest, sculpt), ["toile-engine"]);
        let target = "[target.'cfg(unix)'.dependencies]\ntoile-view = { path = \"x\" }";
        assert_eq!(upward(target, 2), ["toile-view"]);
    }
}
