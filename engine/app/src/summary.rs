//! The reports as people read them: what `--json` says, in words and tables.

use std::fmt::Write;

use toile_perf::skirt::report::SkirtReport;

use crate::report::{
    BodyReport, MeasureReport, MeasuredLength, PhysicsReport, Recommendation, RunReport, SessionReport,
    ShopperMeasures, SkinningReport, TryOn,
};
use crate::terminal::{Paint, Tone};

/// The summary of a try-on.
pub fn try_on(report: &TryOn, paint: Paint) -> String {
    let mut text = String::new();
    session(&mut text, &report.session);
    measurements(&mut text, &report.measurements, paint);
    for worn in std::iter::once(&report.recommendation).chain(&report.others) {
        recommendation(&mut text, worn, paint);
    }
    physics(&mut text, &report.physics, paint);
    heading(&mut text, "Files", paint);
    for file in &report.files {
        line(&mut text, &format!("  {}", file.display()));
    }
    text
}

/// The summary of a measuring.
pub fn measure(report: &MeasureReport, paint: Paint) -> String {
    let mut text = String::new();
    session(&mut text, &report.session);
    measurements(&mut text, &report.measurements, paint);
    for method in &report.methods {
        heading(&mut text, &format!("By {}", method.method), paint);
        for m in &method.measures {
            line(&mut text, &format!("  {:17} {:6.0} mm +- {:.0}", m.name.replace('_', " "), m.value, m.sigma));
        }
    }
    if let Some(b) = &report.body {
        let cloth = if b.clothed { "one-sided, for cloth lies outside the skin" } else { "on the skin" };
        let share = b.explained * 100.0;
        line(&mut text, &format!("\nThe body explains {share:.0} % of the surface, {:.0} mm off; {cloth}", b.off_mm));
    }
    line(&mut text, &format!("\nPeople: {}; pixels with a depth: {} a frame", report.people, report.valid_pixels));
    text
}

/// The summary of a run.
pub fn run(report: &RunReport, paint: Paint) -> String {
    let mut text = String::new();
    line(
        &mut text,
        &paint.tone(&format!("Scene {}: {} steps, {:.2} s", report.scene, report.steps, report.seconds), Tone::Strong),
    );
    for garment in &report.garments {
        let (name, fabric, pinned) = (&garment.name, &garment.fabric, garment.pinned);
        let count = garment.particles;
        line(&mut text, &format!("  {name}: {count} particles, {pinned} pinned, {fabric}, {:.3} kg", garment.mass_kg));
    }
    let (step, strain, deep) = (&report.step_us, &report.strain, &report.penetration_mm);
    line(
        &mut text,
        &format!("  quality           {}, {} substeps at {} Hz", report.quality, report.substeps, report.hz),
    );
    line(&mut text, &format!("  a step takes      {:.0} us, 99 % of them under {:.0} us", step.p50, step.p99));
    let percent = [strain.mean, strain.p99, strain.max].map(|s| s * 100.0);
    let [mean, p99, max] = percent;
    line(&mut text, &format!("  it is stretched   {mean:.2} % on average, 99 % under {p99:.2} %, at worst {max:.1} %"));
    let share = deep.fraction * 100.0;
    line(&mut text, &format!("  deepest contact   {:.2} mm, {share:.2} % of the particles inside", deep.max));
    let energy = report.kinetic_energy_j.end * 1e3;
    line(&mut text, &format!("  it ends with      {energy:.3} mJ of motion, state {}", report.state_hash));
    let events = report.events;
    let counts = [
        (events.repaired, "particles put back"),
        (events.rolled_back, "steps rolled back"),
        (events.speed_limited, "times at the speed limit"),
        (events.held_pins, "pins held"),
        (events.held_colliders, "spheres held"),
        (events.teleports, "jumps of the root"),
        (report.nonfinite, "numbers not finite"),
    ];
    let met: Vec<String> = counts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
    if !met.is_empty() {
        let message = met.join(", ");
        line(&mut text, &format!("  {}", paint.tone(&message, Tone::Warn)));
    }
    if let Some(folder) = &report.dump {
        line(&mut text, &format!("  {} frames in {}, listed in index.csv", report.dumped_frames, folder.display()));
    }
    text
}

