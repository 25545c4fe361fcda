//! The report as one page.

use toile_fitting::live::report::{Quantiles, QueueUse, ThreadPlacement};

use super::report::{BARS, Goal, Latency, LatencyStage};
use toile_view::plot::histogram::Histogram;
use toile_view::plot::page::{Entry, Page};

/// The page; `machine` and `scene` are one line of words each.
pub fn page(report: &Latency, machine: &str, scene: &str) -> String {
    let Latency { seconds, workers, load_threads, .. } = report;
    let mut page = Page::new("Toile: latency");
    page.title("From the sensor to the picture").paragraph(&format!(
        "{machine}\n{scene}\n{seconds} s metered after a first second, {workers} workers, {load_threads} threads of load \
         beside them."
    ));
    page.paragraph(
        "Every time counts from when something was due; steps that were dropped count as late as the one in their place \
         (corrected for coordinated omission).",
    );
    page.section("Goals").table(&["goal", "limit us", "reached us", ""], report.goals.iter().map(goal));
    page.section("What was late").paragraph(&misses(report));
    quality(&mut page, report);
    page.section("Stages")
        .table(&["stage", "budget us", "p50", "p99", "p99.9", "max", "count"], report.stages.iter().map(stage));
    for LatencyStage { name, bars, budget_us, .. } in &report.stages {
        let budget_us = budget_us.map(|us| us as f64);
        page.drawing(&Histogram { title: name, bars, bars_per_decade: BARS, budget_us }.draw());
    }
    page.section("Threads").table(&["thread", "core", "real-time priority"], report.threads.iter().map(thread));
    page.list(&report.warnings);
    page.section("Capacities");
    page.table(&["bound", "places", "most used", "lost"], report.capacities.iter().map(capacity));
    page.finish()
}

fn goal(goal: &Goal) -> Vec<Entry> {
    let verdict = if goal.pass { Entry::Good("kept".into()) } else { Entry::Bad("missed".into()) };
    let us = |us: f64| Entry::Figure(format!("{us:.0}"));
    vec![Entry::words(goal.name), us(goal.limit_us), us(goal.us), verdict]
}

fn misses(report: &Latency) -> String {
    let a = &report.attributed;
    format!(
        "{} of {} steps missed their deadline ({} of them were dropped): {} pre-empted, {} page faults, {} solver, {} other. \
         {} of {} sensor frames came late into a snapshot.",
        report.deadline_misses,
        report.steps + report.dropped,
        report.dropped,
        a.preempted,
        a.page_fault,
        a.solver,
        a.other,
        report.late_frames,
        report.frames
    )
}

fn quality(page: &mut Page, report: &Latency) {
    let q = &report.quality;
    let [mean, p99, max] = q.strain.map(|s| 100.0 * s);
    page.section("At which error").paragraph(&format!(
        "Quality {}, {} substeps, {} particles of which {} move on their own. Strain {mean:.2} % on average, 99 % under \
         {p99:.2} %, at worst {max:.1} %; deepest penetration {:.2} mm; {} steps rolled back.",
        q.name, q.substeps, q.particles, q.free, q.penetration_mm, q.nonfinite
    ));
    let levels = q.gives_up.iter().zip(&q.rungs).map(|(what, steps)| vec![Entry::words(*what), Entry::figure(steps)]);
    page.table(&["given up", "steps"], levels);
}

fn stage(stage: &LatencyStage) -> Vec<Entry> {
    let budget = stage.budget_us.map_or_else(String::new, |us| us.to_string());
    let Quantiles { p50, p99, p999, max, count } = stage.us;
    let times = [p50, p99, p999, max].map(|us| Entry::Figure(format!("{us:.1}")));
    [Entry::words(stage.name), Entry::Figure(budget)].into_iter().chain(times).chain([Entry::figure(count)]).collect()
}

fn thread(t: &ThreadPlacement) -> Vec<Entry> {
    let or_none = |value: Option<String>| Entry::Figure(value.unwrap_or_else(|| "none".into()));
    vec![
        Entry::words(t.thread.to_string()),
        or_none(t.core.map(|c| c.to_string())),
        or_none(t.priority.map(|p| p.to_string())),
    ]
}

fn capacity(c: &QueueUse) -> Vec<Entry> {
    let lost = if c.lost > 0 { Entry::Bad(c.lost.to_string()) } else { Entry::figure(c.lost) };
    vec![Entry::words(c.constant), Entry::figure(c.bound), Entry::figure(c.high_water), lost]
}
