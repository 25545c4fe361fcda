//! Exports, and a body that moves by itself, as a script meets them.

use std::fs;

use crate::common::Scratch;

/// The 32-bit floats of the bytes from a place on.
fn floats(bytes: &[u8], from: usize, read: fn([u8; 4]) -> f32) -> Vec<u32> {
    bytes[from..].chunks_exact(4).map(|b| read(b.try_into().expect("four bytes")).to_bits()).collect()
}

#[test]
fn a_scene_has_the_same_bits_in_every_format() {
    let scratch = Scratch::new("export-scene");
    let write = |format: &str| {
        let line = ["run", "--example", "cloth-on-sphere", "--frames", "24", "--every", "4", "--dump", format];
        let output = scratch.toile(&[&line[..], &["--dump-format", format, "--quiet"]].concat());
        assert!(output.status.success(), "{format}: {}", String::from_utf8_lossy(&output.stderr));
    };
    ["ply", "pc2", "mdd", "usd", "glb"].into_iter().for_each(write);
    let file = |name: &str| fs::read(scratch.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    let mut names: Vec<String> = fs::read_dir(scratch.path().join("pc2"))
        .expect("the folder")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let stem = names[0].strip_suffix(".mtl").expect("the material first").to_owned();
    assert_eq!(names, ["mtl", "obj", "pc2"].map(|ending| format!("{stem}.{ending}")));
    let garment = stem.strip_prefix("cloth-on-sphere-").expect("the scene's name first").to_owned();
    let (pc2, mdd) = (file(&format!("pc2/{stem}.pc2")), file(&format!("mdd/{stem}.mdd")));
    let points = u32::from_le_bytes(pc2[16..20].try_into().expect("four bytes")) as usize;
    let (little, big) = (floats(&pc2, 32, f32::from_le_bytes), floats(&mdd, 8 + 4 * 7, f32::from_be_bytes));
    assert!(points > 100 && little.len() == 7 * 3 * points && little == big);
    let usd = fs::read_to_string(scratch.path().join(format!("usd/{stem}.usda"))).expect("a text");
    for frame in 0..7 {
        let ply = file(&format!("ply/{garment}-{frame:06}.ply"));
        let start = ply.windows(11).position(|w| w == b"end_header\n").expect("a head") + 11;
        let own = floats(&ply[start..start + 12 * points], 0, f32::from_le_bytes);
        assert_eq!(own, little[3 * points * frame..3 * points * (frame + 1)], "frame {frame}");
        let line = usd.lines().find_map(|l| l.trim().strip_prefix(&format!("{frame}: ["))).expect("a time sample");
        let read: Vec<u32> = line
            .split(['(', ')', ',', ' ', ']'])
            .filter_map(|word| word.parse::<f32>().ok())
            .map(f32::to_bits)
            .collect();
        assert_eq!(read, own, "frame {frame}");
    }
    assert!(file("usd/cloth-on-sphere.usda").starts_with(b"#usda 1.0"));
    assert!(file("glb/cloth-on-sphere.glb").starts_with(b"glTF"));
}

#[test]
fn a_session_that_was_exported_is_played_again_as_an_animation() {
    let scratch = Scratch::new("export-again");
    scratch.record_short();
    let run = |args: &[&str]| {
        let output = scratch.toile(args);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).expect("one JSON object")
    };
    let line = ["try-on", "--session", "short.mcap", "--no-pictures", "--json"];
    let own = run(&[&line[..], &["--export", "glb", "--export-rate", "60", "--out", "a"]].concat());
    assert_eq!((&own["export"]["formats"][0], &own["export"]["rate_hz"]), (&"glb".into(), &60.into()));
    let frames = own["export"]["frames"].as_u64().expect("a count");
    assert_eq!(frames, own["physics"]["steps"].as_u64().expect("a count").div_ceil(2));
    let again =
        ["try-on", "--no-pictures", "--json", "--body", "a/session.glb", "--animation", "session", "--out", "b"];
    let again = run(&again);
    assert_eq!(again["physics"]["steps"], 2 * (frames - 1));
    assert_eq!(again["physics"]["nonfinite"], 0);
    // The skin is ours; between the two are blending and the limbs' twist, which bones that are not read share out.
    let animation = &again["animation"];
    assert!(animation["skin_mean_mm"].as_f64().expect("a number") < 1.0, "{animation}");
    assert!(animation["skin_max_mm"].as_f64().expect("a number") < 40.0, "{animation}");
    let refused = |args: &[&str], code: i32, expected: &str| {
        let output = scratch.toile(args);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {text}");
        assert!(text.contains(expected), "{args:?}: {text}");
        assert!(!scratch.path().join("out").exists(), "{args:?} leaves a folder behind");
    };
    let file = ["try-on", "--no-pictures", "--body", "a/session.glb"];
    refused(
        &[&file[..], &["--animation", "run"]].concat(),
        4,
        "a/session.glb: it has no animation named run, only session",
    );
    refused(&["try-on", "--body", "male", "--animation", "run"], 2, "belongs to a .glb, .gltf or .vrm file");
    refused(&["try-on", "--animation", "run"], 2, "--body");
    refused(&["try-on", "--export", "glb", "--export-rate", "50"], 2, "120 steps a second");
    refused(&["try-on", "--export", "fbx"], 2, "fbx");
    fs::create_dir_all(scratch.path().join("taken/session.glb")).expect("the test's own folder");
    refused(
        &["try-on", "--no-pictures", "--export", "glb", "--out", "taken"],
        4,
        "is a folder, which is not overwritten",
    );
}
