//! One hand in a depth frame: segmented around its joint, and its outline compared with the convex hull.
//!
//! After Gultepe 2013, appendix C: region of interest by the body's own size, two dilations and one erosion, contour,
//! convex hull, and the gaps between contour and hull show an open hand. Changed: the region is sized by the arm, not
//! by head and neck, which every tracker puts elsewhere; the grid's cells are a fixed part of the hand, so that distance
//! and resolution do not matter; the forearm is cut off at the wrist; and the hull's own area counts besides, for
//! fingers held together leave no gaps.

use glam::{Affine3A, Vec3};
use toile_base::frame::{DepthFrame, Joints};

use super::hull::{MARGIN, Mask, SIDE};
use super::trunk::Side;

/// Length of a hand, wrist to finger tip, over that of the arm, shoulder to wrist: .1118 of stature over .3315 (means
/// of ANSUR II women and men: hand length, acromion-radiale plus radiale-stylion).
const HAND_TO_ARM: f32 = 0.335;

/// Cells of the grid along a hand: 6 mm each, the pitch of a Kinect's pixels at 3.5 m.
const CELLS_PER_HAND: f32 = 32.0;

/// What belongs to the hand is within this of the palm's middle (hand lengths): finger tips are at 0.6, and the joint
/// may be 40 mm off.
const REACH: f32 = 0.95;

/// Neighbours on one hand differ in depth by less than this (m) and the steps of the sensor, which grow with the square of
/// the distance.
const SAME_HAND: f32 = 0.025;
const SAME_HAND_PER_M2: f32 = 0.004;

/// A patch smaller than this (squared hand lengths) is not a hand but what is left of one.
const SMALLEST: f32 = 0.06;

/// Times that the outline is grown and then shrunk (Gultepe 2013).
const GROWN: usize = 2;
const SHRUNK: usize = 1;

/// Region of interest of a hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandRegion {
    /// Middle of the palm, world (m).
    pub palm: Vec3,
    /// Wrist, world (m): the forearm is cut off there; `None` where it is not known.
    pub wrist: Option<Vec3>,
    /// Direction of the forearm towards the hand, of length 1; zero where it is not known.
    pub along: Vec3,
    /// Length of the hand (m).
    pub length: f32,
}

impl HandRegion {
    /// Where a frame of joints has a hand of a shopper whose arms are `arm` long (m); `None` where neither hand nor wrist
    /// is believed.
    pub fn of(joints: &Joints, side: Side, arm: f32) -> Option<Self> {
        let [_, elbow, wrist, hand] = side.arm().map(|j| joints.believed(j));
        let length = HAND_TO_ARM * arm;
        let along = elbow.zip(wrist.or(hand)).and_then(|(a, b)| (b - a).try_normalize()).unwrap_or(Vec3::ZERO);
        let palm = hand.or_else(|| wrist.map(|w| w + 0.45 * length * along))?;
        Some(Self { palm, wrist, along, length })
    }
}

/// The outline of one hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandShape {
    /// Area of the hull (squared hand lengths): large with fingers stretched.
    pub spread: f32,
    /// How deep the outline lies under its hull at most (hand lengths): the measure of Gultepe 2013.
    pub gap: f32,
    /// Length over breadth: nearly 1 for a fist, about 2 for fingers stretched together.
    pub aspect: f32,
}

/// Cuts hands out of depth frames; owns its buffers and allocates only when it is made.
#[derive(Debug, Clone)]
pub struct HandSegmenter {
    /// Depth of each cell (m), 0 where there is no hand.
    depth: Box<[f32]>,
    mask: Mask,
}

impl Default for HandSegmenter {
    fn default() -> Self {
        Self::new()
    }
}

/// How the grid lies over the image.
struct HandGrid {
    /// Pixels along a cell.
    step: usize,
    /// Pixel of the grid's first cell, which may lie outside of the image.
    corner: [isize; 2],
    /// Side of a cell at the palm (m).
    pitch: f32,
    to_camera: Affine3A,
}

impl HandGrid {
    fn new(frame: &DepthFrame, region: &HandRegion) -> Option<Self> {
        let to_camera = frame.camera_to_world.inverse();
        let palm = to_camera.transform_point3(region.palm);
        let (u, v) = frame.intrinsics.project(palm)?;
        let pixel = palm.z / (frame.intrinsics.fx * frame.intrinsics.fy).sqrt();
        let step = (region.length / CELLS_PER_HAND / pixel).round().max(1.0);
        let half = step * (SIDE / 2) as f32;
        // Far outside of the image there is no hand to be seen, and no number to be trusted.
        let limit = 1e6;
        if !(u.abs() < limit && v.abs() < limit && step < 1e3) {
            return None;
        }
        Some(Self {
            step: step as usize,
            corner: [(u - half).round() as isize, (v - half).round() as isize],
            pitch: step * pixel,
            to_camera,
        })
    }

