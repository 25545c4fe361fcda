//! Dual quaternions of a palette: rotation and, in the dual part, half the translation times the rotation.

use glam::{Affine3A, Mat3, Quat, Vec3, Vec4};
use toile_base::numeric::portable;
use toile_base::skeleton::{BONE_CHAIN, BONES};

/// A rigid motion as eight numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DualQuat {
    /// The rotation: x, y, z, w.
    pub real: Vec4,
    /// Half the product of translation and rotation.
    pub dual: Vec4,
}

impl DualQuat {
    /// The motion that leaves everything where it is.
    pub const IDENTITY: Self = Self { real: Vec4::W, dual: Vec4::ZERO };

    /// The motion of a matrix of rotation and translation.
    pub fn of(matrix: &Affine3A) -> Self {
        let real = portable::unit(Quat::from_mat3(&Mat3::from(matrix.matrix3)));
        let t = Vec3::from(matrix.translation) * 0.5;
        Self { real: real.into(), dual: (Quat::from_xyzw(t.x, t.y, t.z, 0.0) * real).into() }
    }

    /// The same motion by its other quaternion.
    fn negated(self) -> Self {
        Self { real: -self.real, dual: -self.dual }
    }
}

/// A palette's dual quaternions. Of the two that each rotation has, a bone takes the one on its parent's side, once a
/// pose: the bones of a vertex are near each other in the skeleton, so the blend goes the short way without a test a
/// vertex (or a block), and a limb twisted past half a turn in all, but not between two bones, is not torn.
pub fn palette(palette: &[Affine3A; BONES]) -> [DualQuat; BONES] {
    let mut duals = [DualQuat::IDENTITY; BONES];
    for (bone, parent) in BONE_CHAIN {
        let own = DualQuat::of(&palette[bone]);
        let turn = |dual: &DualQuat| Quat::from_vec4(dual.real);
        let beside = parent.is_none_or(|p| portable::inner(turn(&duals[p]), turn(&own)) >= 0.0);
        duals[bone] = if beside { own } else { own.negated() };
    }
    duals
}
