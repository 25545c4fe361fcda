//! Nothing is allocated in the frame, and every capacity and budget is known at load.
//!
//! `cargo run --release -p toile-engine --example no_allocations`
//!
//! Times are printed, not checked: they depend on the machine.

use std::alloc::System;
use std::error::Error;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use toile_assets::{scene, wardrobe};
use toile_base::clock::ticks_to_ns;
use toile_base::frame::Joints;
use toile_base::garment::Garment;
use toile_base::limits::{MAX_CAPSULES, MAX_SPHERES, STEP_HZ};
use toile_engine::body::JointFrames;
use toile_engine::cloth::settings::MAX_SUBSTEPS;
use toile_engine::cloth::{Cloth, Settings};
use toile_engine::frame::Frame;
use toile_engine::meter::{PERIOD_NS, STAGES, STEP_BUDGET_US};

/// Counts what every thread of the program asks for.
#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Length of the run (steps).
const STEPS: u64 = 2 * STEP_HZ as u64;

fn main() -> Result<(), Box<dyn Error>> {
    // The plan: what a step may take, and what there is room for.
    println!("a step of {} us has a budget of {STEP_BUDGET_US} us:", PERIOD_NS / 1_000);
    println!("  {}", STAGES.map(|stage| format!("{} {}", stage.name, stage.budget_us)).join(", "));

    let load = Region::new(&INSTRUMENTED_SYSTEM);
    let body = toile_assets::body::build(scene::SHOPPER.0, &scene::SHOPPER.1)?;
    let rig = toile_assets::rig::fit(&body);
    let garments = [("t-shirt", "M"), ("wide-trousers", "38")];
    let garments = garments.map(|(name, size)| wardrobe::style(name).and_then(|style| style.dress(size, &body)));
    let garments = garments.into_iter().collect::<Result<Vec<Garment>, _>>()?;
    let skeleton = body.skeleton.clone();
    let (mut frame, mut snapshots) = Frame::new(body, &rig, garments, Settings::default())?;
    let joints = |tick: u64| {
        let pose = scene::shopper(&skeleton, 1.5 + tick as f32 / STEP_HZ as f32);
        let at = JointFrames::new(&skeleton, &pose).position;
        Joints::seen(ticks_to_ns(tick), at)
    };
    frame.dress(&joints(0));
    println!("at load: {} allocations", load.change().allocations);

    // In the frame: steps, snapshots, measures of the error; none of it may allocate, on any thread.
    let region = Region::new(&INSTRUMENTED_SYSTEM);
    let mut shown = 0;
    for tick in 0..STEPS {
        frame.step(&joints(tick));
        shown += u64::from(snapshots.news().is_some());
    }
    let change = region.change();
    let asked = change.allocations + change.reallocations;
    println!("in {STEPS} steps with {shown} snapshots: {asked} allocations");

    let colliders = frame.colliders();
    println!(
        "spheres {} of {MAX_SPHERES}, capsules {} of {MAX_CAPSULES}",
        colliders.end().len(),
        colliders.capsules().len()
    );
    for (cloth, garment) in frame.cloths().iter().zip(frame.garments()) {
        let kib = [garment.bytes(), cloth.bytes()].map(|bytes| bytes / 1_024);
        println!(
            "{}: {} particles, {} KiB baked and {} KiB of state, {} substeps of at most {MAX_SUBSTEPS}",
            garment.name,
            garment.particles(),
            kib[0],
            kib[1],
            cloth.substeps()
        );
    }
    let us = |share| frame.meters().step_ns.value_at_quantile(share) / 1_000;
    println!("a step took {} us, at p99 {} us", us(0.5), us(0.99));
    if asked > 0 {
        return Err(format!("{asked} allocations in the frame, {} bytes", change.bytes_allocated).into());
    }
    if shown != STEPS || frame.cloths().iter().map(Cloth::substeps).any(|n| n == 0 || n > MAX_SUBSTEPS) {
        return Err("a snapshot was missing, or a garment took no substep that there is".into());
    }
    Ok(())
}
