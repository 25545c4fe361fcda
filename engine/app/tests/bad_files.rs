//! Every command that reads a file refuses anything but a regular file at once: a FIFO is not waited for, a device is
//! not read until memory is gone.

use std::fs;
use std::os::unix::fs::symlink;
use std::os::unix::net::UnixListener;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{Scratch, refusal};

/// A refusal takes milliseconds; what has not ended by now hangs.
const LONGEST: Duration = Duration::from_secs(20);

/// Ends of names, by which some commands know what a file is.
const ENDINGS: [&str; 8] = ["mcap", "json", "toml", "obj", "glb", "gltf", "csv", "zip"];

/// A folder with a FIFO, a device, a folder and a socket of every ending.
fn traps(name: &str) -> (Scratch, Vec<UnixListener>) {
    let scratch = Scratch::new(name);
    let mut sockets = Vec::new();
    for ending in ENDINGS {
        let at = |kind: &str| scratch.path().join(format!("{kind}.{ending}"));
        let made = Command::new("mkfifo").arg(at("fifo")).status().expect("mkfifo is there");
        assert!(made.success());
        symlink("/dev/zero", at("zero")).unwrap();
        fs::create_dir(at("folder")).unwrap();
        sockets.push(UnixListener::bind(at("socket")).unwrap());
    }
    (scratch, sockets)
}

/// Runs a command that must end soon, with exit code 4 and one sentence.
fn refused(scratch: &Scratch, args: &[&str], words: &[&str]) {
    let mut command = Command::new(crate::PROGRAM);
    command.current_dir(scratch.path()).args(args).env_remove("RUST_BACKTRACE").env("XDG_RUNTIME_DIR", scratch.path());
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the built program starts");
    let begun = Instant::now();
    while child.try_wait().expect("the process can be asked").is_none() {
        if begun.elapsed() > LONGEST {
            child.kill().expect("the process can be ended");
            panic!("{args:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().expect("the process has ended");
    let message = refusal(&output, 4);
    assert!(message.contains("; "), "{args:?}: {message}");
    for word in words {
        assert!(message.contains(word), "{args:?}: `{word}` is not in: {message}");
    }
}

/// What a trap is called in the sentence that refuses it.
const TRAPS: [(&str, &str); 4] = [("fifo", "a pipe"), ("zero", "a device"), ("socket", "a socket"), ("folder", "")];

/// Every command line that reads a file; `@` stands for the trap's name without its ending.
const LINES: [&[&str]; 17] = [
    &["try-on", "--no-pictures", "--session", "@.mcap"],
    &["try-on", "--no-pictures", "--garment", "@.obj"],
    &["try-on", "--no-pictures", "--body", "@.glb"],
    &["measure", "@.mcap"],
    &["measure", "@.csv"],
    &["measure", "depth.png", "--camera", "@.json"],
    &["convert", "@.mcap", "--out", "made.mcap"],
    &["convert", "depth.png", "--camera", "@.json", "--out", "made.mcap"],
    &["plan", "--session", "@.mcap"],
    &["plan", "@.toml"],
    &["run", "@.toml"],
    &["bake", "@.obj"],
    &["bake", "tee", "--fabric", "@.toml"],
    &["body", "@.glb"],
    &["replay", "@.csv"],
    &["kiosk", "--headless", "--seconds", "1", "--config", "@.toml"],
    &["kiosk", "--headless", "--seconds", "1", "--session", "@.mcap"],
];

#[test]
fn every_command_refuses_what_is_not_a_regular_file() {
    let (scratch, _sockets) = traps("traps");
    fs::write(scratch.path().join("depth.png"), b"\x89PNG\r\n\x1a\n").unwrap();
    for line in LINES {
        for (trap, word) in TRAPS {
            let args: Vec<String> = line.iter().map(|word| word.replace('@', trap)).collect();
            let args: Vec<&str> = args.iter().map(String::as_str).collect();
            refused(&scratch, &args, &[word]);
        }
    }
}

/// What a file names is read no otherwise than what the command line names.
#[test]
fn a_scene_that_names_a_device_is_refused() {
    let (scratch, _sockets) = traps("scene-traps");
    let scenes = [
        "[garment]\nmesh = \"@.obj\"\n",
        "[garment]\nmesh = \"@.glb\"\n",
        "[garment]\ngrid = { rows = 2, columns = 2, width = 1, height = 1 }\n[[garment.pin]]\nvertices = [0]\ntrack = \"@.csv\"\n",
    ];
    for scene in scenes {
        for (trap, word) in TRAPS {
            fs::write(scratch.path().join("scene.toml"), scene.replace('@', trap)).unwrap();
            refused(&scratch, &["run", "scene.toml"], &[word]);
        }
    }
}

/// The images of a folder are files too.
#[test]
fn a_folder_with_a_pipe_among_its_images_is_refused() {
    for (trap, word) in TRAPS {
        let (scratch, _sockets) = traps("folder-traps");
        let folder = scratch.path().join("recording");
        fs::create_dir(&folder).unwrap();
        fs::rename(scratch.path().join(format!("{trap}.csv")), folder.join("0001.png")).unwrap();
        refused(&scratch, &["measure", "recording"], &[word, "recording/0001.png"]);
        fs::rename(folder.join("0001.png"), folder.join("camera.json")).unwrap();
        fs::write(folder.join("0002.png"), b"").unwrap();
        refused(&scratch, &["measure", "recording"], &[word, "recording/camera.json"]);
    }
}

/// What counts is the file at the end of a link.
#[test]
fn a_link_to_a_regular_file_is_read() {
    let scratch = Scratch::new("links");
    let scene = "[garment]\ngrid = { rows = 2, columns = 2, width = 1, height = 1 }\npin = { vertices = [0, 1] }\n";
    fs::write(scratch.path().join("scene.toml"), scene).unwrap();
    symlink("scene.toml", scratch.path().join("link.toml")).unwrap();
    let output = scratch.toile(&["run", "link.toml", "--frames", "1", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}
