//! `toile body`, and `toile try-on --body`, as a script meets them.

use std::fs;
use std::path::PathBuf;

use crate::common::Scratch;
use crate::recordings;

/// The MakeHuman folder of the shared data; nothing, with a word, where it is not there and need not be.
fn makehuman() -> Option<PathBuf> {
    Some(recordings::folder()?.join("body/makehuman-hm08"))
}

#[test]
fn a_body_is_imported_written_and_imported_again() {
    let Some(folder) = makehuman() else { return };
    let scratch = Scratch::new("body");
    let folder = folder.to_str().expect("a path of plain text");
    let run = |args: &[&str]| {
        let output = scratch.toile(args);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).expect("one JSON object")
    };
    let target = "caucasian-female-young";
    let first = run(&["body", folder, "--target", target, "--no-pictures", "--json", "--out", "a"]);
    assert_eq!((&first["schema"], &first["dialect"]), (&"toile.body/1".into(), &"Unreal".into()));
    assert_eq!((&first["surface"]["parts"], &first["surface"]["boundary_edges"]), (&1.into(), &0.into()));
    assert_eq!(first["measures_mm"][0]["value"], 1605.4);
    assert_eq!(first["makehuman_mm"][0]["name"], "height");
    let again = run(&["body", "a/body.glb", "--no-pictures", "--json", "--out", "b"]);
    assert_eq!((&again["dialect"], &again["measures_mm"]), (&"H-Anim 2".into(), &first["measures_mm"]));
    let [a, b] = ["a/body.glb", "b/body.glb"].map(|f| fs::read(scratch.path().join(f)).expect("the file written"));
    assert_eq!(a.len(), b.len());
}

#[test]
fn what_is_no_body_is_refused_with_its_cure() {
    let scratch = Scratch::new("no-body");
    fs::write(scratch.path().join("cut.glb"), b"glTF\x02\0\0\0").expect("the test's own folder");
    let lines: [(&[&str], i32, &str); 4] = [
        (&["body", "absent.vrm"], 4, "absent.vrm: it cannot be read"),
        (&["body", "cut.glb"], 4, "cut.glb: the file ends too early; export it again"),
        (&["try-on", "--body", "absent.glb"], 4, "absent.glb: it cannot be read"),
        (&["body", "cut.glb", "--target", "a"], 2, "has no targets"),
    ];
    for (line, code, expected) in lines {
        let output = scratch.toile(line);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{line:?}: {text}");
        assert!(text.contains(expected) && text.lines().count() == 1, "{line:?}: {text}");
        assert!(!scratch.path().join("out").exists(), "{line:?} leaves a folder behind");
    }
}

#[test]
fn colliders_follow_the_skin_of_our_sizes() {
    let scratch = Scratch::new("colliders");
    let output = scratch.toile(&["body", "--colliders", "--strangers", "1", "--no-pictures", "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(report["schema"], "toile.body-colliders/1");
    assert_eq!(report["bodies"].as_array().map(Vec::len), Some(7));
    let chest = &report["bodies"][1]["zones"][0];
    assert_eq!((&chest["zone"], &chest["meets"]), (&"chest".into(), &true.into()));
    assert!(chest["mean_mm"].as_f64().expect("a number") > 0.5);
    assert!(!scratch.path().join("out").exists(), "no pictures, no folder");
}
