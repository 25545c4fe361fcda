//! The skinning benchmark: the engine's kernels, linear and dual, against the reference loop, each with its error; and a device's.

pub mod device;
mod error;
mod oracle;

use std::hint::black_box;

use serde::Serialize;
use toile_assets::body::BodyError;
use toile_base::numeric::statistics::median_of;
use toile_engine::lanes::Width;
use toile_engine::skin::{Blend, Padding, Posed, SkinningJob};
use toile_engine::workers::WorkerPool;

use toile_fitting::scene::reference_time::{self, ReferenceTimer};
use toile_fitting::scene::surface::SkinnedSurface;
use toile_fitting::timing;

pub use error::SkinningError;
pub use oracle::SurfaceErrors;

/// Rounds of a measurement: reference loop and kernels in turn, so that both see the machine in the same state. An odd number.
const ROUNDS: usize = 5;

/// What is skinned.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SkinningSubject {
    /// As many vertices as are asked for, each of exactly four influences.
    #[default]
    Four,
    /// The shopper's body with the weights that it has: most vertices have one or two influences.
    Body,
}

/// What is measured, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SkinningOptions {
    /// The skin that is measured.
    pub subject: SkinningSubject,
    /// Vertices; nothing for as many as the body has.
    pub verts: Option<usize>,
    /// Workers, 1 or 2.
    pub threads: usize,
    /// Lanes of the kernels; nothing for the widest of this processor.
    pub lanes: Option<Width>,
}

impl Default for SkinningOptions {
    fn default() -> Self {
        Self { subject: SkinningSubject::Four, verts: Some(reference_time::VERTICES), threads: 1, lanes: None }
    }
}

/// What one blend costs, and how exact it is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Timing {
    /// Time of one pass over all vertices, positions and unit normals (us, median).
    pub us: f64,
    /// The same for one vertex (ns).
    pub ns_per_vertex: f64,
    /// The same over the reference time of as many vertices.
    pub y_ratio: f64,
    /// Time in the order of the mesh, 32 bytes a vertex, ready to be uploaded (us, median).
    pub mesh_order_us: f64,
    /// Largest distance of a position from the f64 oracle (m).
    pub max_error_m: f64,
    /// Largest angle of a normal to the f64 oracle's (rad).
    pub max_normal_error_rad: f64,
}

/// What skinning costs on this machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Skinning {
    /// The skin that was measured.
    pub subject: SkinningSubject,
    /// Vertices that were skinned.
    pub verts: usize,
    /// Number of workers.
    pub threads: usize,
    /// Number of lanes.
    pub lanes: usize,
    /// Reference time, of [`reference_time::VERTICES`] vertices whatever `verts` is (us, median).
    pub yardstick_us: f64,
    /// Blocks, lanes and influences of the job.
    pub padding: Padding,
    /// Time of linear blending.
    pub linear: Timing,
    /// Time of dual quaternions.
    pub dual: Timing,
}

