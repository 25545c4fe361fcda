//! Hides skin that would show through a garment lying on it: it is drawn beneath the cloth.
//!
//! Cloth collides with capsules that follow the body to within millimetres; where the skin stands out of them it would
//! poke through the garment. Only the picture is mended: positions of body vertices for drawing, nothing else.

use glam::Vec3;

use crate::bvh::{Bvh, Ray};

/// Cloth this deep under the skin is still meant to lie on it (m): what contact leaves, which believes the cones where skin and
/// cones are 20 mm apart.
const DEPTH_M: f32 = 0.03;

/// A fold may lie this much deeper than the outermost cloth (m).
const FOLD_M: f32 = 0.012;

/// Skin is drawn at least this far beneath the cloth (m): more than the sag of a chord of the cloth's mesh.
const BENEATH_M: f32 = 0.006;

/// Cosine between the normals of skin and of the cloth over it, at least.
const LEAST_FACING: f32 = 0.2;

/// Of a vertex's push its neighbours get this share, so that no triangle of skin cuts through a hem.
const SPREAD: f32 = 0.7;

/// Rings of neighbours that a push spreads over.
const SPREAD_RINGS: usize = 2;

/// Skin is under a garment if cloth lies this far before it at most when the garment is put on (m): a flared hem stands
/// this far from the leg.
const UNDER_M: f32 = 0.30;

/// A garment as it is put on lies this deep in the skin at most (m), where a seam cuts a corner.
const PUT_ON_DEPTH_M: f32 = 0.03;

/// The garments that lie over the skin.
#[derive(Debug, Clone)]
pub struct CoveringCloth {
    bvh: Bvh,
    /// Unit normal of each triangle.
    outwards: Vec<Vec3>,
}

impl CoveringCloth {
    /// The garments' triangles, by their corners (m).
    pub fn new(faces: impl Iterator<Item = [Vec3; 3]>) -> Self {
        let faces: Vec<[Vec3; 3]> = faces.collect();
        let outwards = faces.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a).normalize_or_zero()).collect();
        Self { bvh: Bvh::build(faces.into_iter()), outwards }
    }

    /// Which body vertices are dressed: those with cloth before them. A hand that later comes to lie on a skirt is not
    /// under it. Asked once, of the garments as they are put on.
    pub fn dressed(&self, positions: &[Vec3], normals: &[Vec3]) -> Vec<bool> {
        let under = |(p, n): (&Vec3, &Vec3)| {
            let from = *p - *n * PUT_ON_DEPTH_M;
            let ray = Ray::new(from, *n);
            *n != Vec3::ZERO && from.is_finite() && self.bvh.closest(&ray, PUT_ON_DEPTH_M + UNDER_M).is_some()
        };
        positions.iter().zip(normals).map(under).collect()
    }

    /// Pushes dressed vertices beneath the cloth that lies on or in them. `normals` are the unit normals of what is
    /// pushed, `triangles` its topology. The triangles to draw are all but those in a crease, where cloth lies over the skin
    /// but no direction leads out from under it.
    pub fn hide_skin(
        &self,
        positions: &mut [Vec3],
        normals: &[Vec3],
        dressed: &[bool],
        triangles: &[[u32; 3]],
    ) -> DrawnSkin {
        let found: Vec<ClothOver> = positions
            .iter()
            .zip(normals)
            .zip(dressed)
            .map(|((p, n), dressed)| if *dressed { self.cloth_over(*p, *n) } else { ClothOver::Bare })
            .collect();
        let mut pushes: Vec<f32> =
            found.iter().map(|f| if let ClothOver::Under(push) = f { *push } else { 0.0 }).collect();
        for _ in 0..SPREAD_RINGS {
            let before = pushes.clone();
            for t in triangles {
                let most = t.iter().map(|&i| before[i as usize]).fold(0.0, f32::max) * SPREAD;
                t.iter().for_each(|&i| pushes[i as usize] = pushes[i as usize].max(most));
            }
        }
        for ((p, n), push) in positions.iter_mut().zip(normals).zip(pushes) {
            *p -= *n * push;
        }
        let is = |t: &[u32; 3], cloth_over: fn(&ClothOver) -> bool| t.map(|i| cloth_over(&found[i as usize]));
        let hidden = |t: &[u32; 3]| {
            is(t, |f| matches!(f, ClothOver::Creased)).contains(&true)
                && !is(t, |f| matches!(f, ClothOver::Bare)).contains(&true)
        };
        let stands_out = |f: &ClothOver| if let ClothOver::Under(push) = f { push - BENEATH_M } else { 0.0 };
        DrawnSkin {
            drawn: (0..).zip(triangles).filter(|(_, t)| !hidden(t)).map(|(i, _)| i).collect(),
            hidden_m: found.iter().map(stands_out).fold(0.0, f32::max),
        }
    }

    /// What lies over a vertex. The ray comes from outside, so that on a thin limb it meets the near side.
    fn cloth_over(&self, p: Vec3, n: Vec3) -> ClothOver {
        let from = p + n * BENEATH_M;
        if n == Vec3::ZERO || !from.is_finite() {
            return ClothOver::Bare;
        }
        let Some(outer) = self.bvh.closest(&Ray::new(from, -n), DEPTH_M + BENEATH_M) else { return ClothOver::Bare };
        // Cloth met on its inner side does not lie over this skin: in a crease the normals of skin point anywhere.
        if self.outwards[outer.triangle as usize].dot(n) < LEAST_FACING {
            return ClothOver::Creased;
        }
        let under = from - n * (outer.distance + 1e-4);
        let fold = self.bvh.closest(&Ray::new(under, -n), FOLD_M).map_or(0.0, |hit| hit.distance + 1e-4);
        ClothOver::Under(outer.distance + fold)
    }
}

