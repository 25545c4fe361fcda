//! Sheets over one another: on a floor, over a cylinder.

use glam::Vec3A;
use toile_engine::cloth::Cloth;

use super::row::{ContactError, ContactRow};
use super::scenes::{self, play, runner};

/// Half of both thicknesses of the sheets (m).
const GAP_M: f64 = 0.003;

/// Sheets of the pile.
const SHEETS: f64 = 10.0;

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
