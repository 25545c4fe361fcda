//! Recording a run and replaying it bit for bit: on another number of workers, and with one joint a millimetre off.
//!
//! `cargo run --release -p toile-engine --example replay_bit_for_bit`

use std::error::Error;

use toile_assets::{drafting, scene};
use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;
use toile_base::skeleton::Joint;
use toile_engine::body::JointFrames;
use toile_engine::clock::SimClock;
use toile_engine::cloth::Settings;
use toile_engine::frame_loop::event::{EVENTS, EVENTS_NAME, NoCounters};
use toile_engine::frame_loop::physics_thread::{PhysicsOutputs, PhysicsThread, SceneStepper, WorldScene};
use toile_engine::frame_loop::queue::bounded;
use toile_engine::frame_loop::recording::{self, ENTRIES, ENTRIES_NAME, Entry, LoopRecording};
use toile_engine::frame_loop::replay::{Replayed, replay};
use toile_engine::frame_loop::sensor_thread::{Playback, SensorFrame, SensorThread};
use toile_engine::frame_loop::simulate::simulate;
use toile_engine::triple_buffer::TripleBuffer;
use toile_engine::world::World;
use toile_sensors::filter::JointFilter;

/// Length of the run (ns).
const LENGTH_NS: u64 = 2 * SECOND_NS;
/// The recorded frame in which a joint is moved, and how far (m).
const MOVED: (u64, f32) = (30, 1e-3);

/// Makes the scene that the text in the recording describes: a replay makes the very same.
fn staged(size: &str, first: &Joints, workers: usize) -> Result<WorldScene, Box<dyn Error>> {
    let body = toile_assets::body::build(scene::SHOPPER.0, &scene::SHOPPER.1)?;
    let rig = toile_assets::rig::fit(&body);
    let dress = drafting::package("strap-dress")?.dress(size, &body)?;
    let (mut world, _snapshots) = World::new(body, &rig, vec![dress], Settings { workers, ..Settings::default() })?;
    world.dress(first);
    Ok(WorldScene::new(world))
}

/// A run against a simulated clock, as the bytes of a file.
fn record(frames: &[Joints]) -> Result<Vec<u8>, Box<dyn Error>> {
    let (sender, _events) = bounded(EVENTS_NAME, EVENTS);
    let (recorder, mut entries) = bounded(ENTRIES_NAME, ENTRIES);
    let TripleBuffer { writer, reader } = TripleBuffer::new(&SensorFrame::default());
    let clock = SimClock::default();
    let outlets = PhysicsOutputs { events: sender, recording: Some(recorder) };
    let mut physics = PhysicsThread::new(staged("38", &frames[0], 1)?, clock.clone(), 0, reader, outlets, NoCounters);
    let mut sense = SensorThread::new(Playback::new(frames, 0, 1), JointFilter::default(), clock.clone(), writer);
    simulate(&clock, &mut [&mut sense, &mut physics], LENGTH_NS);
    let mut bytes = recording::header("38");
    recording::write(&Entry::Dressed(frames[0]), &mut bytes);
    while let Some(entry) = entries.pop() {
        recording::write(&entry, &mut bytes);
    }
    if let Some(warning) = entries.capacity().warning() {
        return Err(warning.into());
    }
    Ok(bytes)
}

/// The same steps again, by the same function, with so many workers.
fn again(size: &str, entries: &[Entry], workers: usize) -> Result<Replayed, Box<dyn Error>> {
    let Some(Entry::Dressed(first)) = entries.first() else { return Err("the recording dresses no shopper".into()) };
    Ok(replay(&mut SceneStepper::new(staged(size, first, workers)?), entries, &SimClock::default()))
}

fn main() -> Result<(), Box<dyn Error>> {
    let skeleton = toile_assets::body::build(scene::SHOPPER.0, &scene::SHOPPER.1)?.skeleton;
    let seen = |i: u64| {
        let at = JointFrames::new(&skeleton, &scene::shopper(&skeleton, 1.5 + i as f32 / 30.0)).position;
        Joints::seen(i * SECOND_NS / 30, at)
    };
    let frames: Vec<Joints> = (0..60).map(seen).collect();
    let bytes = record(&frames)?;
    let LoopRecording { text: size, mut entries, .. } = recording::read(&bytes)?;
    println!("recorded {} entries in {} kB", entries.len(), bytes.len() / 1_000);

    for workers in [1, 2] {
        let found = again(&size, &entries, workers)?;
        println!(
            "replayed with {workers}: {} steps, the same bits in all: {}",
            found.ticks,
            found.diverged_at.is_none()
        );
        if found.diverged_at.is_some() || found.gap_at.is_some() || found.ticks == 0 {
            return Err(format!("step {:?} came out with other bits", found.diverged_at).into());
        }
    }

    // The comparison is no formality. A joint that is a millimetre off is found in the step that first knew of it or the next:
    // the intake lets what it is off by fade in.
    let moved = entries.iter().position(|e| matches!(e, Entry::SensorFrame(seen) if seen.number == MOVED.0));
    let moved = moved.ok_or("the recording has fewer frames than it should")?;
    let known = entries[moved..].iter().find_map(|e| if let Entry::Step { tick, .. } = e { Some(*tick) } else { None });
    let known = known.ok_or("no step follows the frame")?;
    if let Entry::SensorFrame(seen) = &mut entries[moved] {
        seen.joints.at_mut(Joint::LeftWrist).position.x += MOVED.1;
    }
    let Some(found) = again(&size, &entries, 1)?.diverged_at else { return Err("it was not found".into()) };
    println!("with a wrist a millimetre off, known from step {known} on: other bits from step {found} on");
    if !(known..=known + 1).contains(&found) {
        return Err(format!("step {found} is not the first that it could be seen in").into());
    }
    Ok(())
}
