//! The report as one page that needs no other file and no script.

use std::fmt::Write;

use toile_fitting::live::report::Quantiles;

use super::report::{Latency, Stage};

const HEAD: &str = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Toile: latency</title>\n\
<style>\nbody { font-family: system-ui, sans-serif; background: #fff; color: #222; max-width: 1080px; margin: 2em auto; \
padding: 0 1em; }\nsvg { max-width: 100%; height: auto; }\ntable { border-collapse: collapse; }\nth, td { padding: 0.2em \
0.7em; text-align: right; border-bottom: 1px solid #ddd; }\nth:first-child, td:first-child { text-align: left; }\n\
.bad { color: #b00; font-weight: bold; }\n</style>\n</head>\n<body>\n";

/// Width and height of a plot (px), and its room at the left, the right, the top and the bottom.
const SIZE: [f64; 2] = [720.0, 150.0];
const ROOM: [f64; 4] = [60.0, 20.0, 26.0, 30.0];

/// Shortest and longest time of the plots (us): all have the same axis.
const RANGE_US: [f64; 2] = [1.0, 1_000_000.0];

/// The page; `machine` and `scene` are one line of words each.
pub fn page(report: &Latency, machine: &str, scene: &str) -> String {
    let mut html = String::from(HEAD);
    // Writing to a string cannot fail.
    let _ = writeln!(
        html,
        "<h1>From the sensor to the picture</h1>\n<p>{}<br>{}<br>{} s metered after a first second, {} workers, {} threads of \
         load beside them.</p>\n<p>Every time counts from when something was due; steps that were dropped count as late as \
         the one in their place (corrected for coordinated omission).</p>",
        escaped(machine),
        escaped(scene),
        report.seconds,
        report.workers,
        report.load_threads
    );
    goals(&mut html, report);
    misses(&mut html, report);
    quality(&mut html, report);
    stages(&mut html, report);
    threads(&mut html, report);
    capacities(&mut html, report);
    html.push_str("</body>\n</html>\n");
    html
}

fn goals(html: &mut String, report: &Latency) {
    html.push_str("<h2>Goals</h2>\n<table>\n<tr><th>goal</th><th>limit us</th><th>reached us</th><th></th></tr>\n");
    for goal in &report.goals {
        let verdict = if goal.pass { "kept" } else { "<span class=\"bad\">missed</span>" };
        let _ = writeln!(
            html,
            "<tr><td>{}</td><td>{:.0}</td><td>{:.0}</td><td>{verdict}</td></tr>",
            goal.name, goal.limit_us, goal.us
        );
    }
    html.push_str("</table>\n");
}

fn misses(html: &mut String, report: &Latency) {
    let a = &report.attributed;
    let _ = writeln!(
        html,
        "<h2>What was late</h2>\n<p>{} of {} steps missed their deadline ({} of them were dropped): {} pre-empted, {} page \
         faults, {} solver, {} other. {} of {} sensor frames came late into a snapshot.</p>",
        report.deadline_misses,
        report.steps + report.dropped,
        report.dropped,
        a.preempted,
        a.page_fault,
        a.solver,
        a.other,
        report.late_frames,
        report.frames
    );
}

fn quality(html: &mut String, report: &Latency) {
    let q = &report.quality;
    let [mean, p99, max] = q.strain.map(|s| 100.0 * s);
    let _ = writeln!(
        html,
        "<h2>At which error</h2>\n<p>Quality {}, {} substeps, {} particles of which {} move on their own. Strain {mean:.2} % on \
         average, 99 % under {p99:.2} %, at worst {max:.1} %; deepest penetration {:.2} mm; {} steps rolled back.</p>\n<table>\n\
         <tr><th>given up</th><th>steps</th></tr>",
        q.name, q.substeps, q.particles, q.free, q.penetration_mm, q.nonfinite
    );
    for (what, steps) in q.gives_up.iter().zip(&q.rungs) {
        let _ = writeln!(html, "<tr><td>{what}</td><td>{steps}</td></tr>");
    }
    html.push_str("</table>\n");
}

fn stages(html: &mut String, report: &Latency) {
    html.push_str(
        "<h2>Stages</h2>\n<table>\n<tr><th>stage</th><th>budget us</th><th>p50</th><th>p99</th><th>p99.9</th><th>max</th>\
         <th>count</th></tr>\n",
    );
    for stage in &report.stages {
        let budget = stage.budget_us.map_or_else(String::new, |us| us.to_string());
        let Quantiles { p50, p99, p999, max, count } = stage.us;
        let _ = writeln!(
            html,
            "<tr><td>{}</td><td>{budget}</td><td>{p50:.1}</td><td>{p99:.1}</td><td>{p999:.1}</td><td>{max:.1}</td>\
             <td>{count}</td></tr>",
            stage.name
        );
    }
    html.push_str("</table>\n");
    for stage in &report.stages {
        plot(html, stage);
    }
}

fn threads(html: &mut String, report: &Latency) {
    html.push_str("<h2>Threads</h2>\n<table>\n<tr><th>thread</th><th>core</th><th>real-time priority</th></tr>\n");
    for t in &report.threads {
        let [core, priority] = [t.core.map(|c| c.to_string()), t.priority.map(|p| p.to_string())];
        let none = || "none".to_owned();
        let _ = writeln!(
            html,
            "<tr><td>{}</td><td>{}</td><td>{}</td></tr>",
            t.thread,
            core.unwrap_or_else(none),
            priority.unwrap_or_else(none)
        );
    }
    html.push_str("</table>\n<ul>\n");
    for warning in &report.warnings {
        let _ = writeln!(html, "<li>{}</li>", escaped(warning));
    }
    html.push_str("</ul>\n");
}

fn capacities(html: &mut String, report: &Latency) {
    html.push_str(
        "<h2>Capacities</h2>\n<table>\n<tr><th>bound</th><th>places</th><th>most used</th><th>lost</th></tr>\n",
    );
    for c in &report.capacities {
        let lost = if c.lost > 0 { format!("<span class=\"bad\">{}</span>", c.lost) } else { c.lost.to_string() };
        let _ = writeln!(
            html,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{lost}</td></tr>",
            escaped(c.constant),
            c.bound,
            c.high_water
        );
    }
    html.push_str("</table>\n");
}

/// A histogram: bars as high as the logarithm of their counts, so that a single late one is seen.
fn plot(html: &mut String, stage: &Stage) {
    let ([width, height], [left, right, top, bottom]) = (SIZE, ROOM);
    let decades = (RANGE_US[1] / RANGE_US[0]).log10();
    let across = |us: f64| left + (width - left - right) * ((us / RANGE_US[0]).log10() / decades).clamp(0.0, 1.0);
    let most = stage.bars.iter().map(|b| b.1).max().unwrap_or(1).max(10) as f64;
    let floor = height - bottom;
    let up = |count: f64| floor - (floor - top) * ((1.0 + count).ln() / (1.0 + most).ln());
    let _ = writeln!(
        html,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" role=\"img\" \
         font-family=\"ui-monospace, monospace\" font-size=\"12\" fill=\"#222\">\n<text x=\"{left}\" y=\"16\" \
         font-weight=\"bold\">{}</text>",
        stage.name
    );
    for k in 0..=decades as i32 {
        let us = RANGE_US[0] * 10f64.powi(k);
        let label = match us {
            ..1e3 => format!("{us} us"),
            ..1e6 => format!("{} ms", us / 1e3),
            _ => format!("{} s", us / 1e6),
        };
        let x = across(us);
        let _ = writeln!(
            html,
            "<line x1=\"{x:.1}\" y1=\"{top}\" x2=\"{x:.1}\" y2=\"{floor}\" stroke=\"#e1e1e1\"/><text x=\"{x:.1}\" \
             y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
            floor + 18.0
        );
    }
    let bar = (across(10.0) - across(1.0)) / 12.0;
    for (us, count) in &stage.bars {
        let (x, y) = (across(*us) - bar, up(*count as f64));
        let _ = writeln!(
            html,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#0072b2\"><title>up to {us:.1} us: \
             {count}</title></rect>",
            bar - 1.0,
            floor - y
        );
    }
    if let Some(budget) = stage.budget_us {
        let x = across(budget as f64);
        let _ = writeln!(
            html,
            "<line x1=\"{x:.1}\" y1=\"{top}\" x2=\"{x:.1}\" y2=\"{floor}\" stroke=\"#be2828\" stroke-width=\"1.5\" \
             stroke-dasharray=\"6 4\"/><text x=\"{:.1}\" y=\"16\" fill=\"#be2828\">budget {budget} us</text>",
            x.min(width - 110.0)
        );
    }
    let _ = writeln!(
        html,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{most:.0}</text>\n</svg><br>",
        left - 6.0,
        top + 8.0
    );
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
