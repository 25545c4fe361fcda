//! The manual: one page for each command, without a warning by a strict reader of manual pages.
//!
//! `cargo test` builds the example that writes it; with `--test main` alone, add `--examples`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::common::Scratch;

/// Runs the example that writes the pages.
fn man(args: &[&Path]) -> Output {
    let test = std::env::current_exe().unwrap();
    let program = test.ancestors().nth(2).unwrap().join(format!("examples/man{}", std::env::consts::EXE_SUFFIX));
    assert!(program.exists(), "the example `man` is not built; run `cargo test -p toile`, or add `--examples`");
    Command::new(program).args(args).output().unwrap()
}

/// All pages: their names and what they say.
fn pages(folder: &Path) -> Vec<(String, String)> {
    let output = man(&[folder]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    files.iter().map(|path| (name(path), fs::read_to_string(path).unwrap())).collect()
}

/// Names of the pages that the grammar asks for.
fn wanted(command: &clap::Command, name: &str) -> BTreeSet<String> {
    let below = command.get_subcommands().flat_map(|sub| wanted(sub, &format!("{name}-{}", sub.get_name())));
    below.chain([format!("{name}.1")]).collect()
}

#[test]
fn every_command_has_its_page_and_every_page_its_sections() {
    let scratch = Scratch::new("man-pages");
    let pages = pages(&scratch.path().join("man"));
    let names: BTreeSet<String> = pages.iter().map(|(name, _)| name.clone()).collect();
    assert_eq!(names, wanted(&toile::cli::command(), "toile"));
    for (name, text) in &pages {
        let title = name.trim_end_matches(".1").to_uppercase();
        assert!(text.contains(&format!(".TH {title} 1 ")), "{name}: {text}");
        for section in ["NAME", "SYNOPSIS", "DESCRIPTION", "\"EXIT STATUS\"", "EXAMPLES", "\"SEE ALSO\""] {
            assert!(text.contains(&format!("\n.SH {section}\n")), "{name} has no section {section}");
        }
    }
    let version = String::from_utf8(scratch.toile(&["--version"]).stdout).unwrap();
    let root = &pages.iter().find(|(name, _)| name == "toile.1").unwrap().1;
    assert!(root.contains(&format!("\"Toile {}\"", version.trim().trim_start_matches("toile "))), "{version}");
    let replay = &pages.iter().find(|(name, _)| name == "toile-replay.1").unwrap().1;
    assert!(replay.contains("\\fB6\\fR"), "a replay that diverges ends with 6");
}

#[test]
fn what_a_page_refers_to_is_there() {
    let scratch = Scratch::new("man-links");
    let pages = pages(&scratch.path().join("man"));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut guides = 0;
    for (name, text) in &pages {
        for guide in text.split("/usr/share/doc/toile/").skip(1).filter_map(|rest| rest.split_once(".md")) {
            let guide = guide.0.replace("\\-", "-");
            assert!(root.join(format!("docs/{guide}.md")).is_file(), "{name} sends the reader to docs/{guide}.md");
            guides += 1;
        }
        for page in text.lines().filter_map(|line| Some(line.strip_prefix("\\fB")?.split_once("\\fR(1)")?.0)) {
            let page = format!("{}.1", page.replace("\\-", "-"));
            assert!(pages.iter().any(|(known, _)| *known == page), "{name} refers to {page}");
        }
    }
    assert!(guides >= 10, "{guides} references to guides");
}

#[test]
fn mandoc_has_nothing_to_say() {
    if Command::new("mandoc").arg("-h").output().is_err() {
        eprintln!("mandoc is not installed: the pages are not checked by it");
        return;
    }
    let scratch = Scratch::new("man-lint");
    let folder = scratch.path().join("man");
    for (name, _) in pages(&folder) {
        let lint =
            Command::new("mandoc").args(["-T", "lint", "-W", "warning"]).arg(folder.join(&name)).output().unwrap();
        let findings = String::from_utf8_lossy(&lint.stdout).into_owned();
        // The same sources give the same page on any day.
        let findings: Vec<&str> = findings.lines().filter(|line| !line.contains("missing date")).collect();
        assert!(findings.is_empty(), "{name}: {findings:#?}");
    }
}

#[test]
fn a_folder_is_asked_for_in_one_sentence() {
    let none = man(&[]);
    assert_eq!(none.status.code(), Some(2));
    assert_eq!(String::from_utf8_lossy(&none.stderr).lines().count(), 1);
    let bad = man(&[Path::new("/dev/null/man")]);
    assert_eq!(bad.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&bad.stderr).contains("/dev/null/man"));
}
