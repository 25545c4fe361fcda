//! Structure that a compiler does not check: sizes of files and functions, unsafe code, lints, paths of one machine.

use std::path::{Path, PathBuf};

use toile_workspace::exceptions;
use toile_workspace::items::{self, Item, ItemKind};
use toile_workspace::scan;
use toile_workspace::tree::{self, CRATES};

/// Files that may hold unsafe code, each with its reason.
const UNSAFE_FILES: [(&str, &str); 48] = [
    ("engine/cli/src/heap.rs", "the program's allocator counts, for which it has to implement an unsafe trait"),
    ("engine/c/src/border.rs", "what C hands over is read and written"),
    ("engine/c/src/failure.rs", "a function that C calls by its name"),
    ("engine/c/src/version.rs", "the same"),
    ("engine/c/src/body.rs", "the same"),
    ("engine/c/src/garment.rs", "the same"),
    ("engine/c/src/fit.rs", "the same"),
    ("engine/c/src/recording.rs", "the same"),
    ("engine/c/src/try_on.rs", "the same"),
    ("engine/c/src/scene/make.rs", "the same"),
    ("engine/c/src/scene/step.rs", "the same"),
    ("engine/c/src/scene/read.rs", "the same"),
    ("engine/c/src/scene/picture.rs", "the same"),
    ("engine/c/src/scene/snapshot.rs", "the same"),
    ("engine/python/src/views.rs", "numpy shows memory that a Python object keeps"),
    ("engine/core/src/workers/per_share.rs", "the data of a share is lent to its worker"),
    ("engine/core/src/workers/mod.rs", "a job that borrows the caller's stack is handed to another thread"),
    ("engine/core/src/cloth/step/work.rs", "the workers of a step share its columns"),
    ("engine/core/src/cloth/step/mod.rs", "the stages of a step are done in their order"),
    ("engine/core/src/cloth/contact/garments/work.rs", "the workers of a step share the contacts"),
    ("engine/core/src/cloth/contact/garments/step.rs", "the phases of a step are done in their order"),
    ("engine/core/src/lanes/column.rs", "columns are raw pointers, so that copies may write through them"),
    ("engine/core/src/lanes/neon.rs", "vector instructions of aarch64"),
    ("engine/core/src/lanes/simd128.rs", "vector instructions of WebAssembly read and write by address"),
    ("engine/core/src/lanes/vector.rs", "what is alike for the vectors of every processor"),
    ("engine/core/src/lanes/x86.rs", "vector instructions that are picked at run time"),
    ("engine/core/src/lanes/x86/widths.rs", "the same"),
    ("engine/core/src/lanes/records.rs", "records are read where their list was checked once"),
    ("engine/core/src/lanes/x86/records.rs", "vector instructions that are picked at run time"),
    ("engine/core/src/skin/mod.rs", "the workers share the posed surface"),
    ("engine/core/src/sync.rs", "a value that threads keep apart by other means"),
    ("tests/models/src/ring.rs", "the protocol of the queue in a model"),
    ("tests/models/src/sync.rs", "the same value as the models have it"),
    ("tests/models/src/triple.rs", "the protocol of the triple buffer in a model"),
    ("tests/platforms/src/exports.rs", "functions that a host of WebAssembly calls by their names"),
    ("tests/models/tests/workers.rs", "plain memory that a model watches"),
    ("sensors/src/source/openni_library.rs", "OpenNI's C library is called"),
    ("sensors/src/source/live/library.rs", "libraries of cameras are loaded at run time"),
    ("sensors/src/source/live/kinect.rs", "libfreenect's C interface is called"),
    ("sensors/src/source/live/k4a.rs", "libk4a's C interface is called"),
    ("sensors/src/source/live/realsense.rs", "librealsense's C interface is called"),
    ("sensors/src/source/live/orbbec.rs", "OrbbecSDK's C interface is called"),
    ("sensors/src/source/live/v4l2.rs", "the kernel's calls for webcams, and the memory that it shares"),
    ("engine/core/tests/memory.rs", "a counting allocator has to implement an unsafe trait"),
    ("engine/view/tests/own_picture_allocations.rs", "a counting allocator has to implement an unsafe trait"),
    ("sensors/tests/cameras/azure_lens.rs", "libk4a shows where points of a calibration are seen"),
    ("sensors/tests/cameras/realsense_recorder.rs", "librealsense's recorder writes what the test plays"),
    ("tests/tests/allocations.rs", "a counting allocator has to implement an unsafe trait"),
];

/// Most lines of a file; beyond it, it is two modules.
const MAX_LINES: usize = 500;

fn all_rust_files() -> Vec<PathBuf> {
    CRATES.iter().flat_map(|(folder, _)| tree::crate_files(folder)).collect()
}

fn has_unsafe(source: &str) -> bool {
    scan::tokens(source).iter().any(|t| t.text == "unsafe")
}

