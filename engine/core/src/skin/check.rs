//! Conditions of a valid skin, and the errors of an invalid one.

use glam::Vec3;
use thiserror::Error;
use toile_base::limits::MAX_INFLUENCES;
use toile_base::mesh::Influences;
use toile_base::skeleton::BONES;

/// How far the weights of a vertex may sum from 1: the rounding of four weights kept as text with four digits.
pub const WEIGHT_TOLERANCE: f32 = 1e-3;

/// Why a surface cannot be skinned.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SkinError {
    /// The arrays differ in length.
    #[error(
        "{positions} positions, {normals} normals and {weights} weights do not belong to one skin; give one of each a vertex"
    )]
    Lengths {
        /// Number of positions.
        positions: usize,
        /// Number of normals.
        normals: usize,
        /// Number of weights.
        weights: usize,
    },
    /// A position or normal that is not finite.
    #[error("skin vertex {0} has a position or a normal that is not finite; repair the mesh")]
    NotFinite(usize),
    /// A weighted bone that the skeleton lacks.
    #[error("skin vertex {vertex} names bone {bone}, but there are {BONES} bones; use an index below that")]
    NoSuchBone {
        /// Index of the vertex, from 0.
        vertex: usize,
        /// Index of the bone that it names.
        bone: u8,
    },
    /// A weight that is not finite, or below 0.
    #[error("skin vertex {vertex} has the weight {weight} for bone {bone}; give a number of 0 or more")]
    BadWeight {
        /// Index of the vertex, from 0.
        vertex: usize,
        /// Index of the bone.
        bone: u8,
        /// Weight of the bone; 0 to 1 is right.
        weight: f32,
    },
    /// Weights that do not sum to 1.
    #[error("skin vertex {vertex} has weights that sum to {sum}; divide them by their sum, which must be 1")]
    BadSum {
        /// Index of the vertex, from 0.
        vertex: usize,
        /// Sum of its weights; 1 is right.
        sum: f32,
    },
    /// More influences than a vertex may have.
    #[error(
        "the skin has {0} influences a vertex, but {MAX_INFLUENCES} is the most; prune it with `Influences::strongest`"
    )]
    TooManyInfluences(usize),
}

/// A vertex as the layout wants it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
    /// Its bones of some weight in the order of their indices, each once; [`NO_BONE`] behind them.
    pub bones: [u8; MAX_INFLUENCES],
    /// Their weights, which sum to 1.
    pub weights: [f32; MAX_INFLUENCES],
}

/// What stands where there is no bone.
pub(super) const NO_BONE: u8 = u8::MAX;

/// All vertices, or what is wrong with the first wrong one.
pub(super) fn vertices<const N: usize>(
    positions: &[Vec3],
    normals: &[Vec3],
    weights: &[Influences<N>],
) -> Result<Vec<Vertex>, SkinError> {
    if N > MAX_INFLUENCES {
        return Err(SkinError::TooManyInfluences(N));
    }
    let lengths = [positions.len(), normals.len(), weights.len()];
    if lengths.iter().any(|l| *l != lengths[0]) {
        let [positions, normals, weights] = lengths;
        return Err(SkinError::Lengths { positions, normals, weights });
    }
    let vertex = |v: usize| {
        let (position, normal) = (positions[v], normals[v]);
        if !position.is_finite() || !normal.is_finite() {
            return Err(SkinError::NotFinite(v));
        }
        let (bones, weights) = influences(v, &weights[v])?;
        Ok(Vertex { position, normal: normal.normalize_or_zero(), bones, weights })
    };
    (0..positions.len()).map(vertex).collect()
}

type Checked = ([u8; MAX_INFLUENCES], [f32; MAX_INFLUENCES]);

fn influences<const N: usize>(vertex: usize, given: &Influences<N>) -> Result<Checked, SkinError> {
    for (bone, weight) in given.iter() {
        if !weight.is_finite() || weight < 0.0 {
            return Err(SkinError::BadWeight { vertex, bone, weight });
        }
        if usize::from(bone) >= BONES {
            return Err(SkinError::NoSuchBone { vertex, bone });
        }
    }
    let sum: f32 = given.weights.iter().sum();
    if (sum - 1.0).abs() > WEIGHT_TOLERANCE {
        return Err(SkinError::BadSum { vertex, sum });
    }
    let (kept, _) = Influences::<N>::strongest(given.iter());
    let mut pairs: Vec<(u8, f32)> = kept.iter().collect();
    pairs.sort_by_key(|p| p.0);
    let mut checked = ([NO_BONE; MAX_INFLUENCES], [0.0; MAX_INFLUENCES]);
    for (k, (bone, weight)) in pairs.into_iter().enumerate() {
        (checked.0[k], checked.1[k]) = (bone, weight);
    }
    Ok(checked)
}
