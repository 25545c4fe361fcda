//! A garment on a body of measures: the size that fits, the place of its cloth after a second, and the state of the scene.
//!
//! `cargo run --release -p toile-sdk --example on_measures -- [GARMENT [SIZE]]`

use toile_sdk::{Body, Error, Garment, Scene, Sex, TIME_STEP, recommend};

fn main() -> Result<(), Error> {
    let mut words = std::env::args().skip(1);
    let mm = [("stature", 1720.0), ("chest", 920.0), ("waist", 760.0), ("hip", 1000.0)];
    let body = Body::from_measures_mm(Sex::Female, &mm)?;
    for (name, mm) in body.measures_mm() {
        println!("{name:<18} {mm:7.1} mm");
    }

    let mut garment = Garment::open(words.next().as_deref().unwrap_or("strap-dress"))?;
    println!("{} of {}, in {}", garment.name(), garment.fabric()?, garment.sizes()?.join(", "));
    if let Some(size) = words.next() {
        garment = garment.in_size(&size)?;
    }
    let fit = recommend(&body, &garment)?;
    println!("{}", fit.verdict);
    for zone in &fit.zones {
        println!("{:<6} ease {:+.0} mm, sigma {:.0}: {}", zone.zone, zone.ease_mm, zone.sigma_mm, zone.verdict);
    }

    let mut scene = Scene::dress(&body, &[garment])?;
    scene.step_many((1.0 / TIME_STEP).round() as u64);
    let hem = scene.positions(0)?.iter().map(|p| p.y).fold(f32::MAX, f32::min);
    let stats = scene.stats(0)?;
    println!("after {:.2} s the lowest point is {hem:.3} m above the floor", scene.time());
    println!(
        "strain mean {:.2} %, p99 {:.1} %; deepest inside of the body {:.2} mm",
        stats.strain_mean * 1e2,
        stats.strain_p99 * 1e2,
        stats.penetration_mm
    );
    assert!(stats.strain_mean < 0.01 && stats.rolled_back == 0, "the cloth is torn: {stats:?}");
    Ok(())
}
