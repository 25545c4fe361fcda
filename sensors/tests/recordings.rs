//! Facts of the real recordings, before and after the filter.

mod common;

use common::{data, filtered, length, median, session, spread, top_speed};
use toile_assets::skeleton::Joint;
use toile_sensors::session::Session;

const KINECT: [(&str, usize); 4] = [
    ("skeleton/labanotation-kinect2/Ges01_wavehand.csv", 154),
    ("skeleton/labanotation-kinect2/Ges02_balancinghands.csv", 161),
    ("skeleton/labanotation-kinect2/Ges03_drawlines.csv", 213),
    ("skeleton/labanotation-kinect2/joints.csv", 371),
];

const KINECTRON: &str = "skeleton/kinectron-kinect2/recorded_skeleton.json";

const BVH: [(&str, usize); 5] = [
    ("mocap/animated-drawings/dab.bvh", 339),
    ("mocap/animated-drawings/jumping.bvh", 654),
    ("mocap/animated-drawings/wave_hello.bvh", 839),
    ("mocap/animated-drawings/zombie.bvh", 779),
    ("mocap/cmu/14_14.bvh", 4653),
];

fn describe(s: &Session) {
    let f = filtered(s);
    let y = |j| median(s.joints.iter().filter(|f| f.at(j).confidence > 0.0).map(|f| f.at(j).position.y));
    println!("{}: {} frames, {:.2} s", s.name, s.joints.len(), s.duration_ns() as f32 * 1e-9);
    println!(
        "  head {:.3} hips {:.3} ankles {:.3} {:.3}",
        y(Joint::Head),
        y(Joint::LeftHip),
        y(Joint::LeftAnkle),
        y(Joint::RightAnkle)
    );
    println!("  raw {:?}, filtered {:?}", top_speed(&s.joints), top_speed(&f));
    for j in Joint::ALL {
        if let Some(p) = j.parent() {
            let raw: Vec<f32> = s.joints.iter().filter_map(|f| length(f, p, j)).collect();
            let out: Vec<f32> = f.iter().filter_map(|f| length(f, p, j)).collect();
            if !raw.is_empty() {
                println!("    {j:?}: raw {:.3?} out {:.3?}", spread(raw.into_iter()), spread(out.into_iter()));
            }
        }
    }
    for n in &s.notes {
        println!("  - {n}");
    }
}

#[test]
fn show() {
    let Some(folder) = data() else { return };
    for file in KINECT.iter().map(|k| k.0).chain([KINECTRON]).chain(BVH.iter().map(|b| b.0)) {
        describe(&session(&folder, file));
    }
}
