//! Facts of the real recordings, before and after the filter.

use std::path::Path;

use glam::Vec3;
use toile_base::clock::ticks_to_ns;
use toile_base::frame::Joints;
use toile_base::limits::CONFIDENCE_GATE;
use toile_base::skeleton::Joint;
use toile_sensors::sample::sample;
use toile_sensors::session::{self as recording, Session};
use toile_sensors::source::{OpenOptions, open};

use crate::common::{data, filtered, length, median, session, spread, top_speed};

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

fn all(folder: &Path) -> Vec<Session> {
    let files = KINECT.iter().chain([&(KINECTRON, 0)]).chain(&BVH);
    files.map(|(file, _)| session(folder, file)).collect()
}

/// Direction in which the person faces, from the hips.
fn facing(frame: &Joints) -> Vec3 {
    let [left, right] = [Joint::LeftHip, Joint::RightHip].map(|j| frame.at(j).position);
    (left - right).cross(Vec3::Y).normalize()
}

#[test]
fn frame_counts_are_those_of_the_files() {
    let Some(folder) = data() else { return };
    for (file, frames) in KINECT.iter().chain(&BVH) {
        assert_eq!(session(&folder, file).joints.len(), *frames, "{file}");
    }
    let kinectron = session(&folder, KINECTRON);
    // One of the 286 frames follows its neighbour within a millisecond.
    assert_eq!(kinectron.joints.len(), 285);
    assert!((kinectron.duration_ns() as f32 * 1e-9 - 9.6).abs() < 0.05);
    assert!(kinectron.notes.iter().any(|n| n.contains("1 of 286")), "{:?}", kinectron.notes);
}

#[test]
fn time_begins_at_zero_and_increases() {
    let Some(folder) = data() else { return };
    for s in all(&folder) {
        assert_eq!(s.joints[0].time_ns, 0, "{}", s.name);
        assert!(s.joints.windows(2).all(|w| w[0].time_ns < w[1].time_ns), "{}", s.name);
    }
}

#[test]
fn all_people_stand_on_the_floor_in_plausible_size() {
    let Some(folder) = data() else { return };
    for s in all(&folder) {
        let y = |j: Joint| median(s.joints.iter().filter(|f| f.at(j).confidence > 0.0).map(|f| f.at(j).position.y));
        // The head joint lies about 0.12 m below the crown; mocap bends and squats on the way.
        let stature = s.joints.iter().map(|f| f.at(Joint::Head).position.y).fold(0.0, f32::max) + 0.12;
        println!(
            "{}: tallest {stature:.2}, hips {:.2}, ankles {:.3} {:.3}, toes {:.3} {:.3}",
            s.name,
            y(Joint::LeftHip),
            y(Joint::LeftAnkle),
            y(Joint::RightAnkle),
            y(Joint::LeftToe),
            y(Joint::RightToe)
        );
        assert!((1.4..2.4).contains(&stature), "{}: {stature}", s.name);
        for ankle in [Joint::LeftAnkle, Joint::RightAnkle] {
            assert!((0.05..0.16).contains(&y(ankle)), "{}: {ankle:?} at {}", s.name, y(ankle));
        }
        for toe in [Joint::LeftToe, Joint::RightToe] {
            assert!((-0.02..0.12).contains(&y(toe)), "{}: {toe:?} at {}", s.name, y(toe));
        }
        let pelvis = |k: usize| median(s.joints.iter().map(|f| f.at(Joint::Pelvis).position[k]));
        assert!(pelvis(0).abs() < 0.05 && pelvis(2).abs() < 0.05, "{}: {} {}", s.name, pelvis(0), pelvis(2));
    }
}

#[test]
fn all_people_face_us_with_correct_sides() {
    let Some(folder) = data() else { return };
    for s in all(&folder) {
        let begin = &s.joints[..s.joints.len().min(30)];
        assert!(begin.iter().all(|f| facing(f).z > 0.5), "{}: {}", s.name, facing(&begin[0]));
        let ahead = |f: &Joints, from: Joint, to: Joint| (f.at(to).position - f.at(from).position).dot(facing(f));
        let toes = median(
            s.joints
                .iter()
                .map(|f| ahead(f, Joint::LeftAnkle, Joint::LeftToe) + ahead(f, Joint::RightAnkle, Joint::RightToe)),
        );
        assert!(toes > 0.03, "{}: toes {toes} m ahead of the ankles", s.name);
        let left = |f: &Joints, j: Joint| (f.at(j).position - f.at(j.mirror()).position).dot(Vec3::Y.cross(facing(f)));
        for joint in [Joint::LeftShoulder, Joint::LeftHip] {
            assert!(median(s.joints.iter().map(|f| left(f, joint))) > 0.1, "{}: {joint:?}", s.name);
        }
    }
}

