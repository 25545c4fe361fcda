//! A head followed through a sequence of one camera: in each frame its pose and the amplitudes of its expressions, by analysis and synthesis
//! on the marked points.
//!
//! The adapted head with its expressions is projected, and Gauss-Newton brings the projections to the marked points, from where the head
//! was in the last frame that showed it. A frame whose points are those of no head is left out, and the next starts as if it had not been.

use std::slice::from_ref;

use glam::{DMat3, DQuat, DVec3, EulerRot};
use toile_base::body::Sex;
use toile_base::numeric::linear;
use toile_base::numeric::linear::Pivot;
use toile_sensors::calibration::CalibratedCamera;
use toile_sensors::face_points::FACE_POINTS;

use super::adapt::{AdaptedHead, LARGEST_RESIDUAL};
use super::expressions::{EXPRESSIONS, ExpressionFields};
use super::head_mesh::HeadMesh;
use super::head_pose::{first_pose, moved};
use super::landmarks::FaceLandmarks;
use super::sighting::{HeadPose, Sighting, equations, marked_points};
use super::view::FaceView;

/// Steps of a frame.
const STEPS: usize = 15;

/// Standard deviation of an amplitude: most faces are at rest.
const AMPLITUDE: f64 = 0.5;

/// A point agrees with a head where it lies so near (m, at the head's distance); a head is found where this part of all points does, and
/// so many.
const AGREES: f64 = 0.008;
const AGREEING: f64 = 0.6;
pub(super) const FEWEST: usize = 8;

/// What was found in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackedFrame {
    /// Points that agree with the head.
    pub points: usize,
    /// Their root mean square distance from where they were marked, and of all points where no head is found (px); infinite without any.
    pub residual_px: f64,
    /// The head; none where the points are those of no head.
    pub found: Option<TrackedHead>,
}

/// A head in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackedHead {
    /// From the head's axes (x to the wearer's left, y up, z ahead) to the world's.
    pub turn: DQuat,
    /// The middle of the head (m, world).
    pub place: DVec3,
    /// Amplitudes of the expressions, 0 to 1, in the order of their names.
    pub amplitudes: [f64; EXPRESSIONS],
}

impl TrackedHead {
    /// How far the head is turned to the wearer's left, raised, and leant to the left shoulder (rad), counted from a head that faces
    /// against the camera's axis, upright.
    pub fn angles(&self, camera: &CalibratedCamera) -> [f64; 3] {
        let facing = DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
        let (yaw, pitch, roll) = (facing * camera.rotation() * DMat3::from_quat(self.turn)).to_euler(EulerRot::YXZ);
        [yaw, -pitch, -roll]
    }
}

/// Follows an adapted head through the frames of one camera.
pub fn track(head: &AdaptedHead, frames: &[FaceView]) -> Vec<TrackedFrame> {
    HeadTracker::new(head.sex, head.marks.clone()).run(head.pose, frames).into_iter().map(|(frame, _)| frame).collect()
}

/// Pose and amplitudes: what a frame starts from, and ends at.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrackedState {
    pub pose: HeadPose,
    pub amplitudes: [f64; EXPRESSIONS],
}

/// A head with its expressions.
pub(super) struct HeadTracker {
    /// The points on the mannequin's head, and on this one at rest (m, from its middle) `[68]`.
    pub drawn: Vec<DVec3>,
    pub marks: Vec<DVec3>,
    /// Their displacements (m) in each expression `[68]`.
    expressions: [[DVec3; EXPRESSIONS]; FACE_POINTS],
}

impl HeadTracker {
    /// Of a head of a sex whose points are here (m, from its middle) `[68]`.
    pub(super) fn new(sex: Sex, marks: Vec<DVec3>) -> Self {
        let (landmarks, mesh) = (FaceLandmarks::new(), HeadMesh::of(sex));
        let expressions = ExpressionFields::of(sex).of_points(&landmarks, &mesh);
        Self { drawn: landmarks.on(&mesh.positions), marks, expressions }
    }

    /// All frames in turn, from a pose; the last state that was found with each.
    pub(super) fn run(&self, pose: HeadPose, frames: &[FaceView]) -> Vec<(TrackedFrame, TrackedState)> {
        let mut last = TrackedState { pose, amplitudes: [0.0; EXPRESSIONS] };
        let one = |frame: &FaceView| {
            let (outcome, state) = self.frame(frame, last);
            last = state.unwrap_or(last);
            (outcome, last)
        };
        frames.iter().map(one).collect()
    }

    /// The head in a frame, from where it was last or, where that fails, from anywhere.
    fn frame(&self, frame: &FaceView, last: TrackedState) -> (TrackedFrame, Option<TrackedState>) {
        let marked = frame.points.iter().flatten().count();
        if marked < FEWEST {
            return (TrackedFrame { points: 0, residual_px: f64::INFINITY, found: None }, None);
        }
        let state = self.fitted(frame, last);
        let mut best = (self.judged(frame, state), state);
        if best.0.found.is_none()
            && let Some(state) = self.anew(frame, last.pose.size)
        {
            let state = self.fitted(frame, state);
            let judged = self.judged(frame, state);
            if judged.found.is_some() {
                best = (judged, state);
            }
        }
        (best.0, best.0.found.map(|_| best.1))
    }