/// Skin as it is drawn beneath cloth.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnSkin {
    /// The triangles to draw, by their place among all.
    pub drawn: Vec<u32>,
    /// How far skin stood out of the cloth over it, where it did most (m): what the picture hides.
    pub hidden_m: f32,
}

/// The cover over a vertex of skin.
#[derive(Debug, Clone, Copy, PartialEq)]
enum ClothOver {
    /// No cloth near.
    Bare,
    /// Cloth that is got beneath by going this far inwards (m).
    Under(f32),
    /// Cloth, but seen from its inner side.
    Creased,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(height: f32) -> CoveringCloth {
        let p = |x: f32, z: f32| Vec3::new(x, height, z);
        CoveringCloth::new(
            [[p(-1.0, -1.0), p(1.0, 1.0), p(1.0, -1.0)], [p(-1.0, -1.0), p(-1.0, 1.0), p(1.0, 1.0)]].into_iter(),
        )
    }

    #[test]
    fn skin_goes_beneath_cloth_that_lies_in_it_and_stays_where_cloth_is_away() {
        for (cloth, skin) in [(-0.01, -0.01 - BENEATH_M), (0.003, 0.003 - BENEATH_M), (0.02, 0.0), (-0.12, 0.0)] {
            let mut p = [Vec3::ZERO];
            let drawn = sheet(cloth).hide_skin(&mut p, &[Vec3::Y], &[true], &[]);
            let out = if cloth > -DEPTH_M { (-cloth).max(0.0) } else { 0.0 };
            assert!((drawn.hidden_m - out).abs() < 1e-6, "cloth {cloth}: {} hidden", drawn.hidden_m);
            assert!((p[0].y - skin).abs() < 1e-6, "cloth {cloth}: {}", p[0].y);
        }
    }

    #[test]
    fn only_skin_with_cloth_before_it_is_dressed() {
        let at = [Vec3::ZERO, Vec3::Y * 0.5];
        let mut p = at;
        let dressed = sheet(0.2).dressed(&at, &[Vec3::Y; 2]);
        assert_eq!(dressed, [true, false]);
        let _ = sheet(0.495).hide_skin(&mut p, &[Vec3::Y; 2], &dressed, &[]);
        assert_eq!(p, at, "cloth that comes to lie in bare skin leaves it alone");
    }

    #[test]
    fn a_triangle_in_a_crease_is_not_drawn() {
        // Skin whose normals point down, beneath a sheet that faces up: no way out from under it.
        let mut p = [Vec3::ZERO, Vec3::X * 0.01, Vec3::Z * 0.01];
        let before = p;
        assert!(sheet(0.02).hide_skin(&mut p, &[Vec3::NEG_Y; 3], &[true; 3], &[[0, 1, 2]]).drawn.is_empty());
        assert_eq!(p, before);
        assert_eq!(sheet(0.02).hide_skin(&mut p, &[Vec3::NEG_Y; 3], &[true, false, true], &[[0, 1, 2]]).drawn.len(), 1);
    }
}
