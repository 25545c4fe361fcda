//! Bad input of every call: an error of the right kind, in one sentence that names the cure.

use crate::{coarse_tee, first_second};
use toile_sdk::glam::{Affine3A, Vec3};
use toile_sdk::{
    Body, DepthFrame, DressOptions, Error, ErrorKind, Garment, Intrinsics, Joint, Joints, Look, Motion, Quality,
    Recording, Scene, Sex, Shopper, TryOnOptions, View, Wind, recommend, try_on,
};

/// That a call is refused, by its kind and with words of the cure.
#[track_caller]
fn refused<T>(result: Result<T, Error>, kind: ErrorKind, words: &[&str]) {
    let Err(error) = result else { panic!("nothing was refused") };
    assert_eq!(error.kind(), kind, "{error}");
    for word in words {
        assert!(error.sentence().contains(word), "no {word:?} in: {error}");
    }
    assert!(!error.sentence().contains('\n'), "{error}");
}

use ErrorKind::{Device, Input, Usage};

#[test]
fn measures_that_no_body_has() {
    let of = |mm: &[(&str, f64)]| Body::from_measures_mm(Sex::Female, mm);
    refused(of(&[("chest", 92.0)]), Input, &["chest_girth", "92 mm", "centimetres", "920 mm"]);
    refused(of(&[("stature", 1.72)]), Input, &["stature", "metres", "1720 mm"]);
    refused(of(&[("waist", 30.0)]), Input, &["waist_girth", "inches", "762 mm"]);
    refused(of(&[("hip", f64::NAN)]), Input, &["hip_girth", "check the measure"]);
    refused(of(&[("wasit", 760.0)]), Input, &["wasit", "waist_girth"]);
    refused(of(&[("chest", 900.0), ("bust", 910.0)]), Input, &["chest_girth", "twice", "once"]);
    let contradictory = [("stature", 1700.0), ("chest", 800.0), ("waist", 1400.0), ("hip", 850.0)];
    refused(of(&contradictory), Input, &["mm", "leave one out"]);
    let body = Body::average(Sex::Male).unwrap();
    refused(body.measure_mm("elbow"), Input, &["elbow", "chest_girth"]);
    refused(Body::open("there-is-no-such.glb", Sex::Male), Input, &["there-is-no-such.glb"]);
}

#[test]
fn garments_that_there_are_not() {
    refused(Garment::open("sun-drses"), Input, &["sun-drses", "strap-dress"]);
    refused(Garment::open("there-is-no-such.obj"), Input, &["there-is-no-such.obj"]);
    refused(Garment::open("there-is-no-such.json"), Input, &["there-is-no-such.json"]);
    refused(Garment::open("tee:coton-lawn"), Input, &["coton-lawn", "cotton-lawn"]);
    let shirt = || Garment::open("tee").unwrap();
    refused(shirt().in_size("gigantic"), Input, &["gigantic", "choose one of"]);
    refused(shirt().in_fabric("coton-lawn"), Input, &["coton-lawn", "cotton-lawn"]);
    refused(shirt().in_fabric("there-is-no-such.toml"), Input, &["there-is-no-such.toml"]);
}

#[test]
fn recordings_without_a_person() {
    refused(Recording::open("there-is-no-such.mcap"), Input, &["there-is-no-such.mcap"]);
    refused(Recording::from_frames("mine", Vec::new(), Vec::new()), Input, &["mine", "no frame"]);
    let frame = Joints::seen(0, [Vec3::Y; 23]);
    refused(Recording::from_frames("mine", vec![frame, frame], Vec::new()), Input, &["mine"]);
    let depth = DepthFrame {
        time_ns: 0,
        intrinsics: Intrinsics::KINECT_V1,
        camera_to_world: Affine3A::IDENTITY,
        depth_mm: Box::new([0; 4]),
    };
    refused(Recording::from_frames("mine", Vec::new(), vec![depth.clone()]), Input, &["4 depths"]);
    let empty = DepthFrame { depth_mm: vec![0; 640 * 480].into(), ..depth };
    let empty = Recording::from_frames("mine", Vec::new(), vec![empty]).unwrap();
    refused(empty.measure(&Shopper::default()), Input, &[]);
    let standing = first_second();
    let by = |name: &str, mm: f64| Shopper { by_tape_mm: vec![(name.to_owned(), mm)], ..Shopper::default() };
    refused(standing.measure(&by("chest", 92.0)), Input, &["chest", "centimetres"]);
    refused(standing.measure(&by("nose", 92.0)), Input, &["nose", "chest_girth"]);
    refused(standing.measure(&by("chest", f64::NAN)), Input, &["chest"]);
}

