//! What it costs to leave influences out: the same skin with all of them and with those that are kept.

use glam::{Affine3A, Vec3};
use toile_base::mesh::Influences;
use toile_base::skeleton::BONES;

use super::{Blend, SkinError, SkinningJob};

/// What pruning did to a skin.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pruning {
    /// Vertices that lost influences.
    pub vertices: usize,
    /// The largest share of its weight that a vertex lost (0..1).
    pub share_max: f32,
    /// The largest error of a position in any of the poses (m).
    pub error_max_m: f32,
    /// The vertex with it; nothing where there is no error.
    pub worst: Option<usize>,
    /// Mean error of the vertices that lost influences, over the poses (m).
    pub error_mean_m: f32,
}

/// Compares a skin with its pruned version in some poses, each a palette. At load.
///
/// # Errors
/// Where one of the two is no skin.
pub fn pruning<const ALL: usize, const KEPT: usize>(
    [positions, normals]: [&[Vec3]; 2],
    all: &[Influences<ALL>],
    kept: &[Influences<KEPT>],
    poses: &[[Affine3A; BONES]],
) -> Result<Pruning, SkinError> {
    let (whole, pruned) = (SkinningJob::new(positions, normals, all)?, SkinningJob::new(positions, normals, kept)?);
    let mut found = Pruning::default();
    let lost: Vec<usize> = (0..all.len().min(kept.len())).filter(|&v| share(&all[v], &kept[v]) > 0.0).collect();
    found.vertices = lost.len();
    found.share_max = lost.iter().map(|&v| share(&all[v], &kept[v])).fold(0.0, f32::max);
    let (mut truth, mut shown) = (whole.posed(), pruned.posed());
    let mut sum = 0.0;
    for palette in poses {
        whole.run(Blend::Linear, palette, &mut truth);
        pruned.run(Blend::Linear, palette, &mut shown);
        for &v in &lost {
            let error = truth.position(v).distance(shown.position(v));
            sum += f64::from(error);
            // An error that is NaN is the largest.
            if error > found.error_max_m || error.is_nan() {
                (found.error_max_m, found.worst) = (error, Some(v));
            }
        }
    }
    found.error_mean_m = (sum / (lost.len() * poses.len()).max(1) as f64) as f32;
    Ok(found)
}

/// Share of the weight on bones that are not kept.
fn share<const ALL: usize, const KEPT: usize>(all: &Influences<ALL>, kept: &Influences<KEPT>) -> f32 {
    let total: f32 = all.iter().map(|(_, w)| w).sum();
    let lost = all.iter().filter(|(bone, _)| kept.iter().all(|(other, _)| other != *bone)).map(|(_, w)| w);
    lost.sum::<f32>() / total
}
