//! The command line as a user or a script meets it: the built program, its streams and its exit codes.

mod common;

use std::fs;
use std::process::{Command, Output, Stdio};

use common::{Scratch, sentence, stdout};
use serde_json::Value;

fn toile(args: &[&str]) -> Output {
    program().args(args).output().expect("the built program starts")
}

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
    command.stdin(Stdio::null()).env_remove("RUST_BACKTRACE").current_dir(std::env::temp_dir());
    command
}

#[test]
fn help_is_on_stdout_and_ends_with_an_example() {
    for command in ["", "try-on", "measure", "record", "convert", "bake", "doctor", "bench", "completions"] {
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
    let lines: [&[&str]; 9] = [
        &["--bogus"],
        &["try-on", "--garmet", "x"],
        &["mesure", "x"],
        &["measure"],
        &["record", "--out", "x.mcap", "--seconds", "0"],
        &["bench"],
        &["bake"],
        &["bench", "skinning", "--verts", "0"],
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
fn bench_skinning_reports_time_and_error_together() {
    let output = toile(&["bench", "skinning", "--verts", "2000", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty());
    let json: Value = serde_json::from_str(&stdout(&output)).expect("stdout is exactly one JSON object");
    assert_eq!(json["schema"], "toile.bench-skinning/1");
    assert_eq!(json["verts"], 2000);
    let number = |key: &str| json[key].as_f64().unwrap_or_else(|| panic!("{key} is no number: {json}"));
    assert!(number("us") > 0.0 && number("yardstick_us") > 0.0);
    assert!((number("ns_per_vertex") - number("us") / 2.0).abs() < 1e-6);
    assert!((0.0..1e-6).contains(&number("max_error_m")), "{json}");
    assert!(json["machine"]["cpu"].is_string());

    let output = toile(&["bench", "skinning", "--verts", "500"]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    assert!(text.contains("500 vertices") && text.contains("ns a vertex") && !text.contains('\x1b'), "{text}");

    let output = toile(&["bench", "skinning", "--backend", "gpu", "--dual"]);
    assert_eq!(output.status.code(), Some(2), "what is reported anyway is no option");
}

#[test]
fn bench_skirt_reports_time_and_error_of_the_same_steps() {
    let output = toile(&["bench", "skirt", "--verts", "256", "--runs", "2", "--steps", "30", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty());
    let json: Value = serde_json::from_str(&stdout(&output)).expect("stdout is exactly one JSON object");
    assert_eq!(json["schema"], "toile.bench-skirt/1");
    let contract = [
        "/step_us/p50",
        "/step_us/p99",
        "/step_us/p999",
        "/step_us/max",
        "/strain/mean",
        "/strain/p99",
        "/strain/max",
        "/penetration_mm/max",
        "/penetration_mm/fraction",
        "/allocations_per_step",
        "/memory_bytes",
        "/yardstick_us",
        "/y_ratio",
        "/substeps",
        "/lanes",
        "/hem_winding_wrong",
        "/kinetic_energy_mj",
    ];
    for key in contract {
        assert!(json.pointer(key).is_some_and(Value::is_number), "{key}: {json}");
    }
    assert!(json["stages_us"].is_object() && json["state_hash"].as_str().unwrap().len() == 16);
    assert_eq!(json["allocations_per_step"], 0.0, "the built program counts its own allocations");
    assert!(json["memory_bytes"].as_u64().unwrap() > 256 * 12, "{json}");
    let ratio = json["step_us"]["p50"].as_f64().unwrap() / json["yardstick_us"].as_f64().unwrap();
    assert!((ratio - json["y_ratio"].as_f64().unwrap()).abs() < 1e-9);

    let output = toile(&["bench", "skirt", "--verts", "256", "--runs", "1", "--steps", "5", "--motion", "settled"]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    assert!(text.contains("256 vertices") && text.contains("strain") && !text.contains('\x1b'), "{text}");
}

#[test]
fn bench_skirt_refuses_what_is_no_grid() {
    let output = toile(&["bench", "skirt", "--verts", "1000"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(sentence(&output).contains("1000 vertices"));
}

#[test]
fn completions_know_the_commands() {
    for shell in ["bash", "zsh", "fish"] {
        let output = toile(&["completions", shell]);
        assert_eq!(output.status.code(), Some(0), "{shell}");
        let text = stdout(&output);
        assert!(text.contains("try-on") && text.contains("garment"), "{shell}");
    }
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    // Nobody reads from the start, so that the very first write fails.
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
    // Below a regular file nobody can write, root included.
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