#[test]
fn what_was_assumed_is_said() {
    let Some(folder) = data() else { return };
    let notes = |file| session(&folder, file).notes.join("\n");
    assert!(notes("skeleton/labanotation-kinect2/joints.csv").contains("feet are not seen"));
    assert!(notes(KINECTRON).contains("no confidence"));
    assert!(notes(KINECTRON).contains("tilted by 17 degrees"));
    assert!(notes("mocap/animated-drawings/zombie.bvh").contains("up axis is z"));
    for (file, _) in BVH {
        assert!(!session(&folder, file).raw_scale_known && notes(file).contains("unit is unknown"), "{file}");
    }
    assert!(KINECT.iter().all(|(file, _)| session(&folder, file).raw_scale_known));
}

#[test]
fn clavicles_are_absent_where_the_format_has_none() {
    let Some(folder) = data() else { return };
    let clavicle = |file| session(&folder, file).joints[0].at(Joint::LeftClavicle).confidence;
    assert_eq!(clavicle(KINECT[0].0), 0.0);
    assert_eq!(clavicle("mocap/cmu/14_14.bvh"), 0.0);
    assert_eq!(clavicle("mocap/animated-drawings/dab.bvh"), 1.0);
    let s = session(&folder, KINECT[0].0);
    assert!(filtered(&s).iter().all(|f| f.at(Joint::LeftClavicle).confidence == 0.0));
}

#[test]
fn kinectron_bones_have_their_known_lengths_before_filtering() {
    let Some(folder) = data() else { return };
    let s = session(&folder, KINECTRON);
    for (from, to, mean, deviation) in [
        (Joint::RightShoulder, Joint::RightElbow, 0.227, 0.024),
        (Joint::RightElbow, Joint::RightWrist, 0.226, 0.025),
        (Joint::RightHip, Joint::RightKnee, 0.3175, 0.033),
    ] {
        let (m, d) = spread(s.joints.iter().filter_map(|f| length(f, from, to)));
        assert!((m - mean).abs() < 0.002 && (d - deviation).abs() < 0.002, "{from:?}: {m} +- {d}");
    }
}

#[test]
fn joints_csv_is_a_third_inferred_and_its_feet_almost_always() {
    let Some(folder) = data() else { return };
    let s = session(&folder, KINECT[3].0);
    let share = |j: Joint| {
        s.joints.iter().filter(|f| f.at(j).confidence < CONFIDENCE_GATE).count() as f32 / s.joints.len() as f32
    };
    assert!(share(Joint::LeftToe) > 0.97 && share(Joint::RightToe) > 0.97);
    assert!(share(Joint::Spine) < 0.01);
}

#[test]
fn nothing_jumps_after_the_filter_not_even_between_frames() {
    let Some(folder) = data() else { return };
    for s in all(&folder) {
        let track = filtered(&s);
        let (raw, after) = (top_speed(&s.joints), top_speed(&track));
        let ticks = (0..).map(ticks_to_ns).take_while(|t| *t <= s.duration_ns());
        let fine: Vec<Joints> = ticks.map(|t| sample(&track, t).unwrap()).collect();
        let between = top_speed(&fine);
        println!("{}: fastest raw {raw:.1?}, filtered {after:.1?}, at 120 Hz {between:.1?}", s.name);
        assert!(track.iter().chain(&fine).all(Joints::is_valid), "{}", s.name);
        assert!(after.0 < 9.0, "{}: {after:?}", s.name);
        assert!(between.0 < 10.0, "{}: {between:?}", s.name);
        // One hundred and twentieth of a second at most 8 cm.
        assert!(after.0 < 1.25 * raw.0 || after.0 < 5.0, "{}: {raw:?} {after:?}", s.name);
    }
}

