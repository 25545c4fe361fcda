//! A webcam before `toile-perf latency`, without the network that it needs.

use std::process::{Command, Stdio};

use toile_pose::files;

use crate::common::{Scratch, refusal};

#[test]
fn a_missing_network_is_refused_with_its_cure() {
    let scratch = Scratch::new("perf-webcam-refused");
    let mut command = Command::new(crate::PROGRAM);
    command.stdin(Stdio::null()).current_dir(scratch.path()).env("XDG_RUNTIME_DIR", scratch.path());
    command.env(files::FOLDER_VARIABLE, scratch.path()).args(["latency", "--camera", "webcam-file:pictures"]);
    assert!(refusal(&command.output().unwrap(), 5).contains(files::FETCH));
}
