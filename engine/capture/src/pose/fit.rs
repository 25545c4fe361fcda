//! The fit of the skeleton: keypoints pull their rays, bones keep their lengths, and unseen parts move on as they moved.
//!
//! Unknowns are the keypoints X of a frame. With the pixel `p` of a keypoint in a camera, its score s and the distance in pixels
//! `r = project(X) - p`, the energy `sum s^2 rho(r) + sum (|X_a - X_b| - L)^2 / l^2 + sum |X - X0|^2 / m^2` is made least by Gauss
//! and Newton; rho is that of Geman and McClure, so that a keypoint of another person or of the other leg counts little. At last each
//! bone is set to its length exactly, from the neck outwards. The first frame starts from the points that the rays meet in.

use glam::{DMat3, DVec2, DVec3};
use serde::Serialize;
use toile_sensors::calibration::CalibratedCamera;
use toile_sensors::source::openpose::{KeypointFrame, KeypointRecording, POINTS};

use super::bones::{BONES, BRACES, Bone, ROOT, TREE, length};
use crate::error::CaptureError;
use crate::sparse::BlockSystem;

/// Robust distance of a keypoint, and its standard deviation at a score of 1 (px). From 40 to 80 px joints come out within 1 mm of
/// the same; at 20 hips that cameras disagree on are left out.
const ROBUST: f64 = 40.0;
const SPREAD: f64 = 4.0;

/// Standard deviation of a bone's length while it is fitted, and of a brace's (m).
const BONE: f64 = 2e-3;
const BRACE: f64 = 15e-3;

/// Standard deviation of a keypoint about where its motion carries it, and of one in the first frame (m).
const MOTION: f64 = 0.03;
const START: f64 = 1.0;

/// Iterations a frame.
const ROUNDS: usize = 12;

/// Frames without a person over which the pose is carried.
const CARRIED: usize = 12;

/// The pose of every frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PoseMotion {
    /// Length of each bone (m).
    pub lengths: Vec<f64>,
    /// Ends of each bone, as keypoints of BODY_25B.
    pub bones: Vec<[usize; 2]>,
    /// Keypoints of each frame (m, the cameras' world); none where no person was seen.
    #[serde(skip)]
    pub frames: Vec<Option<[DVec3; POINTS]>>,
    /// Frames a second.
    pub rate: f64,
    /// Mean distance of the keypoints from where the skeleton is seen (px).
    pub residual_px: f64,
}

/// Fits the skeleton to a recording.
///
/// # Errors
/// One sentence where keypoints are not those of BODY_25B, or a bone is never seen whole.
pub fn fit(recording: &KeypointRecording) -> Result<PoseMotion, CaptureError> {
    let cure = "record again with the person in full view of two cameras";
    if !recording.is_25b {
        let problem = "they are those of BODY_25, and a pose is fitted to BODY_25B";
        return Err(CaptureError::unfit("the keypoints", problem, "run OpenPose with --model_pose BODY_25B"));
    }
    let of = |bone: &Bone| {
        length(recording, *bone).ok_or_else(|| {
            let problem = format!("the bone from keypoint {} to {} is seen whole in no frame", bone.from, bone.to);
            CaptureError::unfit("the keypoints", problem, cure)
        })
    };
    let lengths: Vec<f64> = TREE.iter().map(of).collect::<Result<_, _>>()?;
    let braces: Vec<Option<f64>> = BRACES.iter().map(|b| length(recording, *b)).collect();
    let mut fit = SkeletonFit::new(&recording.rig.cameras, lengths, braces);
    let frames: Vec<_> = recording.frames.iter().map(|f| fit.push(f.as_ref())).collect();
    Ok(PoseMotion {
        lengths: fit.lengths,
        bones: TREE.iter().map(|b| [b.from, b.to]).collect(),
        frames,
        rate: recording.rate,
        residual_px: fit.off / fit.counted.max(1) as f64,
    })
}

struct SkeletonFit<'a> {
    cameras: &'a [CalibratedCamera],
    lengths: Vec<f64>,
    braces: Vec<Option<f64>>,
    system: BlockSystem,
    last: Option<[DVec3; POINTS]>,
    before: Option<[DVec3; POINTS]>,
    missing: usize,
    off: f64,
    counted: usize,
}

impl<'a> SkeletonFit<'a> {
    fn new(cameras: &'a [CalibratedCamera], lengths: Vec<f64>, braces: Vec<Option<f64>>) -> Self {
        let pairs: Vec<[u32; 2]> = TREE.iter().chain(&BRACES).map(|b| [b.from as u32, b.to as u32]).collect();
        let system = BlockSystem::new(POINTS, pairs.iter().map(|p| &p[..]));
        Self { cameras, lengths, braces, system, last: None, before: None, missing: 0, off: 0.0, counted: 0 }
    }

