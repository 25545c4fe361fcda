//! Tests of scene files: what they mean, and the message of every mistake.

use glam::{Quat, Vec3};

use super::*;
use crate::scene::skirt::{self, SkirtMotion};
use toile_base::garment::Solver;
use toile_base::limits::MAX_SPHERES;

/// A scene in which every key of the schema stands once.
const EVERY_KEY: &str = r#"name = "all"
duration = 1
step_hz = 60
measure_from = 0.5
gravity = [0, -1.62, 0]
bad_rows = "refuse"

[wind]
velocity = [1, 0, 0]
drag = 0.2
lift = 0.1

[settings]
quality = "fine"
substeps = 6
max_speed = 20
stretch_damping = 0.01
lanes = 8
layers = false
folds = true

[[garment]]
name = "cloth"
grid = { rows = 4, columns = 3, width = 0.2, height = 0.3, plane = "upright" }
weld = true
scale = 2
rotation_deg = [0, 90, 0]
position = [0, 1, 0]
velocity = [0, 0, 1]
mass = 0.5
tuck = false
solver = { warp = "zero-stretch", weft = "semi-implicit", waistband = "gauss-seidel", hem = "zero-stretch" }

[garment.fabric]
base = "linen-twill"
density_kg_m2 = 0.2
stretch_warp_n_m = inf
stretch_weft_n_m = 1000
shear_n_m = 100
bend_warp_un_m = 9
bend_weft_un_m = 8
bend_bias_un_m = 7
friction = 0.4
damping_per_s = 1
contact_offset_mm = 2
thickness_mm = 3

[[garment.pin]]
vertices = [0, "1-2"]
track = "pin.csv"

[[garment.mass_patch]]
factor = 10
box = [[-1, -1, -1], [1, 0.5, 1]]

[[garment]]
name = "pipe"
tube = { rows = 3, columns = 8, top_radius = 0.1, bottom_radius = 0.2, height = 0.3 }
fabric = "cotton-lawn"

[[garment.mass_patch]]
factor = 2
vertices = [0]

[[garment]]
name = "file"
mesh = "cloth.obj"
fabric = { file = "own.toml" }

[[garment.pin]]
box = [[-9, -9, -9], [9, 0.01, 9]]

[[garment.pin]]
material = "Band"

[[garment]]
skirt = { side = 8, layout = "irregular" }

[[garment.pin]]
vertices = ["0-7"]
motion = "fast"

[colliders]
capsules = [[0, 1]]

[[colliders.sphere]]
centre = [0, 1, 0]
radius = 0.1

[[colliders.sphere]]
track = "ball.csv"

[[colliders.plane]]
point = [0, -1, 0]
normal = [0, 2, 0]
"#;

const FILES: &[(&str, &str)] = &[
    ("pin.csv", "0, 0,0,0, 0,0,0,1\n1, 1,0,0, 0,0,0,1\n"),
    ("ball.csv", "0, 0,0,0,0.1\n1, 2,0,0,0.3\n"),
    ("two.csv", "0, 0,0,0,0.1, 1,0,0,0.2\n"),
    ("own.toml", include_str!("../../data/fabrics/cotton-jersey.toml")),
    (
        "cloth.obj",
        "v 0 0 0\nv 1 0 0\nv 9 9 9\nv 1 1 0\nv 0 1 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\nv 1 2 0\n\
         usemtl Band\nf 1 2 4 5\nusemtl ClothFree\nf 7 6 9 8\n",
    ),
];

fn parse(text: &str) -> Result<SceneFile, SceneError> {
    SceneFile::parse("test.toml", text, SceneSource::Inside(FILES))
}

/// The sentence of a refusal, and its line.
fn refusal(text: &str) -> (usize, String) {
    match parse(text) {
        Err(SceneError::At { line, message: problem, .. }) => (line, problem),
        other => panic!("not refused: {other:?}\n{text}"),
    }
}

