//! The kernels: a block's vertices follow the same bones, so each number of a bone is loaded once, into every lane.
//!
//! The bones of a run are blended as base + w1 (bone1 - base) + ...: weights sum to 1, so the base needs none, the
//! differences are made once a run, and a vertex of k influences costs (k - 1) products and sums a number. Operations a
//! vertex, k influences: linear 24 (k - 1) to blend, 33 to apply, 18 to normalise: 123 for four. Dual quaternion
//! 16 (k - 1), 9, 75 and nothing to normalise, because what is applied is a rotation: 132 for four. Bytes: 24 + 4 (k - 1)
//! read and 24 written.

use glam::{Affine3A, Vec4};
use toile_base::limits::MAX_INFLUENCES;
use toile_base::skeleton::BONES;

use super::dual::DualQuat;
use super::layout::BoneRun;
use super::posed::BLOCK;
use crate::lanes::{Kernel, Lanes, MOST, ReadColumn, RecordsAt, V3, WriteColumn, reciprocal_root};

/// Square of the length below which a normal is taken for collapsed.
const COLLAPSED: f32 = 1e-24;

/// Input of both kernels, and where the posed vertices go.
#[derive(Clone, Copy)]
pub(super) struct SkinSurface<'a, O> {
    pub runs: &'a [BoneRun],
    /// Vertices of each block.
    pub filled: &'a [u8],
    pub rest: ReadColumn<'a>,
    pub out: O,
}

/// What posed vertices are written to.
pub(super) trait SkinOutput: Copy {
    /// Writes a vector of vertices, the first of them on this lane, counted over all blocks.
    fn store<L: Lanes>(self, lane: usize, position: V3<L>, normal: V3<L>);
}

/// By column, block after block: [`Posed`](super::Posed).
#[derive(Clone, Copy)]
pub(super) struct BlockOutput<'a>(pub WriteColumn<'a>);

impl SkinOutput for BlockOutput<'_> {
    #[inline(always)]
    fn store<L: Lanes>(self, lane: usize, position: V3<L>, normal: V3<L>) {
        let at = lane / MOST * BLOCK + lane % MOST;
        for (k, v) in [position.x, position.y, position.z, normal.x, normal.y, normal.z].into_iter().enumerate() {
            v.store(self.0, at + k * MOST);
        }
    }
}

/// In the order of the mesh: [`PosedMesh`](super::PosedMesh).
#[derive(Clone, Copy)]
pub(super) struct MeshOutput<'a>(
    /// The vertex of each lane.
    pub RecordsAt<'a>,
);

impl SkinOutput for MeshOutput<'_> {
    #[inline(always)]
    fn store<L: Lanes>(self, lane: usize, position: V3<L>, normal: V3<L>) {
        let (p, n, zero) = (position, normal, L::splat(0.0));
        L::store_doubles([p.x, p.y, p.z, zero, n.x, n.y, n.z, zero], self.0, lane);
    }
}

/// Where a vector of vertices is: in the rest data, and its first lane, counted over all blocks.
#[derive(Clone, Copy)]
struct VertexPlace {
    rest: usize,
    lane: usize,
}

impl<O: SkinOutput> SkinSurface<'_, O> {
    #[inline(always)]
    fn load<L: Lanes>(&self, at: VertexPlace, first: usize) -> V3<L> {
        let from = at.rest + first * MOST;
        V3 { x: L::load(self.rest, from), y: L::load(self.rest, from + MOST), z: L::load(self.rest, from + 2 * MOST) }
    }

    /// The weights of a bone other than the base, counted from 1.
    #[inline(always)]
    fn weight<L: Lanes>(&self, at: VertexPlace, bone: usize) -> L {
        L::load(self.rest, at.rest + (5 + bone) * MOST)
    }
}

/// A bone's matrix, column after column: single numbers, since each is loaded into every lane from where it lies.
type SkinColumns = [f32; 12];

/// The columns of a matrix, each number in lanes.
#[derive(Clone, Copy)]
struct Matrix<L> {
    x: V3<L>,
    y: V3<L>,
    z: V3<L>,
    t: V3<L>,
}

impl<L: Lanes> Matrix<L> {
    #[inline(always)]
    fn splat(m: &SkinColumns) -> Self {
        Self { x: Self::column(m, 0), y: Self::column(m, 3), z: Self::column(m, 6), t: Self::column(m, 9) }
    }
    #[inline(always)]
    fn column(m: &SkinColumns, k: usize) -> V3<L> {
        V3 { x: L::splat(m[k]), y: L::splat(m[k + 1]), z: L::splat(m[k + 2]) }
    }
    #[inline(always)]
    fn and(self, more: &SkinColumns, weight: L) -> Self {
        let more = Self::splat(more);
        Self {
            x: self.x + more.x * weight,
            y: self.y + more.y * weight,
            z: self.z + more.z * weight,
            t: self.t + more.t * weight,
        }
    }
}

/// Blends bone matrices linearly.
pub(super) struct Linear<'a, O> {
    pub surface: SkinSurface<'a, O>,
    pub palette: &'a [Affine3A; BONES],
}

