//! The examples run and hold, and the integrator's guide names each of them and shows what they print.
//!
//! `cargo test` builds the examples of a package with its tests; with `--test main` alone, add `--examples`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// How many examples the guide promises.
const PROMISED: usize = 8;

/// Names of the examples in the folder.
fn in_the_folder() -> BTreeSet<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let sources = files.filter(|path| path.extension().is_some_and(|e| e == "rs"));
    sources.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect()
}

fn guide() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/integrator.md");
    fs::read_to_string(path).unwrap()
}

/// Names of the examples that the guide links to.
fn in_the_guide(guide: &str) -> BTreeSet<String> {
    let links = guide.split("(../engine/core/examples/").skip(1);
    links.filter_map(|rest| Some(rest.split_once(".rs)")?.0.to_owned())).collect()
}

/// The outputs that the guide shows: the example, and what it prints.
fn shown(guide: &str) -> Vec<(String, String)> {
    let blocks = guide.split("```text\n$ cargo run --release -p toile-engine --example ").skip(1);
    let block = |text: &str| {
        let (name, rest) = text.split_once('\n')?;
        Some((name.to_owned(), rest.split_once("```")?.0.to_owned()))
    };
    blocks.filter_map(block).collect()
}

/// Where this build has put an example.
fn built(name: &str) -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let folder = test.ancestors().nth(2).unwrap().join("examples");
    let path = folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    assert!(path.exists(), "{name} is not built; run `cargo test -p toile-engine`, or add `--examples`");
    path
}

fn run(name: &str) -> Output {
    Command::new(built(name)).output().unwrap()
}

#[test]
fn every_example_holds_and_the_guide_shows_what_it_prints() {
    let guide = guide();
    let shown = shown(&guide);
    assert!(!shown.is_empty(), "the guide shows no output");
    for name in in_the_folder() {
        let output = run(&name);
        let (message, printed) = (String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
        assert!(output.status.success(), "{name} ended with {:?}: {message}\n{printed}", output.status.code());
        assert!((2..=20).contains(&printed.lines().count()), "{name} prints some plain lines: {printed}");
        for (_, text) in shown.iter().filter(|(of, _)| *of == name) {
            assert_eq!(*text, printed, "docs/integrator.md shows something else for {name}");
        }
    }
}

#[test]
fn the_guide_names_the_examples_that_there_are() {
    let (guide, folder) = (in_the_guide(&guide()), in_the_folder());
    assert_eq!(guide, folder);
    assert_eq!(folder.len(), PROMISED);
}

#[test]
fn an_example_that_does_not_hold_ends_with_an_error() {
    let nothing = Command::new(built("recorded_session")).arg("no-such-file.mcap").output().unwrap();
    assert!(!nothing.status.success() && String::from_utf8_lossy(&nothing.stderr).contains("no-such-file.mcap"));
}

#[test]
fn links_and_outputs_of_a_guide_are_found() {
    let made_up = "[a](../engine/core/examples/one.rs) ![b](x.rs)\n```text\n$ cargo run --release -p toile-engine \
                   --example one\nsays\n```\n";
    assert_eq!(in_the_guide(made_up), BTreeSet::from(["one".to_owned()]));
    assert_eq!(shown(made_up), [("one".to_owned(), "says\n".to_owned())]);
}
