//! The record as one page that needs no other file and no script.

use std::fmt::Write;

use super::memory::Sample;
use super::report::{Check, Memory, Soak};
use super::watch::FOLLOWS_M;

const HEAD: &str = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Toile: soak</title>\n\
<style>\nbody { font-family: system-ui, sans-serif; background: #fff; color: #222; max-width: 960px; margin: 2em auto; \
padding: 0 1em; font-size: 15px; }\nsvg { max-width: 100%; height: auto; }\ntable { border-collapse: collapse; margin: 0.5em 0; }\n\
th, td { padding: 0.15em 0.8em; text-align: right; border-bottom: 1px solid #ddd; }\nth:first-child, td:first-child, .words { \
text-align: left; white-space: nowrap; }\nh1 { margin-bottom: 0.2em; }\nh2 { margin: 1.2em 0 0.2em; font-size: 1.15em; }\n.bad { color: #b00; \
font-weight: bold; }\n.good { color: #075; }\n.bar { display: inline-block; height: 0.7em; background: #0072b2; }\n</style>\n\
</head>\n<body>\n";

/// Width of the longest bar (px), which is the limit.
const BAR_PX: f64 = 120.0;

/// The limit of a recovery (ms).
const LIMIT_MS: f64 = 1_000.0;

/// Width and height of the plot (px), and its room at the left, the right, the top and the bottom.
const SIZE: [f64; 2] = [920.0, 210.0];
const ROOM: [f64; 4] = [70.0, 20.0, 14.0, 34.0];

/// The page; `machine` is a line of words, `command` what was typed.
pub fn page(soak: &Soak, machine: &str, command: &str) -> String {
    let mut html = String::from(HEAD);
    // Writing to a string cannot fail.
    let failed = soak.failed().count();
    let verdict = match failed {
        0 => "<span class=\"good\">all checks passed</span>".to_owned(),
        n => format!("<span class=\"bad\">{n} of {} checks failed</span>", soak.checks.len()),
    };
    let _ =
        writeln!(html, "<h1>Soak: {} faults in {}</h1>\n<p>{verdict}</p>", soak.faults.injected, length(soak.hours));
    let way = if soak.real_time { "in real time, on threads" } else { "on a simulated clock, as fast as possible" };
    let _ = writeln!(
        html,
        "<p>Toile {}, {}<br><code>{}</code><br>{way}: {} steps in {:.0} s, {:.0} us a step with everything around it; {} scene, {} \
         worker(s), seed {}; the clock began at an uptime of {} h.</p>\n<p>{} shoppers came and went; {} scenes were handed to the \
         running loop, {} of {} garments and sizes were worn. {} sensor frames were taken, {} pictures shown. {} steps missed their \
         deadline or were dropped, by stalls and jumps of the clock where the run is simulated.</p>",
        env!("CARGO_PKG_VERSION"),
        escaped(machine),
        escaped(command),
        soak.ticks,
        soak.wall_s,
        soak.us_per_step,
        soak.scene.name(),
        soak.workers,
        soak.seed,
        soak.uptime_hours,
        soak.visits,
        soak.changes,
        soak.sizes[0],
        soak.sizes[1],
        soak.frames[0],
        soak.pictures[0],
        soak.deadline_misses
    );
    checks(&mut html, soak);
    faults(&mut html, soak);
    memory(&mut html, &soak.memory);
    warnings(&mut html, soak);
    html.push_str("</body>\n</html>\n");
    html
}

fn length(hours: f64) -> String {
    if hours >= 1.0 { format!("{hours:.1} hours") } else { format!("{:.0} minutes", hours * 60.0) }
}

/// A figure without digits that say nothing.
fn figure(value: f64) -> String {
    if value.fract().abs() < 1e-9 { format!("{value:.0}") } else { format!("{value:.1}") }
}

fn checks(html: &mut String, soak: &Soak) {
    html.push_str("<h2>Checks</h2>\n<table>\n<tr><th>check</th><th>at most</th><th>found</th><th></th></tr>\n");
    for Check { name, limit, found, pass } in &soak.checks {
        let verdict = match (found, pass) {
            (None, _) => "not checked",
            (_, true) => "<span class=\"good\">passed</span>",
            (_, false) => "<span class=\"bad\">failed</span>",
        };
        let found = found.map_or_else(|| "-".to_owned(), figure);
        let _ = writeln!(html, "<tr><td>{name}</td><td>{}</td><td>{found}</td><td>{verdict}</td></tr>", figure(*limit));
    }
    let second = soak.second_state_hash.as_deref().unwrap_or("none was made");
    let _ = writeln!(
        html,
        "</table>\n<p>State of all steps: <code>{}</code>; second run: <code>{second}</code>. While nothing was wrong, the joints \
         that were shown were at most {:.0} mm from the shopper's, averaged over the joints.</p>",
        soak.state_hash, soak.off_mm
    );
}

fn faults(html: &mut String, soak: &Soak) {
    if soak.faults.kinds.is_empty() {
        return;
    }
    html.push_str(
        "<h2>Faults</h2>\n<table>\n<tr><th>fault</th><th>injected</th><th>recovered</th><th>mean ms</th><th>max ms</th>\
         <th class=\"words\">of 1 s</th><th class=\"words\">recovered when</th></tr>\n",
    );
    for k in &soak.faults.kinds {
        let class = if k.recovered < k.injected || k.max_ms > LIMIT_MS { " class=\"bad\"" } else { "" };
        let _ = writeln!(
            html,
            "<tr><td>{}</td><td>{}</td><td{class}>{}</td><td>{:.0}</td><td{class}>{:.0}</td><td class=\"words\"><span class=\"bar\" \
             style=\"width:{:.0}px\"></span></td><td class=\"words\">{}</td></tr>",
            escaped(k.name),
            k.injected,
            k.recovered,
            k.mean_ms,
            k.max_ms,
            (k.max_ms / LIMIT_MS).min(1.0) * BAR_PX,
            k.recovered_when
        );
    }
    let _ = writeln!(
        html,
        "</table>\n<p>Time counts from the end of the fault. Followed again: a step that is published in time knows a frame of after the \
         fault, and its joints are on average within {:.0} mm of where the shopper is.</p>",
        1e3 * FOLLOWS_M
    );
}

/// One of a sample's figures.
type Figure = fn(&Sample) -> Option<u64>;

/// Resident memory and the heap over the run.
fn memory(html: &mut String, memory: &Memory) {
    let _ = writeln!(
        html,
        "<h2>Memory</h2>\n<p>Blue: resident; orange: handed out by the allocator. Growth behind the warm-up (dashed), per {} hour: \
         {} KiB resident, {} KiB handed out (median of all slopes).</p>",
        memory.hours_are,
        memory.rss_growth_kib_h.map_or_else(|| "-".into(), |g| format!("{g:.1}")),
        memory.heap_growth_kib_h.map_or_else(|| "-".into(), |g| format!("{g:.1}"))
    );
    let most = memory.rss_max_kib.unwrap_or(0) as f64 / 1024.0 * 1.1;
    let until = memory.samples.last().map_or(0.0, |s| s.hours);
    if most == 0.0 || until == 0.0 {
        return;
    }
    let ([width, height], [left, right, top, bottom]) = (SIZE, ROOM);
    let across = |h: f64| left + (width - left - right) * h / until;
    let floor = height - bottom;
    let up = |mib: f64| floor - (floor - top) * mib / most;
    let _ = writeln!(
        html,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" role=\"img\" \
         font-family=\"ui-monospace, monospace\" font-size=\"12\" fill=\"#222\">"
    );
    for k in 0..=4 {
        let share = f64::from(k) / 4.0;
        let (x, y) = (across(until * share), up(most * share));
        let at =
            if until >= 1.0 { format!("{:.1} h", until * share) } else { format!("{:.0} s", until * share * 3_600.0) };
        let _ = writeln!(
            html,
            "<line x1=\"{left}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{y:.1}\" stroke=\"#e1e1e1\"/><text x=\"{:.1}\" y=\"{:.1}\" \
             text-anchor=\"end\">{:.0} MiB</text><text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{at}</text>",
            width - right,
            left - 6.0,
            y + 4.0,
            most * share,
            floor + 20.0
        );
    }
    let lines: [(&str, Figure); 2] = [("#0072b2", |s| s.rss_kib), ("#d55e00", |s| s.heap_kib)];
    for (colour, of) in lines {
        let points: Vec<String> = memory
            .samples
            .iter()
            .filter_map(|s| Some(format!("{:.1},{:.1}", across(s.hours), up(of(s)? as f64 / 1024.0))))
            .collect();
        let _ = writeln!(
            html,
            "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\" points=\"{}\"/>",
            points.join(" ")
        );
    }
    let x = across(memory.from_h);
    let _ = writeln!(
        html,
        "<line x1=\"{x:.1}\" y1=\"{top}\" x2=\"{x:.1}\" y2=\"{floor}\" stroke=\"#888\" stroke-dasharray=\"6 4\"/>\n</svg>"
    );
}

fn warnings(html: &mut String, soak: &Soak) {
    html.push_str(
        "<h2>Queues</h2>\n<table>\n<tr><th>bound</th><th>places</th><th>most at once</th><th>lost</th></tr>\n",
    );
    for c in &soak.capacities {
        let _ = writeln!(
            html,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            c.constant, c.bound, c.high_water, c.lost
        );
    }
    html.push_str("</table>\n");
    if !soak.warnings.is_empty() {
        html.push_str("<ul>\n");
        for warning in &soak.warnings {
            let _ = writeln!(html, "<li>{}</li>", escaped(warning));
        }
        html.push_str("</ul>\n");
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
