//! The report as one page.

use super::charts::NamedDrawing;
use super::front;
use super::report::{Drape, ModelPoint, ParetoReport, Point, SceneReport};
use toile_view::plot::page::{Entry, Page};

const FRONT: [&str; 7] = ["front, one thread", "substeps", "iterations", "step us", "mean mm", "max mm", "strain %"];

const MODELS: [&str; 7] = ["fabric with", "stepped", "substeps", "step us", "mean mm", "max mm", "strain %"];

const SAMPLINGS: [&str; 6] = ["sampling", "particles", "mean cm", "max cm", "published cm", "step us"];

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
    draw(&mut page, figures, |name| name == "survival");
    if !report.models.is_empty() {
        page.section("Models").paragraph(
            "The walking skirt in a fabric with numbers for one model, stepped with it and without it from the same \
             moments. x* has the model.",
        );
        page.table(&MODELS, report.models.iter().map(model_row));
        draw(&mut page, figures, |name| name == "models");
    }
    if let Some(drape) = &report.drape {
        table_cloth(&mut page, drape);
        draw(&mut page, figures, |name| name == "drape");
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

fn model_row(p: &ModelPoint) -> Vec<Entry> {
    vec![
        Entry::words(p.model),
        Entry::words(if p.with { "with it" } else { "without it" }),
        Entry::figure(p.substeps),
        Entry::Figure(format!("{:.0}", p.step_us)),
        Entry::Figure(format!("{:.3}", p.error_mm)),
        Entry::Figure(format!("{:.2}", p.max_mm)),
        Entry::Figure(format!("{:.3}", 100.0 * p.strain[0])),
    ]
}

fn table_cloth(page: &mut Page, drape: &Drape) {
    let row = |s: &super::report::Sampling| {
        vec![
            Entry::words(format!("{} cm", s.spacing_cm)),
            Entry::figure(s.particles),
            Entry::Figure(format!("{:.3}", s.mean_cm)),
            Entry::Figure(format!("{:.2}", s.max_cm)),
            Entry::Figure(s.published_cm.map_or_else(String::new, |cm| format!("{cm:.2}"))),
            Entry::Figure(format!("{:.0}", s.step_us)),
        ]
    };
    page.section("Drape").paragraph(&drape.setup).table(&SAMPLINGS, drape.samplings.iter().map(row));
}
