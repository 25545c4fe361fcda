//! Commands of other programs: run if the program is installed in this version, else explained.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Output, Stdio};

use crate::common::{Scratch, refusal, sentence, stdout};

/// Runs the program from a folder of its own, where nothing lies beside it, with this folder as the PATH.
fn alone(scratch: &Scratch, args: &[&str]) -> Output {
    let own = scratch.path().join("own");
    fs::create_dir_all(&own).unwrap();
    if !own.join("toile").exists() {
        fs::copy(crate::PROGRAM, own.join("toile")).unwrap();
    }
    let mut command = Command::new(own.join("toile"));
    command.stdin(Stdio::null()).current_dir(scratch.path()).env("PATH", scratch.path()).args(args);
    command.output().unwrap()
}

/// Writes a program that says its version, else its arguments, and exits with 3.
fn write_program(scratch: &Scratch, name: &str, version: &str) {
    let file = scratch.path().join(name);
    let text = format!(
        "#!/bin/sh\nif [ \"$1\" = --version ]; then echo \"{name} {version}\"; exit 0; fi\necho \"$@\"\nexit 3\n"
    );
    fs::write(&file, text).unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn a_missing_program_is_explained() {
    let scratch = Scratch::new("programs-missing");
    for (line, program) in [("bench", "toile-perf"), ("study", "toile-study"), ("capture", "toile-capture")] {
        let said = refusal(&alone(&scratch, &[line, "x"]), 2);
        assert!(said.contains(&format!("cargo build --release -p {program}")), "{said}");
    }
}

#[test]
fn a_program_of_this_version_takes_over() {
    let scratch = Scratch::new("programs-there");
    write_program(&scratch, "toile-perf", env!("CARGO_PKG_VERSION"));
    write_program(&scratch, "toile-study", env!("CARGO_PKG_VERSION"));
    for (line, said) in [
        (&["bench", "skirt", "--json"][..], "bench skirt --json"),
        (&["--json", "soak"], "soak --json"),
        (&["study", "merge", "tee"], "merge tee"),
        (&["help", "torture"], "torture --help"),
    ] {
        let output = alone(&scratch, line);
        assert_eq!((output.status.code(), stdout(&output).trim()), (Some(3), said), "{line:?}");
    }
}

#[test]
fn a_program_of_another_version_is_refused() {
    let scratch = Scratch::new("programs-other");
    write_program(&scratch, "toile-capture", "0.0.1");
    let output = alone(&scratch, &["capture", "face", "a.png"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(sentence(&output).contains("is of version 0.0.1"), "{}", sentence(&output));
}

#[test]
fn help_lists_the_commands_of_other_programs() {
    let help = stdout(&Scratch::new("programs-help").toile(&["--help"]));
    for name in ["bench", "latency", "soak", "validate", "torture", "pareto", "study", "capture"] {
        assert!(help.contains(&format!("\n  {name} ")), "{name}: {help}");
    }
}