    fn push(&mut self, frame: Option<&KeypointFrame>) -> Option<[DVec3; POINTS]> {
        let Some(frame) = frame else {
            self.missing += 1;
            if self.missing > CARRIED {
                (self.last, self.before) = (None, None);
            }
            return None;
        };
        self.missing = 0;
        let (mut x, spread) = match (self.last, self.before) {
            (Some(last), Some(before)) => (std::array::from_fn(|k| last[k] + 0.7 * (last[k] - before[k])), MOTION),
            (Some(last), None) => (last, MOTION),
            _ => (start(frame)?, START),
        };
        let carried = x;
        for _ in 0..ROUNDS {
            self.sum(frame, &x, &carried, spread);
            let mut step = Vec::new();
            self.system.solve(&mut step, 1e-6, 200);
            x.iter_mut().zip(&step).for_each(|(x, s)| *x += s.clamp_length_max(0.2));
        }
        self.set_lengths(&mut x);
        for (camera, view) in self.cameras.iter().zip(&frame.views) {
            for (k, seen) in
                view.iter().flat_map(|v| v.iter().enumerate()).filter(|(k, s)| s.score > 0.0 && in_tree(*k))
            {
                if let Some(pixel) = camera.pixel(x[k]) {
                    self.off += pixel.distance(seen.pixel);
                    self.counted += 1;
                }
            }
        }
        (self.before, self.last) = (self.last, Some(x));
        Some(x)
    }

    /// Sums the normal equations at `x`.
    fn sum(&mut self, frame: &KeypointFrame, x: &[DVec3; POINTS], carried: &[DVec3; POINTS], spread: f64) {
        self.system.clear();
        for (camera, view) in self.cameras.iter().zip(&frame.views) {
            for (k, seen) in view.iter().flat_map(|v| v.iter().enumerate()).filter(|(_, s)| s.score > 0.0) {
                self.pull(camera, k, x[k], seen.pixel, f64::from(seen.score));
            }
        }
        let bones = TREE.iter().zip(&self.lengths).map(|(b, l)| (*b, *l, BONE));
        let braces = BRACES.iter().zip(&self.braces).filter_map(|(b, l)| Some((*b, (*l)?, BRACE)));
        for (bone, length, spread) in bones.chain(braces).collect::<Vec<_>>() {
            self.hold(bone, x, length, spread.powi(-2));
        }
        let heavy = spread.powi(-2);
        for k in 0..POINTS {
            let at = self.system.place(k as u32, k as u32);
            self.system.blocks[at] += DMat3::from_diagonal(DVec3::splat(heavy));
            self.system.right[k] += (carried[k] - x[k]) * heavy;
        }
    }

    fn pull(&mut self, camera: &CalibratedCamera, k: usize, x: DVec3, pixel: DVec2, score: f64) {
        let p = camera.to_camera(x);
        if p.z < 0.1 {
            return;
        }
        // The lens is undone on the keypoint, so that the derivative is that of a pinhole.
        let (flat, focal) = (camera.ray(pixel), camera.focal());
        let off = (p.truncate() / p.z - flat) * focal;
        let part = ROBUST * ROBUST / (ROBUST * ROBUST + off.length_squared());
        let weight = (score / SPREAD).powi(2) * part * part;
        let rows = camera.rotation().transpose();
        let at = self.system.place(k as u32, k as u32);
        for (r, axis, f, along) in [(off.x, DVec3::X, focal.x, p.x), (off.y, DVec3::Y, focal.y, p.y)] {
            let j = rows * ((axis * p.z - DVec3::Z * along) * (f / (p.z * p.z)));
            self.system.blocks[at] += DMat3::from_cols(j * j.x, j * j.y, j * j.z) * weight;
            self.system.right[k] -= j * (r * weight);
        }
    }

    fn hold(&mut self, bone: Bone, x: &[DVec3; POINTS], length: f64, stiff: f64) {
        let along = x[bone.to] - x[bone.from];
        let now = along.length().max(1e-6);
        let n = along / now;
        let block = DMat3::from_cols(n * n.x, n * n.y, n * n.z) * stiff;
        let (a, b) = (bone.from as u32, bone.to as u32);
        for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            let at = self.system.place(i, j);
            self.system.blocks[at] += block * sign;
        }
        let pull = n * ((now - length) * stiff);
        self.system.right[bone.from] += pull;
        self.system.right[bone.to] -= pull;
    }

    /// Each bone gets its length, from the neck outwards; what hangs from it moves along.
    fn set_lengths(&self, x: &mut [DVec3; POINTS]) {
        let found = *x;
        for (bone, length) in TREE.iter().zip(&self.lengths) {
            let along = (found[bone.to] - found[bone.from]).normalize_or(DVec3::NEG_Y);
            x[bone.to] = x[bone.from] + along * *length;
        }
    }
}

fn in_tree(keypoint: usize) -> bool {
    keypoint == ROOT || TREE.iter().any(|b| b.to == keypoint)
}

/// Where a first frame starts: the points that rays meet in, and for others their neighbour along the tree.
fn start(frame: &KeypointFrame) -> Option<[DVec3; POINTS]> {
    let seen = |k: usize| Some(frame.points[k]).filter(|p| p.confidence > 0.0).map(|p| p.position);
    let any = (0..POINTS).filter_map(seen).collect::<Vec<_>>();
    if any.len() < BONES / 3 {
        return None;
    }
    let middle = any.iter().sum::<DVec3>() / any.len() as f64;
    let mut x: [DVec3; POINTS] = std::array::from_fn(|k| seen(k).unwrap_or(middle));
    for bone in TREE {
        if seen(bone.to).is_none() {
            x[bone.to] = x[bone.from] + DVec3::new(1e-3, 1e-3, 1e-3);
        }
    }
    Some(x)
}
