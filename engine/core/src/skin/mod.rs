//! Linear-blend skinning: rest vertices, weights and a palette become a posed surface.
//!
//! Reads: rest positions and normals, four influences a vertex, the palette. Writes: positions and normals.
//! Budget: 10 ns a vertex on one core (7 measured, 8,002 vertices).
//! Thread: physics.

use glam::{Affine3A, Mat3A, Vec3, Vec3A};
use thiserror::Error;
use toile_assets::limits::INFLUENCES;
use toile_assets::mesh::SkinWeights;
use toile_assets::skeleton::BONES;

/// Vertices worked on together.
pub const LANES: usize = 4;

/// The palette with room up to a power of two, so that an index is in bounds by a mask.
const PADDED: usize = BONES.next_power_of_two();

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
    /// A position or normal that is no number.
    #[error("skin vertex {0} has a position or a normal that is not finite; repair the mesh")]
    NotFinite(usize),
    /// A weighted bone that the skeleton lacks.
    #[error("skin vertex {vertex} hangs on bone {bone}, but there are {BONES} bones; use an index below that")]
    NoSuchBone {
        /// The vertex.
        vertex: usize,
        /// What it names.
        bone: u8,
    },
    /// Weights below 0, not finite, or not summing to 1.
    #[error(
        "skin vertex {vertex} has weights summing to {sum}, some perhaps below 0; give weights of 0 or more with sum 1"
    )]
    BadWeights {
        /// The vertex.
        vertex: usize,
        /// The sum found.
        sum: f32,
    },
}

/// Four vertices, structure of arrays; lanes past the last vertex hang on bone 0 with their weight.
#[derive(Debug, Clone, Copy)]
struct Block {
    position: [Vec3A; LANES],
    normal: [Vec3A; LANES],
    /// `[influence][lane]`, heaviest influence first.
    bones: [[u8; LANES]; INFLUENCES],
    weights: [[f32; LANES]; INFLUENCES],
    /// Influences that any of the four uses: the others weigh 0 and are skipped.
    used: usize,
}

/// A skin made ready at load: checked, packed four vertices to a block. Running it cannot fail.
#[derive(Debug, Clone)]
pub struct SkinningJob {
    blocks: Box<[Block]>,
    vertices: usize,
}

impl SkinningJob {
    /// Packs a skin: rest positions (m), rest normals (unit) and weights, one of each a vertex. Bones that weigh
    /// nothing are not looked at. Weights are brought to a sum of exactly 1 within rounding.
    pub fn new(positions: &[Vec3], normals: &[Vec3], weights: &[SkinWeights]) -> Result<Self, SkinError> {
        let vertices = positions.len();
        if normals.len() != vertices || weights.len() != vertices {
            return Err(SkinError::Lengths { positions: vertices, normals: normals.len(), weights: weights.len() });
        }
        let mut blocks = Vec::with_capacity(vertices.div_ceil(LANES));
        for first in (0..vertices).step_by(LANES) {
            let mut block = Block::EMPTY;
            for (lane, v) in (first..vertices.min(first + LANES)).enumerate() {
                if !positions[v].is_finite() || !normals[v].is_finite() {
                    return Err(SkinError::NotFinite(v));
                }
                block.position[lane] = positions[v].into();
                block.normal[lane] = normals[v].into();
                block.hang(lane, check(v, &weights[v])?);
            }
            blocks.push(block);
        }
        Ok(Self { blocks: blocks.into(), vertices })
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Poses the skin: world positions (m) and unit normals `[vertices]`. The normal is turned by the blended matrix
    /// and normalised; one that the blend collapses becomes zero. Shorter outputs are filled as far as they go.
    pub fn run(&self, palette: &[Affine3A; BONES], positions: &mut [Vec3], normals: &mut [Vec3]) {
        let mut padded = [Affine3A::IDENTITY; PADDED];
        padded[..BONES].copy_from_slice(palette);
        let outputs = positions.chunks_mut(LANES).zip(normals.chunks_mut(LANES));
        for (block, (positions, normals)) in self.blocks.iter().zip(outputs) {
            let mut turned = [Vec3A::ZERO; LANES];
            let mut moved = [Vec3A::ZERO; LANES];
            for lane in 0..LANES {
                let matrix = block.blend(&padded, lane);
                moved[lane] = matrix.matrix3 * block.position[lane] + matrix.translation;
                turned[lane] = matrix.matrix3 * block.normal[lane];
            }
            let unit = normalize(&turned);
            for (out, p) in positions.iter_mut().zip(moved) {
                *out = p.into();
            }
            for (out, n) in normals.iter_mut().zip(unit) {
                *out = n.into();
            }
        }
    }
}

impl Block {
    const EMPTY: Self = Self {
        position: [Vec3A::ZERO; LANES],
        normal: [Vec3A::ZERO; LANES],
        bones: [[0; LANES]; INFLUENCES],
        weights: [[0.0; LANES]; INFLUENCES],
        used: 1,
    };

    fn hang(&mut self, lane: usize, weights: SkinWeights) {
        for (i, (bone, weight)) in weights.bones.into_iter().zip(weights.weights).enumerate() {
            self.bones[i][lane] = bone;
            self.weights[i][lane] = weight;
            if weight > 0.0 {
                self.used = self.used.max(i + 1);
            }
        }
    }

    /// The weighted sum of a vertex' matrices; the columns of a matrix are the lanes.
    #[inline]
    fn blend(&self, palette: &[Affine3A; PADDED], lane: usize) -> Affine3A {
        let mut sum = Affine3A { matrix3: Mat3A::ZERO, translation: Vec3A::ZERO };
        for (bones, weights) in self.bones.iter().zip(&self.weights).take(self.used) {
            // Checked at load; the mask only tells the compiler.
            let bone = &palette[usize::from(bones[lane]) % PADDED];
            let w = weights[lane];
            sum.matrix3.x_axis += bone.matrix3.x_axis * w;
            sum.matrix3.y_axis += bone.matrix3.y_axis * w;
            sum.matrix3.z_axis += bone.matrix3.z_axis * w;
            sum.translation += bone.translation * w;
        }
        sum
    }
}

/// Unit vectors, zero where there is no length; exact roots, so that every processor gives the same bits.
#[inline]
fn normalize(v: &[Vec3A; LANES]) -> [Vec3A; LANES] {
    let squared: [f32; LANES] = std::array::from_fn(|i| v[i].length_squared());
    let scale = squared.map(|s| if s > 1e-24 { 1.0 / s.sqrt() } else { 0.0 });
    std::array::from_fn(|i| v[i] * scale[i])
}

/// One vertex' weights, heaviest first, summing to 1; bones that weigh nothing become bone 0.
fn check(vertex: usize, given: &SkinWeights) -> Result<SkinWeights, SkinError> {
    let sum: f32 = given.weights.iter().sum();
    if given.weights.iter().any(|w| !w.is_finite() || *w < 0.0) || (sum - 1.0).abs() > WEIGHT_TOLERANCE {
        return Err(SkinError::BadWeights { vertex, sum });
    }
    let mut pairs: [(u8, f32); INFLUENCES] = std::array::from_fn(|i| (given.bones[i], given.weights[i] / sum));
    for pair in &mut pairs {
        if pair.1 == 0.0 {
            pair.0 = 0;
        }
        if usize::from(pair.0) >= BONES {
            return Err(SkinError::NoSuchBone { vertex, bone: pair.0 });
        }
    }
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
    Ok(SkinWeights { bones: pairs.map(|p| p.0), weights: pairs.map(|p| p.1) })
}

#[cfg(test)]
mod tests;
