//! From coordinates around the body to places in space: where cloth lies before it is sewn.

use std::f32::consts::TAU;

use glam::{DVec2, Vec3};

use super::arrange::Arrangement;
use super::limits::CLEARANCE_M;
use super::outlines::breadth;
use super::panels::{Around, faces};
use super::rows::{BLEND_M, RowRing, Rows};
use crate::tailor::SewnMesh;
use toile_base::body::{Body, Region};
use toile_base::skeleton::Joint;

/// Height under the armpits in which cloth passes from around the trunk to flat before and behind it (m).
const FLATTEN_M: f32 = 0.06;

/// Radius of an arm with the cloth's clearance (m), where the sleeve is not wider.
const ARM_M: f32 = 0.055;

/// Cloth of a leg stays at least this far on its side of the middle (m).
pub const MIDDLE_M: f32 = 0.004;

/// Places points of panels around a body.
pub struct Placer<'a> {
    sewn: &'a SewnMesh,
    arranged: &'a Arrangement,
    rows: Rows,
    body: &'a Body,
    /// Half of the head's breadth with clearance, and how far its middle lies before the body's (m).
    head: [f32; 2],
}

impl<'a> Placer<'a> {
    /// Of an arrangement; `sewn` is the mesh that it was made from.
    pub fn new(sewn: &'a SewnMesh, arranged: &'a Arrangement, body: &'a Body) -> Self {
        let positions = body.mesh.positions.iter().zip(&body.regions);
        let head: Vec<Vec3> = positions.filter(|(_, r)| **r == Region::Head).map(|(p, _)| *p).collect();
        let broad = head.iter().map(|p| p.x.abs()).fold(0.0, f32::max) + 2.0 * CLEARANCE_M;
        let middle = head.iter().map(|p| p.z).sum::<f32>() / head.len().max(1) as f32;
        Self { sewn, arranged, rows: Rows::new(sewn, arranged, body), body, head: [broad, middle] }
    }

    /// Where a point of a panel's drawing starts (m).
    pub fn place(&self, panel: usize, point: DVec2) -> Vec3 {
        let own = &self.arranged.panels[panel];
        let at = own.at(point);
        match own.around {
            Around::Trunk => self.around_trunk(panel, at),
            Around::Head => {
                let tangent = own.tangent().as_vec3();
                let out = Vec3::new(own.angle.sin() as f32, 0.0, own.angle.cos() as f32);
                let level = Vec3::Y * (at.y + self.arranged.lift) as f32;
                out * self.head[0] + tangent * at.x as f32 + level + Vec3::Z * self.head[1]
            }
            Around::LeftArm => self.around_arm(panel, at),
            Around::RightArm => self.around_arm(panel, at) * Vec3::new(-1.0, 1.0, 1.0),
        }
    }

    fn around_trunk(&self, panel: usize, at: DVec2) -> Vec3 {
        let own = &self.arranged.panels[panel];
        let (above, below, part) = self.rows.beside(at.y);
        let turn = own.angle as f32 / TAU;
        let on = |ring: &RowRing, around: f32| ring.at(turn * ring.length + around);
        let wrapped = on(&above.trunk, at.x as f32).lerp(on(&below.trunk, at.x as f32), part);
        if let (Some(legs), Some(first), Some(second)) = (&self.arranged.legs, &above.leg, &below.leg)
            && let Some(left) = legs.left[panel]
        {
            let share = smooth(((legs.crotch + BLEND_M - at.y) / BLEND_M) as f32);
            let middle = breadth(self.sewn, &self.arranged.panels, panel, at.y).map_or(at.x, |[l, h]| 0.5 * (l + h));
            // The ring of the right leg is the left one's mirror image, and so are its coordinates.
            let side = if left { 1.0 } else { -1.0 };
            let around = (at.x - middle) as f32 * side;
            let mut leg = on(first, around).lerp(on(second, around), part);
            leg.x = leg.x.max(MIDDLE_M) * side;
            return wrapped.lerp(leg, share);
        }
        let share = smooth((wrapped.y - (self.rows.armpit - FLATTEN_M)) / FLATTEN_M);
        let Some(front) = faces(own.angle).filter(|_| self.arranged.shoulders && share > 0.0) else { return wrapped };
        let plane = self.rows.planes[usize::from(!front)];
        wrapped.lerp(own.tangent().as_vec3() * at.x as f32 + Vec3::new(0.0, wrapped.y, plane), share)
    }

    /// Around the left arm, along the bones from its shoulder.
    fn around_arm(&self, panel: usize, at: DVec2) -> Vec3 {
        let joints = [Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftWrist].map(|j| self.body.skeleton.at(j));
        let upper = joints[1] - joints[0];
        let down = -at.y as f32;
        let (from, along, far) = if down < upper.length() {
            (joints[0], upper.normalize(), down)
        } else {
            (joints[1], (joints[2] - joints[1]).normalize(), down - upper.length())
        };
        let own = &self.arranged.panels[panel];
        let wide: f64 = (0..self.arranged.panels.len())
            .filter(|&i| self.arranged.panels[i].around == own.around)
            .filter_map(|i| breadth(self.sewn, &self.arranged.panels, i, at.y.clamp(-1e9, -1e-3)))
            .map(|[low, high]| high - low)
            .sum();
        let radius = (wide as f32 / TAU).max(ARM_M);
        let front = (Vec3::Z - along * along.z).normalize_or(Vec3::Z);
        let up = front.cross(along);
        let up = if up.y < 0.0 { -up } else { up };
        let turn = own.angle as f32 + at.x as f32 / radius;
        from + along * far + (front * turn.cos() + up * turn.sin()) * radius
    }
}

/// Rises smoothly from 0 to 1.
fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
