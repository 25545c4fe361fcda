//! The loop on its threads: an own sensor, the physics, an own display, each on a thread of its own, for two seconds.
//!
//! `cargo run --release -p toile-engine --example three_threads`
//!
//! The counts depend on the machine: a core that is taken away shows as dropped steps, and the loop goes on.

use std::error::Error;
use std::time::Duration;

use toile_assets::{drafting, scene};
use toile_base::clock::{SECOND_NS, ticks_to_ns};
use toile_base::frame::Joints;
use toile_base::limits::STEP_HZ;
use toile_base::skeleton::Skeleton;
use toile_engine::body::JointFrames;
use toile_engine::clock::{Clock, RealClock};
use toile_engine::cloth::Settings;
use toile_engine::frame_loop::event::{EVENTS, EVENTS_NAME, NoCounters};
use toile_engine::frame_loop::physics_thread::{PhysicsOutputs, PhysicsThread, WorldScene};
use toile_engine::frame_loop::queue::bounded;
use toile_engine::frame_loop::render_thread::{RenderThread, Renderer};
use toile_engine::frame_loop::sensor_thread::{FrameSource, SensorFrame, SensorThread, SourceFrame};
use toile_engine::frame_loop::thread_roles::ThreadRole;
use toile_engine::frame_loop::threads::{self, Stop};
use toile_engine::triple_buffer::TripleBuffer;
use toile_engine::world::{Snapshot, World};
use toile_sensors::filter::JointFilter;

/// Length of the run (s).
const SECONDS: u64 = 2;

/// An own sensor: gives joints 30 times a second, here those of the scene's shopper. Raw ones; `Sense` filters them.
struct Camera {
    skeleton: Skeleton,
    origin_ns: u64,
    frames: u64,
}

impl FrameSource for Camera {
    fn next_ns(&self) -> Option<u64> {
        Some(self.origin_ns + self.frames * SECOND_NS / 30)
    }

    fn read(&mut self) -> Option<SourceFrame> {
        let time_ns = self.next_ns()?;
        self.frames += 1;
        let seconds = (time_ns - self.origin_ns) as f64 / SECOND_NS as f64;
        let at = JointFrames::new(&self.skeleton, &scene::shopper(&self.skeleton, seconds as f32)).position;
        Some(Joints::seen(time_ns, at).into())
    }
}

/// An own display: is shown the newest snapshot 60 times a second, and must not keep it.
#[derive(Default)]
struct Display {
    pictures: u64,
    newest: u64,
    bad: u64,
}

impl Renderer for Display {
    // The scene is never changed for another here, so there is nothing to put on.
    type Outfit = ();

    fn set_outfit(&mut self, _outfit: &mut ()) {}

    fn draw(&mut self, snapshot: &Snapshot) {
        self.pictures += 1;
        self.bad += u64::from(snapshot.tick < self.newest);
        self.bad += u64::from(snapshot.garments.iter().flatten().any(|p| !p.is_finite()));
        self.newest = snapshot.tick;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    // At load, on this thread.
    let body = toile_assets::body::build(scene::SHOPPER.0, &scene::SHOPPER.1)?;
    let rig = toile_assets::rig::fit(&body);
    let dress = drafting::package("strap-dress")?.dress("38", &body)?;
    let skeleton = body.skeleton.clone();
    let (mut world, snapshots) = World::new(body, &rig, vec![dress], Settings { workers: 1, ..Settings::default() })?;
    let first = Camera { skeleton: skeleton.clone(), origin_ns: 0, frames: 0 }.read();
    world.dress(&first.ok_or("the camera gives no frame")?.joints);
    let (pool, _) = threads::worker_pool(2, ThreadRole::Physics)?;

    // Between the threads: the latest joints, the latest snapshot, and a bounded queue of what happened.
    let TripleBuffer { writer, reader } = TripleBuffer::new(&SensorFrame::default());
    let (sender, mut events) = bounded(EVENTS_NAME, EVENTS);
    let clock = RealClock::default();
    let origin_ns = clock.now_ns() + SECOND_NS / 10;
    let sense = SensorThread::new(Camera { skeleton, origin_ns, frames: 0 }, JointFilter::default(), clock, writer);
    let outlets = PhysicsOutputs { events: sender, recording: None };
    let physics =
        PhysicsThread::new(WorldScene::new(world.with_workers(pool)), clock, origin_ns, reader, outlets, NoCounters);
    let render = RenderThread::new(Display::default(), clock, origin_ns + ticks_to_ns(1), snapshots);

    let stop = Stop::default();
    let sensor = threads::start(ThreadRole::Sensor, sense, clock, &stop)?;
    let physics = threads::start(ThreadRole::Physics, physics, clock, &stop)?;
    let render = threads::start(ThreadRole::Render, render, clock, &stop)?;
    std::thread::sleep(Duration::from_millis(SECONDS * 1_000 + 100));
    stop.now();
    let (sensor, physics, render) = (sensor.join(), physics.join(), render.join());
    let (sensor, physics) = (sensor.ok_or("the sensor panicked")?, physics.ok_or("the physics panicked")?);
    let display = render.ok_or("the render panicked")?.renderer;

    let gauges = &physics.gauges;
    let us = |share| gauges.step.histogram().value_at_quantile(share) / 1_000;
    println!("{} sensor frames, {} steps and {} dropped", sensor.frames(), gauges.steps, gauges.dropped);
    println!("{} pictures, the last of step {}", display.pictures, display.newest);
    println!("a step took {} us, at p99 {} us; {} were late", us(0.5), us(0.99), gauges.missed);
    println!("events: {}", std::iter::from_fn(|| events.pop()).count());
    // A machine without two free cores may be late; that nothing moves is wrong on any.
    let due = SECONDS * u64::from(STEP_HZ);
    if 2 * (gauges.steps + gauges.dropped) < due || display.pictures == 0 || display.bad > 0 {
        return Err(format!("{due} steps were due, and all of {} pictures to be in order", display.pictures).into());
    }
    Ok(())
}
