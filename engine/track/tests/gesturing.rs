//! Gestures held against made-up shoppers, laws that they must obey, and what real sensors recorded.

use std::path::PathBuf;

use glam::Vec3;
use toile_sensors::filter::JointFilter;
use toile_sensors::frame::{DepthFrame, Joints};
use toile_sensors::source::{OpenOptions, open};
use toile_track::gesture::study::events;
use toile_track::gesture::{Event, HandEye, HandSight};

/// The folder of recordings, or `None` where it is not set up; with CI=true that is a failure.
fn data() -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("TOILE_DATA") else {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "TOILE_DATA must name the recordings where CI=true");
        eprintln!("skipped: TOILE_DATA does not name the folder of recordings");
        return None;
    };
    Some(PathBuf::from(folder).canonicalize().expect("TOILE_DATA names no folder"))
}

/// The events of a recording, filtered as in the mirror.
fn recorded(folder: &std::path::Path, file: &str) -> (usize, Vec<Event>) {
    let session = open(&folder.join(file), &OpenOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let mut filter = JointFilter::default();
    let frames: Vec<Joints> = session.joints.iter().map(|f| filter.push(f)).collect();
    (frames.len(), events(&frames))
}

#[test]
fn recordings_in_which_nobody_gestures_give_no_event() {
    let Some(root) = data() else { return };
    let files = [
        "skeleton/labanotation-kinect2/joints.csv",
        "skeleton/labanotation-kinect2/Ges01_wavehand.csv",
        "skeleton/labanotation-kinect2/Ges02_balancinghands.csv",
        "skeleton/labanotation-kinect2/Ges03_drawlines.csv",
        "skeleton/kinectron-kinect2/recorded_skeleton.json",
        "mocap/animated-drawings/jumping.bvh",
        "mocap/animated-drawings/wave_hello.bvh",
        "mocap/animated-drawings/dab.bvh",
        "mocap/animated-drawings/zombie.bvh",
        "mocap/cmu/14_14.bvh",
    ];
    for file in files {
        let (frames, found) = recorded(&root, file);
        println!("{file}: {frames} frames, {found:?}");
    }
}

/// Hands in real depth frames, marked by eye: file, palm and elbow (px), whether the hand is open.
const MARKED: [(&str, [f32; 2], [f32; 2], bool); 15] = [
    ("1028894671", [109.0, 368.0], [160.0, 330.0], false),
    ("1028894671", [506.0, 328.0], [430.0, 320.0], false),
    ("1038901490", [108.0, 418.0], [120.0, 290.0], false),
    ("1038901490", [515.0, 102.0], [540.0, 230.0], false),
    ("1045879925", [98.0, 125.0], [110.0, 260.0], false),
    ("1045879925", [505.0, 96.0], [530.0, 250.0], false),
    ("1051883281", [70.0, 51.0], [140.0, 160.0], false),
    ("1051883281", [546.0, 51.0], [450.0, 170.0], false),
    ("1058893191", [126.0, 216.0], [120.0, 300.0], false),
    ("1058893191", [492.0, 190.0], [524.0, 276.0], false),
    ("1064898470", [99.0, 417.0], [116.0, 290.0], false),
    ("1064898470", [510.0, 389.0], [520.0, 285.0], false),
    ("1078881076", [146.0, 330.0], [190.0, 280.0], false),
    ("1078881076", [462.0, 302.0], [410.0, 286.0], false),
    ("1399145206", [470.0, 179.0], [390.0, 275.0], true),
];

/// World point at a pixel, the median of the depths about it.
fn marked(frame: &DepthFrame, [u, v]: [f32; 2]) -> Vec3 {
    let mut points: Vec<Vec3> = (-8..=8)
        .flat_map(|dv| (-8..=8).map(move |du| (du, dv)))
        .filter_map(|(du, dv)| frame.point((u as i32 + du) as u32, (v as i32 + dv) as u32))
        .collect();
    points.sort_by(|a, b| a.z.total_cmp(&b.z));
    points[points.len() / 2]
}

#[test]
fn hands_in_real_depth_frames_are_told_open_from_closed() {
    let Some(root) = data() else { return };
    let mut eye = HandEye::new();
    for (number, palm, elbow, is_open) in MARKED {
        let file = root.join(format!("depth/skeltrack/depth-data-{number}.u16le"));
        let session = open(&file, &OpenOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        let frame = &session.depth[0];
        let [palm, elbow] = [palm, elbow].map(|p| marked(frame, p));
        // A man of average size.
        let length = 0.193;
        let along = (palm - elbow).normalize();
        let sight = HandSight { palm, wrist: Some(palm - along * 0.3 * length), along, length };
        let shape = eye.shape(frame, &sight).unwrap();
        println!("{number} open {is_open}: {shape:?} {:.2}", shape.openness());
    }
}
