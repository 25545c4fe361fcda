//! Tuck: skin that would show through a garment lying on it is drawn beneath the cloth.
//!
//! Cloth collides with capsules that follow the body to within millimetres; where the skin stands out of them it would
//! poke through the garment. Only the picture is mended: positions of body vertices for drawing, nothing else.

use glam::Vec3;

use crate::tree::{Ray, Tree};

/// Cloth this deep under the skin is still meant to lie on it (m): the largest distance at which the body stands out
/// of its capsules.
const DEPTH_M: f32 = 0.035;

/// Skin is drawn at least this far beneath the cloth (m): more than the sag of a chord of the cloth's mesh.
const BENEATH_M: f32 = 0.006;

/// Skin is under a garment if cloth lies this far before it at most when the garment is put on (m): a flared hem stands
/// this far from the leg.
const UNDER_M: f32 = 0.30;

/// The garments that lie over the skin.
#[derive(Debug, Clone)]
pub struct Cover {
    tree: Tree,
}

impl Cover {
    /// The garments' triangles, by their corners (m).
    pub fn new(faces: impl Iterator<Item = [Vec3; 3]>) -> Self {
        Self { tree: Tree::build(faces) }
    }

    /// Which body vertices are dressed: those with cloth before them. A hand that later comes to lie on a skirt is not
    /// under it. Asked once, of the garments as they are put on.
    pub fn dressed(&self, positions: &[Vec3], normals: &[Vec3]) -> Vec<bool> {
        let under = |(p, n): (&Vec3, &Vec3)| {
            let from = *p - *n * DEPTH_M;
            *n != Vec3::ZERO && from.is_finite() && self.tree.closest(&Ray::new(from, *n), DEPTH_M + UNDER_M).is_some()
        };
        positions.iter().zip(normals).map(under).collect()
    }

    /// Pushes dressed body vertices beneath the cloth that lies on or in them. `normals` are the body's unit normals.
    pub fn tuck(&self, positions: &mut [Vec3], normals: &[Vec3], dressed: &[bool]) {
        for ((p, n), dressed) in positions.iter_mut().zip(normals).zip(dressed) {
            let from = *p - *n * DEPTH_M;
            if !dressed || *n == Vec3::ZERO || !from.is_finite() {
                continue;
            }
            let hit = self.tree.closest(&Ray::new(from, *n), DEPTH_M + BENEATH_M);
            if let Some(hit) = hit {
                *p = from + *n * (hit.distance - BENEATH_M);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(height: f32) -> Cover {
        let p = |x: f32, z: f32| Vec3::new(x, height, z);
        Cover::new([[p(-1.0, -1.0), p(1.0, 1.0), p(1.0, -1.0)], [p(-1.0, -1.0), p(-1.0, 1.0), p(1.0, 1.0)]].into_iter())
    }

    #[test]
    fn skin_goes_beneath_cloth_that_lies_in_it_and_stays_where_cloth_is_away() {
        for (cloth, skin) in [(-0.01, -0.01 - BENEATH_M), (0.003, 0.003 - BENEATH_M), (0.02, 0.0), (-0.05, 0.0)] {
            let mut p = [Vec3::ZERO];
            sheet(cloth).tuck(&mut p, &[Vec3::Y], &[true]);
            assert!((p[0].y - skin).abs() < 1e-6, "cloth {cloth}: {}", p[0].y);
        }
    }

    #[test]
    fn only_skin_with_cloth_before_it_is_dressed() {
        let at = [Vec3::ZERO, Vec3::Y * 0.5];
        let mut p = at;
        let dressed = sheet(0.2).dressed(&at, &[Vec3::Y; 2]);
        assert_eq!(dressed, [true, false]);
        sheet(0.495).tuck(&mut p, &[Vec3::Y; 2], &dressed);
        assert_eq!(p, at, "cloth that comes to lie in bare skin leaves it alone");
    }
}
