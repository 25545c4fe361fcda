//! The record as one page.

use toile_fitting::live::report::QueueUse;

use super::fault_monitor::FOLLOWS_M;
use super::memory::MemorySample;
use super::report::{FaultKindFigures, MemoryFigures, Soak, SoakCheck};
use toile_view::plot::axis::Axis;
use toile_view::plot::chart::{Chart, Series, SeriesStyle};
use toile_view::plot::page::{Entry, Page};
use toile_view::plot::{Drawing, SERIES_COLOURS};

/// The limit of a recovery (ms).
const LIMIT_MS: f64 = 1_000.0;

/// The page; `machine` is a line of words, `command` what was typed.
pub fn page(soak: &Soak, machine: &str, command: &str) -> String {
    let mut page = Page::new("Toile: soak");
    page.title(&format!("Soak: {} faults in {}", soak.faults.injected, length(soak.hours)));
    match soak.failed().count() {
        0 => page.good("All checks passed."),
        n => page.bad(&format!("{n} of {} checks failed.", soak.checks.len())),
    };
    page.paragraph(&run(soak, machine, command)).paragraph(&seen(soak));
    checks(&mut page, soak);
    faults(&mut page, soak);
    memory(&mut page, &soak.memory);
    let queue = |c: &QueueUse| {
        vec![Entry::words(c.constant), Entry::figure(c.bound), Entry::figure(c.high_water), Entry::figure(c.lost)]
    };
    page.section("Queues").table(&["bound", "places", "most at once", "lost"], soak.capacities.iter().map(queue));
    page.list(&soak.warnings);
    page.finish()
}

/// What was run, and how.
fn run(soak: &Soak, machine: &str, command: &str) -> String {
    let way = if soak.real_time { "in real time, on threads" } else { "on a simulated clock, as fast as possible" };
    format!(
        "Toile {}, {machine}\n{command}\n{way}: {} steps in {:.0} s, {:.0} us a step with everything around it; {} scene, \
         {} seen by the camera, {} worker(s), seed {}; the clock began at an uptime of {} h.",
        env!("CARGO_PKG_VERSION"),
        soak.ticks,
        soak.wall_s,
        soak.us_per_step,
        soak.scene.name(),
        soak.camera.name(),
        soak.workers,
        soak.seed,
        soak.uptime_hours,
    )
}

/// What happened in it.
fn seen(soak: &Soak) -> String {
    format!(
        "{} shoppers came and went; {} scenes were handed to the running loop, {} of {} garments and sizes were worn. {} \
         sensor frames were taken, {} pictures shown. {} steps missed their deadline or were dropped, by stalls and jumps of \
         the clock where the run is simulated.",
        soak.visits, soak.changes, soak.sizes[0], soak.sizes[1], soak.frames[0], soak.pictures[0], soak.deadline_misses
    )
}

fn length(hours: f64) -> String {
    if hours >= 1.0 { format!("{hours:.1} hours") } else { format!("{:.0} minutes", hours * 60.0) }
}

/// A figure without digits that say nothing.
fn figure(value: f64) -> String {
    if value.fract().abs() < 1e-9 { format!("{value:.0}") } else { format!("{value:.1}") }
}

fn checks(page: &mut Page, soak: &Soak) {
    let row = |SoakCheck { name, limit, found, pass }: &SoakCheck| {
        let verdict = match (found, pass) {
            (None, _) => Entry::words("not checked"),
            (_, true) => Entry::Good("passed".into()),
            (_, false) => Entry::Bad("failed".into()),
        };
        let found = found.map_or_else(|| "-".to_owned(), figure);
        vec![Entry::words(*name), Entry::Figure(figure(*limit)), Entry::Figure(found), verdict]
    };
    page.section("Checks").table(&["check", "at most", "found", ""], soak.checks.iter().map(row));
    let second = soak.second_state_hash.as_deref().unwrap_or("none was made");
    page.paragraph(&format!(
        "State of all steps: {}; second run: {second}. While nothing was wrong, the joints that were shown were at most \
         {:.0} mm from the shopper's, averaged over the joints.",
        soak.state_hash, soak.off_mm
    ));
}

fn faults(page: &mut Page, soak: &Soak) {
    if soak.faults.kinds.is_empty() {
        return;
    }
    let row = |k: &FaultKindFigures| {
        let recovered = k.recovered >= k.injected && k.max_ms <= LIMIT_MS;
        let judged = |text: String| if recovered { Entry::Figure(text) } else { Entry::Bad(text) };
        vec![
            Entry::words(k.name),
            Entry::figure(k.injected),
            judged(k.recovered.to_string()),
            Entry::Figure(format!("{:.0}", k.mean_ms)),
            judged(format!("{:.0}", k.max_ms)),
            Entry::Bar(k.max_ms / LIMIT_MS),
            k.noticed_max_ms.map_or(Entry::words("-"), |ms| Entry::Figure(format!("{ms:.0}"))),
            Entry::words(k.recovered_when),
        ]
    };
    let heads = ["fault", "injected", "recovered", "mean ms", "max ms", "of 1 s", "noticed ms", "recovered when"];
    page.section("Faults").table(&heads, soak.faults.kinds.iter().map(row));
    page.paragraph(&format!(
        "Time counts from the end of the fault; until a blind camera is noticed, at most, from its begin. Followed again: a step that is published in time knows a frame of after the \
         fault, and its joints are on average within {:.0} mm of where the shopper is.",
        1e3 * FOLLOWS_M
    ));
}

/// Resident memory and the heap over the run.
fn memory(page: &mut Page, memory: &MemoryFigures) {
    let kib = |growth: Option<f64>| growth.map_or_else(|| "-".into(), |g| format!("{g:.1}"));
    page.section("Memory").paragraph(&format!(
        "Growth behind the warm-up, per {} hour: {} KiB resident, {} KiB handed out by the allocator (median of all slopes).",
        memory.hours_are,
        kib(memory.rss_growth_kib_h),
        kib(memory.heap_growth_kib_h)
    ));
    if memory.samples.len() > 1 {
        page.drawing(&plot(memory));
    }
}

fn plot(memory: &MemoryFigures) -> Drawing {
    let series = |name: &str, colour: usize, kib: fn(&MemorySample) -> Option<u64>| Series {
        name: name.into(),
        points: memory.samples.iter().filter_map(|s| Some([s.hours, kib(s)? as f64 / 1024.0])).collect(),
        style: SeriesStyle::line(SERIES_COLOURS[colour], 1.5),
    };
    let series = vec![series("resident", 0, |s| s.rss_kib), series("handed out", 1, |s| s.heap_kib)];
    let all = || series.iter().flat_map(|s| &s.points);
    let x = Axis::around("hours", false, all().map(|p| p[0]));
    let y = Axis::around("memory (MiB)", false, all().map(|p| p[1]).chain([0.0]));
    let rules = vec![(memory.from_h, "warm-up")];
    Chart { title: "Memory over the run".into(), x, y, series, rules }.draw()
}