#[test]
fn every_key_of_the_schema_is_read() {
    let scene = parse(EVERY_KEY).unwrap();
    for key in schema::KEYS {
        // `colliders.track` and spheres of its own exclude each other; it has a test of its own.
        let named = EVERY_KEY.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| word == key.name);
        assert!(named, "{} does not stand in the test's scene", key.path());
    }
    assert_eq!((scene.steps(), scene.gravity.y, scene.measure_from), (60, -1.62, 0.5));
    assert_eq!(scene.wind, Some(Wind { velocity: Vec3::X, drag: 0.2, lift: 0.1 }));
    let settings = SceneSettings {
        quality: Some("fine"),
        substeps: Some(6),
        max_speed: Some(20.0),
        stretch_damping: Some(0.01),
        lanes: Some(8),
        layers: Some(false),
        folds: Some(true),
    };
    assert_eq!(scene.settings, settings);
    let cloth = &scene.garments[0];
    assert_eq!((cloth.fabric.name.as_str(), cloth.fabric.stretch_warp_n_m), ("linen-twill", f32::INFINITY));
    assert_eq!((cloth.fabric.friction, cloth.velocity), (0.4, Vec3::Z));
    let solver = cloth.shape.solver;
    assert_eq!([solver.warp, solver.weft], [Some(Solver::ZeroStretch), Some(Solver::SemiImplicit)]);
    assert_eq!(
        [solver.waistband, solver.hem, solver.bias],
        [Some(Solver::GaussSeidel), Some(Solver::ZeroStretch), None]
    );
    assert_eq!(scene.garments[2].fabric.name, "cotton-jersey");
    assert_eq!(scene.colliders.planes, [ScenePlane { point: Vec3::NEG_Y, normal: Vec3::Y }]);
    assert_eq!(scene.colliders.sphere(1, 0.5), glam::Vec4::new(1.0, 0.0, 0.0, 0.2));
    assert_eq!(scene.colliders.sphere(0, 0.5), glam::Vec4::new(0.0, 1.0, 0.0, 0.1));
}

#[test]
fn a_mesh_is_scaled_then_turned_then_moved() {
    let scene = parse(EVERY_KEY).unwrap();
    // Vertex (3, 2): x = 0.1, y = -0.3 as it was made.
    let p = Quat::from_rotation_y(90f32.to_radians()) * (Vec3::new(0.1, -0.3, 0.0) * 2.0) + Vec3::Y;
    assert!(scene.garments[0].mesh.start[11].distance(p) < 1e-6);
    let plain = "[garment]\ngrid = { rows = 2, columns = 2, width = 1, height = 1 }\n";
    let turned = parse(&format!("{plain}rotation_deg = [90, 90, 0]\n")).unwrap();
    // About x first: (-0.5, -1, 0) -> (-0.5, 0, -1); then about y: -> (-1, 0, 0.5).
    assert!(turned.garments[0].mesh.start[2].distance(Vec3::new(-1.0, 0.0, 0.5)) < 1e-6);
}

#[test]
fn a_file_keeps_its_order_is_sewn_and_held_by_material() {
    let scene = parse(EVERY_KEY).unwrap();
    let garment = &scene.garments[2];
    assert_eq!(garment.mesh.start.len(), 9);
    // Vertex 2 is loose; 5 and 6 lie on 3 and 4.
    assert_eq!(garment.mesh.to_shape, [0, 1, u32::MAX, 2, 3, 2, 3, 4, 5]);
    assert_eq!(garment.mesh.faces, [[0, 1, 3, 4], [6, 5, 8, 7]]);
    assert_eq!(garment.shape.fixed, [true, true, true, true, false, false]);
    let torn = parse("[garment]\nmesh = \"cloth.obj\"\nweld = false\n").unwrap();
    assert_eq!(torn.garments[0].shape.cut.len(), 8);
}

#[test]
fn pins_follow_their_track_and_masses_their_patches() {
    let scene = parse(EVERY_KEY).unwrap();
    let shape = &scene.garments[0].shape;
    let fixed: Vec<usize> = (0..12).filter(|i| shape.fixed[*i]).collect();
    assert_eq!(fixed, [0, 1, 2]);
    assert!(fixed.iter().all(|i| shape.weights[*i].bones[0] == 1 && shape.weights[*i].weights[0] == 1.0));
    assert_eq!(scene.pins.len(), 2, "the track, and the motion of another garment");
    // 0.5 kg by the scene; the last row, below y = 0.5, is ten times heavier on top of that.
    let area = 0.4 * 0.6 * f64::from(0.2f32);
    let (plain, heavy) = (shape.heavier[0], shape.heavier[11]);
    assert!((f64::from(plain) - 0.5 / area).abs() < 1e-5 && (heavy / plain - 10.0).abs() < 1e-5);
    assert_eq!((0..4).filter(|row| shape.heavier[3 * row] > plain).count(), 1, "{:?}", shape.heavier);
    assert!(
        parse("[garment]\ngrid = { rows = 2, columns = 2, width = 1, height = 1 }\n").unwrap().garments[0]
            .shape
            .heavier
            .is_empty()
    );
}

