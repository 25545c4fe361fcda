//! Recordings for tests: small ones of a person who stands still, one of each text kind, and the embedded session.

use std::fs;
use std::path::Path;

/// A person of 1.7 m who stands before a Kinect: x, y, z of its 25 joints in camera axes (m); the camera is 1 m high.
fn kinect_joints() -> [[f64; 3]; 25] {
    let y = |height: f64| height - 1.0;
    let z = 2.5;
    [
        [0.0, y(0.92), z],
        [0.0, y(1.15), z],
        [0.0, y(1.45), z],
        [0.0, y(1.60), z],
        [-0.17, y(1.38), z],
        [-0.22, y(1.12), z],
        [-0.25, y(0.88), z],
        [-0.26, y(0.80), z],
        [0.17, y(1.38), z],
        [0.22, y(1.12), z],
        [0.25, y(0.88), z],
        [0.26, y(0.80), z],
        [-0.09, y(0.90), z],
        [-0.10, y(0.49), z],
        [-0.10, y(0.08), z],
        [-0.10, y(0.03), z - 0.13],
        [0.09, y(0.90), z],
        [0.10, y(0.49), z],
        [0.10, y(0.08), z],
        [0.10, y(0.03), z - 0.13],
        [0.0, y(1.38), z],
        [-0.26, y(0.76), z],
        [-0.24, y(0.80), z],
        [0.26, y(0.76), z],
        [0.24, y(0.80), z],
    ]
}

/// A Kinect v2 CSV: a time in 100 ns, then x, y, z, state of each joint.
pub fn kinect_csv(frames: u64) -> String {
    let mut text = String::new();
    for i in 0..frames {
        text += &format!("{},", 89_810_293_609 + i * 333_333);
        for [x, y, z] in kinect_joints() {
            text += &format!("{x},{y:.4},{z:.4},2,");
        }
        text += "\r\n";
    }
    text
}

/// A Kinectron JSON: an array of bodies.
pub fn kinectron(frames: u64) -> String {
    let joint =
        |[x, y, z]: [f64; 3]| format!(r#"{{"cameraX":{x},"cameraY":{y:.4},"cameraZ":{z:.4},"orientationX":0}}"#);
    let joints = kinect_joints().map(joint).join(",");
    let body = |i| {
        format!(
            r#"{{"bodyIndex":0,"tracked":true,"trackingId":"7","leftHandState":2,"rightHandState":0,"joints":[{joints}],"record_startime":0,"record_timestamp":{}}}"#,
            11 + i * 33
        )
    };
    format!("[{}]", (0..frames).map(body).collect::<Vec<_>>().join(","))
}

/// A BVH in centimetres.
pub fn bvh(frames: usize) -> String {
    let joint = |name: &str, x: f32, y: f32, inner: &str| {
        format!("JOINT {name}\n{{\nOFFSET {x} {y} 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n{inner}}}\n")
    };
    let end = "End Site\n{\nOFFSET 0 -10 0\n}\n";
    let mut tree = String::new();
    let mut chest = joint("Neck", 0.0, 15.0, &joint("Head", 0.0, 13.0, end));
    for (side, s) in [("Left", 1.0), ("Right", -1.0)] {
        let knee = joint(&format!("{side}Knee"), 0.0, -42.0, &joint(&format!("{side}Ankle"), 0.0, -42.0, end));
        tree += &joint(&format!("{side}Hip"), 9.0 * s, -3.0, &knee);
        let elbow = joint(&format!("{side}Elbow"), 0.0, -28.0, &joint(&format!("{side}Wrist"), 0.0, -24.0, end));
        let shoulder = joint(&format!("{side}Shoulder"), 15.0 * s, 0.0, &elbow);
        chest += &joint(&format!("{side}Collar"), 3.0 * s, 8.0, &shoulder);
    }
    tree += &joint("Chest", 0.0, 10.0, &joint("Chest2", 0.0, 25.0, &chest));
    let channels = "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation";
    let turns = vec!["0.5"; 3 * tree.matches("CHANNELS 3").count()].join(" ");
    let rows: String = (0..frames).map(|i| format!("0 95 {i} 0 0 0 {turns}\n")).collect();
    format!(
        "HIERARCHY\nROOT Hips\n{{\nOFFSET 0 0 0\n{channels}\n{tree}}}\nMOTION\nFrames: {frames}\nFrame Time: 0.0333333\n{rows}"
    )
}

/// The embedded session as a file.
pub fn embedded_session() -> Vec<u8> {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/data/sessions/shopper.mcap");
    fs::read(assets).expect("the embedded session lies among the assets")
}
