//! Skinning: rest vertices, weights and a palette become a posed surface, by linear blending or dual quaternions.
//!
//! A run over 15,000 vertices of four influences may take 44 us on one core of 16 lanes, and allocates nothing. See
//! docs/skinning.md. It runs on the physics thread; two workers may share a run and give the same bits as one.

mod check;
mod dual;
mod kernel;
mod laid;
mod layout;
mod posed;
mod posed_mesh;
mod sweep;
#[cfg(test)]
mod tests;

use std::ops::Range;

use glam::{Affine3A, Vec3};
use toile_base::mesh::Influences;
use toile_base::skeleton::BONES;

use crate::lanes::{ReadColumn, Shared, Width};
use crate::workers::{SHARES, WorkerPool};

pub use check::{SkinError, WEIGHT_TOLERANCE};
pub use dual::{DualQuat, palette as dual_palette};
pub use laid::LaidVertex;
pub use layout::Padding;
pub use posed::Posed;
pub use posed_mesh::{PosedMesh, PosedVertex};
pub use sweep::{SweepBinding, SweptLimb, SweptSkin};

use kernel::{BlockOutput, Dual, Linear, MeshOutput, SkinOutput, SkinSurface};
use layout::SkinLayout;

toile_base::named! {
    /// How the motions of a vertex' bones become one.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
    pub enum Blend {
        /// The weighted sum of their matrices: for palettes of any kind. Thins bent joints and twisted limbs; the skeleton's
        /// twist bones keep it from the latter.
        #[default]
        Linear = "linear",
        /// The weighted sum of their dual quaternions (Kavan, Collins, Zara, O'Sullivan 2008, "Geometric skinning with
        /// approximate dual quaternion blending"): for palettes of rotations and translations. Keeps twisted limbs whole;
        /// bent joints bulge.
        Dual = "dual",
    }
}

/// A skin made ready at load: checked, and laid out in blocks of vertices that follow the same bones. Running it
/// cannot fail.
#[derive(Debug, Clone)]
pub struct SkinningJob {
    layout: SkinLayout,
    /// How its kernels run; the widest lanes of this processor, unless set otherwise.
    pub width: Width,
}

impl SkinningJob {
    /// Lays out a skin: rest positions (m), rest normals (brought to unit length, none where they have none) and
    /// weights of up to four bones ([`toile_base::mesh::SkinWeights`]) or eight
    /// ([`toile_base::mesh::WideWeights`]), one of each a vertex. Bones that weigh nothing are not looked at. Weights
    /// are brought to a sum of 1.
    ///
    /// # Errors
    /// What [`SkinError`] names, with the first vertex that it was found at.
    pub fn new<const N: usize>(
        positions: &[Vec3],
        normals: &[Vec3],
        weights: &[Influences<N>],
    ) -> Result<Self, SkinError> {
        let vertices = check::vertices(positions, normals, weights)?;
        Ok(Self { layout: SkinLayout::new(&vertices), width: Width::widest() })
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.layout.slots.len()
    }

    /// Room for what a run gives; it holds the rest pose.
    pub fn posed(&self) -> Posed {
        self.layout.posed()
    }

    /// Room for what a run gives in the order of the mesh; all zero.
    pub fn posed_mesh(&self) -> PosedMesh {
        PosedMesh::new(self.vertices())
    }

    /// How many lanes a run at the job's width works on, beside those that carry a vertex.
    pub fn padding(&self) -> Padding {
        self.layout.padding(self.width)
    }

    /// Poses the skin: world positions (m) and unit normals. A normal that the blend collapses becomes zero. A bone that
    /// is not finite may spoil the vertices that share blocks with its own. `posed` comes from [`Self::posed`].
    pub fn run(&self, blend: Blend, palette: &[Affine3A; BONES], posed: &mut Posed) {
        self.all(blend, palette, Shared::new(BlockOutput(posed.column())));
    }

    /// The same in the order of the mesh, ready to be uploaded. `posed` comes from [`Self::posed_mesh`].
    pub fn run_mesh(&self, blend: Blend, palette: &[Affine3A; BONES], posed: &mut PosedMesh) {
        self.all(blend, palette, Shared::new(self.mesh_output(posed)));
    }

