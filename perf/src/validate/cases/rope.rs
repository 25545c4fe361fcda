//! The rope around a post: a strip over half a turn with a load at each end.

use std::f64::consts::PI;

use glam::DVec3;
use toile_bake::Shape;

use crate::validate::mesh::{EndSupport, Strip};

/// Radius at which the rope lies around the post (m).
pub const POST: f64 = 0.1;

/// Length of each hanging end (m).
const HANGING: f64 = 0.1;

/// Links of the rope.
pub const ROPE_ROWS: usize = 64;

/// Pulls of the lighter end over the weight of the whole rope, whose own weight on the post is part of the exact value. The
/// second is hard: whatever hangs on light cloth by far heavier things takes solvers long to hold.
pub const ROPE_LOADS: [f64; 2] = [4.0, 20.0];

/// How long the rope is watched (s), and how far it must run to have slipped (m): far more than the ends give while they
/// begin to pull.
pub const ROPE_WATCH: (f64, f64) = (1.5, 0.02);

/// Length of the rope (m).
pub fn rope_length() -> f64 {
    PI * POST + 2.0 * HANGING
}

/// A place on a cylinder about the z axis: at an angle from its left side over its top (rad), so far across (m).
pub fn around(radius: f64, angle: f64, across: f64) -> DVec3 {
    DVec3::new(-radius * angle.cos(), radius * angle.sin(), across)
}

/// The rope as a shape.
pub struct LoadedRope {
    /// Two particles wide; its front faces away from the post.
    pub shape: Shape,
    /// Vertices of its left end and of its right end.
    pub ends: [Vec<usize>; 2],
}

impl LoadedRope {
    /// With so many times its own weight pulling at either end.
    pub fn new(pulls: [f64; 2]) -> Self {
        let turn = PI * POST;
        let strip = Strip::narrow(rope_length(), ROPE_ROWS, [EndSupport::Free, EndSupport::Free]);
        let mut shape = strip.shape(|along, across| {
            let s = along - HANGING;
            let beyond = s - s.clamp(0.0, turn);
            around(POST, s.clamp(0.0, turn) / POST, -across) - DVec3::Y * beyond.abs()
        });
        let ends = [0.0, strip.length].map(|end| {
            (0..shape.cut.len()).filter(|v| (f64::from(-shape.cut[*v].y) - end).abs() < 1e-4).collect::<Vec<_>>()
        });
        // What hangs below the post pulls too.
        let hanging = (HANGING - 0.5 * strip.link()) / strip.length;
        let half = 0.5 / ROPE_ROWS as f64;
        shape.heavier = vec![1.0; shape.cut.len()];
        for (end, pull) in ends.iter().zip(pulls) {
            end.iter().for_each(|&v| shape.heavier[v] = ((pull - hanging) / half) as f32);
        }
        Self { shape, ends }
    }
}
