//! Boxes around points.

use glam::DVec3;

/// A box along the axes (m), its surface included.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub low: DVec3,
    pub high: DVec3,
}

impl Bounds {
    /// What holds nothing.
    pub const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// Around points, of which none is NaN.
    pub fn of(points: &[DVec3]) -> Self {
        points.iter().fold(Self::EMPTY, |all, p| Self { low: all.low.min(*p), high: all.high.max(*p) })
    }

    /// Around both.
    pub fn union(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Whether they have a point in common.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }
}
