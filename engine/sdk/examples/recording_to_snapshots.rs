//! A recording in, snapshots out: a person is measured, dressed and followed, and 30 times a second a snapshot holds everything that a
//! display needs.
//!
//! `cargo run --release -p toile-sdk --example recording_to_snapshots -- [RECORDING [GARMENT]]`

use toile_sdk::{DressOptions, Error, Garment, Motion, Recording, Scene, Shopper, Snapshot};

/// Steps from one frame of the display to the next.
const EVERY: u64 = 4;
/// The longest that is followed (steps).
const LONGEST: u64 = 360;

fn main() -> Result<(), Error> {
    let mut words = std::env::args().skip(1);
    let recording = words.next().map_or_else(Recording::embedded, Recording::open)?;
    let garments = [Garment::open(words.next().as_deref().unwrap_or("wide-leg-trousers"))?];
    let measured = recording.measure(&Shopper::default())?;
    for m in measured.measures() {
        println!("{:<18} {:6.0} mm, sigma {:3.0}{}", m.name, m.mm, m.sigma_mm, if m.seen { "" } else { " (expected)" });
    }
    measured.notes().iter().for_each(|note| println!("{note}"));

    let body = measured.body_for(&garments)?;
    let motion = Motion::Track(recording.track(&measured)?);
    let mut scene = Scene::dress_with(&body, &garments, &DressOptions { motion, ..DressOptions::default() })?;
    let worn = &scene.garments()[0];
    println!("{} in {}: {} vertices, {} triangles", worn.name, worn.size, worn.vertices, worn.faces);

    let steps = scene.duration_steps().unwrap_or_default().min(LONGEST);
    let mut shown: Vec<Snapshot> = Vec::new();
    while scene.steps() < steps {
        scene.step();
        if scene.steps().is_multiple_of(EVERY) {
            shown.push(scene.snapshot());
        }
    }
    let last = shown.last().expect("a recording is longer than a frame");
    println!("{} snapshots, the last at {:.2} s; state {:016x}", shown.len(), last.time_s, scene.state_hash());
    assert!(shown.iter().flat_map(|s| s.garments.iter().flatten()).all(|p| p.is_finite()));
    scene.warnings().iter().for_each(|warning| println!("{warning}"));
    Ok(())
}
