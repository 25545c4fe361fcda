//! The scene on which the world is tested: the shopper of the embedded session, her joints as a perfect sensor sees
//! them, and the wardrobe in the size nearest to her.

use toile_assets::draping::PatternPackage;
use toile_assets::sizes::{SizeBody, SizeTable};
use toile_assets::{drafting, scene};
use toile_base::body::Body;
use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;
use toile_base::garment::Garment;
use toile_engine::body::JointFrames;
use toile_engine::cloth::Settings;
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot, World};
use toile_sensors::filter::JointFilter;

/// Frames a second of the sensor.
pub const SENSOR_HZ: u64 = 30;

/// The scene's shopper.
///
/// # Panics
/// Where her body cannot be built.
pub fn shopper() -> Body {
    toile_assets::body::build(scene::SHOPPER.0, &scene::SHOPPER.1).expect("the scene's shopper can be built")
}

/// Her joints at a time, all seen (s).
pub fn joints(body: &Body, time_ns: u64) -> Joints {
    let seconds = (time_ns as f64 / SECOND_NS as f64) as f32;
    let at = JointFrames::new(&body.skeleton, &scene::shopper(&body.skeleton, seconds)).position;
    Joints::seen(time_ns, at)
}

/// What a sensor that sees her perfectly gives after the filter, from `from` (s) on for `seconds`.
pub fn track(body: &Body, from: f32, seconds: f32) -> Vec<Joints> {
    let mut filter = JointFilter::default();
    let first = (from * SENSOR_HZ as f32) as u64;
    let frames = (seconds * SENSOR_HZ as f32) as u64 + 1;
    (first..first + frames).map(|i| filter.push(&joints(body, i * SECOND_NS / SENSOR_HZ))).collect()
}

/// A garment of the wardrobe in the size nearest to a body.
///
/// # Panics
/// Where there is no such garment.
pub fn dress(name: &str, body: &Body) -> Garment {
    let package = drafting::package(name).expect("a garment of the wardrobe");
    package.dress(&nearest_size(&package, body), body).expect("a garment that can be worn")
}

/// The same with threads so far apart that a step costs little: for rules that hold on any mesh.
///
/// # Panics
/// Where there is no such garment.
pub fn dress_coarsely(name: &str, body: &Body) -> Garment {
    let mut package = drafting::package(name).expect("a garment of the wardrobe");
    package.spacing_mm = 40.0;
    package.dress(&nearest_size(&package, body), body).expect("a garment that can be worn")
}

fn nearest_size(package: &PatternPackage, body: &Body) -> String {
    let sizes = package.sizes.as_ref().expect("a garment in sizes");
    let table = SizeTable::embedded(&sizes.table).expect("a table of the wardrobe");
    let m = &body.measures;
    let distance = |size: &SizeBody| {
        let girths =
            [(size.chest_girth, m.chest_girth), (size.waist_girth, m.waist_girth), (size.hip_girth, m.hip_girth)];
        girths.iter().map(|(a, b)| (a - b).abs()).sum::<f32>()
    };
    let of = |code: &&String| distance(&table.size_body(code).expect("a code of its own table"));
    let nearest = sizes.girths.iter().map(|girths| &girths.size).min_by(|a, b| of(a).total_cmp(&of(b)));
    nearest.expect("a garment in sizes").clone()
}

/// A world with these garments on a body, not yet dressed.
///
/// # Panics
/// Where the body has no colliders.
pub fn world(body: Body, garments: Vec<Garment>) -> World {
    world_and_reader(body, garments).0
}

/// The same with the end at which its snapshots come out.
///
/// # Panics
/// As [`world`].
pub fn world_and_reader(body: Body, garments: Vec<Garment>) -> (World, Reader<Snapshot>) {
    let rig = toile_assets::rig::fit(&body);
    World::new(body, &rig, garments, Settings::default()).expect("a world of the wardrobe")
}

/// The scene's shopper dressed in garments of the wardrobe, as she stands at the begin of a track.
pub fn dressed(names: &[&str], track: &[Joints]) -> World {
    let body = shopper();
    let garments = names.iter().map(|name| dress(name, &body)).collect();
    let mut world = world(body, garments);
    world.dress(&track[0]);
    world
}

/// Whether every number that the world shows or keeps is finite.
pub fn is_finite(world: &World) -> bool {
    let pose = world.pose();
    let posed = pose.root.is_finite() && pose.local.iter().all(|q| q.is_finite());
    posed
        && world
            .cloths()
            .iter()
            .all(|c| (0..c.positions.len()).all(|i| c.positions[i].is_finite() && c.velocity(i).is_finite()))
}
