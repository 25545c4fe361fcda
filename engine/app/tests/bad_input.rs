//! Bad input gives one sentence with the fault, its place and the cure, and the exit code of the contract. No file is left behind.

use std::fs::{self, File};

use crate::common::{Scratch, refusal};
use crate::samples;
use crate::samples::embedded_session;

/// Runs a command that must be refused with exit code `code`: one line on stderr with all `words` in it, nothing on
/// stdout, no file or folder more or less than before.
fn refused_with(code: i32, scratch: &Scratch, args: &[&str], words: &[&str]) -> String {
    let listing = |scratch: &Scratch| {
        let entries = fs::read_dir(scratch.path()).expect("the test's own folder");
        let mut names: Vec<_> = entries.map(|e| e.expect("an entry").file_name()).collect();
        names.sort();
        names
    };
    let before = listing(scratch);
    let message = refusal(&scratch.toile(args), code);
    for word in words {
        assert!(message.contains(word), "{args:?}: `{word}` is not in: {message}");
    }
    eprint!("{message}");
    // What is wrong is parted from the cure.
    assert!(message.contains("; ") || message.contains("--help"), "{args:?}: no cure in: {message}");
    assert_eq!(listing(scratch), before, "{args:?} leaves something behind");
    message
}

/// A try-on that must be refused as bad input; `args` say what is wrong.
fn refused(scratch: &Scratch, args: &[&str], words: &[&str]) -> String {
    let mut line = vec!["try-on", "--no-pictures", "--out", "made/out"];
    line.extend(args);
    refused_with(4, scratch, &line, words)
}

/// The recording of [`Scratch::record_short`].
const SHORT: [&str; 2] = ["--session", "short.mcap"];

/// A session file with this content must be refused.
fn session_refused(name: &str, content: &[u8], words: &[&str]) {
    let scratch = Scratch::new(name);
    fs::write(scratch.path().join(name), content).unwrap();
    let mut all = vec![name];
    all.extend(words);
    refused(&scratch, &["--session", name], &all);
    // The same file is as bad for `toile measure`.
    refused_with(4, &scratch, &["measure", name], &all);
}

#[test]
fn a_session_of_nothing_or_of_another_kind() {
    session_refused("empty.mcap", b"", &["empty", "give"]);
    session_refused("white.csv", b" \n\t\n", &["white space", "give"]);
    session_refused(
        "picture.png",
        b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0",
        &["PNG is broken", "16-bit grey PNG"],
    );
    session_refused("picture.jpg", b"\xff\xd8\xff\xe0\0\x10JFIF\0", &["no known kind", "give"]);
    session_refused("letter.txt", b"Dear shopper,\n", &["no known kind", "give"]);
    session_refused("object.json", b"{\"joints\": []}", &["JSON object", "give"]);
    session_refused("none.json", b"[]", &["none.json"]);
}

#[test]
fn a_session_that_is_missing_a_folder_or_too_large() {
    let scratch = Scratch::new("places");
    refused(&scratch, &["--session", "absent.mcap"], &["absent.mcap", "cannot be read", "check"]);
    fs::create_dir(scratch.path().join("folder")).unwrap();
    refused(&scratch, &["--session", "folder"], &["folder", "no depth image", "give"]);
    // A billion joints would fill four gigabytes: the file has their length, and holes for content.
    File::create(scratch.path().join("huge.csv")).and_then(|f| f.set_len(4 << 30)).unwrap();
    refused(&scratch, &["--session", "huge.csv"], &["huge.csv", "4294967296", "shorter"]);
}

#[test]
fn sessions_with_numbers_that_are_none() {
    let csv = samples::kinect_csv(40);
    let json = samples::kinectron(40);
    let bvh = samples::bvh(40);
    // The height of the pelvis in the first line.
    for bad in ["nan", "inf", "1e30"] {
        let mut fields: Vec<&str> = csv.splitn(4, ',').collect();
        fields[2] = bad;
        session_refused("number.csv", fields.join(",").as_bytes(), &["line 1"]);
    }
    session_refused("number.json", json.replacen("\"cameraX\":0", "\"cameraX\":1e39", 1).as_bytes(), &["number.json"]);
    session_refused("number.bvh", bvh.replacen("0.5 0.5", "nan 0.5", 1).as_bytes(), &["number.bvh"]);
    session_refused("far.bvh", bvh.replacen("0 95 0", "0 95000000 0", 1).as_bytes(), &["far.bvh"]);
}

#[test]
fn sessions_that_promise_a_billion_frames_or_joints() {
    let bvh = samples::bvh(3);
    session_refused("frames.bvh", bvh.replacen("Frames: 3", "Frames: 1000000000", 1).as_bytes(), &["1000000000"]);
    let many = "JOINT a\n{\nOFFSET 0 0 0\n".repeat(5000);
    session_refused(
        "joints.bvh",
        bvh.replacen("JOINT Chest", &format!("{many}JOINT Chest"), 1).as_bytes(),
        &["joints.bvh"],
    );
    // The first message of the recording says how many joints follow.
    let mut bytes = embedded_session();
    let head = 23u32.to_le_bytes();
    let at = bytes.windows(4).position(|w| w == head).expect("a count of 23 joints");
    bytes[at..at + 4].copy_from_slice(&1_000_000_000u32.to_le_bytes());
    session_refused("count.mcap", &bytes, &["count.mcap"]);
    let long = format!("1,{}", "0.5,".repeat(1_000_000));
    session_refused("long.csv", long.as_bytes(), &["line 1"]);
}