/// The summary of a skinning benchmark.
pub fn skinning(report: &SkinningReport, paint: Paint) -> String {
    let SkinningReport { blend, ns_per_vertex, y_ratio, yardstick_verts, max_error_m, found, .. } = report;
    let plain = found.yardstick_us * 1e3 / *yardstick_verts as f64;
    let mut text = String::new();
    let title = format!("Skinning {} vertices, positions and normals: {blend}", found.verts);
    line(&mut text, &paint.tone(&title, Tone::Strong));
    let error = max_error_m * 1e6;
    line(
        &mut text,
        &format!("  the engine    {ns_per_vertex:.2} ns a vertex, {y_ratio:.3} of a plain loop, error {error:.3} um"),
    );
    line(
        &mut text,
        &format!("  a plain loop  {plain:.2} ns a vertex ({:.1} us for {yardstick_verts})", found.yardstick_us),
    );
    for (name, t) in [("linear", &found.linear), ("dual", &found.dual)] {
        let error = t.max_error_m * 1e6;
        line(
            &mut text,
            &format!("  {name:<13} {:.1} us, {:.1} in mesh order, error {error:.3} um", t.us, t.mesh_order_us),
        );
    }
    let empty = found.padding * 100.0;
    line(
        &mut text,
        &format!(
            "  {} thread(s), {} lanes, {} joint sets, {empty:.1} % of the lanes empty",
            found.threads, found.lanes, found.sets
        ),
    );
    text
}

/// The summary of a run of the skirt: no time without the error reached at it.
pub fn skirt(report: &SkirtReport, paint: Paint) -> String {
    let SkirtReport { verts, motion, mesh, stretch, substeps, lanes, threads, garments, strain, step_us, .. } = report;
    let mut text = String::new();
    line(&mut text, &paint.tone(&format!("A skirt of {verts} vertices ({mesh}, {stretch}), {motion}"), Tone::Strong));
    let quality = format!("quality {}, ", report.quality);
    let wind = if report.wind { ", wind" } else { "" };
    line(
        &mut text,
        &format!("  {quality}{substeps} substeps, {lanes} lanes, {threads} thread(s), {garments} skirt(s){wind}"),
    );
    if let Some(adapter) = report.stepped_by.adapter.as_ref().filter(|_| report.stepped_by.backend == "gpu") {
        let clock = report.device_us.map_or(String::new(), |us| format!("; by its own clock a step takes {us:.1} us"));
        line(&mut text, &format!("  stepped by    {} ({}, {}){clock}", adapter.name, adapter.kind, adapter.driver));
    }
    if let Some(d) = report.decided_by {
        let words = format!("a step took the processor {:.0} us, the device {:.0} us", d.cpu_us, d.gpu_us);
        line(&mut text, &format!("  decided by    {words}: {} steps", report.stepped_by.backend));
    }
    line(&mut text, &format!("  a step takes  {:.1} us, 99 % of them under {:.1} us", step_us.p50, step_us.p99));
    let (ratio, yardstick) = (report.y_ratio, report.yardstick_us);
    line(&mut text, &format!("  the yardstick {yardstick:.1} us: the step takes {ratio:.2} of it"));
    let [mean, p99, max] = [strain.mean, strain.p99, strain.max].map(|s| s * 100.0);
    line(
        &mut text,
        &format!("  strain        {mean:.3} % mean, {p99:.2} % at the 99th percentile, {max:.1} % at worst"),
    );
    let (deepest, inside) = (report.penetration_mm.max, report.penetration_mm.fraction * 100.0);
    line(&mut text, &format!("  penetration   {deepest:.2} mm at worst, {inside:.3} % of the vertices inside"));
    for (stage, us) in &report.stages_us {
        line(&mut text, &format!("  {stage:13} {us:.1} us"));
    }
    let counted = |x: Option<String>| x.unwrap_or_else(|| "not counted".into());
    let memory = counted(report.memory_bytes.map(|b| format!("{:.3} MB", b as f64 * 1e-6)));
    line(
        &mut text,
        &format!(
            "  memory        {memory}; allocations a step: {}",
            counted(report.allocations_per_step.map(|a| a.to_string()))
        ),
    );
    line(
        &mut text,
        &format!(
            "  energy        {:.3} mJ of motion at the end; state {}",
            report.kinetic_energy_mj, report.state_hash
        ),
    );
    let events = [
        (report.hem_winding_wrong, "frames in which the hem does not go around each leg"),
        (report.nonfinite, "vertices that are not finite"),
        (report.events.rolled_back, "steps taken back"),
        (report.events.speed_limited, "particles at the speed limit"),
    ];
    for (count, what) in events.into_iter().filter(|(count, _)| *count > 0) {
        line(&mut text, &format!("  {}", paint.tone(&format!("{count} {what}"), Tone::Warn)));
    }
    text
}