    /// The same with the pool's workers, a share each: the same bits. Says whether all was done: not where a worker
    /// panicked, which leaves a part of the surface as it was.
    pub fn run_with(
        &self,
        pool: &mut WorkerPool,
        blend: Blend,
        palette: &[Affine3A; BONES],
        posed: &mut Posed,
    ) -> bool {
        self.shared(pool, blend, palette, Shared::new(BlockOutput(posed.column())))
    }

    /// [`Self::run_mesh`] with the pool's workers, as [`Self::run_with`].
    pub fn run_mesh_with(
        &self,
        pool: &mut WorkerPool,
        blend: Blend,
        palette: &[Affine3A; BONES],
        posed: &mut PosedMesh,
    ) -> bool {
        self.shared(pool, blend, palette, Shared::new(self.mesh_output(posed)))
    }

    fn mesh_output<'a>(&'a self, posed: &'a mut PosedMesh) -> MeshOutput<'a> {
        MeshOutput(self.layout.records.within(posed.column()))
    }

    #[expect(unsafe_code, reason = "one thread writes the posed surface")]
    fn all<O: SkinOutput>(&self, blend: Blend, palette: &[Affine3A; BONES], out: Shared<O>) {
        let duals = self.duals(blend, palette);
        let work = SkinningWork { job: self, blend, palette, duals: &duals, out };
        // SAFETY: no other thread has the work.
        unsafe { work.runs(0..self.layout.runs.len()) };
    }

    #[expect(unsafe_code, reason = "the workers share the posed surface")]
    fn shared<O: SkinOutput>(
        &self,
        pool: &mut WorkerPool,
        blend: Blend,
        palette: &[Affine3A; BONES],
        out: Shared<O>,
    ) -> bool {
        if pool.workers() < SHARES {
            self.all(blend, palette, out);
            return true;
        }
        let duals = self.duals(blend, palette);
        let work = SkinningWork { job: self, blend, palette, duals: &duals, out };
        let (half, all) = (self.layout.half, self.layout.runs.len());
        let share = |_: usize, share: usize| {
            // SAFETY: `WorkerPool::run` calls this once for each share, and the two have different runs of blocks.
            unsafe { work.runs(if share == 0 { 0..half } else { half..all }) };
        };
        pool.run(1, share).is_ok()
    }

    fn duals(&self, blend: Blend, palette: &[Affine3A; BONES]) -> [DualQuat; BONES] {
        match blend {
            Blend::Linear => [DualQuat::IDENTITY; BONES],
            Blend::Dual => dual_palette(palette),
        }
    }
}

/// What the workers of a run share; no two runs of blocks write to the same place.
struct SkinningWork<'a, O> {
    job: &'a SkinningJob,
    blend: Blend,
    palette: &'a [Affine3A; BONES],
    duals: &'a [DualQuat; BONES],
    out: Shared<O>,
}

impl<O: SkinOutput> SkinningWork<'_, O> {
    /// Poses some runs of blocks.
    ///
    /// # Safety
    /// Meanwhile no other thread poses any of these runs, or runs of the same half.
    #[expect(unsafe_code, reason = "the workers share the posed surface")]
    unsafe fn runs(&self, runs: Range<usize>) {
        let SkinLayout { runs: all, filled, rest, .. } = &self.job.layout;
        // SAFETY: each run of the layout, which no code outside of this module can make or change, has blocks of its own, and each half
        // has a spare vertex of its own in a mesh. The caller keeps the halves apart, so no place is written by two threads, and
        // none is read.
        let out = unsafe { self.out.open() };
        let surface = SkinSurface { runs: &all[runs], filled, rest: ReadColumn::new(rest.as_slice()), out };
        match self.blend {
            Blend::Linear => self.job.width.run(Linear { surface, palette: self.palette }),
            Blend::Dual => self.job.width.run(Dual { surface, palette: self.duals }),
        }
    }
}