#[test]
fn warp_runs_away_from_the_pins_and_every_thread_keeps_its_stiffness() {
    let text = "[garment]\ngrid = { rows = 3, columns = 4, width = 3, height = 2 }\n\
        fabric = { stretch_warp_n_m = 100, stretch_weft_n_m = 200, bend_warp_un_m = 1, bend_weft_un_m = 2 }\n";
    let (by_top, by_side) = ("pin = { vertices = [\"0-3\"] }\n", "pin = { vertices = [0, 4, 8] }\n");
    for (pins, stiffness, along) in [(by_top, [100.0, 200.0], Vec3::Y), (by_side, [200.0, 100.0], Vec3::X)] {
        let garment = &parse(&format!("{text}{pins}")).unwrap().garments[0];
        let fabric = &garment.fabric;
        assert_eq!([fabric.stretch_warp_n_m, fabric.stretch_weft_n_m], stiffness);
        assert_eq!(fabric.bend_warp_un_m * 100.0, stiffness[0]);
        for face in &garment.shape.faces {
            let [a, _, _, d] = face.map(|v| garment.shape.cut[v as usize]);
            assert!((d - a).dot(along).abs() > 0.99, "warp runs along {along}");
        }
        let sets = |triangles: Vec<[u32; 3]>| {
            let mut all: Vec<[u32; 3]> = triangles
                .into_iter()
                .map(|mut t| {
                    t.sort_unstable();
                    t
                })
                .collect();
            all.sort_unstable();
            all
        };
        let plain = parse(text).unwrap().garments[0].shape.triangles();
        assert_eq!(sets(garment.shape.triangles()), sets(plain), "quads are split as before");
    }
}

#[test]
fn the_benchmarks_body_and_skirt_are_built_in() {
    let text = "[garment]\nskirt = { side = 8 }\nmass = 0.31\npin = { vertices = [\"0-7\"], motion = \"walk\" }\n\
        [colliders]\nmotion = \"walk\"\n";
    let scene = parse(text).unwrap();
    let (own, theirs) = (&scene.garments[0].shape, skirt::shape(8));
    assert_eq!((&own.cut, &own.faces, &own.split), (&theirs.cut, &theirs.faces, &theirs.split));
    assert_eq!(own.fixed, theirs.fixed);
    assert_eq!((scene.colliders.spheres(), scene.colliders.capsules.len()), (16, 28));
    assert_eq!(scene.colliders.sphere(9, 1.7), skirt::spheres(SkirtMotion::Walk, 1.7)[9]);
    assert_eq!(scene.pins[0].at(1.7), skirt::root(SkirtMotion::Walk, 1.7));
    assert!(refusal(&text.replace("walk\"\n", "walk\"\ncapsules = [[0, 1]]\n")).1.contains("of its own"));
    assert!(
        refusal(&text.replace("motion = \"walk\" }", "motion = \"walk\", track = \"pin.csv\" }"))
            .1
            .contains("one of them")
    );
}

#[test]
fn one_track_may_move_all_spheres() {
    let scene = parse(
        "[garment]\ntube = { rows = 2, columns = 3, top_radius = 1, bottom_radius = 1, height = 1 }\n\
        [colliders]\ntrack = \"two.csv\"\n",
    )
    .unwrap();
    assert_eq!(scene.colliders.spheres(), 2);
    assert_eq!(scene.colliders.capsules, [[0, 0], [1, 1]], "a sphere in no capsule is one of its own");
    assert_eq!(scene.colliders.sphere(1, 7.0), glam::Vec4::new(1.0, 0.0, 0.0, 0.2));
}

