//! Small recordings of every kind, made here.

use glam::{Affine3A, Vec3};
use toile_base::frame::{DepthFrame, Intrinsics, Joints, TrackedJoint};
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::Joint;
use toile_sensors::session::Session;
use toile_sensors::source::synthetic::JointNoise;

/// A standing person, 1.7 m, facing +z with the arms down.
pub fn standing(time_ns: u64) -> Joints {
    use Joint::*;
    let middle = [(Pelvis, 0.95), (Spine, 1.05), (Chest, 1.3), (Neck, 1.45), (Head, 1.58)];
    let left = [
        (LeftShoulder, 0.18, 1.38),
        (LeftElbow, 0.2, 1.1),
        (LeftWrist, 0.22, 0.86),
        (LeftHand, 0.22, 0.78),
        (LeftHip, 0.09, 0.92),
        (LeftKnee, 0.1, 0.5),
        (LeftAnkle, 0.1, 0.08),
    ];
    let mut f = Joints::absent(time_ns);
    let mut put = |joint, x, y, z| {
        *f.at_mut(joint) = TrackedJoint { position: Vec3::new(x, y, z), confidence: 1.0 };
    };
    middle.into_iter().for_each(|(joint, y)| put(joint, 0.0, y, 0.0));
    for (joint, x, y) in left {
        put(joint, x, y, 0.0);
        put(joint.mirror(), -x, y, 0.0);
    }
    put(LeftToe, 0.1, 0.03, 0.13);
    put(RightToe, -0.1, 0.03, 0.13);
    f
}

/// Thirty frames of joints with noise and three small depth images.
pub fn session() -> Session {
    let mut noise = JointNoise::new(11);
    let joints = (0..30).map(|i| noise.apply(&standing(i * 33_333_333))).collect();
    let intrinsics = Intrinsics { width: 16, height: 12, fx: 14.0, fy: 14.0, cx: 7.5, cy: 5.5 };
    let mut rng = SplitMix64::new(3);
    let image = |i: u64, rng: &mut SplitMix64| DepthFrame {
        time_ns: i * 300_000_000,
        intrinsics,
        camera_to_world: Affine3A::from_translation(Vec3::Y),
        depth_mm: (0..192).map(|_| 2000 + (rng.next_u64() % 7) as u16).collect(),
    };
    Session {
        name: "sample".to_owned(),
        joints,
        depth: (0..3).map(|i| image(i, &mut rng)).collect(),
        notes: vec!["made by a test".to_owned()],
        raw_scale_known: true,
    }
}

/// Kinect joint number of each of ours.
const KINECT: [Joint; 20] = {
    use Joint::*;
    [
        Pelvis,
        Spine,
        Neck,
        Head,
        LeftShoulder,
        LeftElbow,
        LeftWrist,
        LeftHand,
        RightShoulder,
        RightElbow,
        RightWrist,
        RightHand,
        LeftHip,
        LeftKnee,
        LeftAnkle,
        LeftToe,
        RightHip,
        RightKnee,
        RightAnkle,
        RightToe,
    ]
};

/// Kinect camera coordinates of all 25 joints; the camera stands 1 m high and 2.5 m away.
fn camera_joints(f: &Joints) -> Vec<Vec3> {
    let camera = |j: Joint| {
        let p = f.at(j).position;
        Vec3::new(-p.x, p.y - 1.0, 2.5 - p.z)
    };
    let mut all: Vec<Vec3> = KINECT.iter().map(|j| camera(*j)).collect();
    all.push(camera(Joint::Chest));
    all.extend([Joint::LeftHand, Joint::LeftHand, Joint::RightHand, Joint::RightHand].map(camera));
    all
}

/// A Kinect v2 CSV of some frames.
pub fn kinect_csv(frames: u64) -> Vec<u8> {
    let mut text = String::new();
    for i in 0..frames {
        text += &format!("{},", 89_810_293_609 + i * 330_000);
        for p in camera_joints(&standing(0)) {
            text += &format!("{},{},{},2,", p.x, p.y, p.z);
        }
        text += "\r\n";
    }
    text.into_bytes()
}

