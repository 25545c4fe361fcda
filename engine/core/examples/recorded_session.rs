//! Following a recorded session: joints of a file are filtered, and the dressed body moves as they do.
//!
//! `cargo run --release -p toile-engine --example recorded_session -- [FILE]`
//!
//! Without a file it is the session that comes with Toile. A file may be any recording that `toile try-on` reads.

use std::error::Error;
use std::path::PathBuf;

use toile_assets::{drafting, scene};
use toile_base::clock::{SECOND_NS, ns_to_ticks, ticks_to_ns};
use toile_base::frame::Joints;
use toile_base::skeleton::Joint;
use toile_engine::body::JointFrames;
use toile_engine::cloth::Settings;
use toile_engine::world::World;
use toile_sensors::filter::JointFilter;
use toile_sensors::sample::sample;
use toile_sensors::source::{self, OpenOptions};

/// The session that comes with Toile.
const EMBEDDED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/data/sessions/shopper.mcap");
/// Where the body's joints may be off the sensor's at most, on average (m): it has bones of one length and keeps its limits.
const FOLLOWS: f32 = 0.06;
/// The longest that is watched (ns).
const LONGEST_NS: u64 = 5 * SECOND_NS;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map_or_else(|| PathBuf::from(EMBEDDED), PathBuf::from);
    let session = source::open(&path, &OpenOptions::default())?;
    // Raw joints jump, drop out and lie: the filter gates them by confidence, smooths them and holds what is lost.
    let mut filter = JointFilter::default();
    let track: Vec<Joints> = session.joints.iter().map(|raw| filter.push(raw)).collect();
    let stands = track.iter().position(|seen| seen.at(Joint::Pelvis).is_believed());
    let track =
        &track[stands.ok_or("no person is seen in this session: its joints are too uncertain, or there are none")?..];
    let [first, .., last] = track else { return Err("the session has a single frame; record a longer one".into()) };
    let span = (last.time_ns - first.time_ns).min(LONGEST_NS);
    println!(
        "{}: {} frames of joints, {:.1} s of them followed",
        session.name,
        session.joints.len(),
        span as f64 * 1e-9
    );

    let (sex, measures) = scene::SHOPPER;
    let body = toile_assets::body::build(sex, &measures)?;
    let rig = toile_assets::rig::fit(&body);
    let dress = drafting::package("strap-dress")?.dress("38", &body)?;
    let (mut world, _reader) = World::new(body, &rig, vec![dress], Settings::default())?;
    world.dress(first);

    // The sensor has 30 frames a second, the engine 120 steps: joints in between are those of a smooth path.
    let (mut off, mut count) = (0.0f64, 0u32);
    for tick in 0..ns_to_ticks(span) {
        let joints = sample(track, first.time_ns + ticks_to_ns(tick)).unwrap_or(*first);
        world.step(&joints);
        let shown = JointFrames::new(&world.body().skeleton, world.pose());
        for joint in [Joint::Pelvis, Joint::LeftWrist, Joint::RightWrist, Joint::LeftKnee, Joint::RightKnee] {
            if let Some(seen) = joints.believed(joint) {
                off += f64::from(shown.at(joint).distance(seen));
                count += 1;
            }
        }
    }

    let (off, strain) = ((off / f64::from(count.max(1))) as f32, world.meters().strain());
    println!("{} steps; pelvis, wrists and knees {:.0} mm off the sensor's on average", world.tick(), off * 1e3);
    println!("strain mean {:.2} %, p99 {:.1} %", strain.mean * 100.0, strain.p99 * 100.0);
    if off > FOLLOWS || strain.mean > 0.01 {
        return Err(format!("the body does not follow ({off:.3} m), or the dress is torn ({:.3})", strain.mean).into());
    }
    if world.cloths().iter().any(|c| c.events.rolled_back > 0) {
        return Err("a step was not finite and was rolled back".into());
    }
    Ok(())
}
