//! Triangle meshes at rest: the type that body, garments and imports share, and its checks.

use glam::{Vec2, Vec3};

use crate::limits::{INFLUENCES, MAX_INFLUENCES};

/// A triangle mesh, metres, counter-clockwise seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Texture coordinates `[vertices]`, or empty.
    pub uvs: Vec<Vec2>,
    /// Vertex indices `[triangles]`.
    pub triangles: Vec<[u32; 3]>,
}

/// Skin weights of one vertex: up to `N` bones, weights summing to 1, unused ones 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Influences<const N: usize> {
    /// Bone indices, below [`crate::skeleton::BONES`].
    pub bones: [u8; N],
    /// Weight of each of these bones (0..1).
    pub weights: [f32; N],
}

/// Weights as the engine uses them: four bones a vertex.
pub type SkinWeights = Influences<INFLUENCES>;

/// The weights of imports that lose too much with four bones a vertex.
pub type WideWeights = Influences<MAX_INFLUENCES>;

impl<const N: usize> Default for Influences<N> {
    fn default() -> Self {
        Self { bones: [0; N], weights: [0.0; N] }
    }
}

impl<const N: usize> Influences<N> {
    /// The `N` strongest of any number of influences, strongest first, made to sum to 1, and the share of all weight
    /// that was left out (0..1). A bone may come more than once; equal weights keep the order of the bones. Weights
    /// that are not above 0 are passed over, and none at all gives weights of 0.
    pub fn strongest(all: impl IntoIterator<Item = (u8, f32)>) -> (Self, f32) {
        let mut sums: Vec<(u8, f32)> = Vec::new();
        for (bone, weight) in all.into_iter().filter(|(_, w)| *w > 0.0) {
            match sums.iter_mut().find(|(b, _)| *b == bone) {
                Some((_, sum)) => *sum += weight,
                None => sums.push((bone, weight)),
            }
        }
        sums.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let total: f32 = sums.iter().map(|s| s.1).sum();
        let kept: f32 = sums.iter().take(N).map(|s| s.1).sum();
        let mut out = Self::default();
        for (k, (bone, weight)) in sums.iter().take(N).enumerate() {
            out.bones[k] = *bone;
            out.weights[k] = weight / kept;
        }
        // None left out is exactly none, whatever the order in which the sums were rounded.
        let pruned = if sums.len() > N { 1.0 - kept / total } else { 0.0 };
        (out, pruned)
    }

    /// Bones with a weight above 0, and their weights.
    pub fn iter(&self) -> impl Iterator<Item = (u8, f32)> + '_ {
        self.bones.iter().copied().zip(self.weights).filter(|(_, w)| *w != 0.0)
    }
}

/// Area-weighted vertex normals, unit length, written into `normals` (same length as `positions`).
/// A vertex without area keeps the zero vector.
pub fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]], normals: &mut [Vec3]) {
    normals.fill(Vec3::ZERO);
    for t in triangles {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let n = (b - a).cross(c - a);
        for &i in t {
            normals[i as usize] += n;
        }
    }
    for n in normals {
        *n = n.normalize_or_zero();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_strongest_are_kept_and_sum_to_one() {
        let all = [(3, 0.1), (9, 0.4), (1, 0.2), (7, 0.05), (2, 0.15), (9, 0.1)];
        let (kept, pruned) = SkinWeights::strongest(all);
        assert_eq!(kept.bones, [9, 1, 2, 3]);
        assert!((kept.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        assert!((pruned - 0.05).abs() < 1e-6, "{pruned}");
        let (kept, pruned) = WideWeights::strongest(all);
        assert_eq!((kept.iter().count(), pruned), (5, 0.0));
    }

    #[test]
    fn weights_that_are_none_are_passed_over() {
        let (kept, pruned) = SkinWeights::strongest([(1, -1.0), (2, f32::NAN), (3, 0.0)]);
        assert_eq!((kept, pruned), (SkinWeights::default(), 0.0));
        let (kept, _) = SkinWeights::strongest([(5, 0.25), (4, 0.25)]);
        assert_eq!((kept.bones[..2].to_vec(), kept.weights), (vec![4, 5], [0.5, 0.5, 0.0, 0.0]));
    }
}
