//! The report as one page.

use super::charts::NamedDrawing;
use super::front;
use super::report::{ParetoReport, Point, SceneReport};
use toile_view::plot::page::{Entry, Page};

const FRONT: [&str; 7] = ["front, one thread", "substeps", "iterations", "step us", "mean mm", "max mm", "strain %"];

/// The report as one page of HTML with its charts.
pub fn page(report: &ParetoReport, figures: &[NamedDrawing]) -> String {
    let mut page = Page::new("Toile: speed against error");
    page.title("Speed against error").paragraph(
        "Every point is one setting of one scene: the median time of a step of 1/120 s, and the mean distance of the \
         free particles to x* over the frames that are compared. No setting is both faster and nearer than one on the \
         front.",
    );
    if report.quick {
        page.paragraph("A quick look: few settings of small meshes.");
    }
    for scene in report.scenes.iter().filter(|s| s.main) {
        section(&mut page, report, scene, figures);
    }
    page.finish()
}

fn draw(page: &mut Page, figures: &[NamedDrawing], is: impl Fn(&str) -> bool) {
    for figure in figures.iter().filter(|figure| is(&figure.name)) {
        page.drawing(&figure.drawing);
    }
}

fn section(page: &mut Page, report: &ParetoReport, scene: &SceneReport, figures: &[NamedDrawing]) {
    let (reference, gap) = (&scene.reference, scene.reference_gap_mm);
    page.section(&scene.scene);
    page.paragraph(&format!("x* is {reference}; it is itself uncertain by about {gap:.3} mm."));
    page.table(&FRONT, front::of(&report.points, &scene.scene, &scene.mesh, 1).into_iter().map(row));
    draw(page, figures, |name| name.starts_with(&format!("{}-", scene.scene)));
}

fn row(p: &Point) -> Vec<Entry> {
    let own = if p.default { " (its own)" } else { "" };
    vec![
        Entry::words(format!("{}, {}{own}", p.solver, p.quality)),
        Entry::figure(p.substeps),
        Entry::figure(p.iterations),
        Entry::Figure(format!("{:.0}", p.step_us)),
        Entry::Figure(format!("{:.3}", p.error_mm)),
        Entry::Figure(format!("{:.2}", p.max_mm)),
        Entry::Figure(format!("{:.3}", 100.0 * p.strain_mean)),
    ]
}
