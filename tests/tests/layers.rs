//! Imports point upstream only: a crate imports the floors below it, a room the rooms before it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use toile_tests::scan::{self, NamedPath};
use toile_tests::tree::{self, FLOORS};

/// Rooms in the order in which data flows; a room imports only rooms of earlier rows, and those of no row are held
/// to the general law alone: no circle.
const ROOMS: [(&str, &[&[&str]]); 5] = [
    (
        "toile-assets",
        &[
            &["limits", "cone", "numeric"],
            &["skeleton"],
            &["mesh"],
            &["fabric", "body"],
            &["sizes"],
            &["rig"],
            &["garment"],
            &["import", "bake"],
            &["export"],
            &["wardrobe"],
            &["scene"],
            &["scene_file"],
        ],
    ),
    ("toile-sculpt", &[&["form", "subdivide"], &["lattice", "wrap"], &["draw"], &["unwrap"]]),
    (
        "toile-sensors",
        &[
            &["error", "clock"],
            &["limits"],
            &["frame"],
            &["sample", "segment"],
            &["depth"],
            &["filter"],
            &["session"],
            &["source"],
        ],
    ),
    (
        "toile-engine",
        &[
            &["lanes", "triple_buffer", "sync", "clock", "meter", "cone"],
            &["workers"],
            &["body", "jump_filter"],
            &["skin"],
            &["colliders"],
            &["cloth"],
            &["frame"],
            &["frame_loop", "lines"],
        ],
    ),
    (
        "toile-perf",
        &[
            &["time"],
            &["surface"],
            &["yardstick"],
            &["oracle"],
            &["depth", "skinning", "skirt", "latency"],
            &["torture", "validate"],
            &["pareto", "plan", "soak"],
        ],
    ),
];

/// One arrow between rooms of a crate.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Arrow {
    from: String,
    to: String,
    place: String,
}

/// Which of the house's crates a path names, as a floor.
fn floor_of(path: &NamedPath) -> Option<usize> {
    let first = path.segments.first()?.replace('_', "-");
    FLOORS.iter().position(|(_, name)| *name == first)
}

/// The names that a crate's root re-exports, each with the room it comes from.
fn re_exports(root: &str, rooms: &BTreeSet<String>) -> BTreeMap<String, String> {
    let paths = scan::paths(&scan::without_tests(&scan::tokens(root)));
    let inside = paths.into_iter().map(|mut path| {
        path.segments.retain(|s| s != "crate" && s != "self");
        path.segments
    });
    inside.filter(|s| s.len() > 1 && rooms.contains(&s[0])).map(|s| (s[s.len() - 1].clone(), s[0].clone())).collect()
}

/// The room that a path of a file leads to, if it leads to another than the file's own.
fn room_of(path: &NamedPath, module: &[String], exports: &BTreeMap<String, String>) -> Option<String> {
    let segments: Vec<&str> = path.segments.iter().map(String::as_str).collect();
    let ups = segments.iter().take_while(|s| **s == "super").count();
    let full: Vec<&str> = match *segments.first()? {
        "crate" => segments[1..].to_vec(),
        "super" => {
            let stay = module.len().checked_sub(ups)?;
            module[..stay].iter().map(String::as_str).chain(segments[ups..].iter().copied()).collect()
        }
        _ => return None,
    };
    let room = full.first()?;
    let room = exports.get(*room).map_or(*room, String::as_str);
    (Some(room) != module.first().map(String::as_str)).then(|| room.to_owned())
}

/// All arrows of a file, from its room to others.
fn arrows(source: &str, module: &[String], place: &str, exports: &BTreeMap<String, String>) -> Vec<Arrow> {
    // The root is the door of the crate: it names every room.
    let Some(from) = module.first() else { return Vec::new() };
    let paths = scan::paths(&scan::without_tests(&scan::tokens(source)));
    let leads = paths.iter().filter_map(|p| Some((p.line, room_of(p, module, exports)?)));
    leads.map(|(line, to)| Arrow { from: from.clone(), to, place: format!("{place}:{line}") }).collect()
}