/// The summary of an import.
pub fn body(report: &BodyReport, paint: Paint) -> String {
    let mut text = String::new();
    let BodyReport { file, vertices, triangles, dialect, surface, influences: i, .. } = report;
    line(&mut text, &format!("Body {}: {vertices} vertices, {triangles} triangles", file.display()));
    report.notes.iter().for_each(|note| line(&mut text, &format!("  {note}")));
    line(&mut text, &format!("  {} joints found, named as {dialect} names them", report.joints.len()));
    let (parts, open) = (surface.parts, surface.boundary_edges);
    line(&mut text, &format!("  {parts} closed or open pieces, {open} open edges"));
    let lost = [i.mean_lost, i.max_lost].map(|w| w * 100.0);
    let words = format!("  up to {} influences; {} vertices pruned to 4 lost {:.2} %", i.most, i.pruned, lost[0]);
    line(&mut text, &format!("{words} of their weight on average, {:.1} % at worst", lost[1]));
    for (words, all) in
        [("Measures", Some(&report.measures_mm)), ("MakeHuman's own rows", report.makehuman_mm.as_ref())]
    {
        if let Some(all) = all {
            heading(&mut text, words, paint);
            all.iter().for_each(|n| line(&mut text, &format!("  {:17} {:6.0} mm", n.name, n.value)));
        }
    }
    heading(&mut text, "Collision body, distance from the skin", paint);
    for f in &report.colliders {
        line(&mut text, &format!("  {:17} {:6.1} mm on average, 95 % {:.1} mm", f.zone, f.mean_mm, f.p95_mm));
    }
    heading(&mut text, "Files", paint);
    report.files.iter().for_each(|file| line(&mut text, &format!("  {}", file.display())));
    text
}

fn session(text: &mut String, session: &SessionReport) {
    let SessionReport { name, frames, seconds, notes } = session;
    line(text, &format!("Session {name}: {frames} frames, {seconds:.1} s"));
    for note in notes {
        line(text, &format!("  {note}"));
    }
}

fn measurements(text: &mut String, measurements: &ShopperMeasures, paint: Paint) {
    heading(text, "Measures", paint);
    let rows: [(&str, &MeasuredLength); 5] = [
        ("stature", &measurements.stature_mm),
        ("shoulder breadth", &measurements.shoulder_breadth_mm),
        ("chest girth", &measurements.chest_girth_mm),
        ("waist girth", &measurements.waist_girth_mm),
        ("hip girth", &measurements.hip_girth_mm),
    ];
    for (name, measure) in rows {
        line(text, &format!("  {name:17} {:6.0} mm +- {:.0}", measure.value, measure.sigma));
    }
}

fn recommendation(text: &mut String, worn: &Recommendation, paint: Paint) {
    heading(text, &format!("{}, size {}", worn.garment, worn.size), paint);
    for zone in &worn.zones {
        let tone = if zone.verdict == "good" { Tone::Good } else { Tone::Warn };
        let verdict = format!("{:6}", zone.verdict);
        let verdict = paint.tone(&verdict, tone);
        line(text, &format!("  {:17} {verdict} {:+5.0} mm of ease +- {:.0}", zone.zone, zone.ease_mm, zone.sigma_mm));
    }
    line(text, &format!("  {}", worn.verdict));
    if let Some(note) = &worn.note {
        line(text, &format!("  {note}"));
    }
}

