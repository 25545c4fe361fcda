//! The collision body: spheres, and the tapered capsules (round cones) between them.

use glam::Vec3;

use crate::body::Body;
use crate::cone::round_cone;
use crate::limits::{MAX_CAPSULES, MAX_SPHERES};

/// Spheres of a rig: 24 on either side and 3 in the middle.
pub const SPHERES: usize = 51;

const _: () = assert!(SPHERES <= MAX_SPHERES);

/// A collision sphere that a bone carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// The bone, an index below [`crate::skeleton::BONES`].
    pub bone: u8,
    /// Centre, from the bone's rest origin, in the rest frame (m).
    pub offset: Vec3,
    /// Radius (m).
    pub radius: f32,
}

/// The collision body of one body.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// The spheres: each left one is followed by its mirror image, those of the middle come last.
    pub spheres: [Sphere; SPHERES],
    /// The pairs of spheres that span a capsule.
    pub capsules: [[u8; 2]; MAX_CAPSULES],
}

impl Rig {
    /// Spheres in the rest pose of the body that the rig was fitted to: centre and radius, world (m).
    pub fn placed(&self, body: &Body) -> [(Vec3, f32); SPHERES] {
        let origins = body.skeleton.bone_origins();
        self.spheres.map(|s| (origins[usize::from(s.bone)] + s.offset, s.radius))
    }

    /// Signed distance from a point to the union of the capsules in the body's rest pose (m), negative inside, where it
    /// is the way out of the one capsule that is deepest.
    pub fn distance(&self, body: &Body, p: Vec3) -> f32 {
        let placed = self.placed(body);
        let to = |[a, b]: &[u8; 2]| round_cone(p, placed[usize::from(*a)], placed[usize::from(*b)]).0;
        self.capsules.iter().map(to).fold(f32::INFINITY, f32::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Levels, Measures, Sex};
    use crate::mesh::Mesh;
    use crate::skeleton::{JOINTS, Skeleton};

    /// A body without a surface: joint `j` at (j, 0, 0).
    fn bare() -> Body {
        let [neck, shoulder, chest, underbust, waist, hip, crotch, knee, ankle] = [0.0; 9];
        Body {
            sex: Sex::Female,
            mesh: Mesh::default(),
            normals: Vec::new(),
            skeleton: Skeleton { rest: std::array::from_fn::<_, JOINTS, _>(|j| Vec3::X * j as f32) },
            weights: Vec::new(),
            regions: Vec::new(),
            levels: Levels { neck, shoulder, chest, underbust, waist, hip, crotch, knee, ankle },
            measures: Measures::average(Sex::Female),
        }
    }

    #[test]
    fn spheres_lie_by_their_bones_and_a_distance_is_to_the_nearest_capsule() {
        let sphere = |bone: u8| Sphere { bone, offset: Vec3::Y, radius: 0.25 };
        let spheres = std::array::from_fn(|k| sphere((k % JOINTS) as u8));
        let rig = Rig { spheres, capsules: [[1, 2]; MAX_CAPSULES] };
        let placed = rig.placed(&bare());
        for (k, (centre, radius)) in placed.into_iter().enumerate() {
            assert_eq!((centre, radius), (Vec3::new((k % JOINTS) as f32, 1.0, 0.0), 0.25));
        }
        // The capsule runs from (1, 1, 0) to (2, 1, 0).
        for (p, distance) in
            [(Vec3::new(1.5, 2.0, 0.0), 0.75), (Vec3::new(3.0, 1.0, 0.0), 0.75), (Vec3::new(1.5, 1.0, 0.0), -0.25)]
        {
            assert!((rig.distance(&bare(), p) - distance).abs() < 1e-6, "{p}");
        }
    }
}
