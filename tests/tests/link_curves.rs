//! Links of two slopes that rub and lock: the engine's cloth swings as the oracle's does, substep for substep.

use glam::{DVec3, Quat, Vec3};
use toile_bake::bake;
use toile_base::garment::Garment;
use toile_engine::cloth::{Quality, Settings};
use toile_perf::oracle::{Oracle, OracleStep, Problem, State};
use toile_workspace::cloth::{Alone, sheet};

/// Cells of the sheet each way, and their length (m).
const CELLS: [u32; 2] = [5, 7];
const CELL_M: f32 = 0.03;

/// Steps of 1/120 s, and substeps of each: with twice as many, the rounding of a position to f32 exceeds the error of the curves.
const STEPS: u32 = 36;
const SUBSTEPS: u32 = 24;

/// Figures that the cloth's own weight passes: a knee at .6 %, friction of a tenth of what it weighs, shear that rubs and locks.
const KNEES: &str = "[stretch.warp]\nknee_percent = 0.6\nknee_n_m = 0.2\nbeyond_n_m = 400.0\n\
    [stretch.weft]\nknee_percent = 0.6\nknee_n_m = 0.2\nbeyond_n_m = 400.0\n";
const FRICTION: &str = "[hysteresis]\nshear_n_m = 0.06\n";
const LOCK: &str = "[shear_lock]\ndegrees = 2.0\nbeyond_n_m = 20.0\n";
const ALL: &str = "[hysteresis]\nshear_n_m = 0.06\n[stretch.warp]\nknee_percent = 0.6\nknee_n_m = 0.2\nbeyond_n_m = 400.0\n\
    hysteresis_n_m = 0.05\n[stretch.weft]\nknee_percent = 0.6\nknee_n_m = 0.2\nbeyond_n_m = 400.0\n\
    [shear_lock]\ndegrees = 2.0\nbeyond_n_m = 20.0\n";

fn garment(curves: &str) -> Garment {
    let text = format!(
        "name = \"curve\"\ntitle = \"Curve\"\nbase = \"cotton-lawn\"\ndensity_kg_m2 = 0.3\nstretch_warp_n_m = 33.3\nstretch_weft_n_m = 33.3\nshear_n_m = 2.0\n\
        bend_warp_un_m = 0.0\nbend_weft_un_m = 0.0\nfriction = 0.3\ndamping_per_s = 1.0\ncontact_offset_mm = 3.0\n{curves}"
    );
    let fabric = toile_assets::fabric::parse("curve", &text).expect("figures that cloth can have");
    let top = Vec3::new(-0.5 * CELLS[0] as f32 * CELL_M, 0.0, 0.0);
    bake("curve", "one", &sheet(CELLS[0], CELLS[1], CELL_M, top, true), &fabric).expect("a sheet can be baked")
}

/// Turned about the upper edge, and sheared.
fn begins(p: Vec3) -> (Vec3, Vec3) {
    let sheared = p + Vec3::X * (0.05 * p.y);
    (Quat::from_axis_angle(Vec3::X, 0.7) * sheared, Vec3::ZERO)
}

/// Where the engine's particles are at the end (m).
fn by_the_engine(garment: &Garment) -> Vec<DVec3> {
    let settings = Settings { quality: Quality::Fine, substeps: Some(SUBSTEPS), ..Settings::default() };
    let mut alone = Alone::new(garment);
    alone.disturb(|_, p| begins(p));
    (0..STEPS).for_each(|_| alone.step(&settings));
    alone.cloth.positions.iter().map(|p| p.as_dvec3()).collect()
}

/// The same by exact implicit steps of the same length.
fn by_the_oracle(garment: &Garment) -> Vec<DVec3> {
    let problem = Problem::of(garment);
    let mut state = State::at_rest(&problem.start);
    for (i, x) in state.x.iter_mut().enumerate().filter(|(i, _)| !problem.pinned(*i)) {
        *x = begins(problem.start[i].as_vec3()).0.as_dvec3();
    }
    let dt = 1.0 / (120.0 * f64::from(SUBSTEPS));
    let kept = (-f64::from(garment.fabric.damping_per_s) * dt).exp();
    let step = OracleStep { kept, ..OracleStep::of(dt) };
    let mut oracle = Oracle::new(problem).expect("figures that can be used");
    for _ in 0..STEPS * SUBSTEPS {
        state = oracle.step(&state, &step).expect("a step of cloth").state;
    }
    state.x
}

/// Mean distance (m).
fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).sum::<f64>() / a.len() as f64
}

#[test]
fn cloth_with_curves_swings_as_the_oracle_does() {
    let plain = by_the_oracle(&garment(""));
    let own = apart(&by_the_engine(&garment("")), &plain);
    eprintln!("plain links: {:.3} mm apart", own * 1e3);
    assert!(own < 3e-5, "{own}");
    for (which, curves) in [("knees", KNEES), ("friction", FRICTION), ("shear that locks", LOCK), ("all", ALL)] {
        let garment = garment(curves);
        let exact = by_the_oracle(&garment);
        let (off, worth) = (apart(&by_the_engine(&garment), &exact), apart(&plain, &exact));
        eprintln!("{which}: {:.3} mm apart, where the curve changes {:.3} mm", off * 1e3, worth * 1e3);
        assert!(worth > 1e-4, "{which}: the curve acts, {worth}");
        assert!(off < 0.03 * worth + own, "{which}: {off} of {worth}");
    }
}
