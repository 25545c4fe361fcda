//! The reports as people read them: the contents of `--json`, in words and tables.

use crate::report::{
    BodyReport, MeasureReport, PhysicsReport, RecommendationReport, RunReport, SessionReport, ShopperMeasures, TryOn,
};
use toile_assets::put_line;
use toile_cli::document::MeasuredLength;
use toile_cli::terminal::{Paint, Tone};
use toile_engine::world::{DRESS_STEPS, SETTLE_STEPS};
use toile_fitting::scene::contact::ContactReport;
use toile_fitting::wearing::{PosePulls, Pull, ZonePull};

/// The summary of a try-on.
pub fn try_on(report: &TryOn, paint: Paint) -> String {
    let mut text = String::new();
    session(&mut text, &report.session);
    measurements(&mut text, &report.measurements, paint);
    for worn in std::iter::once(&report.recommendation).chain(&report.others) {
        recommendation(&mut text, worn, paint);
    }
    poses(&mut text, &report.poses, paint);
    physics(&mut text, &report.physics, paint);
    contact(&mut text, report.contact.as_ref(), DRESS_STEPS + SETTLE_STEPS + report.physics.steps);
    crossings(&mut text, report);
    heading(&mut text, "Files", paint);
    // A file for each frame would fill the screen.
    let more = report.files.len().saturating_sub(MOST_FILES);
    for file in &report.files[..report.files.len() - more] {
        put_line!(text, "  {}", file.display());
    }
    if more > 0 {
        put_line!(text, "  and {more} more");
    }
    text
}

/// Most files that are listed.
const MOST_FILES: usize = 40;

/// A hem that moves by less (mm) is not spoken of.
const TOLD_MM: f32 = 10.0;

/// Where garments pull in each pose.
fn poses(text: &mut String, poses: &[PosePulls], paint: Paint) {
    for pose in poses {
        heading(text, &format!("When {}", pose.pose), paint);
        for garment in &pose.garments {
            let pulls = garment.zones.iter().filter(|z| z.pull > Pull::Easy);
            let zone = |z: &ZonePull| {
                let how = if z.pull == Pull::Hard { "hard " } else { "" };
                let [now, good] = [z.stretch, z.comfortable].map(|s| s * 100.0);
                format!("{how}at {} ({now:.1} % stretch, {good:.0} % is comfortable)", z.zone.words())
            };
            let pulls: Vec<String> = pulls.map(zone).collect();
            let says =
                if pulls.is_empty() { "nowhere pulls".to_owned() } else { format!("pulls {}", pulls.join(", ")) };
            let rides = match garment.rides_up_mm {
                Some(up) if up >= TOLD_MM => format!("; its hem rides up by {up:.0} mm"),
                Some(up) if up <= -TOLD_MM => format!("; its hem comes down by {:.0} mm", -up),
                _ => String::new(),
            };
            let tone = if pulls.is_empty() { Tone::Good } else { Tone::Warn };
            put_line!(text, "  {}", paint.tone(&format!("{}: {says}{rides}", garment.garment), tone));
        }
    }
}

/// The summary of a measuring.
pub fn measure(report: &MeasureReport, paint: Paint) -> String {
    let mut text = String::new();
    session(&mut text, &report.session);
    measurements(&mut text, &report.measurements, paint);
    for method in &report.methods {
        heading(&mut text, &format!("By {}", method.method), paint);
        for m in &method.measures {
            put_line!(text, "  {:17} {:6.0} mm +- {:.0}", m.name.replace('_', " "), m.value, m.sigma);
        }
    }
    if let Some(b) = &report.body {
        let cloth = if b.clothed { "one-sided, for cloth lies outside the skin" } else { "on the skin" };
        let share = b.explained * 100.0;
        put_line!(text, "\nThe body explains {share:.0} % of the surface, {:.0} mm off; {cloth}", b.off_mm);
    }
    put_line!(text, "\nPeople: {}; depth pixels on the shopper: {} a frame", report.people, report.valid_pixels);
    text
}

