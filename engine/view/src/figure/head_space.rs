//! The space that heads are shaped in: millimetres of a head 222 mm high, from its crown, above the head's joint, facing +z.

use glam::Vec3;
use toile_base::body::{Body, Region};
use toile_base::skeleton::Joint;

/// Height of the head that shapes are drawn for, crown to chin (mm).
pub const HEIGHT_MM: f32 = 222.3;

/// Place and size of a body's head.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadSpace {
    /// On the height of the crown, above the joint (m).
    origin: Vec3,
    /// Metres a millimetre of it.
    unit: f32,
}

impl HeadSpace {
    /// Of a body at rest; none without a head.
    pub fn of(body: &Body) -> Option<Self> {
        Self::around(&body.mesh.positions, &body.regions, body.skeleton.at(Joint::Head))
    }

    /// Of vertices at rest (m) with their parts of the body and the head's joint (m); none without a head.
    pub fn around(positions: &[Vec3], regions: &[Region], joint: Vec3) -> Option<Self> {
        let head = positions.iter().zip(regions).filter(|(_, r)| **r == Region::Head);
        let heights = head.map(|(p, _)| p.y);
        let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), y| (low.min(y), high.max(y)));
        (high > low).then(|| Self { origin: Vec3::new(0.0, high, joint.z), unit: (high - low) / HEIGHT_MM })
    }

    /// A point of the body (m) in this space (mm).
    pub fn inwards(&self, p: Vec3) -> Vec3 {
        (p - self.origin) / self.unit
    }

    /// A point of this space (mm) on the body (m).
    pub fn outwards(&self, p: Vec3) -> Vec3 {
        self.origin + p * self.unit
    }
}
