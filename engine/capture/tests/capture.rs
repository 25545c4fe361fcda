//! `toile-capture body` and `toile-capture face` as a script meets them: sequences, and input that cannot be used.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::common::{Scratch, sentence};
use glam::DVec3;
use toile_assets::body::shape::Shapes;
use toile_base::body::Sex;
use toile_pose::depth_buffer::DepthBuffer;
use toile_pose::face::FaceLandmarks;
use toile_pose::files::{self, NetworkPackage};

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
fn silhouettes_without_a_person_are_one_sentence() {
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
        let output = scratch.toile(&["body", folder, "--calibration", "cams.toml"]);
        let said = sentence(&output);
        assert!(output.status.code() == Some(4) && said.contains(wanted), "{folder}: {said}");
    }
    let output = scratch.toile(&["body", "box", "--calibration", "cams.toml", "--up", "w"]);
    assert!(output.status.code() == Some(2) && sentence(&output).contains("x, y or z"));
}

#[test]
fn a_sequence_of_silhouettes_is_followed_and_written() {
    let scratch = Scratch::new("capture-body-frames");
    // Pictures of 240 x 320 pixels.
    let larger =
        CAMERAS.replace("80.0", "320.0").replace("60.0", "240.0").replace("29.5", "119.5").replace("39.5", "159.5");
    fs::write(scratch.path().join("cams.toml"), larger).unwrap();
    let rig = toile_sensors::calibration::open(&scratch.path().join("cams.toml")).unwrap();
    let body = Shapes::of(Sex::Female).base();
    for (frame, camera) in (0..4).flat_map(|frame| [0, 1].map(|camera| (frame, camera))) {
        let along = DVec3::new(0.02, 0.0, 0.03) * f64::from(frame);
        let positions: Vec<DVec3> = body.positions.iter().map(|p| p.as_dvec3() + along).collect();
        let mut buffer = DepthBuffer::new([240, 320], 1.0);
        buffer.draw(&rig.cameras[camera], &positions, &body.triangles);
        // No person is in view in the third frame.
        let white = |x: u32, y: u32| frame != 2 && buffer.triangle[(y * 240 + x) as usize] != u32::MAX;
        png(&scratch, &format!("masks/cam{}/{frame:03}.png", camera + 1), [240, 320], white);
    }
    let said = scratch.toile(&[
        "body",
        "masks",
        "--calibration",
        "cams.toml",
        "--sex",
        "female",
        "--rate",
        "60",
        "--out",
        "moved",
        "--json",
    ]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let report: serde_json::Value = serde_json::from_slice(&said.stdout).unwrap();
    let frames = report["motion"]["frames"].as_array().unwrap();
    let found: Vec<bool> = frames.iter().map(|f| f["found"].as_bool().unwrap()).collect();
    assert_eq!(found, [true, false, true]);
    let pelvis = |k: usize| frames[k]["places"][0][2].as_f64().unwrap();
    assert!((pelvis(2) - pelvis(0) - 0.06).abs() < 0.02, "{} {}", pelvis(0), pelvis(2));
    assert_eq!(pelvis(1), pelvis(0), "who is not seen stands where they were");
    let trc = fs::read_to_string(scratch.path().join("moved/joints.trc")).unwrap();
    assert!(trc.lines().nth(2).unwrap().starts_with("60\t60\t3\t23\tm") && trc.contains("leftUpperArm"));
    for file in ["body.ply", "silhouettes.png", "motion.glb", "last.png"] {
        assert!(scratch.path().join("moved").join(file).is_file(), "{file}");
    }
    // A frame that one camera has not.
    fs::remove_file(scratch.path().join("masks/cam2/001.png")).unwrap();
    let output = scratch.toile(&["body", "masks", "--calibration", "cams.toml"]);
    assert!(output.status.code() == Some(4) && sentence(&output).contains("camera cam2 has no frame 1"));
}

#[test]
fn impossible_faces_are_one_sentence() {
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
    let with = |more: &str| wild.replacen("\"points\"", &format!("{more}, \"points\""), 1);
    write("dot.json", &file(&[with("\"outline\": [[3, 4]]")]));
    let sequence = |all: &[String]| file(all).replacen('{', "{\"sequence\": true, ", 1);
    let corner = "\"outline\": [[2, 2], [290, 2], [290, 300]], \"points\"";
    write("corner.json", &file(&[mannequin(0.0).replacen("\"points\"", corner, 1)]));
    write("empty.json", &sequence(&[photograph("[]"), photograph("[]")]));
    write("cameras.json", &sequence(&[wild.clone(), with("\"camera\": \"cam2\"")]));
    write("outlined.json", &sequence(&[with("\"outline\": [[3, 4], [5, 6]]")]));
    write("frames.json", &sequence(&[wild.clone(), wild.clone()]));
    for (name, code, wanted) in [
        ("absent.json", 4, "absent.json"),
        ("none.json", 4, "it holds no marked photographs"),
        ("few.json", 4, "1 points are marked and 8 are needed"),
        ("order.json", 4, "2 points, which is no order that is known"),
        ("two.json", 2, "2 photographs need --calibration"),
        ("gone.json", 4, "gone.png"),
        ("wild.json", 4, "any head that stands before these cameras"),
        ("dot.json", 4, "a.png: an outline of 1 points is no curve"),
        ("corner.json", 4, "lie near the rim of the head; mark where the head itself ends"),
        ("empty.json", 4, "none of the first 2 has 8 points"),
        ("cameras.json", 4, "a sequence is of one camera"),
        ("outlined.json", 4, "an outline in a sequence"),
        ("frames.json", 4, "any head that stands before these cameras"),
    ] {
        let output = scratch.toile(&["face", name]);
        let said = sentence(&output);
        assert!(output.status.code() == Some(code) && said.contains(wanted), "{name}: {said}");
    }
    let output = scratch.toile(&["face", "wild.json", "--picture"]);
    assert!(output.status.code() == Some(2) && sentence(&output).contains("--out"));
}

/// The mannequin's own points, 1.2 m before a camera of 300 x 400 pixels, so far to the side (m).
fn mannequin(aside: f64) -> String {
    let base = Shapes::of(Sex::Female).base();
    let positions: Vec<DVec3> = base.positions.iter().map(|p| p.as_dvec3()).collect();
    let points = FaceLandmarks::new().on(&positions);
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let seen = |p: &DVec3| {
        let p = *p - middle;
        let depth = 1.2 - p.z;
        format!("[{:.3}, {:.3}]", 149.5 + 900.0 * (p.x + aside) / depth, 199.5 - 900.0 * p.y / depth)
    };
    let points: Vec<String> = points.iter().map(seen).collect();
    format!("{{\"picture\": \"a.png\", \"focal_px\": 900, \"points\": [{}]}}", points.join(","))
}

#[test]
fn a_sequence_is_reported_frame_by_frame_and_its_head_has_hair() {
    let scratch = Scratch::new("capture-frames");
    png(&scratch, "a.png", [300, 400], |x, y| x > y);
    let frames =
        [mannequin(0.0), "{\"picture\": \"a.png\", \"focal_px\": 900, \"points\": []}".to_owned(), mannequin(0.02)];
    let text = format!("{{\"sequence\": true, \"photographs\": [{}]}}", frames.join(","));
    fs::write(scratch.path().join("frames.json"), text).unwrap();
    let output = scratch.toile(&["face", "frames.json", "--hair", "bun", "--out", "head", "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let frames = report["sequence"]["frames"].as_array().unwrap();
    let found: Vec<bool> = frames.iter().map(|f| f["found"].as_bool().unwrap()).collect();
    assert_eq!((found, report["sequence"]["lost"].as_u64()), (vec![true, false, true], Some(1)));
    let x = |k: usize| frames[k]["place_mm"][0].as_f64().unwrap();
    assert!((x(2) - x(0) - 20.0).abs() < 1.0 && frames[2]["smile"].as_f64().unwrap() < 0.05, "{} {}", x(0), x(2));
    assert!(frames[1].get("yaw_degrees").is_none() && frames[1]["residual_px"].is_null());
    let obj = fs::read_to_string(scratch.path().join("head/head.obj")).unwrap();
    assert!(obj.contains("o hair\nusemtl hair\n"));
    assert!(fs::read_to_string(scratch.path().join("head/head.mtl")).unwrap().contains("newmtl hair"));
    assert_eq!(fs::read(scratch.path().join("head/report.json")).unwrap().first(), Some(&b'{'));
}

/// Looks for a face in `a.png` with the networks of a folder.
fn seen_with(scratch: &Scratch, networks: &Path) -> Output {
    let mut command = Command::new(crate::PROGRAM);
    command.stdin(Stdio::null()).current_dir(scratch.path()).env("XDG_RUNTIME_DIR", scratch.path());
    command.env(files::FOLDER_VARIABLE, networks).args(["face", "a.png"]).output().unwrap()
}

#[test]
fn without_its_network_a_face_is_refused_with_the_command_that_fetches_it() {
    let scratch = Scratch::new("face-refused");
    image::RgbImage::new(64, 64).save(scratch.path().join("a.png")).unwrap();
    let refused = seen_with(&scratch, scratch.path());
    let words = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(5), "{words}");
    assert!(words.contains(files::FETCH_FACE) && words.lines().count() == 1, "{words}");
    if NetworkPackage::Face.check(&files::folder()).is_ok() {
        let refused = seen_with(&scratch, &files::folder());
        let words = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(4), "{words}");
        assert!(words.contains("a.png: no face is seen; give one of a face from before"), "{words}");
    }
}
