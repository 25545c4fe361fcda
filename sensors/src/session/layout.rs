//! Topics of a session's file and the bytes of its messages: fixed layouts, little endian, described by texts that travel in the file.

use std::io::Cursor;

use glam::{Affine3A, Mat3A, Vec3, Vec3A};
use toile_base::skeleton::JOINTS;

use super::recording::DepthRoom;
use toile_base::frame::{DepthFrame, HandState, Intrinsics, Joints, TrackedJoint, pose_fault};

/// Version of the recording's format; another one is refused.
pub(super) const VERSION: u32 = 1;
pub(super) const JOINTS_TOPIC: &str = "/joints";
pub(super) const DEPTH_TOPIC: &str = "/depth";
pub(super) const HANDS_TOPIC: &str = "/hands";
pub(super) const ENCODING: &str = "toile-le";
pub(super) const SCHEMA_ENCODING: &str = "text/plain";
pub(super) const METADATA: &str = "toile.session";
pub(super) const NOTES: &str = "toile.notes";

/// Description of a joints message, stored as its schema.
pub(super) const JOINTS_LAYOUT: &str = "\
little endian
u64 time_ns            since the session began
u32 count              23
count times:
  f32 x, y, z          world, metres, y up, floor at y = 0, the shopper faces +z
  f32 confidence       0 absent .. 1 seen
joints in order: pelvis, spine, chest, neck, head; then left and right each: clavicle, shoulder, elbow, wrist, hand, \
hip, knee, ankle, toe
";

/// Description of a depth message, stored as its schema.
pub(super) const DEPTH_LAYOUT: &str = "\
little endian
u64 time_ns            since the session began
u32 width, height      pixels
f32 fx, fy, cx, cy     pixels; (u, v) = (cx + fx x / z, cy + fy y / z), camera x right, y down, z forward
f32 camera_to_world[12]  columns x axis, y axis, z axis, translation (m)
then a PNG             greyscale, 16 bit; depth along z in millimetres, 0 = nothing measured
";

/// Description of a hands message, stored as its schema.
pub(super) const HANDS_LAYOUT: &str = "\
little endian
u64 time_ns            of the joints message that it belongs to
u8 left, u8 right      0 unknown, 1 open, 2 closed
";

const DEPTH_HEADER: usize = 8 + 8 + 16 + 48;

/// The bytes of a message of joints.
pub(super) fn encode_joints(frame: &Joints) -> Vec<u8> {
    let mut out = Vec::with_capacity(12 + 16 * JOINTS);
    out.extend(frame.time_ns.to_le_bytes());
    out.extend((JOINTS as u32).to_le_bytes());
    for joint in &frame.joints {
        let p = joint.position;
        for x in [p.x, p.y, p.z, joint.confidence] {
            out.extend(x.to_le_bytes());
        }
    }
    out
}

/// Reads a joints message.
pub(super) fn decode_joints(bytes: &[u8]) -> Result<Joints, String> {
    let mut words = MessageBytes(bytes);
    let time_ns = words.u64()?;
    let count = words.u32()?;
    if count as usize != JOINTS || words.0.len() != 16 * JOINTS {
        return Err(format!("a joints message of {} bytes says that it holds {count} of {JOINTS} joints", bytes.len()));
    }
    let mut frame = Joints::absent(time_ns);
    for joint in &mut frame.joints {
        *joint = TrackedJoint { position: words.vec3()?, confidence: words.f32()? };
    }
    if frame.is_valid() {
        Ok(frame)
    } else {
        Err("a joint is not finite, or its confidence not within 0..1".to_owned())
    }
}

/// A hands message; none where neither hand's state is known.
pub(super) fn encode_hands(frame: &Joints) -> Option<Vec<u8>> {
    if frame.hands == [HandState::Unknown; 2] {
        return None;
    }
    let mut out = frame.time_ns.to_le_bytes().to_vec();
    out.extend(frame.hands.map(|hand| match hand {
        HandState::Unknown => 0,
        HandState::Open => 1,
        HandState::Closed => 2,
    }));
    Some(out)
}

