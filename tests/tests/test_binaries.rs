//! Each crate links its integration tests once: `tests/main.rs` declares every file as a module. Another binary needs a reason.

use std::path::Path;

use toile_workspace::tree::{self, CRATES};

/// Names of the test binaries of a manifest, and whether a comment above each says why it is one.
fn binaries(manifest: &str) -> Vec<(String, bool)> {
    let lines: Vec<&str> = manifest.lines().map(str::trim).collect();
    let blocks = lines.iter().enumerate().filter(|(_, line)| **line == "[[test]]");
    let name = |at: usize| lines[at..].iter().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'));
    let reason = |at: usize| at > 0 && lines[at - 1].starts_with("# ");
    blocks.filter_map(|(at, _)| Some((name(at)?.to_owned(), reason(at)))).collect()
}

/// The faults of a crate's tests: `files` are the names of the files and folders in its folder `tests`, and `roots` the text of
/// the files that its test binaries begin with.
fn faults(manifest: &str, files: &[String], roots: &str) -> Vec<String> {
    let table: toml::Table = manifest.parse().expect("a manifest is TOML");
    let mut found = Vec::new();
    if table["package"].get("autotests").and_then(toml::Value::as_bool) != Some(false) {
        found.push("each file of tests/ is linked on its own; write `autotests = false` below [package]".to_owned());
    }
    let binaries = binaries(manifest);
    for (name, _) in binaries.iter().filter(|(name, reason)| name != "main" && !reason) {
        found.push(format!("the test binary {name} is linked beside `main`; a comment above [[test]] says why"));
    }
    let declared = |file: &String| roots.lines().any(|line| line.trim() == format!("mod {file};"));
    for file in files.iter().filter(|file| !declared(file) && !binaries.iter().any(|(name, _)| name == *file)) {
        found.push(format!("tests/{file} is in no test binary; write `mod {file};` into tests/main.rs"));
    }
    found
}

/// Names of the Rust files in a folder, and of the folders with a `mod.rs` or a `main.rs`; none where there is no such folder.
fn files(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.map(|entry| entry.expect("an entry can be read").path());
    let holds_tests = |path: &Path| path.join("mod.rs").exists() || path.join("main.rs").exists();
    let tests = paths.filter(|path| path.extension().is_some_and(|e| e == "rs") || holds_tests(path));
    tests.map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned()).collect()
}

#[test]
fn each_crate_links_its_tests_once() {
    let mut found = Vec::new();
    for (folder, name) in CRATES {
        let folder = tree::root().join(folder);
        let tests = folder.join("tests");
        let (manifest, files) = (tree::read(&folder.join("Cargo.toml")), files(&tests));
        if files.is_empty() {
            continue;
        }
        let roots = binaries(&manifest).into_iter().map(|(of, _)| tree::read(&tests.join(of).with_extension("rs")));
        let roots: String = roots.collect::<Vec<_>>().join("\n");
        found.extend(faults(&manifest, &files, &roots).into_iter().map(|fault| format!("{name}: {fault}")));
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn tests_linked_twice_or_never_are_found() {
    let name = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    let plain = "[package]\nautotests = false\n[[test]]\nname = \"main\"\n";
    assert!(faults(plain, &name(&["main", "a"]), "//! Words.\nmod a;").is_empty());
    assert_eq!(faults(plain, &name(&["main", "a", "b"]), "mod a;").len(), 1, "b is in no binary");
    assert_eq!(faults("[package]", &name(&["main"]), "").len(), 2, "autotests, and `main` is no binary");
    let own = |why: &str| format!("{plain}\n{why}[[test]]\nname = \"own\"\n");
    assert!(faults(&own("# It has an allocator of its own.\n"), &name(&["main", "own"]), "").is_empty());
    assert_eq!(faults(&own(""), &name(&["main", "own"]), "").len(), 1, "no reason is given");
}

/// Whether the documentation in a source has a block of code that is run or compiled as a test.
fn has_doc_test(source: &str) -> bool {
    let mut open = false;
    let documentation = source.lines().map(str::trim).filter_map(|l| l.strip_prefix("//!").or(l.strip_prefix("///")));
    for language in documentation.filter_map(|line| line.trim().strip_prefix("```")) {
        let words = ["text", "json", "toml", "sh", "ignore"];
        if !open && !words.contains(&language) {
            return true;
        }
        open = !open;
    }
    false
}

/// Whether a source has a test that is linked with it.
fn has_unit_test(source: &str) -> bool {
    source.lines().any(|line| line.trim() == "#[test]")
}

#[test]
fn tests_that_are_there_are_not_switched_off() {
    for (folder, name) in CRATES {
        let folder = tree::root().join(folder);
        let manifest: toml::Table = tree::read(&folder.join("Cargo.toml")).parse().expect("a manifest is TOML");
        let off = |key: &str| manifest.get("lib").and_then(|lib| lib.get(key)?.as_bool()) == Some(false);
        for file in tree::rust_files(&folder.join("src")) {
            let (place, source) = (tree::name(&file), tree::read(&file));
            assert!(!(off("doctest") && has_doc_test(&source)), "{place}: {name} says `doctest = false`");
            assert!(!(off("test") && has_unit_test(&source)), "{place}: {name} says `test = false`");
        }
    }
}

#[test]
fn doc_tests_are_told_from_plain_text() {
    assert!(has_doc_test("//! A.\n//! ```\n//! let a = 1;\n//! ```"));
    assert!(has_doc_test("/// ```text\n/// a\n/// ```\n/// ```no_run\n/// f();\n/// ```"));
    assert!(!has_doc_test("/// ```text\n/// a\n/// ```\nlet a = \"```\";"));
}
