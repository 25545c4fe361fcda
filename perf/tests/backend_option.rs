//! `--backend` as a user and a script meet it, on a machine without a graphics driver: the processor steps, and says why.

use std::process::{Command, Stdio};

use crate::common::Scratch;
use serde_json::Value;

/// Runs it where no Vulkan driver can be found; gives the object on stdout, and stderr.
fn toile(line: &str) -> (Value, String) {
    let scratch = Scratch::new(&format!("backend-{}", line.len()));
    let args: Vec<&str> = line.split_whitespace().collect();
    let mut command = Command::new(crate::PROGRAM);
    command.current_dir(scratch.path()).env("XDG_RUNTIME_DIR", scratch.path()).stdin(Stdio::null());
    command.env("VK_DRIVER_FILES", "/nowhere").env("VK_ICD_FILENAMES", "/nowhere");
    let output = command.args(&args).output().expect("the built program starts");
    let words = String::from_utf8(output.stderr).expect("stderr is UTF-8");
    assert_eq!(output.status.code(), Some(0), "{line}: {words}");
    (serde_json::from_slice(&output.stdout).expect("stdout is exactly one JSON object"), words)
}

#[test]
fn without_a_device_the_benchmark_goes_on_by_the_processor_and_says_why() {
    let run = |backend: &str| toile(&format!("bench skirt --verts 256 --runs 1 --steps 4 --json --backend {backend}"));
    let (plain, silent) = run("cpu");
    assert_eq!((plain["stepped_by"]["fallen"].is_null(), silent.as_str()), (true, ""));
    for backend in ["gpu", "auto"] {
        let (found, words) = run(backend);
        let by = &found["stepped_by"];
        assert_eq!((by["asked"].as_str(), by["backend"].as_str()), (Some(backend), Some("cpu")));
        let reason = by["fallen"].as_str().expect("it says why");
        assert!(words.starts_with("the processor steps: ") && words.contains(reason), "{words}");
        // Every reason has its cure: another build, or a driver.
        assert!(reason.contains("--features gpu") || reason.contains("install"), "{reason}");
        assert_eq!(found["state_hash"], plain["state_hash"], "no bit of it is another");
    }
}

#[test]
fn garments_that_keep_out_of_each_other_are_the_processors_whatever_was_asked_for() {
    let run = |more: &str| toile(&format!("bench skirt --garment scarf --runs 1 --steps 2 --json {more}"));
    let (plain, silent) = run("--backend cpu");
    assert_eq!((plain["stepped_by"]["fallen"].is_null(), silent.as_str()), (true, ""));
    for backend in ["gpu", "auto"] {
        let (found, words) = run(&format!("--backend {backend}"));
        let by = &found["stepped_by"];
        assert_eq!((by["asked"].as_str(), by["backend"].as_str()), (Some(backend), Some("cpu")));
        let reason = by["fallen"].as_str().expect("it says why");
        assert!(reason.contains("cloth out of cloth") && reason.contains("--no-folds"), "{reason}");
        assert_eq!(words, format!("the processor steps: {reason}\n"), "one sentence");
        assert_eq!(found["state_hash"], plain["state_hash"], "no bit of it is another");
    }
    let (found, _) = run("--no-layers --no-folds --backend auto");
    let reason = found["stepped_by"]["fallen"].as_str().expect("it says why");
    assert!(reason.contains("skin") && reason.contains("--no-skin"), "{reason}");
    let (found, _) = run("--no-layers --no-folds --no-skin --backend gpu");
    let reason = found["stepped_by"]["fallen"].as_str().expect("it says why");
    assert!(reason.contains("--features gpu") || reason.contains("install"), "then only a device is missing: {reason}");
}

#[test]
fn validation_and_torture_say_what_stepped() {
    for line in ["validate spring --every 9 --json --backend gpu", "torture bad-state --seed 0 --json --backend gpu"] {
        let (found, words) = toile(line);
        let by = &found["stepped_by"];
        assert_eq!((by["backend"].as_str(), by["fallen"].is_string()), (Some("cpu"), true), "{line}");
        assert!(words.contains("the processor steps: "), "{line}: {words}");
    }
}

#[test]
fn the_table_of_a_device_is_made_without_one_and_says_so() {
    let scratch = Scratch::new("backend-picture");
    let output = scratch.toile(&["bench", "skirt", "--picture", "out"]);
    assert_eq!(output.status.code(), Some(2), "there is no table to draw");
    let output = scratch.toile(&["bench", "skirt", "--table"]);
    assert_eq!(output.status.code(), Some(2), "a table is of a device or of stages");
    let output = scratch.toile(&["bench", "skirt", "--table", "--picture", "out"]);
    assert_eq!(output.status.code(), Some(2), "there is no chart of the processor alone");
    let words = String::from_utf8(output.stderr).expect("stderr is UTF-8");
    assert!(words.contains("--backend gpu"), "{words}");
}