fn physics(text: &mut String, physics: &PhysicsReport, paint: Paint) {
    let PhysicsReport { hz, steps, particles, substeps, .. } = physics;
    let words =
        format!("Cloth of {particles} particles at {hz} steps a second ({substeps} substeps each), {steps} steps");
    heading(text, &words, paint);
    let (step, strain) = (&physics.step_us, &physics.strain);
    line(text, &format!("  a step takes      {:.0} us, 99 % of them under {:.0} us", step.p50, step.p99));
    let (mean, p99) = (strain.mean * 100.0, strain.p99 * 100.0);
    line(text, &format!("  it is stretched   {mean:.2} % on average, 99 % of it under {p99:.2} %"));
    line(text, &format!("  deepest contact   {:.1} mm", physics.penetration_mm.max));
    for warning in &physics.warnings {
        line(text, &format!("  {}", paint.tone(warning, Tone::Warn)));
    }
    if physics.nonfinite > 0 {
        let message = format!("{} steps met a particle that was not finite, and were taken back", physics.nonfinite);
        line(text, &format!("  {}", paint.tone(&message, Tone::Warn)));
    }
}

fn heading(text: &mut String, words: &str, paint: Paint) {
    line(text, &format!("\n{}", paint.tone(words, Tone::Strong)));
}

fn line(text: &mut String, words: &str) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{words}");
}

#[cfg(test)]
mod tests {
    use toile_engine::skin::{Blend, Padding};
    use toile_perf::skinning::{Skinning, SkinningSubject, Timing};

    use super::*;
    use crate::report::ZoneFitReport;

    #[test]
    fn a_skinning_summary_compares_vertex_with_vertex() {
        let timing = Timing { us: 5.0, ns_per_vertex: 5.0, max_error_m: 2.5e-7, ..Timing::default() };
        let padding = Padding { vertices: 1000, lanes: 1010, blocks: 64, runs: 9, influences: 2000, blended: 2100 };
        let found = Skinning {
            subject: SkinningSubject::Body,
            verts: 1000,
            threads: 1,
            lanes: 16,
            yardstick_us: 120.0,
            padding,
            linear: timing,
            dual: timing,
        };
        let report = SkinningReport::new(found, Blend::Linear);
        let text = skinning(&report, Paint::none());
        for message in ["1000 vertices", "linear", "5.00 ns", "8.00 ns", "0.250 um", "1.0 % of the lanes"] {
            assert!(text.contains(message), "{message} is not in: {text}");
        }
    }

    #[test]
    fn a_skirt_summary_says_time_and_error_and_warns_of_what_should_not_be() {
        let mut report = SkirtReport { verts: 4_096, y_ratio: 0.58, motion: "walk", ..SkirtReport::default() };
        report.strain.mean = 0.0014;
        report.memory_bytes = Some(420_000);
        let text = skirt(&report, Paint::none());
        for message in ["4096 vertices", "0.58 of it", "0.140 %", "0.420 MB", "allocations a step: not counted"] {
            assert!(text.contains(message), "{message} is not in: {text}");
        }
        assert!(!text.contains("the hem does not"));
        report.hem_winding_wrong = 3;
        assert!(skirt(&report, Paint::none()).contains("3 frames in which the hem does not"));
    }

    #[test]
    fn a_summary_says_each_zone_and_each_file() {
        let zone = ZoneFitReport {
            zone: "waist".into(),
            ease_mm: -12.0,
            sigma_mm: 8.0,
            verdict: "tight".into(),
            sentence: "Waist: tight.".into(),
        };
        let mut report = TryOn {
            renderer: None,
            session: SessionReport { name: "a.csv".into(), frames: 3, seconds: 0.1, notes: vec!["one drop".into()] },
            measurements: ShopperMeasures::default(),
            recommendation: Recommendation {
                garment: "trousers".into(),
                size: "40".into(),
                zones: vec![zone],
                ..Default::default()
            },
            others: Vec::new(),
            physics: PhysicsReport::default(),
            state_hash: String::new(),
            files: vec!["out/front.png".into()],
        };
        let text = try_on(&report, Paint::none());
        for message in ["a.csv", "one drop", "trousers, size 40", "waist", "tight", "-12 mm", "out/front.png"] {
            assert!(text.contains(message), "{message} is not in: {text}");
        }
        assert!(!text.contains("not finite"));
        report.physics.nonfinite = 2;
        assert!(try_on(&report, Paint::none()).contains("2 steps met a particle that was not finite"));
    }
}
