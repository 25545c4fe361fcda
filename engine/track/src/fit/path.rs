//! Path of the measured person through the frames.

use std::f32::consts::TAU;

use glam::Vec3;

use super::posed_body::FitState;

/// One frame of the measured person.
#[derive(Debug, Clone, Copy)]
pub(super) struct PathState {
    /// Number of the frame, from 0.
    pub frame: usize,
    /// What was fitted.
    pub state: FitState,
    /// Angle from the direction to the camera to the front of the body, about the vertical (rad).
    pub facing: f32,
}

/// Angle from the direction to the camera to the front of a body, about the vertical (rad).
pub(super) fn facing(state: &FitState, camera: Vec3) -> f32 {
    let (front, to) = (state.local[0] * Vec3::Z, camera - state.root);
    (front.x.atan2(front.z) - to.x.atan2(to.z)).rem_euclid(TAU)
}
