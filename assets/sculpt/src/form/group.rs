//! Parts that blend into one another, and the frame they stand in.

use glam::{Mat3, Vec3};
use serde::Deserialize;

use super::parts::{BallChain, Bump, Ellipsoid, Tube, TubeRow, smooth_max, smooth_min};

/// A group of parts in one frame; lengths in millimetres.
#[derive(Debug, Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(crate) struct GroupRow {
    #[serde(default)]
    tube: Vec<TubeRow>,
    #[serde(default)]
    chain: Vec<BallChain>,
    #[serde(default)]
    ball: Vec<Ellipsoid>,
    #[serde(default)]
    bump: Vec<Bump>,
    /// Digits: they join the group, but not one another.
    #[serde(default)]
    pub(crate) digit: Vec<BallChain>,
}

/// Parts that blend into one another.
#[derive(Debug)]
pub(crate) struct Group {
    tubes: Vec<Tube>,
    chains: Vec<BallChain>,
    balls: Vec<Ellipsoid>,
    bumps: Vec<Bump>,
    digits: Vec<BallChain>,
}

/// Each part followed by its mirror image, if it has one.
fn with_mirrors<T: Clone>(parts: &[T], mirror: impl Fn(&T) -> Option<T>) -> Vec<T> {
    parts.iter().flat_map(|p| std::iter::once(p.clone()).chain(mirror(p))).collect()
}

impl Group {
    /// `paired`: parts beside the middle have their mirror on the other side.
    pub(crate) fn new(row: &GroupRow, paired: bool) -> Self {
        Self {
            tubes: row.tube.iter().map(Tube::new).collect(),
            chains: with_mirrors(&row.chain, |c| c.mirrored().filter(|_| paired)),
            balls: with_mirrors(&row.ball, |b| b.mirrored().filter(|_| paired))
                .into_iter()
                .map(Ellipsoid::turned)
                .collect(),
            bumps: with_mirrors(&row.bump, |b| b.mirrored().filter(|_| paired)).into_iter().map(Bump::turned).collect(),
            digits: row.digit.clone(),
        }
    }

    /// Distance to the group's surface.
    pub(crate) fn distance(&self, p: Vec3) -> f32 {
        let mut d = f32::MAX;
        for tube in &self.tubes {
            d = smooth_min(d, tube.distance(p), tube.blend);
        }
        for chain in &self.chains {
            d = smooth_min(d, chain.distance(p), chain.blend);
        }
        for ball in &self.balls {
            let b = ball.distance(p);
            d = if ball.carve { smooth_max(d, -b, ball.blend) } else { smooth_min(d, b, ball.blend) };
        }
        let digits = self.digits.iter().map(|c| (c.distance(p), c.blend));
        if let Some((nearest, blend)) = digits.min_by(|a, b| a.0.total_cmp(&b.0)) {
            d = smooth_min(d, nearest, blend);
        }
        if d.abs() < 60.0 {
            d -= self.bumps.iter().map(|b| b.swelling(p)).sum::<f32>();
        }
        d
    }

    /// Balls of a digit.
    pub(crate) fn digit(&self, k: usize) -> Vec<(Vec3, f32)> {
        self.digits[k].balls.iter().map(|b| (Vec3::new(b[0], b[1], b[2]), b[3])).collect()
    }
}

/// A frame of its own: where its origin stands and where its axes point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    pub origin: Vec3,
    pub axes: Mat3,
}

impl Frame {
    pub(crate) fn inward(&self, p: Vec3) -> Vec3 {
        self.axes.transpose() * (p - self.origin)
    }

    pub(crate) fn out(&self, p: Vec3) -> Vec3 {
        self.origin + self.axes * p
    }
}