/// The scene's lines that hold a key, with the line's number from 1.
fn key_lines() -> impl Iterator<Item = (usize, &'static str, &'static str)> {
    let lines = EVERY_KEY.lines().enumerate();
    lines.filter_map(|(i, line)| line.split_once(" = ").map(|(key, value)| (i + 1, key, value)))
}

fn with_line(number: usize, line: &str) -> String {
    EVERY_KEY.lines().enumerate().map(|(i, l)| if i + 1 == number { line } else { l }.to_owned() + "\n").collect()
}

#[test]
fn every_key_mistyped_is_told_with_its_line_and_the_key_that_was_meant() {
    for (number, key, value) in key_lines() {
        let mut letters: Vec<char> = key.chars().collect();
        let last = letters.len() - 1;
        letters.swap(last, last - 1);
        letters.push('x');
        let wrong: String = letters.into_iter().collect();
        let (line, problem) = refusal(&with_line(number, &format!("{wrong} = {value}")));
        assert_eq!(line, number, "{problem}");
        assert!(problem.contains(&format!("\"{wrong}\"")) && problem.contains(&format!("\"{key}\"")), "{problem}");
    }
}

#[test]
fn every_value_of_another_kind_is_told_with_its_line_and_what_is_taken() {
    for (number, key, _) in key_lines() {
        for value in ["1979-05-27", "[[[]]]", "nan", "-1e300", "\"\"", "{ zz = 1 }", "\"no such thing\"", "[]"] {
            let text = with_line(number, &format!("{key} = {value}"));
            // A name may be any text, and an empty list holds nothing.
            let taken = key == "name" && value == "\"no such thing\"" || value == "[]";
            match parse(&text) {
                Ok(_) if taken => {}
                Ok(_) => panic!("{key} = {value} is let through"),
                Err(SceneError::At { line, message: problem, .. }) => {
                    assert!(line == number || value == "[]", "{key} = {value}: line {line}: {problem}");
                    assert!(problem.contains(key) || problem.contains("zz"), "{key} = {value}: {problem}");
                    assert!(!problem.contains('\n') && problem.len() < 400, "{problem}");
                }
                Err(other) => panic!("{other}"),
            }
        }
    }
}

#[test]
fn every_line_left_out_and_every_truncation_is_a_scene_or_a_sentence_with_a_line() {
    let lines = EVERY_KEY.lines().count();
    for number in 1..=lines {
        if let Err(error) = parse(&with_line(number, "")) {
            assert!(error.to_string().starts_with("test.toml:"), "{error}");
        }
    }
    for end in 0..EVERY_KEY.len() {
        if let Err(error) = parse(&EVERY_KEY[..end]) {
            let message = error.to_string();
            assert!(message.starts_with("test.toml:") && !message.contains('\n'), "{message}");
        }
    }
}