impl<O: SkinOutput> Kernel for Linear<'_, O> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let surface = self.surface;
        for run in surface.runs {
            let base = columns(run.of(self.palette, 0));
            let mut apart = [[0.0; 12]; MAX_INFLUENCES];
            for (k, apart) in apart.iter_mut().enumerate().take(run.count).skip(1) {
                let bone = columns(run.of(self.palette, k));
                *apart = std::array::from_fn(|i| bone[i] - base[i]);
            }
            for block in 0..run.blocks {
                let filled = usize::from(surface.filled[run.first + block]);
                let mut lane = 0;
                while lane < filled {
                    let at = VertexPlace { rest: run.rest(block) + lane, lane: (run.first + block) * MOST + lane };
                    linear::<L>(&surface, at, &base, &apart[..run.count]);
                    lane += L::N;
                }
            }
        }
    }
}

/// One vector of vertices; `apart[1..]` are what the other bones have beyond the base.
#[inline(always)]
fn linear<L: Lanes>(
    surface: &SkinSurface<'_, impl SkinOutput>,
    at: VertexPlace,
    base: &SkinColumns,
    apart: &[SkinColumns],
) {
    let mut m = Matrix::<L>::splat(base);
    for (k, more) in apart.iter().enumerate().skip(1) {
        m = m.and(more, surface.weight::<L>(at, k));
    }
    let p = surface.load::<L>(at, 0);
    let n = surface.load::<L>(at, 3);
    let position = (m.x * p.x + m.y * p.y) + (m.z * p.z + m.t);
    let normal = m.x * n.x + m.y * n.y + m.z * n.z;
    let squared = normal.dot(normal);
    let scale = reciprocal_root(squared).select(L::splat(COLLAPSED).lt(squared), L::splat(0.0));
    surface.out.store(at.lane, position, normal * scale);
}

#[inline(always)]
fn columns(matrix: &Affine3A) -> SkinColumns {
    matrix.to_cols_array()
}

/// Dual quaternion blending.
pub(super) struct Dual<'a, O> {
    pub surface: SkinSurface<'a, O>,
    pub palette: &'a [DualQuat; BONES],
}

impl<O: SkinOutput> Kernel for Dual<'_, O> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let surface = self.surface;
        for run in surface.runs {
            let base = *run.of(self.palette, 0);
            let mut apart = [DualQuat { real: Vec4::ZERO, dual: Vec4::ZERO }; MAX_INFLUENCES];
            for (k, apart) in apart.iter_mut().enumerate().take(run.count).skip(1) {
                let bone = run.of(self.palette, k);
                *apart = DualQuat { real: bone.real - base.real, dual: bone.dual - base.dual };
            }
            for block in 0..run.blocks {
                let filled = usize::from(surface.filled[run.first + block]);
                let mut lane = 0;
                while lane < filled {
                    let at = VertexPlace { rest: run.rest(block) + lane, lane: (run.first + block) * MOST + lane };
                    dual::<L>(&surface, at, &base, &apart[..run.count]);
                    lane += L::N;
                }
            }
        }
    }
}

/// Four numbers, each in lanes: a quaternion's vector and scalar.
#[derive(Clone, Copy)]
struct QuaternionLanes<L> {
    v: V3<L>,
    w: L,
}

impl<L: Lanes> QuaternionLanes<L> {
    #[inline(always)]
    fn splat(q: Vec4) -> Self {
        Self { v: V3 { x: L::splat(q.x), y: L::splat(q.y), z: L::splat(q.z) }, w: L::splat(q.w) }
    }
    #[inline(always)]
    fn and(self, more: Vec4, weight: L) -> Self {
        let more = Self::splat(more);
        Self { v: self.v + more.v * weight, w: self.w + more.w * weight }
    }
}

/// One vector of vertices. With the blend r + e d, r = (v, w), d = (u, s), a point p goes to
/// p + 2 / |r|^2 (v x (v x p + w p + u) + w u - s v), a direction n to n + 2 / |r|^2 v x (v x n + w n): the
/// normalisation of Kavan et al. 2008, equation 6, is in the factor.
#[inline(always)]
fn dual<L: Lanes>(surface: &SkinSurface<'_, impl SkinOutput>, at: VertexPlace, base: &DualQuat, apart: &[DualQuat]) {
    let (mut real, mut dual) = (QuaternionLanes::<L>::splat(base.real), QuaternionLanes::<L>::splat(base.dual));
    for (k, more) in apart.iter().enumerate().skip(1) {
        let weight = surface.weight::<L>(at, k);
        real = real.and(more.real, weight);
        dual = dual.and(more.dual, weight);
    }
    let (v, w) = (real.v, real.w);
    let squared = v.dot(v) + w * w;
    // Bones that cancel each other leave no rotation; the floor keeps what is then shown finite.
    let factor = L::splat(2.0).div(squared.max(L::splat(COLLAPSED)));
    let p = surface.load::<L>(at, 0);
    let n = surface.load::<L>(at, 3);
    let moved = v.cross(v.cross(p) + p * w + dual.v) + (dual.v * w - v * dual.w);
    let turned = v.cross(v.cross(n) + n * w);
    surface.out.store(at.lane, p + moved * factor, n + turned * factor);
}