    /// A start that knows nothing of the frames before; the head keeps its size.
    fn anew(&self, frame: &FaceView, size: f64) -> Option<TrackedState> {
        let pose = first_pose(from_ref(frame), &self.marks).ok()?;
        let from = frame.camera.position();
        let place = from + (pose.place - from) * (size / pose.size);
        Some(TrackedState { pose: HeadPose { place, size, ..pose }, amplitudes: [0.0; EXPRESSIONS] })
    }

    /// Pose and amplitudes in a frame, from some that are near.
    pub(super) fn fitted(&self, frame: &FaceView, from: TrackedState) -> TrackedState {
        (0..STEPS).fold(from, |state, _| self.step(frame, state))
    }

    /// The marked points, with their numbers, on the head with its expressions.
    pub(super) fn sightings(&self, frame: &FaceView, state: TrackedState) -> (Vec<usize>, Vec<Sighting>) {
        let shown: Vec<usize> = (0..FACE_POINTS).filter(|i| frame.points[*i].is_some()).collect();
        let mut all = marked_points(from_ref(frame), &self.drawn, &self.marks);
        for (s, i) in all.iter_mut().zip(&shown) {
            s.by = self.expressions[*i].iter().zip(state.amplitudes).map(|(by, a)| *by * a).sum();
        }
        (shown, all)
    }

    /// A Gauss-Newton step of pose and amplitudes, which stay within 0 and 1.
    fn step(&self, frame: &FaceView, state: TrackedState) -> TrackedState {
        const N: usize = 6 + EXPRESSIONS;
        let (shown, sightings) = self.sightings(frame, state);
        let (mut a, mut b) = ([[0.0; N]; N], [0.0; N]);
        for e in equations(from_ref(frame), &sightings, state.pose) {
            let turn = (e.world - state.pose.place).cross(e.along);
            let fields = self.expressions[shown[e.of]];
            let grown = fields.map(|by| e.along.dot(state.pose.turn * (by * state.pose.size)));
            let mut row = [0.0; N];
            row[..3].copy_from_slice(&e.along.to_array());
            row[3..6].copy_from_slice(&turn.to_array());
            row[6..].copy_from_slice(&grown);
            let weight = sightings[e.of].weight(e.length, true);
            for i in 0..N {
                (0..=i).for_each(|k| a[i][k] += weight * row[i] * row[k]);
                b[i] -= weight * row[i] * e.off;
            }
        }
        for (k, amplitude) in state.amplitudes.iter().enumerate() {
            a[6 + k][6 + k] += AMPLITUDE.powi(-2);
            b[6 + k] -= amplitude * AMPLITUDE.powi(-2);
        }
        (0..N).for_each(|i| a[i][i] *= 1.0 + 1e-6);
        let Some(x) = within(a, b, &state.amplitudes) else { return state };
        TrackedState {
            pose: moved(state.pose, std::array::from_fn(|i| x[i])),
            amplitudes: std::array::from_fn(|k| (state.amplitudes[k] + x[6 + k]).clamp(0.0, 1.0)),
        }
    }

    /// Whether the points are those of a head that stands so.
    fn judged(&self, frame: &FaceView, state: TrackedState) -> TrackedFrame {
        let (shown, sightings) = self.sightings(frame, state);
        let focal = frame.camera.focal().x;
        let depth = frame.camera.to_camera(state.pose.place).z;
        let limit = (AGREES / depth.max(AGREES)).min(1e-3 * LARGEST_RESIDUAL) * focal;
        // Each point has two equations.
        let off: Vec<f64> = equations(from_ref(frame), &sightings, state.pose).step_by(2).map(|e| e.length).collect();
        let near: Vec<f64> = off.iter().copied().filter(|o| *o <= limit).collect();
        let found = near.len() >= FEWEST && near.len() as f64 >= AGREEING * shown.len() as f64;
        let root = |of: &[f64]| (of.iter().map(|o| o * o).sum::<f64>() / of.len().max(1) as f64).sqrt();
        let TrackedState { pose: HeadPose { turn, place, .. }, amplitudes } = state;
        TrackedFrame {
            points: if found { near.len() } else { 0 },
            residual_px: if off.is_empty() { f64::INFINITY } else { root(if found { &near } else { &off }) },
            found: found.then_some(TrackedHead { turn, place, amplitudes }),
        }
    }
}

/// Solves for a step that keeps amplitudes within 0 and 1: those that would leave are held at their end, and the others solved anew.
fn within<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N], amplitudes: &[f64; EXPRESSIONS]) -> Option<[f64; N]> {
    /// Weight that holds an amplitude, of its own.
    const HELD: f64 = 1e9;
    let mut held = [false; EXPRESSIONS];
    loop {
        let (mut l, mut x) = (a, b);
        linear::factor(&mut l, Pivot::AtLeast(1e-9))?;
        linear::solve(&l, &mut x);
        let leaves = (0..EXPRESSIONS).find(|k| !held[*k] && !(0.0..=1.0).contains(&(amplitudes[*k] + x[6 + *k])));
        let Some(k) = leaves else { return Some(x) };
        let end = (amplitudes[k] + x[6 + k]).clamp(0.0, 1.0) - amplitudes[k];
        let weight = HELD * a[6 + k][6 + k];
        (a[6 + k][6 + k], b[6 + k], held[k]) = (a[6 + k][6 + k] + weight, b[6 + k] + weight * end, true);
    }
}
