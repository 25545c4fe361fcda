//! `toile bench skirt` in words.

use toile_assets::put_line;
use toile_cli::terminal::{Paint, Tone};
use toile_perf::skirt::report::SkirtReport;

/// The summary of a run of the skirt: no time without the error reached at it.
pub fn summary(report: &SkirtReport, paint: Paint) -> String {
    let SkirtReport { verts, motion, mesh, stretch, substeps, lanes, threads, garments, strain, step_us, .. } = report;
    let mut text = String::new();
    put_line!(
        text,
        "{}",
        paint.tone(&format!("A skirt of {verts} vertices ({mesh}, {stretch}), {motion}"), Tone::Strong)
    );
    let quality = format!("quality {}, ", report.quality);
    let wind = if report.wind { ", wind" } else { "" };
    let folds = if report.folds { ", against itself" } else { "" };
    put_line!(
        text,
        "  {quality}{substeps} substeps, {lanes} lanes, {threads} thread(s), {garments} skirt(s){wind}{folds}"
    );
    if let Some(adapter) = report.stepped_by.adapter.as_ref().filter(|_| report.stepped_by.backend == "gpu") {
        let clock = report.device_us.map_or(String::new(), |us| format!("; by its own clock a step takes {us:.1} us"));
        put_line!(text, "  stepped by    {} ({}, {}){clock}", adapter.name, adapter.kind, adapter.driver);
    }
    if let Some(d) = report.decided_by {
        let words = format!("a step took the processor {:.0} us, the device {:.0} us", d.cpu_us, d.gpu_us);
        put_line!(text, "  decided by    {words}: {} steps", report.stepped_by.backend);
    }
    put_line!(text, "  a step takes  {:.1} us, 99 % of them under {:.1} us", step_us.p50, step_us.p99);
    let (ratio, reference) = (report.y_ratio, report.yardstick_us);
    put_line!(text, "  reference     {reference:.1} us: the step takes {ratio:.2} of it");
    let [mean, p99, max] = [strain.mean, strain.p99, strain.max].map(|s| s * 100.0);
    put_line!(text, "  strain        {mean:.3} % mean, {p99:.2} % at the 99th percentile, {max:.1} % at worst");
    let (deepest, inside) = (report.penetration_mm.max, report.penetration_mm.fraction * 100.0);
    put_line!(text, "  penetration   {deepest:.2} mm at worst, {inside:.3} % of the vertices inside");
    if let Some(c) = report.crossings {
        let words =
            format!("{} of {} moments, {} edges at most, longest {:.2} s", c.frames_with, c.frames, c.max, c.longest_s);
        put_line!(text, "  crossings     {words}");
    }
    for (stage, us) in &report.stages_us {
        put_line!(text, "  {stage:13} {us:.1} us");
    }
    let counted = |x: Option<String>| x.unwrap_or_else(|| "not counted".into());
    let memory = counted(report.memory_bytes.map(|b| format!("{:.3} MB", b as f64 * 1e-6)));
    put_line!(
        text,
        "  memory        {memory}; allocations a step: {}",
        counted(report.allocations_per_step.map(|a| a.to_string()))
    );
    put_line!(
        text,
        "  energy        {:.3} mJ of motion at the end; state {}",
        report.kinetic_energy_mj,
        report.state_hash
    );
    let events = [
        (report.hem_winding_wrong, "frames in which the hem does not go around each leg"),
        (report.nonfinite, "vertices that are not finite"),
        (report.events.rolled_back, "steps taken back"),
        (report.events.speed_limited, "particles at the speed limit"),
    ];
    for (count, what) in events.into_iter().filter(|(count, _)| *count > 0) {
        put_line!(text, "  {}", paint.tone(&format!("{count} {what}"), Tone::Warn));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_skirt_summary_says_time_and_error_and_warns_of_what_should_not_be() {
        let mut report = SkirtReport { verts: 4_096, y_ratio: 0.58, motion: "walk", ..SkirtReport::default() };
        report.strain.mean = 0.0014;
        report.memory_bytes = Some(420_000);
        let text = summary(&report, Paint::none());
        for said in ["4096 vertices", "0.58 of it", "0.140 %", "0.420 MB", "allocations a step: not counted"] {
            assert!(text.contains(said), "{said} is not in: {text}");
        }
        assert!(!text.contains("the hem does not"));
        report.hem_winding_wrong = 3;
        assert!(summary(&report, Paint::none()).contains("3 frames in which the hem does not"));
    }
}
