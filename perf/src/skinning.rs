//! The skinning benchmark: the engine's kernel, the yardstick of the machine, and the error against f64.

use std::hint::black_box;

use glam::{Affine3A, DVec3, Vec3};
use thiserror::Error;
use toile_assets::body::BodyError;
use toile_assets::mesh::SkinWeights;
use toile_assets::skeleton::BONES;
use toile_engine::skin::{SkinError, SkinningJob};

use crate::surface::Surface;
use crate::{time, yardstick};

/// What skinning costs on this machine, and how exact it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Skinning {
    /// Vertices skinned.
    pub verts: usize,
    /// Time of one pass over all of them, positions and normals (us, median).
    pub us: f64,
    /// The same for one vertex (ns).
    pub ns_per_vertex: f64,
    /// Time of the yardstick, [`yardstick::VERTICES`] vertices whatever `verts` is (us, median).
    pub yardstick_us: f64,
    /// Largest distance of a position from the f64 oracle (m).
    pub max_error_m: f64,
}

/// Why the benchmark cannot run: neither happens unless the scene's shopper is broken.
#[derive(Debug, Error)]
pub enum BenchError {
    /// The shopper's body.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// The shopper's skin.
    #[error(transparent)]
    Skin(#[from] SkinError),
}

/// Times the engine's skinning of `verts` vertices, at least 1, and finds its error.
///
/// # Errors
/// Where the scene's shopper cannot be built.
pub fn measure(verts: usize) -> Result<Skinning, BenchError> {
    let verts = verts.max(1);
    let surface = Surface::new(verts)?;
    let job = SkinningJob::new(&surface.positions, &surface.normals, &surface.weights)?;
    let (mut positions, mut normals) = (vec![Vec3::ZERO; verts], vec![Vec3::ZERO; verts]);
    let us = time::median_us(|| {
        job.run(black_box(&surface.palette), &mut positions, &mut normals);
        black_box((&positions, &normals));
    });
    Ok(Skinning {
        verts,
        us,
        ns_per_vertex: us * 1e3 / verts as f64,
        yardstick_us: yardstick::measure()?,
        max_error_m: max_error(&surface, &positions),
    })
}

/// Largest distance of posed positions from the oracle (m).
fn max_error(surface: &Surface, posed: &[Vec3]) -> f64 {
    let vertices = surface.positions.iter().zip(&surface.weights).zip(posed);
    let error =
        |((p, w), posed): ((&Vec3, &SkinWeights), &Vec3)| oracle(&surface.palette, *p, w).distance(posed.as_dvec3());
    // Not `f64::max`, which passes over what is not a number.
    vertices.map(error).fold(0.0, |worst, e| if e > worst || e.is_nan() { e } else { worst })
}

/// The plain sum of weighted matrices in f64; weights are brought to a sum of 1 as the engine does at load.
fn oracle(palette: &[Affine3A; BONES], rest: Vec3, weights: &SkinWeights) -> DVec3 {
    let sum: f64 = weights.weights.iter().map(|w| f64::from(*w)).sum();
    let influence = |(bone, weight): (&u8, &f32)| {
        let m = &palette[usize::from(*bone)];
        let [x, y, z] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis].map(|c| Vec3::from(c).as_dvec3());
        let p = rest.as_dvec3();
        let moved = x * p.x + y * p.y + z * p.z + Vec3::from(m.translation).as_dvec3();
        moved * (f64::from(*weight) / sum)
    };
    weights.bones.iter().zip(&weights.weights).map(influence).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernel_is_timed_at_its_error() {
        let found = measure(1_001).unwrap();
        assert_eq!(found.verts, 1_001);
        assert!(found.us > 0.0 && found.yardstick_us > 0.0);
        assert!((found.ns_per_vertex - found.us * 1e3 / 1_001.0).abs() < 1e-9);
        // Positions are up to 2 m: a few roundings of f32 there, and never exactly none.
        assert!((1e-9..1e-6).contains(&found.max_error_m), "{} m", found.max_error_m);
    }

    #[test]
    fn a_wrong_position_is_found() {
        let surface = Surface::new(100).unwrap();
        let job = SkinningJob::new(&surface.positions, &surface.normals, &surface.weights).unwrap();
        let (mut positions, mut normals) = (vec![Vec3::ZERO; 100], vec![Vec3::ZERO; 100]);
        job.run(&surface.palette, &mut positions, &mut normals);
        positions[71].y += 0.003;
        assert!((max_error(&surface, &positions) - 0.003).abs() < 1e-5);
        positions[20].x = f32::NAN;
        positions[30].x += 1.0;
        assert!(max_error(&surface, &positions).is_nan(), "what is not a number is the largest error");
    }
}
