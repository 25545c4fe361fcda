//! Tests of the decoder: frames are complete, time runs forwards, and whatever is wrong is counted.

use rosc::{OscBundle, OscMessage, OscPacket, OscTime, OscType, encoder};
use toile_base::skeleton::Joint;

use super::{Decoder, Drops, MAX_PACKET_BYTES, Vec3};

fn float(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage { addr: address.to_owned(), args })
}

fn bone(name: &str, p: [f32; 3], q: [f32; 4]) -> OscPacket {
    let numbers = p.into_iter().chain(q).map(OscType::Float);
    float("/VMC/Ext/Bone/Pos", std::iter::once(OscType::String(name.to_owned())).chain(numbers).collect())
}

fn time(t: f32) -> OscPacket {
    float("/VMC/Ext/T", vec![OscType::Float(t)])
}

fn bytes(packets: Vec<OscPacket>) -> Vec<u8> {
    let bundle = OscBundle { timetag: OscTime { seconds: 0, fractional: 1 }, content: packets };
    encoder::encode(&OscPacket::Bundle(bundle)).unwrap()
}

const NONE: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// One sender's frame: hips at `x`, and an arm.
fn frame(t: f32, x: f32) -> Vec<u8> {
    bytes(vec![
        time(t),
        bone("Hips", [x, 1.0, 0.0], NONE),
        bone("Spine", [0.0, 0.2, 0.0], NONE),
        bone("LeftShoulder", [-0.05, 0.3, 0.0], NONE),
        bone("LeftUpperArm", [-0.1, 0.0, 0.0], NONE),
    ])
}

#[test]
fn the_persons_left_is_our_left_and_the_collar_bone_is_no_shoulder() {
    let mut decoder = Decoder::new();
    decoder.push(&frame(1.0, 0.0), 0);
    decoder.push(&frame(1.033, 0.0), 33_000_000);
    let joints = decoder.take().unwrap();
    assert!(joints.at(Joint::LeftClavicle).position.distance(Vec3::new(0.05, 1.5, 0.0)) < 1e-6);
    assert!(joints.at(Joint::LeftShoulder).position.distance(Vec3::new(0.15, 1.5, 0.0)) < 1e-6);
    assert_eq!(joints.at(Joint::RightShoulder).confidence, 0.0);
    assert_eq!(decoder.drops().total(), 0);
    assert!(decoder.take().is_none());
}

#[test]
fn a_turn_is_mirrored_as_unity_is_left_handed() {
    // A quarter turn about y takes z to x in Unity: the figure looks to its right, our -x.
    let mut decoder = Decoder::new();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turned =
        bytes(vec![bone("Hips", [0.0, 1.0, 0.0], [0.0, half, 0.0, half]), bone("Spine", [0.0, 0.0, 0.3], NONE)]);
    decoder.push(&turned, 0);
    decoder.push(&turned, 33_000_000);
    let spine = decoder.take().unwrap().at(Joint::Spine).position;
    assert!(spine.distance(Vec3::new(-0.3, 1.0, 0.0)) < 1e-6, "{spine}");
}

#[test]
fn from_the_second_frame_on_a_frame_is_given_as_soon_as_it_is_complete() {
    let mut decoder = Decoder::new();
    decoder.push(&frame(1.0, 0.0), 0);
    assert!(decoder.take().is_none());
    for i in 1..10 {
        decoder.push(&frame(1.0 + 0.1 * i as f32, 0.01 * i as f32), i * 100_000_000);
        let joints = decoder.take();
        let wanted = -0.01 * (if i == 1 { 0 } else { i }) as f32;
        // The first frame is given when the second begins, which then completes too.
        let joints = joints.unwrap_or_else(|| panic!("frame {i} is not given"));
        assert!((joints.at(Joint::Pelvis).position.x - wanted).abs() < 1e-6 || i == 1);
        assert!((joints.time_ns as i64 - i as i64 * 100_000_000).abs() < 1_000_000, "{}", joints.time_ns);
    }
}

#[test]
fn late_packets_are_dropped_and_counted_and_a_restart_is_taken_over() {
    let mut decoder = Decoder::new();
    for (t, x) in [(5.0, 0.0), (5.1, 0.1), (5.2, 0.2), (5.15, 0.9), (5.3, 0.3)] {
        decoder.push(&frame(t, x), (t * 1e9) as u64);
    }
    assert_eq!(decoder.drops(), Drops { late: 1, ..Drops::default() });
    let before = decoder.take().unwrap();
    assert!((before.at(Joint::Pelvis).position.x + 0.3).abs() < 1e-6);
    for t in [0.1, 0.2, 0.3] {
        decoder.push(&frame(t, 0.5), 6_000_000_000 + (t * 1e9) as u64);
    }
    let after = decoder.take().unwrap();
    assert!(after.time_ns > before.time_ns && after.time_ns < 7_000_000_000, "{}", after.time_ns);
    assert_eq!(decoder.drops().total(), 1);
}

#[test]
fn what_is_wrong_is_counted_by_its_kind() {
    let mut decoder = Decoder::new();
    decoder.push(b"", 0);
    decoder.push(b"hello", 0);
    decoder.push(&[0xff; 64], 0);
    assert_eq!(decoder.drops().malformed, 3);
    decoder.push(&vec![b'/'; MAX_PACKET_BYTES + 1], 0);
    assert_eq!(decoder.drops().oversize, 1);
    let wrong = [
        bone("Hips", [f32::NAN, 0.0, 0.0], NONE),
        bone("Hips", [1e9, 0.0, 0.0], NONE),
        bone("Hips", [0.0; 3], [0.0; 4]),
        bone("Hips", [0.0; 3], [f32::INFINITY, 0.0, 0.0, 1.0]),
        float("/VMC/Ext/Bone/Pos", vec![OscType::Int(3)]),
        float("/VMC/Ext/Bone/Pos", vec![OscType::String("Hips".to_owned())]),
        float("/VMC/Ext/Root/Pos", vec![OscType::String("root".to_owned()), OscType::Int(1)]),
        time(f32::NAN),
        time(-1.0),
    ];
    let count = wrong.len() as u64;
    wrong.into_iter().for_each(|packet| decoder.push(&bytes(vec![packet]), 0));
    assert_eq!(decoder.drops().invalid, count);
    assert!(decoder.take().is_none());
    // What is none of ours is no fault.
    decoder.push(&bytes(vec![float("/VMC/Ext/Blend/Val", vec![]), bone("LeftEye", [0.0; 3], NONE)]), 0);
    assert_eq!(decoder.drops().total(), count + 4);
}

#[test]
fn bundles_nested_beyond_reason_and_brackets_do_no_harm() {
    let mut nested = b"/VMC/Ext/T\0\0,f\0\0\0\0\0\0".to_vec();
    while nested.len() + 20 < MAX_PACKET_BYTES {
        let mut outer = b"#bundle\0\0\0\0\0\0\0\0\x01".to_vec();
        outer.extend((nested.len() as u32).to_be_bytes());
        outer.extend(nested);
        nested = outer;
    }
    let mut decoder = Decoder::new();
    decoder.push(&nested, 0);
    assert_eq!(decoder.drops().malformed, 1);
    let half = MAX_PACKET_BYTES / 2 - 20;
    let mut brackets = b"/VMC/Ext/OK\0,".to_vec();
    brackets.extend(vec![b'['; half]);
    brackets.extend(vec![b']'; half]);
    brackets.extend([0; 4]);
    brackets.truncate(brackets.len() / 4 * 4);
    decoder.push(&brackets, 0);
}