#[test]
fn unsafe_code_stands_only_in_named_files() {
    for file in all_rust_files() {
        let name = tree::name(&file);
        let named = UNSAFE_FILES.iter().any(|(allowed, _)| *allowed == name);
        assert!(named || !has_unsafe(&tree::read(&file)), "{name} holds unsafe code but is not a named file");
    }
}

#[test]
fn unsafe_is_found_in_code_and_not_in_words() {
    assert!(has_unsafe("fn f() { unsafe { g() } }"));
    assert!(!has_unsafe("// unsafe\nconst S: &str = \"unsafe\"; #![deny(unsafe_code)]"));
}

#[test]
fn no_file_is_too_long() {
    for file in all_rust_files() {
        let lines = tree::read(&file).lines().count();
        assert!(lines <= MAX_LINES, "{} has {lines} lines, more than {MAX_LINES}: split it", tree::name(&file));
    }
}

/// Most lines of a function, from `fn` to its closing brace: a kernel's or a scheduler's.
const MAX_FUNCTION_LINES: usize = 120;

/// The functions of a source that are too long.
fn long_functions(source: &str) -> Vec<Item> {
    let long = |item: &Item| item.kind == ItemKind::Function && item.lines() > MAX_FUNCTION_LINES;
    items::items(&scan::tokens(source)).into_iter().filter(long).collect()
}

#[test]
fn no_function_is_too_long() {
    let files = all_rust_files();
    let long = files.iter().flat_map(|file| {
        long_functions(&tree::read(file)).into_iter().map(move |item| format!("{} {}", tree::name(file), item.name))
    });
    exceptions::hold("long_functions", &long.collect());
}

#[test]
fn a_long_function_is_found() {
    let body = |lines: usize| format!("impl A {{\n    fn f() {{\n{}    }}\n}}", "        g(); // }\n".repeat(lines));
    assert!(long_functions(&body(MAX_FUNCTION_LINES - 2)).is_empty());
    assert_eq!(long_functions(&body(MAX_FUNCTION_LINES - 1))[0].name, "f");
}

/// Whether a manifest takes over the lints of the workspace, of which one asks for a word on every public item.
fn takes_the_lints(manifest: &str) -> bool {
    let table: toml::Table = manifest.parse().expect("a manifest is TOML");
    table.get("lints").and_then(|lints| lints.get("workspace")?.as_bool()) == Some(true)
}

#[test]
fn nothing_public_is_excused_from_saying_what_it_is() {
    let workspace: toml::Table = tree::read(&tree::root().join("Cargo.toml")).parse().expect("a manifest is TOML");
    assert_eq!(workspace["workspace"]["lints"]["rust"]["missing_docs"].as_str(), Some("warn"));
    for (folder, name) in CRATES {
        assert!(
            takes_the_lints(&tree::read(&tree::root().join(folder).join("Cargo.toml"))),
            "{name} has lints of its own"
        );
    }
    for file in all_rust_files() {
        let excused = scan::tokens(&tree::read(&file)).iter().any(|t| t.text == "missing_docs");
        assert!(!excused, "{} excuses an item from `missing_docs`", tree::name(&file));
    }
}

#[test]
fn lints_of_a_crates_own_are_found() {
    assert!(takes_the_lints("[lints]\nworkspace = true"));
    assert!(!takes_the_lints("[lints.rust]\nmissing_docs = \"allow\"") && !takes_the_lints("[package]\nname = \"x\""));
}

/// The first line of a text that names a path of one person's machine.
fn machine_path(text: &str) -> Option<&str> {
    // Put together here, so that this file does not name them itself.
    let homes = ["home", "root", "work", "Users"].map(|folder| format!("/{folder}/"));
    // A path inside the project, or an address, continues something; an absolute path begins.
    let begins = |line: &str, at: usize| {
        let before = line[..at].chars().next_back();
        before.is_none_or(|c| !(c.is_alphanumeric() || "._-~}/*".contains(c)))
    };
    text.lines().find(|line| homes.iter().any(|home| line.match_indices(home.as_str()).any(|(at, _)| begins(line, at))))
}

#[test]
fn no_file_names_a_path_of_one_machine() {
    let is_text = |path: &Path| {
        let endings = ["rs", "toml", "md", "sh", "wgsl", "json", "txt", "yml"];
        path.extension().is_none_or(|e| endings.iter().any(|x| *x == e))
    };
    for file in tree::files(&tree::root(), is_text) {
        // Without an ending a file may be binary; those are not read as text.
        let Ok(content) = std::fs::read_to_string(&file) else { continue };
        if let Some(line) = machine_path(&content) {
            panic!("{} names a path of one machine: {line}", tree::name(&file));
        }
    }
}

#[test]
fn a_path_of_one_machine_is_found() {
    for folder in ["home", "root", "Users"] {
        assert!(machine_path(&format!("see `/{folder}/someone/x`")).is_some());
        assert!(machine_path(&format!("/{folder}/x")).is_some());
    }
    assert!(machine_path(&format!("src/{}/x and https://example.org/{}/y", "home", "work")).is_none());
}
