//! The chart of a crossover: time a step over the particles of the scene.

use super::study::{Crossover, CrossoverRow, EACH};
use toile_view::plot::axis::Axis;
use toile_view::plot::chart::{Chart, Series, SeriesStyle};
use toile_view::plot::{BLACK, Drawing, SERIES_COLOURS};

/// What 120 Hz leaves a step (us).
const STEP_US: f64 = 1e6 / 120.0;

/// A time of a row (us).
type TimeOf = fn(&CrossoverRow) -> Option<f64>;

/// Time a step over vertices in all, of one skirt and of several.
pub fn chart(study: &Crossover) -> Drawing {
    let sides: [(&str, TimeOf); 4] = [
        ("one thread", |row| Some(row.one.step_us)),
        ("two threads", |row| Some(row.two.step_us)),
        ("device", |row| row.device.map(|side| side.step_us)),
        ("device's own clock", |row| row.device_us),
    ];
    let mut series = Vec::new();
    for (several, words) in [(false, "one skirt"), (true, "4,096 each")] {
        for (k, (name, us)) in sides.iter().enumerate() {
            let chosen = |row: &&CrossoverRow| if several { row.verts == EACH } else { row.garments == 1 };
            let point = |row: &CrossoverRow| Some([(row.verts * row.garments) as f64, us(row)?]);
            let points: Vec<[f64; 2]> = study.rows.iter().filter(chosen).filter_map(point).collect();
            if points.len() > usize::from(several) {
                let style = SeriesStyle { dashed: several, ..SeriesStyle::joined(SERIES_COLOURS[k]) };
                series.push(Series { name: format!("{name}, {words}"), points, style });
            }
        }
    }
    let all = || series.iter().flat_map(|s| &s.points);
    let x = Axis::around("vertices in all", true, all().map(|p| p[0]));
    let y = Axis::around("a step (us)", true, all().map(|p| p[1]).chain([STEP_US]));
    let budget = Series {
        name: "120 steps a second".into(),
        points: vec![[x.range[0], STEP_US], [x.range[1], STEP_US]],
        style: SeriesStyle { dashed: true, ..SeriesStyle::line(BLACK, 1.0) },
    };
    series.push(budget);
    let device = study.stepped_by.adapter.as_ref().map_or("no device".into(), |a| format!("{} ({})", a.name, a.kind));
    Chart { title: format!("The cloth on the processor and on {device}"), x, y, series, rules: Vec::new() }.draw()
}