#[test]
fn dressing_that_cannot_be() {
    let body = Body::average(Sex::Female).unwrap();
    let shirt = coarse_tee();
    refused(Scene::dress(&body, &vec![shirt.clone(); 40]), Input, &["40 garments", "leave some out"]);
    let with = |options: DressOptions| Scene::dress_with(&body, std::slice::from_ref(&shirt), &options);
    let motion = |motion: Motion| with(DressOptions { motion, ..DressOptions::default() });
    refused(with(DressOptions { workers: 3, ..DressOptions::default() }), Input, &["3 workers", "1 or 2"]);
    let wind = |velocity: Vec3, drag: f32| Some(Wind { velocity, drag, lift: 0.1 });
    for wind in [wind(Vec3::splat(1e6), 0.1), wind(Vec3::NAN, 0.1), wind(Vec3::X, -1.0)] {
        refused(with(DressOptions { wind, ..DressOptions::default() }), Input, &["wind", "m/s"]);
    }
    let tuck = vec!["socks".to_owned()];
    refused(with(DressOptions { tuck, ..DressOptions::default() }), Input, &["socks", "tee"]);
    refused(motion(Motion::Track(Vec::new())), Input, &["track", "give one"]);
    refused(motion(Motion::Joints(Box::new(Joints::absent(0)))), Input, &["hips"]);
    let mut frame = Joints::seen(0, [Vec3::Y; 23]);
    refused(motion(Motion::Track(vec![frame, frame])), Input, &["frame 1", "sort"]);
    frame.at_mut(Joint::Head).position.x = f32::NAN;
    refused(motion(Motion::Joints(Box::new(frame))), Input, &["finite", "confidence of 0"]);
    assert!("finest".parse::<Quality>().is_err());
}

#[test]
fn reading_what_is_not_there() {
    let body = Body::average(Sex::Female).unwrap();
    let mut scene = Scene::dress(&body, &[coarse_tee()]).unwrap();
    refused(scene.positions(1), Usage, &["no garment 1", "has 1"]);
    refused(scene.faces(7), Usage, &["no garment 7"]);
    refused(scene.stats(1), Usage, &["no garment 1"]);
    refused(scene.pinned(1), Usage, &["no garment 1"]);
    refused(scene.normals(1), Usage, &["no garment 1"]);
    refused(scene.fit_map(1), Usage, &["no garment 1"]);
    refused(scene.read_positions(0, &mut [Vec3::ZERO; 3]), Usage, &["room", "not 3"]);
    refused(scene.pictures(&[View::Front], [0, 100], Look::Fabric), Usage, &["0 x 100", "give 16"]);
    refused(scene.pictures(&[View::Front], [100, 100_000], Look::Fabric), Usage, &["100000"]);
    refused(scene.step_to(&Joints::absent(0)), Input, &["hips"]);
    let options = TryOnOptions { picture: Some([1, 1]), ..TryOnOptions::default() };
    refused(try_on(&first_second(), &[], &options), Usage, &["1 x 1"]);
    let picture = &scene.pictures(&[View::Front], [16, 16], Look::FitMap).unwrap()[0];
    refused(
        picture.write_png("there-is-no-such-folder/a.png"),
        Device,
        &["there-is-no-such-folder", "folder that exists"],
    );
}