/// The arrows that point to the same or a later row.
fn against_the_flow<'a>(arrows: &'a [Arrow], rows: &[&[&str]]) -> Vec<&'a Arrow> {
    let row = |room: &str| rows.iter().position(|row| row.contains(&room));
    arrows.iter().filter(|a| row(&a.from).zip(row(&a.to)).is_some_and(|(from, to)| to >= from)).collect()
}

/// The arrows that lie on a circle.
fn on_a_circle(arrows: &[Arrow]) -> Vec<&Arrow> {
    let reaches = |start: &str, goal: &str| {
        let mut seen = BTreeSet::new();
        let mut open = vec![start];
        while let Some(room) = open.pop() {
            if seen.insert(room) {
                let next = arrows.iter().filter(|a| a.from == room).map(|a| a.to.as_str());
                open.extend(next.collect::<Vec<_>>());
            }
        }
        seen.contains(goal)
    };
    arrows.iter().filter(|a| reaches(&a.to, &a.from)).collect()
}

fn is_test_file(file: &Path) -> bool {
    file.file_stem().is_some_and(|stem| stem == "tests")
}

/// All arrows between the rooms of one crate.
fn crate_arrows(folder: &str) -> Vec<Arrow> {
    let src = tree::root().join(folder).join("src");
    let files = tree::rust_files(&src);
    let rooms: BTreeSet<String> = files.iter().filter_map(|f| tree::module_path(&src, f).into_iter().next()).collect();
    let door = files.iter().find(|f| f.ends_with("src/lib.rs"));
    let exports = door.map(|d| re_exports(&tree::read(d), &rooms)).unwrap_or_default();
    let real = files.iter().filter(|f| !is_test_file(f));
    let found = real.flat_map(|f| arrows(&tree::read(f), &tree::module_path(&src, f), &tree::name(f), &exports));
    // A name that is neither a room nor re-exported stands in the root itself.
    found.filter(|a| rooms.contains(&a.to)).collect()
}

