//! Sheets over one another: on a floor, over a cylinder, on an incline.

use glam::Vec3A;
use toile_engine::cloth::Cloth;

use super::row::{ContactError, ContactRow};
use super::scenes::{self, play, runner};

/// Half of both thicknesses of the sheets (m).
const GAP_M: f64 = 0.003;

/// Sheets of the pile.
const SHEETS: f64 = 10.0;

/// Coefficient of friction of the sheets on the incline (1).
const FRICTION: f64 = 0.4;

fn mean(cloth: &Cloth) -> Vec3A {
    cloth.positions.iter().sum::<Vec3A>() / cloth.positions.len() as f32
}

/// Three sheets on a floor: gaps, rest, crossings.
pub fn stack() -> Result<Vec<ContactRow>, ContactError> {
    let mut run = runner(&scenes::stack())?;
    let crossings = play(&mut run);
    let heights: Vec<f64> = run.cloths().iter().map(|c| f64::from(mean(c).y)).collect();
    let off = heights.windows(2).map(|h| ((h[1] - h[0]) / GAP_M - 1.0).abs() * 100.0).fold(0.0, f64::max);
    let speeds = run.cloths().iter().flat_map(|c| (0..c.positions.len()).map(|i| c.velocity(i).length()));
    let mut speeds: Vec<f64> = speeds.map(|v| 1e3 * f64::from(v)).collect();
    speeds.sort_by(f64::total_cmp);
    let faster_than = |share: f64| speeds[((speeds.len() - 1) as f64 * share) as usize];
    Ok(vec![
        ContactRow::at_most("three sheets on a floor: a gap off 3 mm", 5.0, off, "%"),
        ContactRow::at_most("three sheets on a floor: nine in ten particles after 4 s", 1.0, faster_than(0.9), "mm/s"),
        ContactRow::at_most("three sheets on a floor: fastest particle after 4 s", 1.0, faster_than(1.0), "mm/s"),
        ContactRow::at_most("three sheets on a floor: most crossings", 0.0, crossings.max as f64, "edges"),
    ])
}

/// Ten sheets over a cylinder: time and crossings.
pub fn pile() -> Result<Vec<ContactRow>, ContactError> {
    let mut run = runner(&scenes::pile())?;
    let crossings = play(&mut run);
    let figures = run.figures();
    let name = |what: &str| format!("ten sheets of 1,024 over a cylinder: {what}");
    Ok(vec![
        ContactRow::at_most(name("time of a sheet's step, one core"), 0.3, figures.step_us.p50 * 1e-3 / SHEETS, "ms"),
        ContactRow::at_most(name("most crossings in 10 s"), 0.0, crossings.max as f64, "edges"),
        ContactRow::at_most(name("most of them between sheets"), 0.0, crossings.max_between as f64, "edges"),
    ])
}

/// How far the small sheet has slid on an incline of so much of the critical slope (mm).
fn slid(share: f64) -> Result<f64, ContactError> {
    let mut run = runner(&scenes::incline(FRICTION * share))?;
    let before = mean(&run.cloths()[1]);
    play(&mut run);
    Ok(1e3 * f64::from((mean(&run.cloths()[1]) - before).x))
}

/// Sheet on sheet on an incline: it holds below the angle of friction and slides above it.
pub fn incline() -> Result<Vec<ContactRow>, ContactError> {
    let ideal = 0.5 * 9.81 * 0.02 * FRICTION / (1.0 + (FRICTION * 1.02).powi(2)).sqrt() * 4.0 * 1e3;
    let (holds, slides) = (slid(0.98)?, slid(1.02)?);
    Ok(vec![
        ContactRow::at_most("incline, sheet on sheet: slid in 2 s at 98 % of tan = mu", 1.0, holds.abs(), "mm"),
        ContactRow::at_most(
            "incline, sheet on sheet: slid too little in 2 s at 102 %, of the exact way",
            50.0,
            100.0 * (1.0 - slides / ideal),
            "%",
        ),
    ])
}
