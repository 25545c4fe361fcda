//! The front, the plots and a small sweep.

use super::*;
use toile_view::plot::axis::{Axis, figure};
use toile_view::plot::{Anchor, Drawing, Mark, raster, svg};

fn at(step_us: f64, error_mm: f64) -> Point {
    Point { scene: "s".into(), mesh: "m".into(), threads: 1, step_us, error_mm, ..Point::default() }
}

#[test]
fn nothing_on_the_front_is_beaten_and_all_else_is() {
    let mut points = vec![at(1.0, 9.0), at(2.0, 5.0), at(3.0, 6.0), at(4.0, 1.0), at(5.0, 1.0)];
    points.push(Point { rolled_back: 1, ..at(0.5, 0.1) });
    points.push(Point { threads: 2, ..at(0.1, 0.1) });
    front::mark(&mut points);
    let on: Vec<bool> = points.iter().map(|p| p.on_front).collect();
    assert_eq!(on, [true, true, false, true, false, false, true]);
    let times: Vec<f64> = front::of(&points, "s", "m", 1).iter().map(|p| p.step_us).collect();
    assert_eq!(times, [1.0, 2.0, 4.0]);
}

#[test]
fn ticks_lie_on_the_axis_and_are_written_shortly() {
    let axis = Axis::around("x", true, [0.03, 80.0, 0.0, f64::NAN].into_iter());
    assert_eq!(axis.ticks(), [0.1, 1.0, 10.0, 100.0]);
    assert!(axis.place(0.0).is_none() && axis.place(axis.range[1]).is_some_and(|p| (p - 1.0).abs() < 1e-12));
    let linear = Axis::around("x", false, [0.0, 1.0].into_iter());
    assert_eq!(linear.ticks(), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
    assert_eq!([0.1, 100.0, 1e-5, 0.6000000000000001].map(figure), ["0.1", "100", "1e-5", "0.6"]);
}

#[test]
fn a_drawing_is_the_same_marks_in_svg_and_in_pixels() {
    let line = Mark::Line { points: vec![[10.0, 10.5], [50.0, 10.5]], colour: [255, 0, 0], width: 1.0, dashed: false };
    let words = Mark::text([30.0, 30.0], Anchor::Middle, "a < b");
    let drawing = Drawing { size: [60, 40], marks: vec![line, words] };
    let text = svg::text(&drawing);
    assert!(text.contains("10.0,10.5 50.0,10.5") && text.contains("a &lt; b") && text.contains("#ff0000"));
    let image = raster::image(&drawing);
    assert_eq!(image.pixel(30, 10), Some([255, 0, 0]));
    assert_eq!(image.pixel(30, 13), Some([255; 3]));
    assert!((20..40).any(|x| image.pixel(x, 30).is_some_and(|p| p[0] < 128)), "no colour of the words");
}

#[test]
fn more_substeps_come_nearer_to_x_star() {
    let options = ParetoOptions { scene: Some("cantilever".into()), quick: true };
    let report = run(&options, &|_| {}).unwrap();
    let error = |substeps: u32| {
        let of = |p: &&Point| p.solver == "mixed" && p.quality == "fine" && p.substeps == substeps;
        report.points.iter().filter(|p| p.mesh == report.scenes[0].mesh).find(of).unwrap().error_mm
    };
    assert!(error(8) < error(1), "{} mm with 8 substeps, {} with 1", error(8), error(1));
    assert!(report.points.iter().any(|p| p.on_front) && report.points.iter().all(|p| p.step_us > 0.0));
    let files = files(&report).unwrap();
    let page = files.iter().find(|f| f.name == "pareto.html").map(|f| String::from_utf8_lossy(&f.bytes)).unwrap();
    assert!(page.contains("<svg") && !page.contains("<script") && !page.contains("src="));
    assert!(files.iter().any(|f| f.name == "cantilever-front.png" && f.bytes.starts_with(b"\x89PNG")));
}

#[test]
fn an_unknown_scene_is_said_so() {
    let options = ParetoOptions { scene: Some("hat".into()), quick: true };
    let message = run(&options, &|_| {}).unwrap_err().to_string();
    assert!(message.contains("hat") && message.contains("--help"));
}