#[test]
fn scene_files_say_where_and_what_helps() {
    let grid = "[garment]\ngrid = { rows = 4, columns = 4, width = 0.2, height = 0.2 }\n";
    let of = |text: &str| Scene::parse("a.toml", text, &[]);
    refused(of("duration ="), Input, &["a.toml:1"]);
    refused(of(&format!("winds = 3\n{grid}")), Input, &["a.toml:1:1", "winds"]);
    refused(of(&format!("{grid}pins = [0]\n")), Input, &["a.toml:3", "pin"]);
    refused(of(&format!("{grid}pin = {{ vertices = [99] }}\n")), Input, &["a.toml:3", "99"]);
    refused(of(&format!("{grid}fabric = \"coton-lawn\"\n")), Input, &["a.toml:3", "cotton-lawn"]);
    refused(of("[garment]\nmesh = \"flag.obj\"\n"), Input, &["a.toml:2", "flag.obj", "given along"]);
    // No file of the machine is read where files are given.
    refused(of("[garment]\nmesh = \"/etc/hostname.obj\"\n"), Input, &["given along"]);
    refused(Scene::open("there-is-no-such.toml"), Input, &["there-is-no-such.toml", "give the path"]);
    let mut scene = of(grid).unwrap();
    refused(scene.body(), Usage, &["no body", "dress a body"]);
    refused(scene.fit_map(0), Usage, &["no body"]);
    refused(scene.step_to(&Joints::absent(0)), Usage, &["no body"]);
    refused(scene.pictures(&[View::Front], [32, 32], Look::FitMap), Usage, &["fit map"]);
}

#[test]
fn meshes_that_are_no_cloth() {
    let corner = [Vec3::ZERO, Vec3::X * 0.1, Vec3::Y * 0.1];
    let of = |positions: &[Vec3], triangles: &[[u32; 3]], pins: &[u32], fabric: &str| {
        Scene::of_mesh(positions, triangles, pins, fabric)
    };
    refused(of(&corner, &[[0, 1, 3]], &[], "cotton-lawn"), Input, &["triangle 0", "counted from 0"]);
    refused(of(&corner, &[[0, 1, u32::MAX]], &[], "cotton-lawn"), Input, &["triangle 0"]);
    refused(of(&corner, &[[0, 1, 2]], &[3], "cotton-lawn"), Input, &["3"]);
    refused(of(&corner, &[[0, 1, 2]], &[], "coton-lawn"), Input, &["cotton-lawn"]);
    refused(of(&corner, &[[0, 1, 2]], &[], "a\"\nb"), Input, &[]);
    refused(of(&[], &[], &[], "cotton-lawn"), Input, &[]);
    refused(of(&[Vec3::NAN, corner[1], corner[2]], &[[0, 1, 2]], &[], "cotton-lawn"), Input, &[]);
}

#[test]
fn a_mesh_without_sizes_is_not_guessed_at() {
    let path = std::env::temp_dir().join(format!("toile-sdk-{}-plain.obj", std::process::id()));
    let ring =
        |y: f32| (0..24).map(move |k| (k as f32 / 24.0 * std::f32::consts::TAU).sin_cos()).map(move |(s, c)| (c, y, s));
    let mut text = String::new();
    for (x, y, z) in (0..10).flat_map(|row| ring(1.2 - 0.05 * row as f32)) {
        text.push_str(&format!("v {} {y} {}\n", 0.25 * x, 0.2 * z));
    }
    for v in 0..9 * 24 {
        let (row, k) = (v / 24, v % 24);
        let [a, b] = [row * 24 + k + 1, row * 24 + (k + 1) % 24 + 1];
        text.push_str(&format!("f {a} {b} {} {}\n", b + 24, a + 24));
    }
    std::fs::write(&path, text).unwrap();
    let garment = Garment::open(path.to_str().unwrap()).unwrap();
    _ = std::fs::remove_file(&path);
    assert!(garment.sizes().unwrap().is_empty());
    let body = Body::average(Sex::Female).unwrap();
    refused(recommend(&body, &garment), Input, &["without sizes", "TOML"]);
    refused(garment.in_size("38"), Input, &["one size", "TOML"]);
}

#[test]
fn what_follows_a_track_is_not_moved_by_hand() {
    let recording = first_second();
    let measured = recording.measure(&Shopper::default()).unwrap();
    let track = recording.track(&measured).unwrap();
    let (first, body) = (track[0], measured.body().unwrap());
    let options = DressOptions { motion: Motion::Track(track), ..DressOptions::default() };
    let mut scene = Scene::dress_with(&body, &[], &options).unwrap();
    refused(scene.step_to(&first), Usage, &["follows a track", "in joints"]);
}
