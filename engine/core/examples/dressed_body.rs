//! A garment on a body: the whole frame, from joints to a snapshot, with a shopper who lifts her arms.
//!
//! `cargo run --release -p toile-engine --example dressed_body`

use std::error::Error;

use toile_assets::{drafting, scene};
use toile_base::body::Body;
use toile_base::clock::ticks_to_ns;
use toile_base::frame::Joints;
use toile_base::limits::STEP_HZ;
use toile_engine::body::JointFrames;
use toile_engine::cloth::Settings;
use toile_engine::world::World;

/// Length of the run (s).
const SECONDS: u32 = 3;

/// The joints of the scene's shopper at a tick, as a sensor without noise would give them.
fn joints(body: &Body, tick: u64) -> Joints {
    let time_ns = ticks_to_ns(tick);
    let pose = scene::shopper(&body.skeleton, tick as f32 / STEP_HZ as f32);
    let at = JointFrames::new(&body.skeleton, &pose).position;
    Joints::seen(time_ns, at)
}

fn main() -> Result<(), Box<dyn Error>> {
    // At load: a body of some measures, its collision spheres, a dress in a size of its table.
    let (sex, measures) = scene::SHOPPER;
    let body = toile_assets::body::build(sex, &measures)?;
    let rig = toile_assets::rig::fit(&body);
    let dress = drafting::package("strap-dress")?.dress("38", &body)?;
    println!(
        "{} in {}: {} particles on a body of {:.3} m",
        dress.name,
        dress.size,
        dress.particles(),
        measures.stature
    );

    // The world owns the scene; the reader is the end at which pictures are made, on whatever thread.
    let (mut world, mut reader) = World::new(body.clone(), &rig, vec![dress], Settings::default())?;
    world.dress(&joints(&body, 0));
    let mut shown = 0;
    for tick in 0..u64::from(SECONDS * STEP_HZ) {
        world.step(&joints(&body, tick));
        // A display of 60 Hz takes every other snapshot; the step does not wait for it.
        if tick % 2 == 1 && reader.news().is_some() {
            shown += 1;
        }
    }

    let snapshot = reader.latest();
    let hem = snapshot.garments[0].iter().map(|p| p.y).fold(f32::MAX, f32::min);
    let (meters, strain) = (world.meters(), world.meters().strain());
    println!("{} steps, {shown} snapshots shown, the last of step {}", world.tick(), snapshot.tick);
    println!("hem {:.2} m above the floor, {} vertices of skin", hem, snapshot.skin.vertices());
    println!("strain mean {:.2} %, p99 {:.1} %", strain.mean * 100.0, strain.p99 * 100.0);
    println!("deepest inside the body {:.1} mm", meters.penetration_max * 1e3);

    if strain.mean > 0.005 || meters.penetration_max > 0.002 {
        return Err("the dress is strained or inside the body more than cloth can be".into());
    }
    let finite = snapshot.garments.iter().flatten().all(|p| p.is_finite());
    if !finite || world.broken() > 0 || world.cloths().iter().any(|c| c.events.rolled_back > 0) {
        return Err("a step went wrong".into());
    }
    Ok(())
}