/// A Kinectron JSON of some frames.
pub fn kinectron(frames: u64) -> Vec<u8> {
    let bodies: Vec<String> = (0..frames)
        .map(|i| {
            let joints: Vec<String> = camera_joints(&standing(0))
                .iter()
                .map(|p| format!(r#"{{"cameraX":{},"cameraY":{},"cameraZ":{},"orientationX":0}}"#, p.x, p.y, p.z))
                .collect();
            format!(
                r#"{{"bodyIndex":0,"tracked":true,"trackingId":"7","leftHandState":2,"rightHandState":0,"joints":[{}],"record_startime":0,"record_timestamp":{}}}"#,
                joints.join(","),
                11 + i * 33
            )
        })
        .collect();
    format!("[{}]", bodies.join(",")).into_bytes()
}

/// A BVH in centimetres of some frames, y up.
pub fn bvh(frames: usize) -> Vec<u8> {
    let mut text =
        "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation \
                    Xrotation\n"
            .to_owned();
    let joint = |name: &str, x: f32, y: f32, inner: &str| {
        format!("JOINT {name}\n{{\nOFFSET {x} {y} 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n{inner}}}\n")
    };
    let end = "End Site\n{\nOFFSET 0 -10 0\n}\n";
    for (side, s) in [("Left", 1.0), ("Right", -1.0)] {
        let ankle = joint(&format!("{side}Ankle"), 0.0, -42.0, end);
        let knee = joint(&format!("{side}Knee"), 0.0, -42.0, &ankle);
        text += &joint(&format!("{side}Hip"), 9.0 * s, -3.0, &knee);
    }
    let mut chest = joint("Neck", 0.0, 15.0, &joint("Head", 0.0, 13.0, end));
    for (side, s) in [("Left", 1.0), ("Right", -1.0)] {
        let wrist = joint(&format!("{side}Wrist"), 0.0, -24.0, end);
        let elbow = joint(&format!("{side}Elbow"), 0.0, -28.0, &wrist);
        let shoulder = joint(&format!("{side}Shoulder"), 15.0 * s, 0.0, &elbow);
        chest += &joint(&format!("{side}Collar"), 3.0 * s, 8.0, &shoulder);
    }
    text += &joint("Chest", 0.0, 10.0, &joint("Chest2", 0.0, 25.0, &chest));
    text += &format!("}}\nMOTION\nFrames: {frames}\nFrame Time: 0.0333333\n");
    let moving = text.matches("CHANNELS 3").count() * 3;
    for i in 0..frames {
        text += &format!("0 95 {i} 0 0 0 {}\n", vec!["0.5"; moving].join(" "));
    }
    text.into_bytes()
}

/// A camera JSON of 16 x 12 pixels, level, at 1 m, looking towards -z.
pub const CAMERA: &str = r#"{"width":16,"height":12,"fx":14,"fy":14,"cx":7.5,"cy":5.5,"format":"u16 little endian",
    "cam_to_world":[[1,0,0,0],[0,-1,0,1000],[0,0,-1,2000],[0,0,0,1]]}"#;

/// Two raw images for [`CAMERA`].
pub fn raw_depth() -> Vec<u8> {
    (0..384u16).flat_map(|i| (2000 + i % 5).to_le_bytes()).collect()
}

/// A 16-bit grey PNG whose depths rise from 2 m.
pub fn png(width: u32, height: u32) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let samples: Vec<u8> = (0..width * height).flat_map(|i| (2000 + (i % 5) as u16).to_be_bytes()).collect();
    encoder.write_header().unwrap().write_image_data(&samples).unwrap();
    out
}

/// A Matroska element: id, size and content.
fn element(id: &[u8], data: &[u8]) -> Vec<u8> {
    let length = (data.len() as u64 | 1 << 56).to_be_bytes();
    [id, &length, data].concat()
}

/// A recording such as an Azure Kinect's, 320 x 288 pixels, with a calibration.
pub fn azure(frames: u16) -> Vec<u8> {
    let calibration = r#"{"CalibrationInformation":{"Cameras":[{"Location":"CALIBRATION_CameraLocationD0","MetricRadius":1.7,
        "Intrinsics":{"ModelType":"CALIBRATION_LensDistortionModelBrownConrady","ModelParameters":
        [0.51,0.51,0.49,0.49,0.5,-0.02,-0.002,0.88,0.08,-0.01,0,0,0,0]}}]}}"#;
    let mut private = [0; 40];
    private[16..20].copy_from_slice(b"b16g");
    let video = [element(&[0xb0], &[1, 64]), element(&[0xba], &[1, 32])].concat();
    let track = [
        element(&[0xd7], &[2]),
        element(&[0x53, 0x6e], b"DEPTH"),
        element(&[0x63, 0xa2], &private),
        element(&[0xe0], &video),
    ]
    .concat();
    let file = [element(&[0x46, 0x6e], b"calibration.json"), element(&[0x46, 0x5c], calibration.as_bytes())].concat();
    let mut segment = [
        element(&[0x15, 0x49, 0xa9, 0x66], &element(&[0x2a, 0xd7, 0xb1], &[0x03, 0xe8])),
        element(&[0x16, 0x54, 0xae, 0x6b], &element(&[0xae], &track)),
        element(&[0x19, 0x41, 0xa4, 0x69], &element(&[0x61, 0xa7], &file)),
    ]
    .concat();
    for i in 0..frames {
        let image = (0..320 * 288u32).flat_map(|p| (1500 + (p % 320) as u16 + i).to_be_bytes());
        let block: Vec<u8> = [0x82, 0, 0, 0x80].into_iter().chain(image).collect();
        let begin = (u32::from(i) * 33_333).to_be_bytes();
        let cluster = [element(&[0xe7], &begin), element(&[0xa3], &block)].concat();
        segment.extend(element(&[0x1f, 0x43, 0xb6, 0x75], &cluster));
    }
    [element(&[0x1a, 0x45, 0xdf, 0xa3], b""), element(&[0x18, 0x53, 0x80, 0x67], &segment)].concat()
}
