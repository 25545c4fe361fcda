//! Says in ten lines what `cargo test --workspace --release` has tested.
//!
//! Cargo runs this program last of all, before the examples of the documentation, and stops before it where a test program fails.
//! Only `--no-fail-fast` goes on, and names what failed at the end.

use std::fs;

use toile_workspace::tree;

/// Folders of crates, and what their tests hold.
const PARTS: [(&str, &str); 7] = [
    ("assets", "bodies, patterns, sewing, draping and sizes; files of others read right or refused"),
    ("sensors", "recordings and cameras, the shopper found in depth, filters; hostile files"),
    ("engine/core", "skinning, colliders and cloth against plain f64 references; the loop and its queues"),
    ("engine", "measures, pictures, try-ons, the kiosk, the SDK, C and Python, the command line"),
    ("perf", "oracles, validation and hard cases of the solver, soak and latency runs of seconds"),
    ("tests", "the same bits on any number of workers and lanes, no allocation in a step, recordings, structure"),
    ("", "all of it"),
];

/// Marks a test that needs minutes and that `.ci/long` runs.
const IGNORED: &str = "#[ignore";

fn main() {
    // A filter was given, or a list asked for: not all tests ran.
    if std::env::args().len() > 1 {
        return;
    }
    let sources = tree::files(&tree::root(), |path| path.extension().is_some_and(|e| e == "rs"));
    let mut counts = [[0usize; 2]; PARTS.len()];
    for source in sources {
        let text = fs::read_to_string(&source).unwrap_or_else(|e| panic!("{}: {e}", source.display()));
        let lines = |word: &str| text.lines().filter(|line| line.trim_start().starts_with(word)).count();
        let found = [lines("#[test]"), lines(IGNORED)];
        let place = source.strip_prefix(tree::root()).expect("a file of the workspace");
        let part =
            PARTS.iter().position(|(folder, _)| place.starts_with(folder)).expect("the last part has every file");
        for of in [part, PARTS.len() - 1] {
            counts[of][0] += found[0];
            counts[of][1] += found[1];
        }
    }
    println!("\nWhat the tests of this workspace hold:");
    for ((folder, what), [tests, _]) in PARTS.iter().zip(counts) {
        println!("  {folder:<12}{tests:>6} tests  {what}");
    }
    let ignored = counts[PARTS.len() - 1][1];
    println!(
        "Of these, {ignored} take minutes and run in `.ci/long`; those of the window and of graphics adapters in `.ci/run`.\n"
    );
}
