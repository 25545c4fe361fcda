//! Reference time of a machine: plain scalar linear-blend skinning of 15,000 vertices with four influences each, position
//! and normal. Times on different machines are compared through it.

use std::hint::black_box;

use glam::Affine3A;
use toile_assets::body::BodyError;
use toile_engine::lanes::{Kernel, Lanes, Width};

use super::surface::SkinnedSurface;
use crate::timing;

/// Vertices of the reference, by the benchmark scene.
pub const VERTICES: usize = 15_000;

/// Three rows of four: the rotation, then the translation, of each row.
type Matrix = [[f32; 4]; 3];

/// One vertex as a plain loop would keep it.
#[derive(Debug, Clone, Copy)]
struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
    bones: [u8; 4],
    weights: [f32; 4],
}

/// The reference work, prepared so that it can be timed more than once in a run.
#[derive(Debug)]
pub struct ReferenceTimer {
    vertices: Vec<Vertex>,
    palette: Vec<Matrix>,
}

impl ReferenceTimer {
    /// Prepares the reference on the scene's shopper.
    ///
    /// # Errors
    /// Where she cannot be built.
    pub fn new() -> Result<Self, BodyError> {
        let surface = SkinnedSurface::new(VERTICES)?;
        Ok(Self { vertices: vertices(&surface), palette: surface.palette.iter().map(rows).collect() })
    }

    /// Its time on this machine now (us, median of many passes).
    pub fn read_us(&self) -> f64 {
        let (mut posed, width) = (vec![[[0.0; 3]; 2]; VERTICES], Width::widest());
        timing::median_us(|| {
            let (palette, vertices) = black_box((&self.palette, &self.vertices));
            width.run(PlainBlend { palette, vertices, posed: &mut posed });
            black_box(&posed);
        })
    }
}

/// Reference time of this machine (us, median).
///
/// # Errors
/// Where the scene's shopper cannot be built.
pub fn measure() -> Result<f64, BodyError> {
    Ok(ReferenceTimer::new()?.read_us())
}

fn vertices(surface: &SkinnedSurface) -> Vec<Vertex> {
    let parts = surface.positions.iter().zip(&surface.normals).zip(&surface.weights);
    let vertex = |((p, n), w): ((&glam::Vec3, &glam::Vec3), &toile_base::mesh::SkinWeights)| Vertex {
        position: p.to_array(),
        normal: n.to_array(),
        bones: w.bones,
        weights: w.weights,
    };
    parts.map(vertex).collect()
}

fn rows(matrix: &Affine3A) -> Matrix {
    let m = matrix.matrix3.to_cols_array_2d();
    let t = matrix.translation.to_array();
    std::array::from_fn(|row| [m[0][row], m[1][row], m[2][row], t[row]])
}

/// The loop, compiled for the instructions that this processor has: nothing in it asks for lanes, but the compiler may.
struct PlainBlend<'a> {
    palette: &'a [Matrix],
    vertices: &'a [Vertex],
    posed: &'a mut [[[f32; 3]; 2]],
}

impl Kernel for PlainBlend<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        blend(self.palette, self.vertices, self.posed);
    }
}

/// The loop itself: every influence moves the vertex, and the weighted sum is where it ends. The normals keep the
/// length that the sum gives them.
#[inline(always)]
fn blend(palette: &[Matrix], vertices: &[Vertex], posed: &mut [[[f32; 3]; 2]]) {
    for (vertex, posed) in vertices.iter().zip(posed) {
        let ([x, y, z], [nx, ny, nz]) = (vertex.position, vertex.normal);
        let mut sum = [[0.0; 3]; 2];
        for (&bone, &weight) in vertex.bones.iter().zip(&vertex.weights) {
            for (axis, row) in palette[usize::from(bone)].iter().enumerate() {
                sum[0][axis] += weight * (row[0] * x + row[1] * y + row[2] * z + row[3]);
                sum[1][axis] += weight * (row[0] * nx + row[1] * ny + row[2] * nz);
            }
        }
        *posed = sum;
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use toile_engine::skin::{Blend, SkinningJob};

    use super::*;

    #[test]
    fn the_reference_does_the_work_of_the_engine() {
        let surface = SkinnedSurface::new(VERTICES).unwrap();
        let palette: Vec<Matrix> = surface.palette.iter().map(rows).collect();
        let mut posed = vec![[[0.0; 3]; 2]; VERTICES];
        blend(&palette, &vertices(&surface), &mut posed);
        let (mut positions, mut normals) = (surface.positions.clone(), surface.normals.clone());
        let job = SkinningJob::new(&surface.positions, &surface.normals, &surface.weights).unwrap();
        let mut shown = job.posed();
        job.run(Blend::Linear, &surface.palette, &mut shown);
        shown.read(&mut positions, &mut normals);
        for (i, [position, normal]) in posed.iter().enumerate() {
            assert!(Vec3::from_array(*position).distance(positions[i]) < 1e-5, "vertex {i}");
            assert!(Vec3::from_array(*normal).normalize().distance(normals[i]) < 1e-4, "vertex {i}");
        }
        let moved = positions.iter().zip(&surface.positions).filter(|(a, b)| a.distance(**b) > 0.05).count();
        assert!(moved > VERTICES / 10, "the pose bends the body: {moved} vertices moved");
    }
}
