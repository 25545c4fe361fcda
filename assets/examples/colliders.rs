//! How closely the collision body follows the skin: `cargo run --release -p toile-assets --example colliders` prints the
//! mean, 95th percentile and greatest distance (mm) of every zone, and how long the fit took, for small, middle and large
//! bodies.

use std::time::Instant;

use toile_assets::body::{Ansur, Body, BodyError, En, Sex, Vocabulary, Wanted};
use toile_assets::rig::{Rig, Zone, ZoneReport};

/// Label, stature, bust or chest, waist and hip girth (m) of EN 13402-3's sizes.
const SIZES: [(Sex, &str, [f32; 4]); 6] = [
    (Sex::Female, "women 34", [1.68, 0.80, 0.64, 0.88]),
    (Sex::Female, "women 42", [1.68, 0.96, 0.80, 1.04]),
    (Sex::Female, "women 50", [1.68, 1.16, 1.02, 1.22]),
    (Sex::Male, "men 46", [1.78, 0.92, 0.80, 0.94]),
    (Sex::Male, "men 52", [1.78, 1.04, 0.92, 1.06]),
    (Sex::Male, "men 58", [1.78, 1.16, 1.08, 1.18]),
];

/// Percentiles of ANSUR II (m), in the order of [`TAKEN`].
const PERCENTILES: [(Sex, &str, [f32; 8]); 6] = [
    (Sex::Female, "women 5th", [1.525, 0.302, 0.824, 0.710, 0.901, 0.712, 0.746, 0.335]),
    (Sex::Female, "women 50th", [1.626, 0.328, 0.940, 0.852, 1.018, 0.780, 0.805, 0.365]),
    (Sex::Female, "women 95th", [1.740, 0.363, 1.094, 1.040, 1.156, 0.857, 0.870, 0.396]),
    (Sex::Male, "men 5th", [1.648, 0.360, 0.922, 0.768, 0.899, 0.771, 0.831, 0.384]),
    (Sex::Male, "men 50th", [1.755, 0.395, 1.056, 0.937, 1.017, 0.845, 0.895, 0.415]),
    (Sex::Male, "men 95th", [1.870, 0.443, 1.207, 1.131, 1.149, 0.925, 0.963, 0.447]),
];

const TAKEN: [Ansur; 8] = [
    Ansur::Stature,
    Ansur::NeckCircumference,
    Ansur::ChestCircumference,
    Ansur::WaistCircumferenceOmphalion,
    Ansur::ButtockCircumference,
    Ansur::CrotchHeight,
    Ansur::SleeveLengthSpineWrist,
    Ansur::BiacromialBreadth,
];

fn main() -> Result<(), BodyError> {
    print!("{:12}{:>7}", "mean p95 max", "fit ms");
    Zone::ALL.iter().for_each(|zone| print!("{:>18}", zone.name()));
    println!("{:>18}", "trunk");
    for (sex, label, size) in SIZES {
        line(label, &built(sex, &[En::Stature, En::BustGirth, En::WaistGirth, En::HipGirth], &size)?);
    }
    for (sex, label, row) in PERCENTILES {
        line(label, &built(sex, &TAKEN, &row)?);
    }
    Ok(())
}

fn built<V: Vocabulary>(sex: Sex, measures: &[V], values: &[f32]) -> Result<Body, BodyError> {
    let wanted = measures.iter().zip(values).fold(Wanted::new(), |w, (m, value)| w.with(*m, *value));
    Ok(Body::fitted(sex, &wanted)?.body)
}

fn line(label: &str, body: &Body) {
    let begun = Instant::now();
    let rig = Rig::fit(body);
    print!("{label:12}{:7.1}", begun.elapsed().as_secs_f64() * 1e3);
    let cell = |r: &ZoneReport| print!("{:>18}", format!("{:.1} {:.1} {:.0}/{:.0}|{:.0}", r.mean_mm, r.p95_mm, r.max_outside_mm, r.max_inside_mm,r.cloth_max_above_mm));
    let report = rig.report(body);
    report.zones.iter().for_each(cell);
    cell(&report.trunk);
    println!();
}