/// Cuts a recording at `ends`: each piece is refused in one sentence, or is a shorter session. Returns how many were
/// refused.
fn truncated(name: &str, bytes: &[u8], ends: impl IntoIterator<Item = usize>) -> usize {
    let scratch = Scratch::new(name);
    let mut refusals = 0;
    for end in ends {
        fs::write(scratch.path().join(name), &bytes[..end]).unwrap();
        let output = scratch.toile(&["measure", name, "--json"]);
        if output.status.code() == Some(0) {
            assert!(output.stderr.is_empty(), "{name}, {end} bytes: {}", String::from_utf8_lossy(&output.stderr));
            let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("stdout is one JSON object");
            let stature = json["measurements"]["stature_mm"]["value"].as_f64().unwrap();
            assert!((500.0..2500.0).contains(&stature), "{name}, {end} bytes: {stature} mm");
        } else {
            refused_with(4, &scratch, &["measure", name, "--json"], &[]);
            refusals += 1;
        }
    }
    refusals
}

/// `count` places spread over a file, its first bytes among them.
fn spread(length: usize, count: usize) -> Vec<usize> {
    let mut ends: Vec<usize> = vec![1, 4, 7];
    ends.extend((1..count).map(|i| i * length / count + i % 7));
    ends.push(length - 1);
    ends.retain(|end| *end < length);
    ends
}

#[test]
fn a_session_cut_off_anywhere() {
    let [csv, json, bvh] = [samples::kinect_csv(12), samples::kinectron(12), samples::bvh(12)];
    for (name, text) in [("cut.csv", &csv), ("cut.json", &json), ("cut.bvh", &bvh)] {
        let refusals = truncated(name, text.as_bytes(), spread(text.len(), 24));
        assert!(refusals >= 4, "{name}: only {refusals} pieces were refused");
        // The same through a whole try-on, which would have a folder to leave behind.
        let scratch = Scratch::new("try-on");
        fs::write(scratch.path().join(name), &text[..text.len() / 30]).unwrap();
        refused(&scratch, &["--session", name], &[name]);
    }
}

#[test]
fn the_embedded_session_cut_off_anywhere() {
    let bytes = embedded_session();
    // Measuring a long piece takes a second, so that there are few of them; the head is cut densely.
    let ends = [1, 7, 8, 9, 40, 100, 333, 1000, 1800, 2500, bytes.len() / 10, bytes.len() / 3];
    let refusals = truncated("cut.mcap", &bytes, ends);
    assert!(refusals >= 6, "only {refusals} pieces were refused");
    let scratch = Scratch::new("cut-try-on");
    fs::write(scratch.path().join("cut.mcap"), &bytes[..700]).unwrap();
    refused(&scratch, &["--session", "cut.mcap"], &["cut.mcap"]);
}

/// A band around the waist as OBJ text: `n` quads.
fn band(n: usize) -> String {
    let mut text = String::from("o band\n");
    for height in [1.1, 0.7] {
        for i in 0..n {
            let a = std::f64::consts::TAU * i as f64 / n as f64;
            text += &format!("v {:.5} {height} {:.5}\n", 0.3 * a.sin(), 0.3 * a.cos());
        }
    }
    for i in 0..n {
        let next = (i + 1) % n;
        text += &format!("f {} {} {} {}\n", n + i + 1, n + next + 1, next + 1, i + 1);
    }
    text
}

#[test]
fn a_garment_whose_mesh_is_no_cloth() {
    let good = band(24);
    let cases: [(&str, String, &[&str]); 6] = [
        ("empty", String::new(), &["no faces", "export"]),
        ("points", "v 0 0 0\nv 0 1 0\nv 1 1 0\n".into(), &["no faces", "export"]),
        ("garbage", "PK\u{3}\u{4} this is no mesh\nf a b c\n".into(), &["export"]),
        ("number", good.replacen("v 0.00000", "v nan", 1), &["number.obj"]),
        ("index", format!("{good}f 1 2 4000\n"), &["index.obj", "export"]),
        ("units", good.replace(" 1.1 ", " 1100 ").replace(" 0.7 ", " 700 "), &["metres", "export"]),
    ];
    let scratch = Scratch::new("meshes");
    for (name, text, words) in cases {
        let file = format!("{name}.obj");
        fs::write(scratch.path().join(&file), text).unwrap();
        let mut all = vec![file.as_str()];
        all.extend(words);
        refused(&scratch, &["--garment", &file], &all);
    }
    fs::write(scratch.path().join("bytes.obj"), [0xff, 0xfe, 0x00, 0x80]).unwrap();
    refused(&scratch, &["--garment", "bytes.obj"], &["bytes.obj", "text in UTF-8", "save"]);
    fs::create_dir(scratch.path().join("folder.obj")).unwrap();
    refused(&scratch, &["--garment", "folder.obj"], &["folder.obj", "give"]);
    refused(&scratch, &["--garment", "absent.obj"], &["absent.obj", "give"]);
}

