//! One garment against itself: the twisted square, and the skirt that walks in the wind.

use super::row::{ContactError, ContactRow};
use super::scenes::{self, play, runner};

/// Turns of the skirt's two runs, of which the median ratio counts.
const TURNS: usize = 5;

/// The square metre twisted by half a turn.
pub fn twist() -> Result<Vec<ContactRow>, ContactError> {
    let mut run = runner(&scenes::twist())?;
    let crossings = play(&mut run);
    Ok(vec![
        ContactRow::at_most("1 m square twisted by half a turn: most crossings", 0.0, crossings.max as f64, "edges"),
        ContactRow::at_most(
            "1 m square twisted by half a turn: worst edge",
            10.0,
            100.0 * run.figures().strain_max,
            "%",
        ),
    ])
}

/// The skirt with wind and contact with itself, over the skirt without both.
pub fn skirt() -> Result<Vec<ContactRow>, ContactError> {
    let (mut ratios, mut strains, mut us, mut most) = (Vec::new(), [0.0; 2], [0.0; 2], 0);
    for _ in 0..TURNS {
        for (k, with) in [false, true].into_iter().enumerate() {
            let mut run = runner(&scenes::skirt(with))?;
            let crossings = play(&mut run);
            let figures = run.figures();
            (us[k], strains[k]) = (figures.step_us.p50, figures.strain_mean);
            if with {
                most = crossings.max;
            }
        }
        ratios.push(us[1] / us[0]);
    }
    ratios.sort_by(f64::total_cmp);
    let name = |what: &str| format!("skirt of 4,096, walking, wind and itself, over the same without both: {what}");
    Ok(vec![
        ContactRow::at_most(name("time"), 1.8, ratios[TURNS / 2], "times"),
        ContactRow::at_most(name("mean strain"), 1.5, strains[1] / strains[0], "times"),
        ContactRow::at_most("skirt of 4,096, walking, wind and itself: most crossings", 0.0, most as f64, "edges"),
    ])
}