/// Times the engine's skinning, both blends, and finds its errors.
///
/// # Errors
/// Where the processor lacks the lanes asked for, and where the scene's shopper or the workers cannot be made.
pub fn measure(options: &SkinningOptions) -> Result<Skinning, SkinningError> {
    let width = options.lanes.unwrap_or_else(Width::widest);
    if !width.available() {
        return Err(SkinningError::NoSuchLanes(width));
    }
    let surface = subject(options)?;
    let mut job = SkinningJob::new(&surface.positions, &surface.normals, &surface.weights)?;
    job.width = width;
    let mut pool = WorkerPool::new(options.threads)?;
    let reference = ReferenceTimer::new()?;
    let mut rounds: [[Vec<f64>; 2]; 2] = Default::default();
    let mut references = Vec::new();
    for _ in 0..ROUNDS {
        references.push(reference.read_us());
        for (blend, [alone, whole]) in Blend::ALL.into_iter().zip(&mut rounds) {
            let mut run = TimedSkinning { job: &job, surface: &surface, pool: &mut pool, blend };
            alone.push(run.us());
            whole.push(run.mesh_order_us());
        }
    }
    let verts = job.vertices();
    let of_reference = verts as f64 / reference_time::VERTICES as f64;
    let timing = |blend: Blend, [alone, whole]: &[Vec<f64>; 2]| {
        let ratios = alone.iter().zip(&references).map(|(us, reference)| us / (reference * of_reference));
        let error = oracle::compare(&surface, blend, &skinned(&job, &surface, blend));
        let us = median_of(alone.iter().copied()).unwrap_or(0.0);
        Timing {
            us,
            ns_per_vertex: us * 1e3 / verts as f64,
            y_ratio: median_of(ratios).unwrap_or(0.0),
            mesh_order_us: median_of(whole.iter().copied()).unwrap_or(0.0),
            max_error_m: error.position_m,
            max_normal_error_rad: error.normal_rad,
        }
    };
    Ok(Skinning {
        subject: options.subject,
        verts,
        threads: pool.workers(),
        lanes: width.lanes(),
        yardstick_us: median_of(references.iter().copied()).unwrap_or(0.0),
        padding: job.padding(),
        linear: timing(Blend::Linear, &rounds[0]),
        dual: timing(Blend::Dual, &rounds[1]),
    })
}

fn subject(options: &SkinningOptions) -> Result<SkinnedSurface, BodyError> {
    let body = SkinnedSurface::body()?;
    let verts = options.verts.unwrap_or(body.positions.len()).max(1);
    Ok(match options.subject {
        SkinningSubject::Four => body.repeated(verts).with_four_influences(),
        SkinningSubject::Body => body.repeated(verts),
    })
}

/// The surface as a job poses it.
fn skinned(job: &SkinningJob, surface: &SkinnedSurface, blend: Blend) -> Posed {
    let mut posed = job.posed();
    job.run(blend, &surface.palette, &mut posed);
    posed
}

/// The skin that is timed, with its palettes and results.
struct TimedSkinning<'a> {
    job: &'a SkinningJob,
    surface: &'a SkinnedSurface,
    pool: &'a mut WorkerPool,
    blend: Blend,
}

impl TimedSkinning<'_> {
    fn us(&mut self) -> f64 {
        let mut posed = self.job.posed();
        timing::median_us(|| {
            self.job.run_with(self.pool, self.blend, black_box(&self.surface.palette), &mut posed);
            black_box(&posed);
        })
    }

    fn mesh_order_us(&mut self) -> f64 {
        let mut posed = self.job.posed_mesh();
        timing::median_us(|| {
            self.job.run_mesh_with(self.pool, self.blend, black_box(&self.surface.palette), &mut posed);
            black_box(&posed);
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kernels_are_timed_at_their_errors() {
        for subject in [SkinningSubject::Four, SkinningSubject::Body] {
            let found =
                measure(&SkinningOptions { subject, verts: Some(1_001), ..SkinningOptions::default() }).unwrap();
            assert_eq!((found.verts, found.padding.vertices), (1_001, 1_001));
            assert!(found.yardstick_us > 0.0 && found.padding.lanes >= 1_001);
            for timing in [found.linear, found.dual] {
                assert!(timing.us > 0.0 && timing.mesh_order_us > 0.0);
                assert!((timing.ns_per_vertex - timing.us * 1e3 / 1_001.0).abs() < 1e-9);
                // Positions are up to 2 m: a few roundings of f32 there, and never exactly none.
                assert!((1e-9..2e-6).contains(&timing.max_error_m), "{} m", timing.max_error_m);
                assert!(timing.max_normal_error_rad < 1e-5, "{} rad", timing.max_normal_error_rad);
            }
        }
    }

    #[test]
    fn every_vertex_of_the_synthetic_surface_has_four_influences() {
        let surface = subject(&SkinningOptions { verts: Some(3_000), ..SkinningOptions::default() }).unwrap();
        for w in &surface.weights {
            assert_eq!(w.iter().count(), 4);
            assert!((w.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
            let mut bones = w.bones;
            bones.sort_unstable();
            assert!(bones.windows(2).all(|b| b[0] < b[1]), "{bones:?}");
        }
    }
}