#[test]
fn a_session_survives_being_recorded() {
    let Some(folder) = data() else { return };
    for (file, _) in [KINECT[0], BVH[4]] {
        let s = session(&folder, file);
        let back = recording::read("memory", &s.to_bytes().unwrap()).unwrap();
        assert_eq!(back, s);
    }
}

#[test]
fn raw_kinect_depth_opens_with_its_assumption_listed() {
    let Some(folder) = data() else { return };
    let mut seen = 0;
    for entry in std::fs::read_dir(folder.join("depth/skeltrack")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "u16le") {
            continue;
        }
        let s = open(&path, &OpenOptions::default()).unwrap();
        let frame = &s.depth[0];
        assert_eq!((s.depth.len(), frame.intrinsics.width, frame.intrinsics.height), (1, 640, 480));
        assert!(s.notes[0].contains("575.8"), "{:?}", s.notes);
        let (low, high) = heights(frame.points());
        println!("{}: {} pixels, y {low:.2} .. {high:.2} m", s.name, frame.valid_pixels());
        assert!((0.4..1.3).contains(&(high - low)), "waist up: {low} .. {high}");
        seen += 1;
    }
    assert_eq!(seen, 8);
}

#[test]
fn the_standing_woman_is_as_tall_as_the_data_says() {
    let Some(folder) = data() else { return };
    let folder = folder.join("depth/depthkit-chae/derived");
    let camera = Some(folder.join("chae_depth_camera.json"));
    let s = open(&folder.join("chae_depth_mm_1024x512.u16le"), &OpenOptions { camera }).unwrap();
    let frame = &s.depth[0];
    assert_eq!(frame.valid_pixels(), 165_326);
    let (low, high) = heights(frame.points());
    assert!(low.abs() < 0.002 && (high - 1.750).abs() < 0.003, "{low} .. {high}");
    let end_to_end = frame.points().fold((f32::MAX, f32::MIN), |(a, b), p| (a.min(p.y), b.max(p.y)));
    assert!((end_to_end.1 - end_to_end.0 - 1.782).abs() < 0.003, "{end_to_end:?}");
    let x = median(frame.points().map(|p| p.x));
    let z = median(frame.points().map(|p| p.z));
    assert!(x.abs() < 0.01 && z.abs() < 0.01, "{x} {z}");
    // The camera stands in front: what it sees faces +z.
    assert!(frame.camera_to_world.translation.z > 1.0);
}

#[test]
fn the_azure_recording_gives_its_depth_straightened() {
    let Some(folder) = data() else { return };
    let s = open(&folder.join("depth/pyk4a-azure-mkv/recording.mkv"), &OpenOptions::default()).unwrap();
    assert!(s.joints.is_empty() && s.depth.len() == 1, "{} {}", s.joints.len(), s.depth.len());
    let frame = &s.depth[0];
    let k = frame.intrinsics;
    // The narrow unbinned mode: 640 x 576 pixels as the lens bends them, f = .4928 x 1024 px.
    assert!((k.fx - 504.61).abs() < 0.01 && (k.fy - 504.73).abs() < 0.01, "{k:?}");
    assert!((640..800).contains(&k.width) && (576..720).contains(&k.height), "{k:?}");
    assert!(s.notes.iter().any(|n| n.contains("straightened")), "{:?}", s.notes);
    let mut depths: Vec<u16> = frame.depth_mm.iter().copied().filter(|d| *d != 0).collect();
    depths.sort_unstable();
    println!("{k:?}: {} pixels, {} .. {} mm", depths.len(), depths[0], depths[depths.len() - 1]);
    // A room: read little endian, half of the depths would lie beyond 16 m.
    assert!(depths.len() > 150_000 && depths[depths.len() / 100] > 150 && depths[depths.len() * 99 / 100] < 6_000);
    assert_eq!(recording::read("memory", &s.to_bytes().unwrap()).unwrap(), s);
}

/// The 0.2 and 99.8 percentiles of y (m).
fn heights(points: impl Iterator<Item = Vec3>) -> (f32, f32) {
    let mut y: Vec<f32> = points.map(|p| p.y).collect();
    y.sort_by(f32::total_cmp);
    (y[y.len() / 500], y[y.len() - 1 - y.len() / 500])
}
