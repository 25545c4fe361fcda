//! Documents that are true: the paths that they name exist.

use std::collections::BTreeSet;
use std::path::Path;

use toile_workspace::exceptions;
use toile_workspace::tree;

/// Folders of the project; a path in a document that begins with one of them leads to something.
const FOLDERS: [&str; 6] = ["assets/", "sensors/", "engine/", "perf/", "tests/", "docs/"];

/// The paths of the project between backticks, whole or as the beginning of a command's argument.
fn named_paths(text: &str) -> Vec<&str> {
    let quoted = text.split('`').skip(1).step_by(2);
    let of_the_project =
        |word: &&str| FOLDERS.iter().any(|folder| word.starts_with(folder) && word.len() > folder.len());
    // What stands for several (`docs/*.md`) or names a part (`skin.rs:12`) is cut there.
    quoted
        .filter(|quote| !quote.contains('\n'))
        .flat_map(str::split_whitespace)
        .filter(of_the_project)
        .map(|word| word.split(['*', ':', '{', '<', '?']).next().unwrap_or(word).trim_end_matches(['/', ',', ')', ';']))
        .collect()
}

/// The files that links of a document lead to, without their anchors; addresses are left alone.
fn links(text: &str) -> Vec<&str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next());
    let local = targets.filter(|t| !t.contains("://") && !t.starts_with('#'));
    local.filter_map(|t| t.split('#').next()).collect()
}

fn documents() -> Vec<std::path::PathBuf> {
    let markdown = |path: &Path| path.extension().is_some_and(|e| e == "md");
    let mut found = tree::files(&tree::root().join("docs"), markdown);
    found.extend(["README.md", "CONTRIBUTING.md"].map(|name| tree::root().join(name)));
    found
}

#[test]
fn paths_in_documents_lead_to_something() {
    let mut found = BTreeSet::new();
    for file in documents() {
        let text = tree::read(&file);
        let name = tree::name(&file);
        let gone = named_paths(&text).into_iter().filter(|path| !tree::root().join(path).exists());
        found.extend(gone.map(|path| format!("{name} {path}")));
        let folder = file.parent().expect("a file lies in a folder");
        let gone = links(&text).into_iter().filter(|target| !folder.join(target).exists());
        found.extend(gone.map(|target| format!("{name} {target}")));
    }
    exceptions::hold("paths_in_documents", &found);
}

#[test]
fn paths_and_links_are_found() {
    let text = "see `engine/core/src/cloth` and `toile run assets/x.toml --json`, `sensors/src/a.rs:12`, `docs/*.md`; \
                not `out/x`, engine/core or `engine/`. [a](loop.md#x) [b](https://x.org/y) ![c](pictures/c.svg)";
    assert_eq!(named_paths(text), ["engine/core/src/cloth", "assets/x.toml", "sensors/src/a.rs", "docs"]);
    assert_eq!(links(text), ["loop.md", "pictures/c.svg"]);
}
