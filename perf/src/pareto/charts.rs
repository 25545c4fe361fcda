//! The charts of a report.

use super::front;
use super::report::{ParetoReport, Point, SceneReport};
use toile_view::plot::axis::Axis;
use toile_view::plot::chart::{Chart, Series, SeriesStyle};
use toile_view::plot::{BLACK, Drawing, SERIES_COLOURS};

/// A chart under its file's name.
pub struct NamedDrawing {
    /// The file's name without its ending.
    pub name: String,
    /// The chart, laid out as marks.
    pub drawing: Drawing,
}

/// What 120 Hz leaves a step (us).
const STEP_US: f64 = 1e6 / 120.0;

/// Solvers and qualities that are series of their own, each with its name in a legend.
const GROUPS: [(&str, &str, &str); 6] = [
    ("mixed", "draft", "mixed, draft"),
    ("mixed", "shop", "mixed, shop"),
    ("mixed", "fine", "mixed, fine"),
    ("gauss-seidel", "shop", "Gauss-Seidel, shop"),
    ("semi-implicit", "shop", "semi-implicit, shop"),
    ("zero-stretch", "shop", "zero-stretch, shop"),
];

/// All charts that the figures give.
pub fn figures(report: &ParetoReport) -> Vec<NamedDrawing> {
    let mut all = Vec::new();
    let mut add = |name: String, drawing: Drawing| all.push(NamedDrawing { name, drawing });
    for scene in report.scenes.iter().filter(|s| s.main) {
        let of = |p: &&Point| p.scene == scene.scene && p.mesh == scene.mesh;
        let points: Vec<&Point> = report.points.iter().filter(of).collect();
        let name = &scene.scene;
        add(format!("{name}-front"), speed(scene, &points, &report.points).draw());
        add(format!("{name}-substeps"), substeps(scene, &points).draw());
        add(format!("{name}-iterations"), iterations(scene, &points).draw());
        if report.scenes.iter().filter(|s| s.scene == *name).count() > 1 {
            add(format!("{name}-mesh"), meshes(name, report).draw());
        }
        if !scene.energy.is_empty() {
            add(format!("{name}-energy"), energy(scene).draw());
        }
    }
    all
}

/// A series for each group, by what x is.
fn by_group(points: &[&Point], style: fn([u8; 3]) -> SeriesStyle, x: impl Fn(&Point) -> f64) -> Vec<Series> {
    let group = |(k, (solver, quality, name)): (usize, &(&str, &str, &str))| {
        let of = points.iter().filter(|p| p.solver == *solver && p.quality == *quality && p.threads == 1);
        let mut points: Vec<[f64; 2]> = of.map(|p| [x(p), p.error_mm]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Series { name: (*name).into(), points, style: style(SERIES_COLOURS[k]) }
    };
    GROUPS.iter().enumerate().map(group).filter(|s| !s.points.is_empty()).collect()
}

/// The chart with axes around all its points.
fn framed(title: String, labels: [(&'static str, bool); 2], series: Vec<Series>) -> Chart {
    let axis = |k: usize| {
        let values = series.iter().flat_map(|s| &s.points).map(|p| p[k]);
        Axis::around(labels[k].0, labels[k].1, values)
    };
    Chart { title, x: axis(0), y: axis(1), series, rules: Vec::new() }
}

const ERROR: (&str, bool) = ("mean distance to x* (mm)", true);

fn titled(scene: &SceneReport, words: &str) -> String {
    format!("{}: {words} ({}, {} particles)", scene.scene, scene.mesh, scene.particles)
}

fn speed(scene: &SceneReport, points: &[&Point], all: &[Point]) -> Chart {
    let mut series = by_group(points, SeriesStyle::dots, |p| p.step_us);
    let two: Vec<[f64; 2]> = points.iter().filter(|p| p.threads == 2).map(|p| [p.step_us, p.error_mm]).collect();
    if !two.is_empty() {
        let style = SeriesStyle { dot: 2.5, ..SeriesStyle::dots([150; 3]) };
        series.push(Series { name: "mixed, two threads".into(), points: two, style });
    }
    for (threads, words) in [(1, "front, one thread"), (2, "front, two threads")] {
        let found = front::of(all, &scene.scene, &scene.mesh, threads);
        let points: Vec<[f64; 2]> = found.iter().map(|p| [p.step_us, p.error_mm]).collect();
        if !points.is_empty() {
            let style = SeriesStyle { dashed: threads == 2, ..SeriesStyle::line(BLACK, 1.6) };
            series.push(Series { name: words.into(), points, style });
        }
    }
    let own = points.iter().filter(|p| p.default && p.threads == 1).map(|p| [p.step_us, p.error_mm]).collect();
    series.push(Series { name: "a quality's own".into(), points: own, style: SeriesStyle::rings(BLACK) });
    let mut chart = framed(titled(scene, "error against time"), [("median time of a step (us)", true), ERROR], series);
    chart.x.range[1] = chart.x.range[1].max(STEP_US * 1.3);
    chart.rules.push((STEP_US, "120 Hz: 8.33 ms"));
    chart
}

fn substeps(scene: &SceneReport, points: &[&Point]) -> Chart {
    let series = by_group(points, SeriesStyle::joined, |p| f64::from(p.substeps));
    framed(titled(scene, "convergence by substeps"), [("substeps of a step", true), ERROR], series)
}

fn iterations(scene: &SceneReport, points: &[&Point]) -> Chart {
    let series = by_group(points, SeriesStyle::joined, |p| f64::from(p.substeps) * p.iterations as f64);
    let x = ("iterations of a step: substeps x passes over the weft", true);
    framed(titled(scene, "convergence by iterations"), [x, ERROR], series)
}

/// Error of the qualities' own settings over the meshes of a scene, and what their x* may itself be off.
fn meshes(name: &str, report: &ParetoReport) -> Chart {
    let scenes: Vec<&SceneReport> = report.scenes.iter().filter(|s| s.scene == name).collect();
    let mut series = Vec::new();
    for (k, quality) in ["draft", "shop", "fine"].into_iter().enumerate() {
        let point = |s: &&SceneReport| {
            let of = |p: &&Point| p.scene == s.scene && p.mesh == s.mesh && p.default && p.threads == 1;
            report.points.iter().filter(of).find(|p| p.quality == quality).map(|p| [s.spacing_mm, p.error_mm])
        };
        let mut points: Vec<[f64; 2]> = scenes.iter().filter_map(point).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        series.push(Series {
            name: format!("{quality}, its own substeps"),
            points,
            style: SeriesStyle::joined(SERIES_COLOURS[k]),
        });
    }
    let x = ("mean length of an edge (mm)", true);
    framed(format!("{name}: error against mesh size"), [x, ERROR], series)
}

fn energy(scene: &SceneReport) -> Chart {
    let colours = [BLACK, SERIES_COLOURS[0], SERIES_COLOURS[1], SERIES_COLOURS[2]];
    let runs = scene.energy.iter().zip(colours.into_iter().cycle());
    let series = runs.map(|(run, colour)| {
        let style = SeriesStyle { dashed: colour == BLACK, ..SeriesStyle::line(colour, 1.8) };
        Series { name: run.setting.clone(), points: run.frames.clone(), style }
    });
    let axes = [("time (s)", false), ("energy: motion, weight, bending, stretch (J)", false)];
    framed(titled(scene, "energy by frame"), axes, series.collect())
}
