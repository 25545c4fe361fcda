//! Quality control under load: the machine becomes slow for a second, quality is given up so that steps stay in time, and
//! comes back.
//!
//! `cargo run --release -p toile-engine --example quality_under_load`
//!
//! The loop runs against a simulated clock, which only its parts move: what a step costs is said here, so that the same
//! load gives the same decisions on every machine.

use std::error::Error;

use toile_assets::{drafting, scene};
use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;
use toile_engine::body::JointFrames;
use toile_engine::clock::{Clock, SimClock};
use toile_engine::cloth::{Settings, Wind};
use toile_engine::frame_loop::event::{EVENTS, EVENTS_NAME, EventKind, NoCounters};
use toile_engine::frame_loop::physics_thread::{LoopScene, PhysicsOutputs, PhysicsThread, WorldScene};
use toile_engine::frame_loop::quality_control::{QUALITY_LEVELS, QualityLevel};
use toile_engine::frame_loop::queue::bounded;
use toile_engine::frame_loop::sensor_thread::{Playback, SensorFrame, SensorThread};
use toile_engine::frame_loop::simulate::simulate;
use toile_engine::triple_buffer::TripleBuffer;
use toile_engine::world::{SnapshotTimes, World};
use toile_sensors::filter::JointFilter;

/// What a step costs at whole quality (ns), and while the load lasts.
const COST_NS: [u64; 2] = [3_000_000, 10_500_000];
/// When the load begins and ends (ns).
const LOAD_NS: [u64; 2] = [SECOND_NS, 2 * SECOND_NS];
/// Length of the run (ns).
const LENGTH_NS: u64 = 8 * SECOND_NS;

/// The dressed shopper on a machine whose speed is simulated.
struct Loaded {
    staged: WorldScene,
    clock: SimClock,
    share: f32,
}

impl LoopScene for Loaded {
    fn step(&mut self, joints: &Joints, times: SnapshotTimes, clock: &impl Clock) {
        let loaded = (LOAD_NS[0]..LOAD_NS[1]).contains(&times.scheduled_ns);
        self.clock.spend((COST_NS[usize::from(loaded)] as f32 * self.share) as u64);
        self.staged.step(joints, times, clock);
    }

    fn set_level(&mut self, level: &QualityLevel) {
        self.share = level.time_share;
        self.staged.set_level(level);
    }

    fn measure(&mut self) {
        self.staged.measure();
    }

    fn clear_meters(&mut self) {
        self.staged.clear_meters();
    }

    fn fingerprint(&self) -> u64 {
        self.staged.fingerprint()
    }

    fn fault_counts(&self) -> [u64; 2] {
        self.staged.fault_counts()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let body = toile_assets::body::build(scene::SHOPPER.0, &scene::SHOPPER.1)?;
    let seen = |i: u64| {
        let pose = scene::shopper(&body.skeleton, i as f32 / 30.0);
        let at = JointFrames::new(&body.skeleton, &pose).position;
        Joints::seen(i * SECOND_NS / 30, at)
    };
    let frames: Vec<Joints> = (0..240).map(seen).collect();
    // Threads 40 mm apart: the load is what is shown here, not the dress.
    let mut package = drafting::package("strap-dress")?;
    package.spacing_mm = 40.0;
    let dress = package.dress("38", &body)?;
    let wind = Some(Wind { velocity: glam::Vec3A::X, drag: 1.2, lift: 0.6 });
    let rig = toile_assets::rig::fit(&body);
    let (mut world, _snapshots) = World::new(body, &rig, vec![dress], Settings { wind, ..Settings::default() })?;
    world.dress(&frames[0]);

    let clock = SimClock::default();
    let TripleBuffer { writer, reader } = TripleBuffer::new(&SensorFrame::default());
    let (sender, mut events) = bounded(EVENTS_NAME, EVENTS);
    let scene = Loaded { staged: WorldScene::new(world), clock: clock.clone(), share: 1.0 };
    let outlets = PhysicsOutputs { events: sender, recording: None };
    let mut physics = PhysicsThread::new(scene, clock.clone(), 0, reader, outlets, NoCounters);
    let mut sense = SensorThread::new(Playback::new(&frames, 0, 2), JointFilter::default(), clock.clone(), writer);
    simulate(&clock, &mut [&mut sense, &mut physics], LENGTH_NS);

    let mut lowest = 0;
    while let Some(event) = events.pop() {
        let at = event.scheduled_ns as f64 / SECOND_NS as f64;
        match event.what {
            EventKind::Quality(change) => {
                lowest = lowest.max(change.to);
                let level = &QUALITY_LEVELS[usize::from(change.to)];
                println!("{at:.3} s: level {} to {}, which gives up {}", change.from, change.to, level.gives_up);
            }
            EventKind::Missed(miss) => {
                println!("{at:.3} s: a step was published {:.1} ms after it was due", miss.total_ns as f64 * 1e-6);
            }
            _ => {}
        }
    }
    let gauges = &physics.gauges;
    println!(
        "{} steps, {} late, {} dropped; on each level {:?}",
        gauges.steps, gauges.missed, gauges.dropped, gauges.level_steps
    );
    if lowest == 0 || physics.level() != 0 {
        return Err("quality was not given up, or did not come back".into());
    }
    if gauges.missed > 4 || gauges.dropped > 0 || physics.stepper.scene.fault_counts() != [0, 0] {
        return Err("more steps were late than it takes to see that they are".into());
    }
    Ok(())
}