#[test]
fn mistakes_are_told_with_their_cure() {
    let grid = "[[garment]]\ngrid = { rows = 3, columns = 3, width = 1, height = 1 }\n";
    let cases: [(String, usize, &[&str]); 25] = [
        (String::new(), 1, &["garment is missing", "[[garment]]"]),
        ("x = [".into(), 1, &["not TOML", "docs/scene.md"]),
        ("[[garment]]\n".into(), 1, &["exactly one of"]),
        (format!("{grid}mesh = \"cloth.obj\"\n"), 1, &["has 2 of", "exactly one"]),
        ("[garment]\nmesh = \"cloht.obj\"\n".into(), 2, &["cloht.obj", "give the path"]),
        ("[garment]\nmesh = \"pin.csv\"\n".into(), 2, &[".obj, .gltf or .glb"]),
        (format!("{grid}mass = -1\n"), 3, &["garment.mass is -1", "from 0.000001 to 1000 (kg)"]),
        (format!("step_hz = 1e9\n{grid}"), 1, &["step_hz", "from 10 to 2000 (1/s)"]),
        (format!("{grid}[settings]\nlanes = 5\n"), 4, &["settings.lanes", "1, 4, 8 or 16"]),
        (format!("gravity = [0, 1]\n{grid}"), 1, &["gravity", "three numbers"]),
        (format!("{grid}fabric = \"coton-lawn\"\n"), 3, &["coton-lawn", "did you mean \"cotton-lawn\""]),
        (format!("{grid}fabric = {{ base = \"tin\" }}\n"), 3, &["tin", "toile fabric list"]),
        (format!("{grid}fabric = {{ base = \"cotton-lawn\", file = \"own.toml\" }}\n"), 3, &["one of them"]),
        (format!("{grid}fabric = {{ frictoin = 1 }}\n"), 3, &["did you mean \"friction\""]),
        (format!("{grid}[[garment.pin]]\ntrack = \"pin.csv\"\n"), 3, &["holds nothing", "vertices, box or material"]),
        (format!("{grid}[[garment.pin]]\nvertices = [9]\n"), 4, &["vertex 9 of 9", "0 to 8"]),
        (format!("{grid}[[garment.pin]]\nvertices = [\"0-8\"]\n"), 1, &["pinned as a whole"]),
        (format!("{grid}[[garment.pin]]\nbox = [[5, 5, 5], [6, 6, 6]]\n"), 4, &["holds no vertex"]),
        (format!("{grid}[[garment.pin]]\nvertices = [0]\ntrack = \"ball.csv\"\n"), 5, &["5 columns", "qw"]),
        (format!("{grid}[[garment.pin]]\nmaterial = \"Band\"\n"), 4, &["ends no material"]),
        (format!("{grid}[colliders]\ncapsules = [[0, 1]]\n"), 4, &["sphere 1", "there are 0"]),
        (format!("{grid}[colliders.plane]\nnormal = [0, 0, 0]\n"), 4, &["no length"]),
        (format!("{grid}[colliders.sphere]\ncentre = [0, 0, 0]\n"), 3, &["radius is missing"]),
        (format!("{grid}scale = 1e-6\n"), 2, &["garment.scale", "0.001 for millimetres"]),
        (format!("{grid}name = \"../x\"\n"), 3, &["names files", "letters"]),
    ];
    for (text, line, parts) in cases {
        let (found, problem) = refusal(&text);
        assert_eq!(found, line, "{problem}\n{text}");
        parts.iter().for_each(|part| assert!(problem.contains(part), "{part:?} is not in: {problem}"));
    }
    let spheres = "[[colliders.sphere]]\ncentre = [0, 0, 0]\nradius = 1\n".repeat(MAX_SPHERES + 1);
    assert!(refusal(&format!("{grid}{spheres}")).1.contains(&format!("MAX_SPHERES = {MAX_SPHERES}")));
    assert!(refusal(&format!("{grid}name = \"a\"\n{grid}name = \"a\"\n")).1.contains("stands twice"));
}

#[test]
fn a_missing_file_is_told_where_it_was_looked_for() {
    let folder = std::env::temp_dir();
    let text = "[garment]\nmesh = \"not-there.obj\"\n";
    let error = SceneFile::parse("a.toml", text, SceneSource::Folder(&folder)).unwrap_err().to_string();
    assert!(
        error.contains("a.toml:2:8") && error.contains(&folder.join("not-there.obj").display().to_string()),
        "{error}"
    );
    let error = SceneFile::read(&folder.join("not-there.toml")).unwrap_err().to_string();
    assert!(error.contains("not-there.toml") && error.contains("give the path"), "{error}");
}

#[test]
fn every_example_is_a_scene() {
    assert!(examples::names().count() >= 4);
    for name in examples::names() {
        let scene = SceneFile::example(name).unwrap();
        assert_eq!(scene.name, name);
    }
    let error = SceneFile::example("hat").unwrap_err().to_string();
    assert!(error.contains("hat") && error.contains("flag-in-wind"), "{error}");
}

#[test]
fn a_scene_beyond_all_measure_is_refused_before_it_is_baked() {
    let grid = |rows: usize, i: usize| {
        format!("[[garment]]\nname = \"g{i}\"\ngrid = {{ rows = {rows}, columns = {rows}, width = 1, height = 1 }}\n")
    };
    let large: String = (0..40).map(|i| grid(512, i)).collect();
    let (line, problem) = refusal(&format!("duration = 1\n{large}"));
    assert!(line == 14 && problem.contains("1310720 vertices, more than the 1048576"), "line {line}: {problem}");
    let many: String = (0..65).map(|i| grid(2, i)).collect();
    let (_, problem) = refusal(&format!("duration = 1\n{many}"));
    assert!(problem.contains("65 garments, more than 64"), "{problem}");
}
