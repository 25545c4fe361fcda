//! The f64 oracle of both blends, vertex after vertex, regardless of speed.

use glam::{Affine3A, DMat3, DQuat, DVec3, DVec4, Vec3};
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{BONE_CHAIN, BONES};
use toile_engine::skin::{Blend, Posed};

use toile_fitting::scene::surface::SkinnedSurface;

/// The largest errors of a posed surface; NaN where one of its numbers is NaN.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SurfaceErrors {
    /// Of a position (m).
    pub position_m: f64,
    /// Of a normal (rad), as the distance of the two unit vectors.
    pub normal_rad: f64,
}

/// Compares a posed surface with the oracle.
pub fn compare(surface: &SkinnedSurface, blend: Blend, posed: &Posed) -> SurfaceErrors {
    compare_each(surface, blend, posed.vertices(), |v| [posed.position(v), posed.normal(v)])
}

/// The same for the first `count` vertices, of which `posed` gives position (m) and unit normal.
pub(super) fn compare_each(
    surface: &SkinnedSurface,
    blend: Blend,
    count: usize,
    posed: impl Fn(usize) -> [Vec3; 2],
) -> SurfaceErrors {
    let duals = duals(&surface.palette);
    let mut worst = SurfaceErrors::default();
    for v in 0..count {
        let [position, normal] = posed(v);
        let rest = [surface.positions[v], surface.normals[v]].map(|x| x.as_dvec3());
        let [p, n] = match blend {
            Blend::Linear => linear(&surface.palette, &surface.weights[v], rest),
            Blend::Dual => dual(&duals, &surface.weights[v], rest),
        };
        worst.position_m = worse(worst.position_m, position.as_dvec3().distance(p));
        worst.normal_rad = worse(worst.normal_rad, normal.as_dvec3().distance(n));
    }
    worst
}

/// The larger error. Not `f64::max`, which passes over NaN.
fn worse(worst: f64, error: f64) -> f64 {
    if error > worst || error.is_nan() { error } else { worst }
}

fn wide(m: &Affine3A) -> (DMat3, DVec3) {
    (glam::Mat3::from(m.matrix3).as_dmat3(), Vec3::from(m.translation).as_dvec3())
}

/// The plain sum of weighted matrices; weights are brought to a sum of 1 as the engine does at load.
fn linear(palette: &[Affine3A; BONES], weights: &SkinWeights, [p, n]: [DVec3; 2]) -> [DVec3; 2] {
    let sum: f64 = weights.iter().map(|(_, w)| f64::from(w)).sum();
    let mut at = [DVec3::ZERO; 2];
    for (bone, weight) in weights.iter() {
        let (turn, shift) = wide(&palette[usize::from(bone)]);
        let w = f64::from(weight) / sum;
        at[0] += (turn * p + shift) * w;
        at[1] += turn * n * w;
    }
    [at[0], at[1].normalize_or_zero()]
}

/// Rotation and dual part of each bone, on its parent's side.
type DualBones = [[DQuat; 2]; BONES];

fn duals(palette: &[Affine3A; BONES]) -> DualBones {
    let mut duals = [[DQuat::IDENTITY; 2]; BONES];
    for (bone, parent) in BONE_CHAIN {
        let (turn, shift) = wide(&palette[bone]);
        let own = DQuat::from_mat3(&turn).normalize();
        let real = if parent.is_some_and(|p| duals[p][0].dot(own) < 0.0) { -own } else { own };
        let half = shift * 0.5;
        duals[bone] = [real, DQuat::from_xyzw(half.x, half.y, half.z, 0.0) * real];
    }
    duals
}

/// The blended motion taken apart into rotation and translation, and applied one after the other.
fn dual(duals: &DualBones, weights: &SkinWeights, [p, n]: [DVec3; 2]) -> [DVec3; 2] {
    let mut sum = [DVec4::ZERO; 2];
    for (bone, weight) in weights.iter() {
        let [real, dual] = duals[usize::from(bone)];
        sum[0] += DVec4::from(real) * f64::from(weight);
        sum[1] += DVec4::from(dual) * f64::from(weight);
    }
    let length = sum[0].length();
    let [turn, dual] = sum.map(|s| DQuat::from_vec4(s / length));
    let shift = (dual * turn.conjugate()).xyz() * 2.0;
    [turn * p + shift, (turn * n).normalize_or_zero()]
}

#[cfg(test)]
mod tests {
    use toile_engine::skin::SkinningJob;

    use super::*;

    #[test]
    fn a_wrong_position_is_found() {
        let surface = SkinnedSurface::body().unwrap().repeated(100);
        let mut moved = surface.clone();
        moved.positions[71].y += 0.003;
        let job = SkinningJob::new(&moved.positions, &moved.normals, &moved.weights).unwrap();
        let mut posed = job.posed();
        for blend in Blend::ALL {
            job.run(blend, &surface.palette, &mut posed);
            let error = compare(&surface, blend, &posed);
            // Blending may shorten what was moved, and lengthen it nowhere.
            assert!(error.position_m > 0.002 && error.position_m < 0.00301, "{blend}: {error:?}");
        }
        let mut palette = surface.palette;
        palette.iter_mut().for_each(|m| m.translation.x = f32::NAN);
        job.run(Blend::Linear, &palette, &mut posed);
        let error = compare(&surface, Blend::Linear, &posed);
        assert!(error.position_m.is_nan(), "what is not a number is the largest error");
    }
}
