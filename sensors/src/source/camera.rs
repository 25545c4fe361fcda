//! A camera JSON: intrinsics in pixels and, optionally, how its lens bends, its unit and `cam_to_world` (4 x 4,
//! translation in mm, y up).

use glam::{Affine3A, Mat3A, Vec3, Vec3A};
use serde::Deserialize;

use crate::error::{FilePlace, ReaderFault};
use crate::lens::BrownConrady;
use toile_base::frame::{Intrinsics, pose_fault};

/// A depth camera as described beside its images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DepthCamera {
    pub intrinsics: Intrinsics,
    /// How the lens bends straight lines, where it does.
    pub distortion: Option<BrownConrady>,
    /// Camera to a world with y up (m), where known.
    pub pose: Option<Affine3A>,
    /// Millimetres in one unit of the samples.
    pub mm_per_unit: f32,
    /// Quarters by which its images are turned clockwise to be upright.
    pub quarter_turns: u8,
}

impl DepthCamera {
    /// A pinhole of unknown pose that measures in millimetres.
    pub const fn pinhole(intrinsics: Intrinsics) -> Self {
        Self { intrinsics, distortion: None, pose: None, mm_per_unit: 1.0, quarter_turns: 0 }
    }
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
    distortion: Option<Bent>,
    #[serde(default)]
    mm_per_unit: Option<f32>,
    #[serde(default)]
    quarter_turns: u8,
    #[serde(default)]
    cam_to_world: Option<[[f64; 4]; 4]>,
}

/// Brown and Conrady's coefficients; those left out are 0.
#[derive(Deserialize, Default)]
#[serde(default)]
struct Bent {
    k1: f32,
    k2: f32,
    k3: f32,
    k4: f32,
    k5: f32,
    k6: f32,
    p1: f32,
    p2: f32,
}

const CURE: &str = "give width, height, fx, fy, cx, cy in pixels and cam_to_world in mm";

pub(super) fn read(bytes: &[u8]) -> Result<DepthCamera, ReaderFault> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let d: Described = serde_json::from_slice(bytes)
        .map_err(|e| ReaderFault::new(FilePlace::Line(e.line()), format!("not a camera description: {e}"), CURE))?;
    let intrinsics = Intrinsics { width: d.width, height: d.height, fx: d.fx, fy: d.fy, cx: d.cx, cy: d.cy };
    let pose = d.cam_to_world.map(|m| {
        let column = |k: usize| Vec3A::new(m[0][k] as f32, m[1][k] as f32, m[2][k] as f32);
        let rotation = Mat3A::from_cols(column(0), column(1), column(2));
        Affine3A::from_mat3_translation(rotation.into(), Vec3::from(column(3)) * 1e-3)
    });
    if let Some(fault) = intrinsics.fault().or_else(|| pose.as_ref().and_then(pose_fault)) {
        return Err(ReaderFault::new(FilePlace::Whole, fault, CURE));
    }
    let mm_per_unit = d.mm_per_unit.unwrap_or(1.0);
    if !(1e-3..=1e3).contains(&mm_per_unit) {
        let problem = format!("mm_per_unit is {mm_per_unit}, which is no unit of a depth camera");
        return Err(ReaderFault::new(
            FilePlace::Whole,
            problem,
            "give the millimetres in one unit, such as 0.2 for 5000 to the metre",
        ));
    }
    let distortion = d.distortion.map(|b| BrownConrady {
        k: [b.k1, b.k2, b.k3, b.k4, b.k5, b.k6],
        p: [b.p1, b.p2],
        centre: [0.0; 2],
        widest: f32::INFINITY,
    });
    Ok(DepthCamera { intrinsics, distortion, pose, mm_per_unit, quarter_turns: d.quarter_turns % 4 })
}
