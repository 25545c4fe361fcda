//! A plan as people read it.

use toile_cli::terminal::{Paint, Tone};
use toile_fitting::plan::report::Plan;
use toile_fitting::plan::weigh::Played;
use toile_fitting::plan::work::STAGES;
use toile_fitting::scene::contact::ContactReport;

/// The plan as tables for a terminal; `costs` adds the time of each kind of work.
pub fn table(plan: &Plan, costs: bool, paint: Paint) -> String {
    let mut lines = vec![paint.tone(&format!("Plan: {}", plan.scene), Tone::Strong).into_owned()];
    lines.push(format!("  {} workers, {} lanes, a step every {:.0} us", plan.workers, plan.lanes, plan.period_us));
    garments(plan, &mut lines);
    reach(plan, &mut lines);
    memory(plan, &mut lines);
    stages(plan, &mut lines, paint);
    if let Some(played) = &plan.played {
        models(plan, played, &mut lines);
    }
    if costs {
        lines.push(format!("\n  {:<10} {:<32} {:>9}", "costs of", "a unit", "ns"));
        lines.extend(plan.units.iter().map(|u| format!("  {:<10} {:<32} {:>9.2}", u.stage, u.unit, u.ns)));
    }
    lines.join("\n") + "\n"
}

fn garments(plan: &Plan, lines: &mut Vec<String>) {
    lines.push(format!(
        "\n  {:<16} {:>9} {:>7} {:>8} {:>9} {:>7} {:>12} {:>12}",
        "garment", "particles", "moving", "mm apart", "substeps", "near", "us, 1 core", "us, 2 cores"
    ));
    for g in &plan.garments {
        lines.push(format!(
            "  {:<16} {:>9} {:>7} {:>8.1} {:>9} {:>7} {:>12.0} {:>12.0}",
            g.name, g.particles, g.free, g.spacing_mm, g.substeps, g.near, g.us[0], g.us[1]
        ));
    }
}

fn reach(plan: &Plan, lines: &mut Vec<String>) {
    lines.push(format!(
        "\n  {:<16} {:<10} {:>9} {:>14} {:>10} {:>7}  can touch",
        "garment", "part", "particles", "capsules, part", "by length", "mean"
    ));
    for r in &plan.reach {
        lines.push(format!(
            "  {:<16} {:<10} {:>9} {:>14} {:>10} {:>7.1}  {}",
            r.garment,
            r.part,
            r.particles,
            r.by_part,
            r.by_length,
            r.mean,
            shortened(&r.touches)
        ));
    }
}

/// Most names of a list that are printed.
const NAMES: usize = 6;

fn shortened(names: &[String]) -> String {
    let more = names.len().saturating_sub(NAMES);
    let shown = names[..names.len() - more].join(", ");
    if more > 0 { format!("{shown} and {more} more") } else { shown }
}

fn memory(plan: &Plan, lines: &mut Vec<String>) {
    lines.push(format!("\n  {:<50} {:>9}", "memory", "KiB"));
    let kib = |bytes: u64| bytes.div_ceil(1024);
    lines.extend(plan.memory.iter().map(|m| format!("  {:<50} {:>9}", m.part, kib(m.bytes))));
    lines.push(format!("  {:<50} {:>9}", "together", kib(plan.memory.iter().map(|m| m.bytes).sum())));
}

fn stages(plan: &Plan, lines: &mut Vec<String>, paint: Paint) {
    lines.push(format!("\n  {:<10} {:>12} {:>10}", "stage", "predicted us", "budget us"));
    for s in &plan.stages {
        let over = if s.within { "" } else { "  over" };
        lines.push(format!("  {:<10} {:>12.0} {:>10.0}{over}", s.stage, s.predicted_us, s.budget_us));
    }
    let v = &plan.verdict;
    let total = format!("  {:<10} {:>12.0} {:>10.0}", "step", v.step_us, v.budget_us);
    let tone = if v.within_budget { Tone::Good } else { Tone::Warn };
    lines.push(paint.tone(&total, tone).into_owned());
    if let (Some(held), Some(played)) = (&plan.held, &plan.played) {
        let ([p50, p99], [total, one, off]) = (held.measured_us, held.one_core);
        lines.push(format!(
            "  played: cloth {p50:.0} us in the median, {p99:.0} us at 99 %, {} pairs near; the prediction is {:+.0} % off the median",
            played.near, held.error_percent
        ));
        lines.push(format!("  on one core: {total:.0} us predicted, {one:.0} us played, {off:+.0} % off"));
        let warnings = played.contact.iter().flat_map(ContactReport::warnings);
        lines.extend(warnings.map(|w| paint.tone(&format!("  {w}"), Tone::Warn).into_owned()));
    }
    if !v.within_budget {
        let gives_up = v.gives_up.map_or_else(
            || "the last quality level does not bring it within the budget".to_owned(),
            |what| format!("the quality control gives up {what} to hold the budget"),
        );
        lines.push(paint.tone(&format!("  {gives_up}"), Tone::Warn).into_owned());
        lines.extend(v.cures.iter().map(|c| format!("  cure: {c}")));
    }
}

fn models(plan: &Plan, played: &Played, lines: &mut Vec<String>) {
    let all = |k: &str| plan.garments.iter().filter_map(|g| g.stages_us.get(k)).sum::<f64>();
    lines.push(format!("\n  {:<10} {:>12} {:>12}", "cloth", "predicted us", "played us"));
    for (stage, us) in STAGES.iter().zip(played.stages_us) {
        lines.push(format!("  {stage:<10} {:>12.0} {us:>12.0}", all(stage)));
    }
    lines.push(format!(
        "\n  {:<50} {:>8} {:>8} {:>8} {:>9}",
        "model, and the error of being without it", "mean mm", "99 % mm", "worst mm", "takes us"
    ));
    for on in [true, false] {
        lines.push(format!("  {}", if on { "on:" } else { "left out:" }));
        for m in played.models.iter().filter(|m| m.on == on) {
            let [mean, p99, max] = m.error_mm;
            lines.push(format!("    {:<48} {mean:>8.3} {p99:>8.2} {max:>8.2} {:>9.0}", m.model, m.us));
        }
    }
    lines.push("    (50 ms from the same state; times on one core, all garments)".to_owned());
}