/// The summary of a run.
pub fn run(report: &RunReport, paint: Paint) -> String {
    let mut text = String::new();
    put_line!(
        text,
        "{}",
        paint.tone(&format!("Scene {}: {} steps, {:.2} s", report.scene, report.steps, report.seconds), Tone::Strong)
    );
    for garment in &report.garments {
        let (name, fabric, pinned) = (&garment.name, &garment.fabric, garment.pinned);
        let count = garment.particles;
        put_line!(text, "  {name}: {count} particles, {pinned} pinned, {fabric}, {:.3} kg", garment.mass_kg);
    }
    let (step, strain, deep) = (&report.step_us, &report.strain, &report.penetration_mm);
    put_line!(text, "  quality           {}, {} substeps at {} Hz", report.quality, report.substeps, report.hz);
    put_line!(text, "  a step takes      {:.0} us, 99 % of them under {:.0} us", step.p50, step.p99);
    let percent = [strain.mean, strain.p99, strain.max].map(|s| s * 100.0);
    let [mean, p99, max] = percent;
    put_line!(text, "  it is stretched   {mean:.2} % on average, 99 % under {p99:.2} %, at worst {max:.1} %");
    let share = deep.fraction * 100.0;
    put_line!(text, "  deepest contact   {:.2} mm, {share:.2} % of the particles inside", deep.max);
    let energy = report.kinetic_energy_j.end * 1e3;
    put_line!(text, "  it ends with      {energy:.3} mJ of motion, state {}", report.state_hash);
    contact(&mut text, report.contact.as_ref(), report.steps);
    for warning in &report.warnings {
        put_line!(text, "  {}", paint.tone(warning, Tone::Warn));
    }
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
        put_line!(text, "  {}", paint.tone(&message, Tone::Warn));
    }
    if let Some(folder) = &report.dump {
        put_line!(text, "  {} frames in {}, listed in index.csv", report.dumped_frames, folder.display());
    }
    text
}

/// The summary of an import.
pub fn body(report: &BodyReport, paint: Paint) -> String {
    let mut text = String::new();
    let BodyReport { file, vertices, triangles, dialect, surface, influences: i, .. } = report;
    put_line!(text, "Body {}: {vertices} vertices, {triangles} triangles", file.display());
    report.notes.iter().for_each(|note| put_line!(text, "  {note}"));
    put_line!(text, "  {} joints found, named as {dialect} names them", report.joints.len());
    let (parts, open) = (surface.parts, surface.boundary_edges);
    put_line!(text, "  {parts} closed or open pieces, {open} open edges");
    let lost = [i.mean_lost, i.max_lost].map(|w| w * 100.0);
    let words = format!("  up to {} influences; {} vertices pruned to 4 lost {:.2} %", i.most, i.pruned, lost[0]);
    put_line!(text, "{words} of their weight on average, {:.1} % at worst", lost[1]);
    for (words, all) in
        [("Measures", Some(&report.measures_mm)), ("MakeHuman's own rows", report.makehuman_mm.as_ref())]
    {
        if let Some(all) = all {
            heading(&mut text, words, paint);
            all.iter().for_each(|n| put_line!(text, "  {:17} {:6.0} mm", n.name, n.value));
        }
    }
    heading(&mut text, "Collision body, distance from the skin", paint);
    for f in &report.colliders {
        put_line!(text, "  {:17} {:6.1} mm on average, 95 % {:.1} mm", f.zone, f.mean_mm, f.p95_mm);
    }
    heading(&mut text, "Files", paint);
    report.files.iter().for_each(|file| put_line!(text, "  {}", file.display()));
    text
}

fn session(text: &mut String, session: &SessionReport) {
    let SessionReport { name, frames, seconds, notes } = session;
    put_line!(text, "Session {name}: {frames} frames, {seconds:.1} s");
    for note in notes {
        put_line!(text, "  {note}");
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
        put_line!(text, "  {name:17} {:6.0} mm +- {:.0}", measure.value, measure.sigma);
    }
}

fn recommendation(text: &mut String, worn: &RecommendationReport, paint: Paint) {
    heading(text, &format!("{}, size {}", worn.garment, worn.size), paint);
    for zone in &worn.zones {
        let tone = if zone.verdict == "good" { Tone::Good } else { Tone::Warn };
        // The word of the pictures, from the same numbers; where the body was not seen there is none.
        let verdict = format!("{:7}", zone.feel.as_ref().unwrap_or(&zone.verdict));
        let verdict = paint.tone(&verdict, tone);
        put_line!(text, "  {:17} {verdict} {:+5.0} mm of ease +- {:.0}", zone.zone, zone.ease_mm, zone.sigma_mm);
    }
    put_line!(text, "  {}", worn.verdict);
    if let Some(note) = &worn.note {
        put_line!(text, "  {note}");
    }
}

