//! A camera JSON: intrinsics in pixels and, optionally, `cam_to_world` (4 x 4, translation in mm, y up).

use glam::{Affine3A, Mat3A, Vec3, Vec3A};
use serde::Deserialize;

use crate::error::{Fault, Place};
use crate::frame::{Intrinsics, pose_fault};

/// A depth camera as described beside a raw file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Camera {
    pub intrinsics: Intrinsics,
    /// Camera to a world with y up (m), where known.
    pub pose: Option<Affine3A>,
}

#[derive(Deserialize)]
struct Described {
    width: u32,
    height: u32,
    fx: f32,
    fy: f32,
    cx: f32,
    cy: f32,
    #[serde(default)]
    cam_to_world: Option<[[f64; 4]; 4]>,
}

const CURE: &str = "give width, height, fx, fy, cx, cy in pixels and cam_to_world in mm";

pub(super) fn read(bytes: &[u8]) -> Result<Camera, Fault> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let d: Described = serde_json::from_slice(bytes)
        .map_err(|e| Fault::new(Place::Line(e.line()), format!("not a camera description: {e}"), CURE))?;
    let intrinsics = Intrinsics { width: d.width, height: d.height, fx: d.fx, fy: d.fy, cx: d.cx, cy: d.cy };
    let pose = d.cam_to_world.map(|m| {
        let column = |k: usize| Vec3A::new(m[0][k] as f32, m[1][k] as f32, m[2][k] as f32);
        let rotation = Mat3A::from_cols(column(0), column(1), column(2));
        Affine3A::from_mat3_translation(rotation.into(), Vec3::from(column(3)) * 1e-3)
    });
    if let Some(fault) = intrinsics.fault().or_else(|| pose.as_ref().and_then(pose_fault)) {
        return Err(Fault::new(Place::Whole, fault, CURE));
    }
    Ok(Camera { intrinsics, pose })
}
