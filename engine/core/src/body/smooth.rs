//! Asymptotic smoothing of angles: each step turns a fraction of what is left (Gultepe 2013, section 4.4.2, eq. 4.6).
//!
//! The published fraction is a constant a frame; here it is `1 - exp(-dt / tau)`, so that the time constant is the
//! same at any frame rate. A limit on the speed keeps one bad frame from showing as a jump.

use glam::{Quat, Vec3};

/// Time constant of joint angles (s): a sensor's steps at 30 Hz melt into a curve, and the lag stays under two of them.
pub const ANGLE_TAU: f32 = 0.04;

/// Fastest turn of a limb at its joint (rad/s): a fast dancer's; pitchers are faster, shoppers are not.
pub const LIMB_SPEED: f32 = 15.0;

/// Fastest turn of a joint of the trunk, and of the whole person (rad/s).
pub const TRUNK_SPEED: f32 = 8.0;

/// Share of the way to go in one step of `dt` with time constant `tau` (both s): 0 for no time, towards 1.
pub fn fraction(dt: f32, tau: f32) -> f32 {
    if dt > 0.0 { 1.0 - (-dt / tau).exp() } else { 0.0 }
}

/// Turns `from` towards `to` by the asymptotic fraction, at most `speed * dt` (rad); the short way round.
pub fn turn_towards(from: Quat, to: Quat, dt: f32, tau: f32, speed: f32) -> Quat {
    let delta = to * from.inverse();
    let delta = if delta.w < 0.0 { -delta } else { delta };
    let left = rotation_vector(delta);
    let angle = left.length();
    let step = (angle * fraction(dt, tau)).min(speed * dt.max(0.0));
    if angle < 1e-7 {
        return from;
    }
    (Quat::from_axis_angle(left / angle, step) * from).normalize()
}

/// Axis times angle (rad) of a rotation, exact near none: `acos` of a cosine near 1 would lose half the digits.
pub fn rotation_vector(turn: Quat) -> Vec3 {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let sine = turn.xyz().length();
    if sine < 1e-12 { Vec3::ZERO } else { turn.xyz() * (2.0 * sine.atan2(turn.w) / sine) }
}

/// An angle (rad) brought within half a turn of 0.
pub fn wrap(angle: f32) -> f32 {
    let turns = (angle / std::f32::consts::TAU).round();
    angle - turns * std::f32::consts::TAU
}

/// 0 below the first value, 1 above the second, smooth between.
pub fn ramp([low, high]: [f32; 2], value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
