//! Files that are refused at once, as input and as output.

use std::fs;
use std::process::Command;

use crate::common::{Scratch, refusal};

/// Runs a line that ends with exit code 4; the sentence names these words.
fn refused(scratch: &Scratch, args: &[&str], words: &[&str]) {
    let said = refusal(&scratch.toile(args), 4);
    assert!(words.iter().all(|word| said.contains(word)), "{args:?}: {said}");
}

#[test]
fn an_input_is_not_overwritten() {
    let scratch = Scratch::new("perf-outputs-input");
    fs::write(scratch.path().join("film.png"), "kept").unwrap();
    refused(&scratch, &["latency", "--session", "film.png", "--record", "film.png"], &["film.png"]);
    assert_eq!(fs::read(scratch.path().join("film.png")).unwrap(), b"kept");
}

#[test]
fn devices_and_pipes_are_refused() {
    let scratch = Scratch::new("perf-outputs-irregular");
    for line in [&["soak", "--minutes", "1"], &["latency", "--seconds", "1"]] {
        refused(&scratch, &[line, &["--record", "/dev/null"][..]].concat(), &["/dev/null", "is a device"]);
    }
    let made = Command::new("mkfifo").args(["pipe.mcap", "pipe.csv"]).current_dir(scratch.path()).status();
    assert!(made.is_ok_and(|status| status.success()), "mkfifo is there");
    refused(&scratch, &["soak", "--minutes", "1", "--record", "pipe.mcap"], &["pipe.mcap", "is a pipe"]);
    refused(&scratch, &["latency", "--seconds", "1", "--session", "pipe.mcap"], &["a pipe"]);
    refused(&scratch, &["bench", "measure", "--ansur", "pipe.csv"], &["a pipe"]);
}
