//! `toile bench skirt --garment` in words.

use toile_assets::put_line;
use toile_cli::terminal::{Paint, Tone};
use toile_perf::worn::WornReport;

/// The summary of a run of garments on a mannequin: no time without the error reached at it.
pub fn summary(report: &WornReport, paint: Paint) -> String {
    let WornReport { garments, sizes, moving, quality, substeps, lanes, threads, strain, step_us, .. } = report;
    let mut text = String::new();
    let worn: Vec<String> = garments.iter().zip(sizes).map(|(name, size)| format!("{name} {size}")).collect();
    let title = format!("{} on a performing mannequin, {moving} particles that move", worn.join(" over "));
    put_line!(text, "{}", paint.tone(&title, Tone::Strong));
    let substeps: Vec<String> = substeps.iter().map(u32::to_string).collect();
    put_line!(text, "  quality {quality}, {} substeps, {lanes} lanes, {threads} thread(s)", substeps.join(" and "));
    if let Some(adapter) = report.stepped_by.adapter.as_ref().filter(|_| report.stepped_by.backend == "gpu") {
        put_line!(text, "  stepped by    {} ({}, {})", adapter.name, adapter.kind, adapter.driver);
    }
    put_line!(text, "  a step takes  {:.1} us, 99 % of them under {:.1} us", step_us.p50, step_us.p99);
    let [mean, p99, max] = [strain.mean, strain.p99, strain.max].map(|s| s * 100.0);
    put_line!(text, "  strain        {mean:.3} % mean, {p99:.2} % at the 99th percentile, {max:.1} % at worst");
    put_line!(text, "  penetration   {:.2} mm at worst", report.deepest_mm);
    for (stage, us) in &report.stages_us {
        put_line!(text, "  {stage:13} {us:.1} us");
    }
    let counted = |x: Option<String>| x.unwrap_or_else(|| "not counted".into());
    let memory = counted(report.memory_bytes.map(|b| format!("{:.3} MB", b as f64 * 1e-6)));
    let allocations = counted(report.allocations_per_step.map(|a| a.to_string()));
    put_line!(text, "  memory        {memory}; allocations a step: {allocations}");
    put_line!(text, "  state         {}", report.state_hash);
    let events = [
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
    fn it_names_garments_and_sizes_and_says_time_and_error() {
        let mut report = WornReport { moving: 8_000, quality: "shop", ..WornReport::default() };
        report.garments = vec!["wide-leg-trousers".into(), "tee".into()];
        report.sizes = vec!["50".into(), "M".into()];
        report.strain.mean = 0.0024;
        let text = summary(&report, Paint::none());
        for part in ["wide-leg-trousers 50 over tee M", "8000 particles", "0.240 % mean", "not counted"] {
            assert!(text.contains(part), "{part} is not in: {text}");
        }
    }
}