#[test]
fn a_mesh_with_a_fault_that_can_be_repaired_is_worn_and_the_repair_is_told() {
    let good = band(24);
    let cases = [
        ("band", good.clone(), ""),
        ("degenerate", format!("{good}f 1 1 2\n"), "without area"),
        ("line", format!("{good}v 0 1.1 0.3\nv 0 1.0 0.3\nv 0 0.9 0.3\nf 49 50 51\n"), "without area"),
        ("fin", format!("{good}v 0 1.3 0.5\nv 0 1.3 0.6\nf 1 2 49\nf 2 1 50\n"), "more than two faces"),
    ];
    let scratch = Scratch::new("repaired");
    fs::write(scratch.path().join("still.csv"), samples::kinect_csv(8)).unwrap();
    for (name, text, repair) in cases {
        let file = format!("{name}.obj");
        fs::write(scratch.path().join(&file), text).unwrap();
        let output = scratch.toile(&["--garment", &file, "--session", "still.csv", "--no-pictures", "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let repairs = report["meshes"][0]["repairs"].as_array().unwrap();
        assert_eq!(repairs.is_empty(), repair.is_empty(), "{name}: {repairs:?}");
        assert!(
            repairs.iter().any(|r| r["what"].as_str().unwrap().contains(repair)) || repair.is_empty(),
            "{repairs:?}"
        );
    }
}

#[test]
fn an_unknown_garment_or_size_is_told_what_there_is() {
    let scratch = Scratch::new("names");
    scratch.record_short();
    let refused = |args: &[&str], words: &[&str]| refused(&scratch, &[&SHORT, args].concat(), words);
    refused(&["--garment", "crinoline"], &["crinoline", "strap-dress", "tee", "wide-leg-trousers", "choose"]);
    refused(&["--garment", "sun-dress"], &["sun-dress is no longer built in; ask for strap-dress"]);
    refused(&["--garment", "strap-dress", "--garment", "crinoline"], &["crinoline", "choose"]);
    refused(&["--garment", "strap-dress", "--size", "999"], &["999", "40", "choose"]);
    fs::write(scratch.path().join("band.obj"), band(24)).unwrap();
    refused(&["--garment", "band.obj", "--size", "40"], &["band.obj", "40", "leave the size out"]);
}

#[test]
fn what_cannot_be_tucked_in_is_refused_with_the_cure() {
    let scratch = Scratch::new("tucked");
    scratch.record_short();
    let refused = |args: &[&str], words: &[&str]| refused(&scratch, &[&SHORT, args].concat(), words);
    refused(&["--garment", "tee", "--tuck", "tee"], &["cannot be tucked in", "waistband", "wear trousers"]);
    refused(&["--garment", "tee", "--tuck", "shirt"], &["shirt", "not worn", "name one of tee"]);
    let dress = ["--garment", "wide-leg-trousers", "--garment", "strap-dress", "--tuck", "strap-dress"];
    refused(&dress, &["strap-dress", "below the waistband", "shorter"]);
}

#[test]
fn an_output_folder_that_cannot_be_written() {
    let scratch = Scratch::new("outputs");
    fs::write(scratch.path().join("file"), b"kept").unwrap();
    for out in ["file", "file/below", "file/below/deeper"] {
        refused_with(4, &scratch, &["try-on", "--no-pictures", "--out", out], &[out, "cannot be written", "--out"]);
    }
    refused_with(4, &scratch, &["record", "--out", "file/a.mcap", "--seconds", "1"], &["file", "cannot be written"]);
    assert_eq!(fs::read(scratch.path().join("file")).unwrap(), b"kept");
}

#[test]
fn a_folder_with_results_keeps_them_when_a_run_is_refused() {
    let scratch = Scratch::new("kept");
    let out = scratch.path().join("out");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("report.json"), b"of yesterday").unwrap();
    refused_with(4, &scratch, &["try-on", "--session", "absent.csv", "--out", "out"], &["absent.csv"]);
    assert_eq!(fs::read(out.join("report.json")).unwrap(), b"of yesterday");
    assert_eq!(fs::read_dir(&out).unwrap().count(), 1);
}

#[test]
fn a_command_line_that_is_not_understood() {
    let scratch = Scratch::new("usage");
    let lines: [&[&str]; 5] = [
        &["try-on", "--body", "tall"],
        &["try-on", "--out"],
        &["try-on", "--frobnicate"],
        &["measure"],
        &["record", "--seconds", "1"],
    ];
    for line in lines {
        refused_with(2, &scratch, line, &["--help"]);
    }
}
