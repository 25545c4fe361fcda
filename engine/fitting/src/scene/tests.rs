//! Tests of runs: a scene's settings take effect.

use toile_assets::scene_file::SceneSource;

use super::*;

const GRID: &str = "[garment]\ngrid = { rows = 5, columns = 4, width = 0.3, height = 0.4 }\n";

const FILES: &[(&str, &str)] =
    &[("pins.csv", "0, 0,0,0, 0,0,0,1\n1, 0.5,0,0, 0,0.7071067811865476,0,0.7071067811865476\n")];

fn runner(text: &str) -> Runner {
    let scene =
        SceneFile::parse("test.toml", text, SceneSource::Inside(FILES)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Runner::new(scene).unwrap()
}

fn played(text: &str) -> Runner {
    let mut runner = runner(text);
    (0..runner.scene().steps()).for_each(|_| runner.step());
    runner
}

fn positions(runner: &Runner) -> Vec<Vec3> {
    runner.positions(0).collect()
}

#[test]
fn a_cloth_that_nothing_holds_falls_as_a_stone_at_any_step() {
    for hz in [30, 60, 120, 400] {
        let text = format!(
            "duration = 0.5\nstep_hz = {hz}\ngravity = [0, -2, 0]\n{GRID}velocity = [1, 0, 0]\n\
             [garment.fabric]\ndamping_per_s = 0\n"
        );
        let runner = played(&text);
        assert_eq!((runner.steps(), runner.time()), (hz / 2, 0.5));
        for (end, start) in positions(&runner).iter().zip(&runner.scene().garments[0].mesh.start) {
            let fell = Vec3::new(0.5, -0.25, 0.0);
            // Semi-implicit Euler falls half a substep's motion too far.
            assert!((*end - *start).distance(fell) < 0.5 * 0.5 * 2.0 / hz as f32, "{hz} Hz: {}", *end - *start);
        }
        let mass = runner.scene().garments[0].mass_kg;
        let energy = 0.5 * mass * 2.0;
        assert!(
            (runner.figures().kinetic_j / energy - 1.0).abs() < 0.01,
            "{} J of {energy}",
            runner.figures().kinetic_j
        );
    }
}

/// Trousers and a shirt that starts 2 mm outside of them, both hung by their upper ends; the shirt's own keys are added.
fn shirt_in_trousers(keys: &str) -> String {
    let tube = |rows: u32, radius: f32, height: f32, top: f32| {
        format!(
            "[[garment]]\ntube = {{ rows = {rows}, columns = 30, top_radius = {radius}, bottom_radius = {radius}, \
             height = {height} }}\nposition = [0, {top}, 0]\n"
        )
    };
    let pin = "[[garment.pin]]\nvertices = [\"0-29\"]\n";
    let (trousers, shirt) = (tube(16, 0.1, 0.3, 1.0), tube(22, 0.102, 0.42, 1.25));
    format!("duration = 0.5\n{trousers}{pin}{shirt}{keys}\n{pin}")
}

#[test]
fn a_garment_is_tucked_in_where_its_file_says_so() {
    let inside = |keys: &str| {
        let runner = played(&shirt_in_trousers(keys));
        // Rows of the hem, below the waistband by 40 to 160 mm.
        let hem = runner.positions(1).skip(15 * 30);
        let radii: Vec<f32> = hem.map(|p| p.x.hypot(p.z)).collect();
        radii.iter().sum::<f32>() / (radii.len() as f32)
    };
    let (tucked, over) = (inside("tuck = true"), inside("tuck = false"));
    assert!(tucked < 0.1 && over > 0.1, "tucked in {tucked} m from the middle, over them {over} m");
    let text = format!("{GRID}tuck = true\n");
    let scene = SceneFile::parse("test.toml", &text, SceneSource::Inside(FILES)).unwrap();
    let message = Runner::new(scene).unwrap_err().to_string();
    assert!(message.contains("cloth-1") && message.contains("waistband") && !message.contains('\n'), "{message}");
}

#[test]
fn pins_follow_their_track_and_the_rest_of_the_world_stands() {
    let text = format!(
        "duration = 0.5\n{GRID}[[garment.pin]]\nvertices = [0, 1]\ntrack = \"pins.csv\"\n\
        [[garment.pin]]\nvertices = [2, 3]\n"
    );
    let mut runner = runner(&text);
    let start = positions(&runner);
    assert_eq!(start, runner.scene().garments[0].mesh.start);
    while runner.time() < 0.5 {
        runner.step();
        let now = positions(&runner);
        let motion = runner.scene().pins[0].at(runner.time());
        for i in [0, 1] {
            assert!(now[i].distance(motion.transform_point3(start[i])) < 1e-6, "step {}: vertex {i}", runner.steps());
        }
        assert_eq!(now[2..4], start[2..4]);
    }
    assert!(positions(&runner)[4..].iter().zip(&start[4..]).all(|(a, b)| a != b), "the rest moves");
}

#[test]
fn a_floor_and_a_slope_hold_what_falls_on_them() {
    for (normal, duration) in [([0.0f32, 1.0, 0.0], 1.0), ([0.3, 1.0, 0.0], 0.6)] {
        let text = format!(
            "duration = {duration}\n[settings]\nsubsteps = 8\n[garment]\n\
             grid = {{ rows = 5, columns = 4, width = 0.3, height = 0.4, plane = \"level\" }}\nposition = [0, 0.3, 0]\n\
             [colliders.plane]\nnormal = {normal:?}\n"
        );
        let runner = played(&text);
        let normal = Vec3::from_array(normal).normalize();
        let least = positions(&runner).iter().map(|p| p.dot(normal)).fold(f32::INFINITY, f32::min);
        assert!((0.0..0.01).contains(&least), "{least} m above the plane {normal}");
        assert!(runner.figures().penetration_mm < 0.5, "{:?}", runner.figures());
    }
}

#[test]
fn every_lane_width_and_every_run_gives_the_same_bits() {
    let text =
        |lanes: u32| format!("duration = 0.3\n[settings]\nlanes = {lanes}\n{GRID}pin = {{ vertices = [0, 3] }}\n");
    let hash = |lanes| played(&text(lanes)).state_hash();
    let one = hash(1);
    assert_eq!(one, hash(1));
    for lanes in [4, 8, 16] {
        assert_eq!(hash(lanes), one, "{lanes} lanes");
    }
    assert_ne!(played(&text(1).replace("0.3\n", "0.31\n")).state_hash(), one);
}

#[test]
fn quality_and_longer_steps_ask_for_more_substeps() {
    let substeps = |head: &str| {
        let mut runner = runner(&format!("{head}{GRID}"));
        runner.step();
        runner.cloths()[0].substeps()
    };
    let shop = substeps("");
    assert!(substeps("[settings]\nquality = \"fine\"\n") > shop);
    assert_eq!(substeps("step_hz = 30\n"), 4 * shop);
    assert_eq!(substeps("step_hz = 30\n[settings]\nsubsteps = 5\n"), 5);
}

#[test]
fn patches_weigh_what_they_say_and_steps_before_the_measuring_do_not_count() {
    let plain = format!("duration = 0.2\nmeasure_from = 0.1\n{GRID}mass = 0.1\npin = {{ vertices = [0] }}\n");
    let runner = played(&format!("{plain}mass_patch = {{ vertices = [19], factor = 100 }}\n"));
    assert_eq!(runner.figures().steps, 12);
    let mass = |runner: &Runner, v: usize| {
        f64::from(runner.garments()[0].inverse_mass[runner.particles[0][v] as usize]).recip()
    };
    let light = played(&plain);
    assert!((mass(&runner, 19) / mass(&light, 19) / 100.0 - 1.0).abs() < 1e-5);
    assert_eq!(mass(&runner, 18), mass(&light, 18));
    let whole = runner.scene().garments[0].mass_kg;
    assert!(whole > 0.1 && whole < 0.1 + 100.0 * 0.1 / 12.0, "{whole} kg");
}

#[test]
fn a_chosen_solver_is_the_one_that_runs() {
    let hash = |key: &str, solver: &str| {
        let fabric = "fabric = { stretch_warp_n_m = 10000, stretch_weft_n_m = 10000 }\n";
        let solver = format!("solver = {{ {key} = \"{solver}\" }}\n");
        played(&format!("duration = 0.3\n{GRID}{fabric}{solver}pin = {{ vertices = [0, 1] }}\n")).state_hash()
    };
    for key in ["warp", "weft"] {
        let hashes = ["gauss-seidel", "semi-implicit", "zero-stretch"].map(|solver| hash(key, solver));
        assert!(hashes[0] != hashes[1] && hashes[1] != hashes[2] && hashes[0] != hashes[2], "{key}: {hashes:x?}");
    }
}
