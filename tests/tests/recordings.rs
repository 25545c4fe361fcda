//! Recordings of real sensors through the filter, the pose and the cloth: drops, bursts, inferred joints and wobbling
//! bones are all in them, and none of it may show as a jump or harm the cloth.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Mutex;
use std::thread;

use toile_base::body::{Measures, Sex};
use toile_base::clock::{SECOND_NS, ns_to_ticks, ticks_to_ns};
use toile_base::frame::Joints;
use toile_base::limits::STEP_SECONDS;
use toile_base::skeleton::Pose;
use toile_engine::body::ROOT_SPEED;
use toile_engine::body::smooth::LIMB_SPEED;
use toile_engine::world::World;
use toile_sensors::filter::JointFilter;
use toile_sensors::sample::sample;
use toile_sensors::source::{OpenOptions, open};
use toile_workspace::{dressed, recordings};

/// A recording, what is worn in it, and the most strain that the 99th percentile of the edges may have, averaged over
/// the steps: a jump flings a dress about, and the T-shirt is tight at the armpits.
const TRY_ONS: [(&str, &[&str], f32); 11] = [
    ("skeleton/kinectron-kinect2/recorded_skeleton.json", &["strap-dress"], 0.06),
    ("skeleton/labanotation-kinect2/Ges01_wavehand.csv", &["strap-dress"], 0.06),
    ("skeleton/labanotation-kinect2/Ges02_balancinghands.csv", &["strap-dress"], 0.06),
    ("skeleton/labanotation-kinect2/Ges03_drawlines.csv", &["strap-dress"], 0.06),
    ("skeleton/labanotation-kinect2/joints.csv", &["strap-dress"], 0.06),
    ("mocap/cmu/14_14.bvh", &["strap-dress"], 0.12),
    ("mocap/animated-drawings/jumping.bvh", &["strap-dress"], 0.25),
    ("mocap/animated-drawings/wave_hello.bvh", &["strap-dress"], 0.06),
    ("mocap/animated-drawings/dab.bvh", &["strap-dress"], 0.10),
    ("mocap/animated-drawings/zombie.bvh", &["strap-dress"], 0.06),
    ("skeleton/kinectron-kinect2/recorded_skeleton.json", &["tee", "wide-leg-trousers"], 0.25),
];

/// The part of each recording that is played (ns): its first seconds, in which each sensor's flaws already show.
const PLAYED_NS: u64 = 10 * SECOND_NS;

/// What was seen over one recording.
#[derive(Debug, Default)]
struct Figures {
    /// Fastest turn of any joint (rad/s) and fastest move of the pelvis (m/s), level and upright.
    turn: f32,
    level: f32,
    upright: f32,
}

impl Figures {
    fn look(&mut self, before: &Pose, after: &Pose) {
        for (a, b) in before.local.iter().zip(&after.local) {
            self.turn = self.turn.max(a.angle_between(*b) / STEP_SECONDS);
        }
        let moved = (after.root - before.root) / STEP_SECONDS;
        self.level = self.level.max(moved.with_y(0.0).length());
        self.upright = self.upright.max(moved.y.abs());
    }
}

fn filtered(file: &Path) -> Vec<Joints> {
    let session = open(file, &OpenOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let mut filter = JointFilter::default();
    let start = session.joints[0].time_ns;
    let played = session.joints.iter().take_while(|j| j.time_ns - start <= PLAYED_NS);
    played.map(|j| filter.push(j)).collect()
}

/// An average woman in these garments, through a recording.
fn play(track: &[Joints], worn: &[&str]) -> (World, Figures) {
    let body = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).expect("the average woman");
    let garments = worn.iter().map(|name| dressed::dress(name, &body)).collect();
    let mut world = dressed::world(body, garments);
    world.dress(&track[0]);
    let mut figures = Figures::default();
    let start = track[0].time_ns;
    for tick in 0..ns_to_ticks(track[track.len() - 1].time_ns - start).max(1) {
        let before = *world.pose();
        world.step(&sample(track, start + ticks_to_ns(tick)).expect("a track with frames"));
        figures.look(&before, world.pose());
        assert!(dressed::is_finite(&world), "tick {tick}");
    }
    (world, figures)
}

fn judge((file, worn, most): (&str, &[&str], f32), world: &World, figures: &Figures) {
    let (strain, depth) = (world.meters().strain(), world.meters().penetration_max);
    eprintln!(
        "{file}, {}: {} steps, turn {:.1} rad/s, pelvis {:.2} m/s level and {:.2} upright, strain mean {:.2} % p99 \
         {:.1} % max {:.0} %, {:.1} mm deep",
        worn.join(" and "),
        world.tick(),
        figures.turn,
        figures.level,
        figures.upright,
        strain.mean * 1e2,
        strain.p99 * 1e2,
        strain.max * 1e2,
        depth * 1e3,
    );
    for (cloth, garment) in world.cloths().iter().zip(world.garments()) {
        assert_eq!(cloth.events.rolled_back, 0, "{file}, {}: steps were rolled back", garment.name);
    }
    assert!(world.tick() > 100, "{file} is too short to tell anything");
    assert!(figures.turn <= LIMB_SPEED * 1.01, "{file}: a joint jumps at {} rad/s", figures.turn);
    assert!(figures.level <= ROOT_SPEED * 1.01, "{file}: the pelvis jumps at {} m/s", figures.level);
    // Who lands from a jump of 1.2 m falls at 4.9 m/s.
    assert!(figures.upright < 4.9, "{file}: the pelvis jumps up or down at {} m/s", figures.upright);
    assert!(strain.p99 < most, "{file}: {strain:?}");
}

#[test]
fn real_recordings_neither_jump_nor_harm_the_cloth() {
    let Some(data) = recordings::folder() else { return };
    let waiting = Mutex::new(TRY_ONS.into_iter().collect::<VecDeque<_>>());
    let next = || waiting.lock().expect("no thread panics while holding it").pop_front();
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(run) = next() {
                    let (world, figures) = play(&filtered(&data.join(run.0)), run.1);
                    judge(run, &world, &figures);
                }
            });
        }
    });
}
