//! Raw depth: images of 16-bit little-endian millimetres, one after the other, 0 = nothing measured.

use glam::{Affine3A, Mat3, Vec3};

use super::align::quantile;
use super::camera::Camera;
use crate::clock::SECOND_NS;
use crate::error::{Fault, Place};
use crate::frame::{DepthFrame, Intrinsics};
use crate::limits::MAX_DEPTH_FRAMES;
use crate::session::{Session, too_many};

/// Bytes of an image of the Kinect v1, by which a file without a camera is recognised.
pub(super) const KINECT_V1_BYTES: u64 = 640 * 480 * 2;

/// Rate assumed of several images in one file (Hz): that of the Kinects.
const ASSUMED_HZ: u64 = 30;

/// Height of a camera of unknown pose above the floor (m): the middle of the 0.6 .. 1.8 m that Kinect's makers advise.
const ASSUMED_CAMERA_HEIGHT: f32 = 1.2;

pub(super) fn read(bytes: &[u8], camera: Option<Camera>) -> Result<Session, Fault> {
    let mut notes = Vec::new();
    let camera = camera.unwrap_or_else(|| {
        notes.push(
            "no camera was given: a Kinect v1 is assumed (640 x 480, f = 575.8 px, centred); sizes depend on it"
                .to_owned(),
        );
        Camera { intrinsics: Intrinsics::KINECT_V1, pose: None }
    });
    let image = camera.intrinsics.pixels() * 2;
    if bytes.is_empty() || !bytes.len().is_multiple_of(image) {
        let (w, h) = (camera.intrinsics.width, camera.intrinsics.height);
        let problem = format!("{} bytes are not whole images of {w} x {h} x 2", bytes.len());
        return Err(Fault::new(
            Place::Byte(bytes.len() as u64),
            problem,
            "give the camera JSON that fits, or the whole file",
        ));
    }
    if bytes.len() / image > MAX_DEPTH_FRAMES {
        return Err(too_many(bytes.len() / image));
    }
    if bytes.len() > image {
        notes.push(format!("the file holds no times: its {} images are taken at {ASSUMED_HZ} Hz", bytes.len() / image));
    }
    let mut depth: Vec<DepthFrame> =
        (0u64..).zip(bytes.chunks_exact(image)).map(|(i, b)| frame(i, b, &camera)).collect();
    place(&mut depth, camera.pose.is_some(), &mut notes)?;
    Ok(Session { depth, notes, raw_scale_known: true, ..Session::default() })
}

fn frame(index: u64, bytes: &[u8], camera: &Camera) -> DepthFrame {
    let depth_mm = bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect();
    let camera_to_world = camera.pose.unwrap_or_else(level_camera);
    DepthFrame { time_ns: index * SECOND_NS / ASSUMED_HZ, intrinsics: camera.intrinsics, camera_to_world, depth_mm }
}

/// A level camera that the shopper faces: image right is the shopper's left (+x), down is -y, forward is -z.
fn level_camera() -> Affine3A {
    let rotation = Mat3::from_cols(Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z);
    Affine3A::from_mat3_translation(rotation, Vec3::Y * ASSUMED_CAMERA_HEIGHT)
}

/// Centres at the median point of the first image; puts the floor under the lowest points where up is known.
fn place(depth: &mut [DepthFrame], posed: bool, notes: &mut Vec<String>) -> Result<(), Fault> {
    let points: Vec<Vec3> = depth.first().map(|f| f.points().collect()).unwrap_or_default();
    let axis = |k: usize, fraction| quantile(points.iter().map(|p| p[k]).collect(), fraction);
    let (Some(x), Some(low), Some(z)) = (axis(0, 0.5), axis(1, 0.002), axis(2, 0.5)) else {
        let cure = "record again with somebody in view";
        return Err(Fault::new(Place::Frame(0), "the first depth image is empty", cure));
    };
    let floor = if posed {
        notes.push(format!(
            "the floor is put under the lowest points of the first image, at y = {low:.3} m of the camera's world"
        ));
        low
    } else {
        notes
            .push(format!("the camera's pose is unknown: level, {ASSUMED_CAMERA_HEIGHT} m above the floor is assumed, and heights depend on it"));
        0.0
    };
    let shift = Affine3A::from_translation(-Vec3::new(x, floor, z));
    for frame in depth {
        frame.camera_to_world = shift * frame.camera_to_world;
    }
    Ok(())
}
