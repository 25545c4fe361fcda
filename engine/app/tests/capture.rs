//! `toile capture body` and `toile capture face` with input that cannot be used, as a script meets them.

mod common;

use std::fs;

use common::{Scratch, sentence};

/// Two cameras at a right angle, 3 m from the middle, in the format of Pose2Sim.
const CAMERAS: &str = "[cam1]\nname = \"cam1\"\nsize = [60.0, 80.0]\nmatrix = [[80.0, 0.0, 29.5], [0.0, 80.0, 39.5], [0.0, 0.0, 1.0]]\n\
    distortions = [0.0, 0.0, 0.0, 0.0]\nrotation = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]\ntranslation = [0.0, 0.9, 3.0]\n\
    fisheye = false\n[cam2]\nname = \"cam2\"\nsize = [60.0, 80.0]\nmatrix = [[80.0, 0.0, 29.5], [0.0, 80.0, 39.5], [0.0, 0.0, 1.0]]\n\
    distortions = [0.0, 0.0, 0.0, 0.0]\nrotation = [[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]]\ntranslation = [0.0, 0.9, 3.0]\n\
    fisheye = false\n";

fn png(scratch: &Scratch, name: &str, [width, height]: [u32; 2], white: impl Fn(u32, u32) -> bool) {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    let pixels: Vec<u8> = (0..width * height).map(|i| if white(i % width, i / width) { 255 } else { 0 }).collect();
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
    let path = scratch.path().join(name);
    fs::create_dir_all(path.parent().expect("it lies in a folder")).unwrap();
    fs::write(path, bytes).unwrap();
}

#[test]
fn silhouettes_of_nobody_are_one_sentence() {
    let scratch = Scratch::new("capture-body");
    fs::write(scratch.path().join("cams.toml"), CAMERAS).unwrap();
    let small = |x: u32, y: u32| (27..33).contains(&x) && (36..43).contains(&y);
    let tall = |x: u32, y: u32| (20..40).contains(&x) && (15..63).contains(&y);
    type White<'a> = &'a dyn Fn(u32, u32) -> bool;
    let all: [(&str, [u32; 2], White); 5] = [
        ("black", [60, 80], &|_, _| false),
        ("white", [60, 80], &|_, _| true),
        ("other", [30, 40], &small),
        ("small", [60, 80], &small),
        ("box", [60, 80], &tall),
    ];
    for (folder, size, white) in all {
        for camera in ["a.png", "b.png"] {
            png(&scratch, &format!("{folder}/{camera}"), size, white);
        }
    }
    png(&scratch, "one/a.png", [60, 80], tall);
    for (folder, wanted) in [
        ("absent", "absent"),
        ("one", "1 pictures for 2 cameras"),
        ("black", "0.00 % of it is a person's"),
        ("white", "turn black and white round"),
        ("other", "it has 30 x 40 pixels and its camera 60 x 80"),
        ("small", "which no standing person is"),
        ("box", "share only"),
    ] {
        let output = scratch.toile(&["capture", "body", folder, "--calibration", "cams.toml"]);
        let said = sentence(&output);
        assert!(output.status.code() == Some(4) && said.contains(wanted), "{folder}: {said}");
    }
    let output = scratch.toile(&["capture", "body", "box", "--calibration", "cams.toml", "--up", "w"]);
    assert!(output.status.code() == Some(2) && sentence(&output).contains("x, y or z"));
}

#[test]
fn faces_that_nobody_has_are_one_sentence() {
    let scratch = Scratch::new("capture-face");
    png(&scratch, "a.png", [300, 400], |x, y| x > y);
    let write = |name: &str, text: &str| fs::write(scratch.path().join(name), text).unwrap();
    let photograph = |points: &str| format!("{{\"picture\": \"a.png\", \"points\": {points}}}");
    let file = |all: &[String]| format!("{{\"photographs\": [{}]}}", all.join(","));
    // Anywhere: no head has its points so.
    let wild: Vec<String> = (0..68).map(|i| format!("[{}, {}]", (i * 7919) % 300, (i * 104_729) % 400)).collect();
    let wild = photograph(&format!("[{}]", wild.join(",")));
    write("none.json", "{}");
    write("few.json", &file(&[photograph("{\"30\": [10, 10]}")]));
    write("order.json", &file(&[photograph("[[1, 2], [3, 4]]")]));
    write("two.json", &file(&[wild.clone(), wild.clone()]));
    write("wild.json", &file(std::slice::from_ref(&wild)));
    write("gone.json", &file(&[wild.replace("a.png", "gone.png")]));
    for (name, code, wanted) in [
        ("absent.json", 4, "absent.json"),
        ("none.json", 4, "it holds no marked photographs"),
        ("few.json", 4, "1 points are marked and 8 are needed"),
        ("order.json", 4, "2 points, which is no order that is known"),
        ("two.json", 2, "2 photographs need --calibration"),
        ("gone.json", 4, "gone.png"),
        ("wild.json", 4, "any head that stands before these cameras"),
    ] {
        let output = scratch.toile(&["capture", "face", name]);
        let said = sentence(&output);
        assert!(output.status.code() == Some(code) && said.contains(wanted), "{name}: {said}");
    }
}
