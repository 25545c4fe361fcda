//! The scene files of the cases: `toile run` takes them as they are.

use toile_assets::scene_file::{SceneError, SceneFile, SceneSource};
use toile_fitting::scene::Runner;

use super::row::ContactError;
use toile_fitting::crossings::{CrossingFigures, CrossingWatch};

/// Half a turn of the lower end in three seconds, which comes nearer to the upper one meanwhile.
const TURN: &str = "time,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.5,0,0.008,0,0,0.258819,0,0.965926\n\
                    1,0,0.016,0,0,0.5,0,0.866025\n1.5,0,0.025,0,0,0.707107,0,0.707107\n2,0,0.033,0,0,0.866025,0,0.5\n\
                    2.5,0,0.041,0,0,0.965926,0,0.258819\n3,0,0.05,0,0,1,0,0\n";

/// Files that the scenes name.
const FILES: &[(&str, &str)] = &[("turn.csv", TURN)];

/// The benchmark's skirt, walking in the wind, with or without both models.
pub fn skirt(with: bool) -> String {
    let wind = if with { "[wind]\nvelocity = [1.0, 0.0, 0.5]\n" } else { "" };
    format!(
        "duration = 6\nmeasure_from = 1\n{wind}[settings]\nfolds = {with}\n[colliders]\nmotion = \"walk\"\n\
         [[garment]]\nskirt = {{ side = 64 }}\n[[garment.pin]]\nvertices = [\"0-63\"]\nmotion = \"walk\"\n"
    )
}

/// A sheet of jersey that lies, `side` vertices a side; `more` are keys of the garment.
fn sheet(side: u32, size: f64, at: [f64; 3], thickness_mm: f64, more: &str) -> String {
    let [x, y, z] = at;
    format!(
        "[[garment]]\ngrid = {{ rows = {side}, columns = {side}, width = {size}, height = {size}, plane = \"level\" }}\n\
         position = [{x}, {y}, {z}]\n{more}\n[garment.fabric]\nbase = \"cotton-jersey\"\nthickness_mm = {thickness_mm}\n"
    )
}

/// Three sheets over one another on a floor, 3 mm thick.
pub fn stack() -> String {
    let sheets: String =
        (0..3).map(f64::from).map(|k| sheet(24, 0.4, [0.003 * k, 0.01 + 0.006 * k, 0.002 * k], 3.0, "")).collect();
    format!("duration = 4\nmeasure_from = 3\n{sheets}[[colliders.plane]]\n")
}

/// Ten sheets dropped over a lying cylinder.
pub fn pile() -> String {
    let sheets: String =
        (0..10).map(|k| sheet(32, 0.6, [0.003 * f64::from(k), 0.75 + 0.012 * f64::from(k), 0.0], 3.0, "")).collect();
    format!(
        "duration = 10\nmeasure_from = 1\n[settings]\nfolds = true\n{sheets}[colliders]\ncapsules = [[0, 1]]\n\
         [[colliders.sphere]]\ncentre = [-0.6, 0.6, 0]\nradius = 0.1\n[[colliders.sphere]]\ncentre = [0.6, 0.6, 0]\n\
         radius = 0.1\n[[colliders.plane]]\n"
    )
}

/// A square metre, 5 mm thick, whose lower end is turned by half a turn: 30 cm of either end are held.
pub fn twist() -> String {
    "duration = 5\nmeasure_from = 0.1\n[settings]\nfolds = true\n[[garment]]\n\
     grid = { rows = 51, columns = 51, width = 1, height = 1, plane = \"upright\" }\nposition = [0, 1, 0]\n\
     [garment.fabric]\nbase = \"cotton-jersey\"\nthickness_mm = 5\n[[garment.pin]]\nvertices = [\"18-32\"]\n\
     [[garment.pin]]\nvertices = [\"2568-2582\"]\ntrack = \"turn.csv\"\n"
        .to_owned()
}

/// Two sheets on a floor, of which the outer one starts 10 mm below the inner one; turn and shift tell seeds apart.
pub fn lost_order(turn_deg: f64, shift_m: f64) -> String {
    let turned = format!("rotation_deg = [0, {turn_deg}, 0]");
    let inner = sheet(24, 0.4, [0.0, 0.014, 0.0], 3.0, "");
    format!("duration = 0.5\n{inner}{}[[colliders.plane]]\n", sheet(24, 0.4, [shift_m, 0.004, 0.003], 3.0, &turned))
}

/// A scene, ready to run.
pub fn runner(text: &str) -> Result<Runner, ContactError> {
    let scene: Result<SceneFile, SceneError> = SceneFile::parse("contact", text, SceneSource::Inside(FILES));
    Ok(Runner::new(scene?)?)
}

/// Runs a scene to its end, with crossings counted.
pub fn play(runner: &mut Runner) -> CrossingFigures {
    let faces: Vec<&[[u32; 3]]> = runner.garments().iter().map(|g| &*g.triangles).collect();
    let mut watch = CrossingWatch::new(&faces, runner.scene().step_hz.recip());
    for step in 1..=runner.scene().steps() {
        runner.step();
        if CrossingWatch::wants(step) {
            let at = runner.cloths().iter().map(|c| c.positions.iter().map(|p| (*p).into()).collect());
            watch.look(&at.collect::<Vec<_>>());
        }
    }
    watch.figures()
}