    /// The nearest pixel of a cell: column, row and depth (mm).
    fn nearest(&self, frame: &DepthFrame, cell: usize) -> Option<[u32; 3]> {
        let (w, h) = (frame.intrinsics.width as usize, frame.intrinsics.height as usize);
        let begin = [cell % SIDE, cell / SIDE].map(|c| (c * self.step) as isize);
        let mut best: Option<[u32; 3]> = None;
        for dv in 0..self.step as isize {
            for du in 0..self.step as isize {
                let (u, v) = (self.corner[0] + begin[0] + du, self.corner[1] + begin[1] + dv);
                if u < 0 || v < 0 || u as usize >= w || v as usize >= h {
                    continue;
                }
                let mm = u32::from(frame.depth_mm[v as usize * w + u as usize]);
                if mm != 0 && best.is_none_or(|b| mm < b[2]) {
                    best = Some([u as u32, v as u32, mm]);
                }
            }
        }
        best
    }
}

impl HandSegmenter {
    /// Buffers for one hand at a time.
    pub fn new() -> Self {
        Self { depth: vec![0.0; SIDE * SIDE].into_boxed_slice(), mask: Mask::new() }
    }

    /// The outline of a hand; `None` where the frame shows none there.
    pub fn shape(&mut self, frame: &DepthFrame, region: &HandRegion) -> Option<HandShape> {
        let grid = HandGrid::new(frame, region)?;
        let seed = self.cut_out(frame, region, &grid)?;
        let z = self.depth[seed];
        let step = SAME_HAND + SAME_HAND_PER_M2 * z * z;
        let depth = &self.depth;
        self.mask.flood(seed, |a, b| depth[b] > 0.0 && (depth[a] - depth[b]).abs() < step);
        for grows in [true; GROWN].into_iter().chain([false; SHRUNK]) {
            self.mask.grow(grows);
        }
        self.mask.fill_holes();
        let outline = self.mask.outline()?;
        let cell = grid.pitch / region.length;
        (outline.area * cell * cell >= SMALLEST).then_some(HandShape {
            spread: outline.hull * cell * cell,
            gap: outline.gap * cell,
            aspect: outline.aspect,
        })
    }

    /// Fills the grid with what lies about the palm and beyond the wrist; gives the cell nearest to the palm.
    fn cut_out(&mut self, frame: &DepthFrame, region: &HandRegion, grid: &HandGrid) -> Option<usize> {
        let palm = grid.to_camera.transform_point3(region.palm);
        let wrist = region.wrist.map(|w| grid.to_camera.transform_point3(w));
        let along = grid.to_camera.transform_vector3(region.along);
        let reach = (REACH * region.length).powi(2);
        let mut nearest: Option<(usize, f32)> = None;
        self.depth.fill(0.0);
        let inside = MARGIN..SIDE - MARGIN;
        for cell in inside.clone().flat_map(|row| inside.clone().map(move |column| row * SIDE + column)) {
            let Some([u, v, mm]) = grid.nearest(frame, cell) else { continue };
            let z = mm as f32 * 1e-3;
            let p = frame.intrinsics.unproject(u as f32, v as f32, z);
            let distance = p.distance_squared(palm);
            if distance > reach || wrist.is_some_and(|w| (p - w).dot(along) < 0.0) {
                continue;
            }
            self.depth[cell] = z;
            if nearest.is_none_or(|(_, d)| distance < d) {
                nearest = Some((cell, distance));
            }
        }
        nearest.map(|(cell, _)| cell)
    }
}

/// Aspect, spread and gap of a fist, and by how much they differ from hand to hand: means over distances and deviations of
/// simulated hands (docs/gestures.md, "What is missed, and what is false").
const FIST: [f32; 3] = [1.41, 0.325, 0.05];
const SCATTER: [f32; 3] = [0.17, 0.06, 0.03];

/// The sum of the three deviations from a fist below which a hand is surely closed, and above which surely open: fists have
/// 0 +- 2, fingers stretched together 7, spread 10.
const CLOSED_OPEN: [f32; 2] = [1.5, 6.5];

impl HandShape {
    /// How open the hand is, 0 to 1: the sum of how much longer, wider and more gapped than a fist it is, each in its own
    /// scatter. Fingers stretched together show by the aspect, spread ones by the other two.
    pub fn openness(&self) -> f32 {
        let seen = [self.aspect, self.spread, self.gap];
        let sum: f32 = (0..3).map(|i| (seen[i] - FIST[i]) / SCATTER[i]).sum();
        ((sum - CLOSED_OPEN[0]) / (CLOSED_OPEN[1] - CLOSED_OPEN[0])).clamp(0.0, 1.0)
    }
}
