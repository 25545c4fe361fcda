//! The built program, as a script meets it. Tests of the programs include this file; each names its program as `crate::PROGRAM`.

#![allow(dead_code, reason = "each program uses its part")]

use std::fs;
#[cfg(unix)]
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use serde_json::Value;

/// The machine's cores: shared by what runs as long as it needs, and held by a program that has to keep up with a camera.
static CORES: RwLock<()> = RwLock::new(());

/// The cores beside others, for work that takes seconds. Each program of [`Scratch::toile`] has them.
pub fn beside_others() -> RwLockReadGuard<'static, ()> {
    CORES.read().unwrap_or_else(PoisonError::into_inner)
}

/// All cores: waits for the work that has begun, and keeps more from beginning.
pub fn alone() -> RwLockWriteGuard<'static, ()> {
    CORES.write().unwrap_or_else(PoisonError::into_inner)
}

/// A folder of a test's own, empty; it goes with the test.
pub struct Scratch(PathBuf);

impl Scratch {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("toile-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("the temporary folder can be written");
        Self(path)
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Runs the program in this folder.
    pub fn toile(&self, args: &[&str]) -> Output {
        let _cores = beside_others();
        let mut command = Command::new(crate::PROGRAM);
        command.stdin(Stdio::null()).env_remove("RUST_BACKTRACE").current_dir(&self.0);
        // Graphics drivers complain on stderr where there is none.
        command.env("XDG_RUNTIME_DIR", &self.0);
        command.args(args).output().expect("the built program starts")
    }

    /// Records a second of the synthetic shopper as `short.mcap`.
    pub fn record_short(&self) {
        let output = self.toile(&["record", "--out", "short.mcap", "--seconds", "1", "--quiet"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Runs a command whose stderr is read line by line, and ends it with SIGTERM once `enough` says so of a line.
#[cfg(unix)]
pub fn run_until(command: &mut Command, mut enough: impl FnMut(&str) -> bool) -> Output {
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let id = child.id().to_string();
    let (mut said, mut told) = (String::new(), false);
    for line in BufReader::new(child.stderr.take().unwrap()).lines() {
        let line = line.expect("stderr is UTF-8");
        if !told && enough(&line) {
            told = true;
            assert!(Command::new("kill").args(["-TERM", &id]).status().expect("kill is there").success());
        }
        said += &line;
        said.push('\n');
    }
    Output { stderr: said.into_bytes(), ..child.wait_with_output().unwrap() }
}

/// What a run printed.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("stdout is UTF-8")
}

/// The one object that a run printed, which said nothing beside it.
pub fn object(output: &Output) -> Value {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.is_empty(), "with --json nothing is said: {said}");
    serde_json::from_slice(&output.stdout).expect("stdout is exactly one JSON object")
}

/// The one line on stderr of a run.
pub fn sentence(output: &Output) -> String {
    let said = String::from_utf8(output.stderr.clone()).expect("stderr is UTF-8");
    assert_eq!(said.lines().count(), 1, "not one line: {said}");
    assert!(said.starts_with("toile: ") && said.ends_with('\n'), "{said}");
    said
}

/// The sentence of a run that was refused with a code, and printed no data.
pub fn refusal(output: &Output, code: i32) -> String {
    let said = sentence(output);
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert!(output.stdout.is_empty(), "data beside: {said}");
    said
}