#[test]
fn crates_import_only_the_floors_below() {
    let mut wrong = Vec::new();
    for (floor, (folder, name)) in FLOORS.iter().enumerate() {
        for file in tree::rust_files(&tree::root().join(folder)) {
            for path in scan::paths(&scan::tokens(&tree::read(&file))) {
                if floor_of(&path).is_some_and(|to| to > floor) {
                    wrong.push(format!("{}:{} {name} imports {}", tree::name(&file), path.line, path.segments[0]));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "imports that point up:\n{}", wrong.join("\n"));
}

/// The crates of the house that a manifest depends on in any way, for all targets.
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

/// The dependencies of a manifest that are not below its floor.
fn upward(manifest: &str, floor: usize) -> Vec<String> {
    let table: toml::Table = manifest.parse().expect("a manifest is TOML");
    let below: BTreeSet<&str> = FLOORS[..floor].iter().map(|(_, name)| *name).collect();
    dependencies(&table).into_iter().filter(|d| !below.contains(d.as_str())).collect()
}

#[test]
fn manifests_depend_only_on_the_floors_below() {
    for (floor, (folder, name)) in FLOORS.iter().enumerate() {
        let wrong = upward(&tree::read(&tree::root().join(folder).join("Cargo.toml")), floor);
        assert!(wrong.is_empty(), "{name} depends on {wrong:?}, which is not below it");
    }
}

#[test]
fn what_ships_does_not_depend_on_what_draws_it() {
    for (folder, name) in FLOORS {
        let table: toml::Table =
            tree::read(&tree::root().join(folder).join("Cargo.toml")).parse().expect("a manifest is TOML");
        let ships = table.get("dependencies").and_then(toml::Value::as_table);
        assert!(!ships.is_some_and(|d| d.contains_key("toile-sculpt")), "{name} needs the offline drawing to be built");
    }
}

#[test]
fn the_workspace_has_no_crate_without_a_floor() {
    let table: toml::Table = tree::read(&tree::root().join("Cargo.toml")).parse().expect("a manifest is TOML");
    let members: BTreeSet<&str> =
        table["workspace"]["members"].as_array().unwrap().iter().map(|m| m.as_str().unwrap()).collect();
    assert_eq!(members, FLOORS.iter().map(|(folder, _)| *folder).collect());
}

#[test]
fn rooms_import_only_upstream() {
    for (folder, name) in FLOORS {
        let Some((_, rows)) = ROOMS.iter().find(|(of, _)| *of == name) else { continue };
        let found = crate_arrows(folder);
        let wrong = against_the_flow(&found, rows);
        assert!(wrong.is_empty(), "{name}: arrows against the flow of data: {wrong:#?}");
    }
}

#[test]
fn rooms_import_in_no_circle() {
    for (folder, name) in FLOORS {
        let found = crate_arrows(folder);
        let wrong = on_a_circle(&found);
        assert!(wrong.is_empty(), "{name}: arrows on a circle: {wrong:#?}");
    }
}

/// The law against made-up sources: a forbidden arrow is found however it is written.
mod the_law_itself {
    use super::*;

    const ROWS: &[&[&str]] = &[&["lanes"], &["body"], &["skin"], &["cloth"]];

    fn wrong(source: &str, module: &[&str]) -> usize {
        let rooms = ["lanes", "body", "skin", "cloth"].map(str::to_owned).into();
        let exports = re_exports("pub mod cloth; pub use cloth::state::{Cloth, Step};", &rooms);
        let module: Vec<String> = module.iter().map(|m| (*m).to_owned()).collect();
        against_the_flow(&arrows(source, &module, "made_up.rs", &exports), ROWS).len()
    }

    #[test]
    fn arrows_against_the_flow_are_found() {
        let forbidden = [
            ("use crate::cloth::Cloth;", &["body"][..]),
            ("use crate::{lanes::F32x8, cloth};", &["skin"]),
            ("use super::cloth::Step;", &["skin"]),
            ("use super::super::cloth;", &["skin", "palette"]),
            ("fn f(c: &crate::cloth::Cloth) {}", &["body"]),
            ("use crate::Cloth;", &["body"]),
            ("use crate::{lanes, Step as Moment};", &["skin", "palette"]),
        ];
        for (source, module) in forbidden {
            assert_eq!(wrong(source, module), 1, "{source}");
        }
    }

    #[test]
    fn arrows_with_the_flow_and_inside_a_room_pass() {
        let allowed = [
            ("use crate::body::Pose;", &["skin"][..]),
            ("use crate::lanes;", &["cloth"]),
            ("use super::state::Cloth;", &["cloth", "contact"]),
            ("use crate::Cloth;", &["cloth", "contact"]),
            ("// use crate::cloth::Cloth;", &["body"]),
            ("#[cfg(test)] mod tests { use crate::cloth::Cloth; }", &["body"]),
            ("use crate::cloth::Cloth;", &[]),
        ];
        for (source, module) in allowed {
            assert_eq!(wrong(source, module), 0, "{source}");
        }
    }

    #[test]
    fn circles_are_found_and_trees_are_not() {
        let arrow = |from: &str, to: &str| Arrow { from: from.into(), to: to.into(), place: String::new() };
        let circle = [arrow("a", "b"), arrow("b", "c"), arrow("c", "a"), arrow("a", "d")];
        assert_eq!(on_a_circle(&circle), circle[..3].iter().collect::<Vec<_>>());
        assert!(on_a_circle(&[arrow("a", "b"), arrow("a", "c"), arrow("b", "c")]).is_empty());
    }

    #[test]
    fn upward_crates_are_found() {
        let path = &scan::paths(&scan::tokens("use toile_view::Image;"))[0];
        assert_eq!(floor_of(path), FLOORS.iter().position(|(_, name)| *name == "toile-view"));
        let manifest =
            "[dependencies]\ntoile-assets.workspace = true\n[dev-dependencies]\ntoile-engine.workspace = true";
        assert_eq!(upward(manifest, 1), ["toile-engine"]);
        let target = "[target.'cfg(unix)'.dependencies]\ntoile-view = { path = \"x\" }";
        assert_eq!(upward(target, 2), ["toile-view"]);
    }
}
