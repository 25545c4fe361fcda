//! A command overwrites neither its own inputs nor anything but regular files.

use std::fs;
use std::path::Path;

use crate::common::{Scratch, refusal};

/// A command that must end with exit code 4 and one sentence with these words.
fn refused(scratch: &Scratch, args: &[&str], words: &[&str]) {
    let text = refusal(&scratch.toile(args), 4);
    for word in words.iter().chain(&["not overwritten", "; name another"]) {
        assert!(text.contains(word), "{args:?}: `{word}` is not in: {text}");
    }
}

/// A second of the synthetic shopper, as a file of this name, and its bytes.
fn recorded(scratch: &Scratch, name: &str) -> Vec<u8> {
    let output = scratch.toile(&["record", "--out", name, "--seconds", "1", "--quiet"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    fs::read(scratch.path().join(name)).unwrap()
}

#[test]
fn a_recording_is_not_converted_onto_itself() {
    let scratch = Scratch::new("outputs-input");
    let bytes = recorded(&scratch, "in.mcap");
    fs::create_dir(scratch.path().join("folder")).unwrap();
    let mut places = vec!["in.mcap", "./in.mcap", "folder/../in.mcap"];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("in.mcap", scratch.path().join("link.mcap")).unwrap();
        fs::hard_link(scratch.path().join("in.mcap"), scratch.path().join("second.mcap")).unwrap();
        places.extend(["link.mcap", "second.mcap"]);
    }
    for place in places {
        refused(&scratch, &["convert", "in.mcap", "--out", place], &[place, "is read by this command"]);
    }
    assert_eq!(fs::read(scratch.path().join("in.mcap")).unwrap(), bytes);
    assert!(scratch.toile(&["convert", "in.mcap", "--out", "out.mcap"]).status.success());
}

#[test]
fn a_session_is_not_overwritten_by_what_is_made_of_it() {
    let scratch = Scratch::new("outputs-session");
    fs::create_dir(scratch.path().join("out")).unwrap();
    let bytes = recorded(&scratch, "out/report.json");
    let words = ["out/report.json", "is read by this command"];
    refused(&scratch, &["try-on", "--no-pictures", "--session", "out/report.json"], &words);
    fs::rename(scratch.path().join("out/report.json"), scratch.path().join("film.png")).unwrap();
    let film = ["try-on", "--no-pictures", "--session", "film.png", "--video", "film.png"];
    refused(&scratch, &film, &["film.png", "is read by this command"]);
    assert_eq!(fs::read(scratch.path().join("film.png")).unwrap(), bytes);
}

#[test]
fn a_folder_may_have_the_name_of_a_garment_that_is_built_in() {
    let scratch = Scratch::new("outputs-garment");
    fs::create_dir(scratch.path().join("scarf")).unwrap();
    fs::write(scratch.path().join("scarf/report.json"), "of the last run").unwrap();
    scratch.record_short();
    let line = ["try-on", "--session", "short.mcap", "--no-pictures", "--garment", "scarf", "--out", "scarf"];
    let output = scratch.toile(&line);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(fs::read_to_string(scratch.path().join("scarf/report.json")).unwrap().contains("toile.try-on/1"));
}

#[test]
fn what_is_not_a_regular_file_is_not_overwritten() {
    let scratch = Scratch::new("outputs-irregular");
    recorded(&scratch, "in.mcap");
    fs::create_dir(scratch.path().join("folder.mcap")).unwrap();
    refused(&scratch, &["record", "--out", "folder.mcap"], &["folder.mcap", "is a folder"]);
    refused(&scratch, &["convert", "in.mcap", "--out", "folder.mcap"], &["folder.mcap", "is a folder"]);
    fs::create_dir_all(scratch.path().join("out/report.json")).unwrap();
    refused(&scratch, &["try-on", "--no-pictures", "--session", "in.mcap"], &["report.json", "is a folder"]);
    if cfg!(unix) && Path::new("/dev/null").exists() {
        refused(&scratch, &["record", "--out", "/dev/null"], &["/dev/null", "is a device"]);
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_at_once() {
    let scratch = Scratch::new("outputs-pipe");
    let made = std::process::Command::new("mkfifo").arg(scratch.path().join("pipe.mcap")).status();
    if !made.is_ok_and(|status| status.success()) {
        eprintln!("mkfifo is not installed: pipes are not tried");
        return;
    }
    refused(&scratch, &["record", "--out", "pipe.mcap"], &["pipe.mcap", "is a pipe"]);
}

#[test]
fn a_body_and_a_scene_are_not_overwritten() {
    let scratch = Scratch::new("outputs-scene");
    // The index of positions has the name of the scene's own file.
    fs::create_dir(scratch.path().join("scene")).unwrap();
    let scene = "duration = 0.1\n[garment]\ngrid = { rows = 8, columns = 8, width = 0.5, height = 0.5 }\n\
                 pin = { vertices = [0, 7] }\n";
    fs::write(scratch.path().join("scene/index.csv"), scene).unwrap();
    refused(&scratch, &["run", "scene/index.csv", "--dump", "scene"], &["index.csv", "is read by this command"]);
    assert_eq!(fs::read(scratch.path().join("scene/index.csv")).unwrap(), scene.as_bytes());
    // A body that this command has made is not made again over itself.
    fs::create_dir(scratch.path().join("out")).unwrap();
    scratch.record_short();
    let made = scratch.toile(&["try-on", "--session", "short.mcap", "--no-pictures", "--glb", "--out", "out"]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    fs::rename(scratch.path().join("out/dressed.glb"), scratch.path().join("out/body.glb")).unwrap();
    let bytes = fs::read(scratch.path().join("out/body.glb")).unwrap();
    refused(&scratch, &["body", "out/body.glb", "--no-pictures"], &["body.glb", "is read by this command"]);
    assert_eq!(fs::read(scratch.path().join("out/body.glb")).unwrap(), bytes);
}
