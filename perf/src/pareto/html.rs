//! The report as one page that needs no other file and no script.

use std::fmt::Write;

use super::charts::Figure;
use super::front;
use super::report::{Drape, Point, Report, SceneReport};
use crate::plot::svg::{self, escaped};

const HEAD: &str = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Toile: speed against \
error</title>\n<style>\nbody { font-family: system-ui, sans-serif; background: #fff; color: #222; max-width: 1080px; \
margin: 2em auto; padding: 0 1em; }\nsvg { max-width: 100%; height: auto; }\ntable { border-collapse: collapse; }\n\
th, td { padding: 0.2em 0.7em; text-align: right; border-bottom: 1px solid #ddd; }\nth:first-child, td:first-child \
{ text-align: left; }\n</style>\n</head>\n<body>\n";

/// The page.
pub fn page(report: &Report, figures: &[Figure]) -> String {
    let mut html = String::from(HEAD);
    html.push_str("<h1>Speed against error</h1>\n");
    html.push_str(
        "<p>Every point is one setting of one scene: the median time of a step of 1/120 s, and the mean distance of the \
         free particles to x* over the frames that are compared. No setting is both faster and nearer than one on the \
         front.</p>\n",
    );
    if report.quick {
        html.push_str("<p><strong>A quick look: few settings of small meshes.</strong></p>\n");
    }
    for scene in report.scenes.iter().filter(|s| s.main) {
        section(&mut html, report, scene, figures);
    }
    put(&mut html, figures, "survival");
    if let Some(drape) = &report.drape {
        table_cloth(&mut html, drape);
        put(&mut html, figures, "drape");
    }
    html.push_str("</body>\n</html>\n");
    html
}

fn section(html: &mut String, report: &Report, scene: &SceneReport, figures: &[Figure]) {
    // Writing to a string cannot fail.
    let _ = writeln!(
        html,
        "<h2>{}</h2>\n<p>x* is {}; it is itself uncertain by about {:.3} mm.</p>\n<table>\n<tr><th>front, one thread</th>\
         <th>substeps</th><th>iterations</th><th>step us</th><th>mean mm</th><th>max mm</th><th>strain %</th></tr>",
        escaped(&scene.scene),
        escaped(&scene.reference),
        scene.reference_gap_mm
    );
    for p in front::of(&report.points, &scene.scene, &scene.mesh, 1) {
        let _ = writeln!(html, "{}", row(p));
    }
    html.push_str("</table>\n");
    for figure in figures.iter().filter(|f| f.name.starts_with(&format!("{}-", scene.scene))) {
        html.push_str(&svg::text(&figure.drawing));
    }
}

fn row(p: &Point) -> String {
    let own = if p.default { " (its own)" } else { "" };
    format!(
        "<tr><td>{}, {}{own}</td><td>{}</td><td>{}</td><td>{:.0}</td><td>{:.3}</td><td>{:.2}</td><td>{:.3}</td></tr>",
        p.solver,
        p.quality,
        p.substeps,
        p.iterations,
        p.step_us,
        p.error_mm,
        p.max_mm,
        100.0 * p.strain_mean
    )
}

fn put(html: &mut String, figures: &[Figure], name: &str) {
    if let Some(figure) = figures.iter().find(|f| f.name == name) {
        html.push_str(&svg::text(&figure.drawing));
    }
}

fn table_cloth(html: &mut String, drape: &Drape) {
    let _ = writeln!(
        html,
        "<h2>Drape</h2>\n<p>{}</p>\n<table>\n<tr><th>sampling</th><th>particles</th><th>mean cm</th><th>max cm</th>\
         <th>published cm</th><th>step us</th></tr>",
        escaped(&drape.setup)
    );
    for s in &drape.samplings {
        let published = s.published_cm.map_or_else(String::new, |cm| format!("{cm:.2}"));
        let _ = writeln!(
            html,
            "<tr><td>{} cm</td><td>{}</td><td>{:.3}</td><td>{:.2}</td><td>{published}</td><td>{:.0}</td></tr>",
            s.spacing_cm, s.particles, s.mean_cm, s.max_cm, s.step_us
        );
    }
    html.push_str("</table>\n");
}