fn physics(text: &mut String, physics: &PhysicsReport, paint: Paint) {
    let PhysicsReport { hz, steps, particles, substeps, .. } = physics;
    let words =
        format!("Cloth of {particles} particles at {hz} steps a second ({substeps} substeps each), {steps} steps");
    heading(text, &words, paint);
    let (step, strain) = (&physics.step_us, &physics.strain);
    put_line!(text, "  a step takes      {:.0} us, 99 % of them under {:.0} us", step.p50, step.p99);
    let (mean, p99) = (strain.mean * 100.0, strain.p99 * 100.0);
    put_line!(text, "  it is stretched   {mean:.2} % on average, 99 % of it under {p99:.2} %");
    put_line!(text, "  deepest contact   {:.1} mm", physics.penetration_mm.max);
    for warning in &physics.warnings {
        put_line!(text, "  {}", paint.tone(warning, Tone::Warn));
    }
    if physics.nonfinite > 0 {
        let message = format!("{} steps met a particle that was not finite, and were taken back", physics.nonfinite);
        put_line!(text, "  {}", paint.tone(&message, Tone::Warn));
    }
}

/// What contact of cloth with cloth did.
fn contact(text: &mut String, contact: Option<&ContactReport>, steps: u64) {
    let Some(c) = contact else { return };
    let [asked, contacts] = [c.asked, c.contacts].map(|n| n / steps.max(1));
    let most = c.contacts_most;
    put_line!(text, "  cloth on cloth    {contacts} contacts a step, {most} at most, of {asked} particles looked at");
}

/// What passed through what, and what the pictures hide of it.
fn crossings(text: &mut String, report: &TryOn) {
    let c = &report.crossings;
    let share = 100.0 * c.frames_with as f64 / (c.frames.max(1)) as f64;
    match c.frames_with {
        0 => put_line!(text, "  no cloth passes through cloth, in {} moments looked at", c.frames),
        _ => put_line!(
            text,
            "  cloth passes through cloth in {share:.0} % of {} moments: {} edges at most, at {:.1} s; for {:.1} s at a time",
            c.frames,
            c.max,
            c.worst_s.unwrap_or_default(),
            c.longest_s
        ),
    }
    if let Some(hidden) = &report.hidden_mm {
        put_line!(text, "  pictures hide     {:.0} mm of what lies beneath cloth and stands out of it", hidden.max);
    }
}

fn heading(text: &mut String, words: &str, paint: Paint) {
    put_line!(text, "\n{}", paint.tone(words, Tone::Strong));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{CrossingReport, Penetration, ZoneFitReport};

    #[test]
    fn a_summary_says_each_zone_and_each_file() {
        let zone = ZoneFitReport {
            zone: "waist".into(),
            ease_mm: -12.0,
            sigma_mm: 8.0,
            verdict: "tight".into(),
            feel: Some("tight".into()),
            sentence: "Waist: tight.".into(),
        };
        let mut report = TryOn {
            crossings: CrossingReport {
                frames: 50,
                frames_with: 5,
                max: 7,
                max_between: 0,
                longest_s: 0.25,
                worst_s: Some(1.5),
            },
            contact: Some(ContactReport { contacts_most: 321, ..ContactReport::default() }),
            hidden_mm: Some(Penetration { max: 3.0 }),
            renderer: None,
            session: SessionReport { name: "a.csv".into(), frames: 3, seconds: 0.1, notes: vec!["one drop".into()] },
            measurements: ShopperMeasures::default(),
            recommendation: RecommendationReport {
                garment: "trousers".into(),
                size: "40".into(),
                zones: vec![zone],
                ..Default::default()
            },
            others: Vec::new(),
            meshes: Vec::new(),
            physics: PhysicsReport::default(),
            poses: Vec::new(),
            animation: None,
            export: None,
            state_hash: String::new(),
            files: vec!["out/front.png".into()],
        };
        let text = try_on(&report, Paint::none());
        for message in [
            "a.csv",
            "one drop",
            "at 1.5 s",
            "321 at most",
            "trousers, size 40",
            "waist",
            "tight",
            "-12 mm",
            "out/front.png",
        ] {
            assert!(text.contains(message), "{message} is not in: {text}");
        }
        assert!(!text.contains("not finite"));
        report.physics.nonfinite = 2;
        assert!(try_on(&report, Paint::none()).contains("2 steps met a particle that was not finite"));
    }
}