/// Reads a hands message: its time, left and right.
pub(super) fn decode_hands(bytes: &[u8]) -> Result<(u64, [HandState; 2]), String> {
    let mut words = MessageBytes(bytes);
    let (time_ns, states) = (words.u64()?, words.take::<2>()?);
    if !words.0.is_empty() || states.iter().any(|state| *state > 2) {
        return Err("a hands message holds more than two states of 0, 1 or 2".to_owned());
    }
    let hand = |state| match state {
        1 => HandState::Open,
        2 => HandState::Closed,
        _ => HandState::Unknown,
    };
    Ok((time_ns, states.map(hand)))
}

/// The bytes of a message of a depth image.
pub(super) fn encode_depth(frame: &DepthFrame) -> Result<Vec<u8>, String> {
    let k = &frame.intrinsics;
    let mut out = Vec::with_capacity(DEPTH_HEADER + frame.depth_mm.len() / 4);
    out.extend(frame.time_ns.to_le_bytes());
    out.extend(k.width.to_le_bytes());
    out.extend(k.height.to_le_bytes());
    let pose = frame.camera_to_world.to_cols_array();
    for x in [k.fx, k.fy, k.cx, k.cy].into_iter().chain(pose) {
        out.extend(x.to_le_bytes());
    }
    let mut encoder = png::Encoder::new(&mut out, k.width, k.height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::Adaptive);
    // PNG samples are big endian.
    let samples: Vec<u8> = frame.depth_mm.iter().flat_map(|d| d.to_be_bytes()).collect();
    let mut writer = encoder.write_header().map_err(|e| e.to_string())?;
    writer.write_image_data(&samples).map_err(|e| e.to_string())?;
    writer.finish().map_err(|e| e.to_string())?;
    Ok(out)
}

/// Reads a depth message; sizes are checked, and `room` is asked, before memory is taken.
pub(super) fn decode_depth(bytes: &[u8], room: &mut DepthRoom) -> Result<DepthFrame, String> {
    let mut words = MessageBytes(bytes);
    let time_ns = words.u64()?;
    let (width, height) = (words.u32()?, words.u32()?);
    let [fx, fy, cx, cy] = [words.f32()?, words.f32()?, words.f32()?, words.f32()?];
    let intrinsics = Intrinsics { width, height, fx, fy, cx, cy };
    let axes = Mat3A::from_cols(words.vec3()?.into(), words.vec3()?.into(), words.vec3()?.into());
    let camera_to_world = Affine3A { matrix3: axes, translation: Vec3A::from(words.vec3()?) };
    if let Some(fault) = intrinsics.fault().or_else(|| pose_fault(&camera_to_world)) {
        return Err(fault);
    }
    room.take(&intrinsics).map_err(|fault| fault.problem)?;
    let depth_mm = decode_png(words.0, &intrinsics)?;
    Ok(DepthFrame { time_ns, intrinsics, camera_to_world, depth_mm })
}

fn decode_png(bytes: &[u8], camera: &Intrinsics) -> Result<Box<[u16]>, String> {
    let size = camera.pixels() * 2;
    let broken = |e: png::DecodingError| format!("the depth image is broken ({e})");
    let limits = png::Limits { bytes: 2 * size + (1 << 20) };
    let mut reader = png::Decoder::new_with_limits(Cursor::new(bytes), limits).read_info().map_err(broken)?;
    let info = reader.info();
    let same = (info.width, info.height) == (camera.width, camera.height);
    if !same || reader.output_color_type() != (png::ColorType::Grayscale, png::BitDepth::Sixteen) {
        return Err("the depth image is not 16-bit grey of the camera's size".to_owned());
    }
    let mut samples = vec![0; size];
    reader.next_frame(&mut samples).map_err(broken)?;
    reader.finish().map_err(broken)?;
    Ok(samples.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect())
}

/// The unread rest of a message.
struct MessageBytes<'a>(&'a [u8]);

impl MessageBytes<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (head, tail) = self.0.split_first_chunk::<N>().ok_or("the message is too short")?;
        self.0 = tail;
        Ok(*head)
    }

    fn u64(&mut self) -> Result<u64, String> {
        self.take().map(u64::from_le_bytes)
    }

    fn u32(&mut self) -> Result<u32, String> {
        self.take().map(u32::from_le_bytes)
    }

    fn f32(&mut self) -> Result<f32, String> {
        self.take().map(f32::from_le_bytes)
    }

    fn vec3(&mut self) -> Result<Vec3, String> {
        Ok(Vec3::new(self.f32()?, self.f32()?, self.f32()?))
    }
}
