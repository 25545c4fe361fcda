//! The command line as a user or a script meets it: the built program, its streams and its exit codes.

use std::fs;
use std::process::{Command, Output, Stdio};

use crate::common::{Scratch, sentence, stdout};
use serde_json::Value;

fn toile(args: &[&str]) -> Output {
    program().args(args).output().expect("the built program starts")
}

fn program() -> Command {
    let mut command = Command::new(crate::PROGRAM);
    command.stdin(Stdio::null()).env_remove("RUST_BACKTRACE").current_dir(std::env::temp_dir());
    command
}

#[test]
fn help_is_on_stdout_and_ends_with_an_example() {
    for command in ["", "try-on", "measure", "record", "convert", "bake", "doctor", "catalogue", "completions"] {
        let args: Vec<&str> = [command, "--help"].into_iter().filter(|a| !a.is_empty()).collect();
        let output = toile(&args);
        assert_eq!(output.status.code(), Some(0), "{command}");
        assert!(output.stderr.is_empty(), "{command}");
        let text = stdout(&output);
        let example = text.split("Example: ").nth(1).unwrap_or_else(|| panic!("{command} has no example"));
        assert!(example.lines().count() >= 2 && example.contains("\n  toile"), "{command}: {example}");
        assert!(!text.contains('\x1b'), "{command} is coloured in a pipe");
    }
}

#[test]
fn version_is_the_packages() {
    let output = toile(&["--version"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stdout(&output), format!("toile {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn a_line_not_understood_exits_2_with_one_sentence() {
    let lines: [&[&str]; 8] = [
        &["--bogus"],
        &["try-on", "--garmet", "x"],
        &["mesure", "x"],
        &["measure"],
        &["record", "--out", "x.mcap", "--seconds", "0"],
        &["catalogue"],
        &["bake"],
        &["completions", "tcsh"],
    ];
    for line in lines {
        let output = toile(line);
        assert_eq!(output.status.code(), Some(2), "{line:?}");
        assert!(output.stdout.is_empty(), "{line:?}");
        assert!(sentence(&output).contains("--help"), "{line:?}");
    }
}

#[test]
fn doctor_json_is_one_object_with_its_keys() {
    let scratch = Scratch::new("cli-doctor");
    let folder = scratch.path();
    let output = program().current_dir(folder).args(["doctor", "--json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty());
    let json: Value = serde_json::from_str(&stdout(&output)).expect("stdout is exactly one JSON object");
    assert_eq!(json["schema"], "toile.doctor/1");
    assert_eq!(json["version"], env!("CARGO_PKG_VERSION"));
    assert!(json["machine"]["cores"].as_u64().unwrap() >= 1);
    for key in ["/machine/cpu", "/machine/lanes", "/machine/adapter", "/gpu_built_in", "/ready", "/adapters"] {
        assert!(json.pointer(key).is_some(), "{key}");
    }
    let checks = json["checks"].as_array().unwrap();
    for name in ["processor", "cores", "lanes", "memory", "priority", "gpu", "output folder", "ffmpeg", "display"] {
        let check = checks.iter().find(|c| c["name"] == name).unwrap_or_else(|| panic!("{name} was not looked at"));
        assert_eq!(check["status"] == "missing", check["cure"].is_string(), "{check}");
    }
    assert_eq!(fs::read_dir(folder).unwrap().count(), 0, "doctor leaves no trace");
}

#[test]
fn doctor_finds_a_folder_that_cannot_be_written() {
    let scratch = Scratch::new("cli-doctor-file");
    let folder = scratch.path();
    fs::write(folder.join("file"), b"x").unwrap();
    let output = program().current_dir(folder).args(["doctor", "--out", "file/out", "--json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "what is missing is a finding, not an error");
    let json: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(json["ready"], false);
}

#[test]
fn doctor_for_people_has_no_colour_in_a_pipe() {
    let output = toile(&["doctor", "--out", "toile-doctor-table"]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    assert!(text.contains("processor") && text.contains("priority") && !text.contains('\x1b'), "{text}");
}

#[test]
fn completions_know_the_commands() {
    for shell in ["bash", "zsh", "fish"] {
        let output = toile(&["completions", shell]);
        assert_eq!(output.status.code(), Some(0), "{shell}");
        let text = stdout(&output);
        assert!(text.contains("try-on") && text.contains("garment") && text.contains("torture"), "{shell}");
    }
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    // There is no reader from the start, so that the very first write fails.
    let (reader, writer) = std::io::pipe().expect("a pipe can be made");
    drop(reader);
    let mut command = program();
    let output = command.args(["completions", "zsh"]).stdout(writer).output().expect("the built program starts");
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn an_output_folder_that_cannot_be_written_exits_4_and_leaves_nothing() {
    let scratch = Scratch::new("cli-unwritable");
    let folder = scratch.path();
    // Below a regular file no user can write, root included.
    fs::write(folder.join("file"), b"kept").unwrap();
    for line in [&["try-on", "--out", "file/out"][..], &["--json", "--out", "file"][..]] {
        let output = program().current_dir(folder).args(line).output().unwrap();
        assert_eq!(output.status.code(), Some(4), "{line:?}");
        assert!(output.stdout.is_empty());
        let message = sentence(&output);
        assert!(message.contains("file") && message.contains("--out"), "{message}");
    }
    assert_eq!(fs::read(folder.join("file")).unwrap(), b"kept");
    assert_eq!(fs::read_dir(folder).unwrap().count(), 1);
}

#[test]
fn a_session_that_cannot_be_used_leaves_no_folder() {
    let scratch = Scratch::new("cli-no-session");
    let folder = scratch.path();
    fs::write(folder.join("empty.json"), b"").unwrap();
    for session in ["absent.mcap", "empty.json"] {
        let output = program().current_dir(folder).args(["--session", session, "--out", "made/out"]).output().unwrap();
        assert_eq!(output.status.code(), Some(4), "{session}");
        assert!(output.stdout.is_empty(), "{session}");
        sentence(&output);
        assert!(!folder.join("made").exists(), "{session}");
    }
}
