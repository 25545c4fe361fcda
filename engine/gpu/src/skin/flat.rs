//! Skins flattened into the kernels' arrays, one behind the other, in workgroups of 64.

use std::ops::Range;

use glam::Vec3;
use toile_base::skeleton::BONES;
use toile_engine::skin::{LaidVertex, SkinningJob};

use crate::cloth::flat::{WIDTH, Workgroups};

/// A vertex at rest; the struct `Vertex` of `shaders/skin.wgsl`, field by field.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct FlatVertex {
    /// Rest position (m).
    pub position: [f32; 3],
    /// Its run, counted over all bodies.
    pub run: u32,
    /// Its unit normal, or zero.
    pub normal: [f32; 3],
    /// Its number, counted over all bodies in the order of their meshes.
    pub place: u32,
}

const _: () = assert!(size_of::<FlatVertex>() == 32, "`Vertex` in skin.wgsl is 32 bytes");

/// The skins of a scene, laid flat.
#[derive(Debug, Clone, Default)]
pub struct FlatSkins {
    /// The vertices of each body, in the order of its mesh.
    pub spans: Vec<Range<usize>>,
    /// Workgroups: body, first vertex as laid, number of vertices, first weight.
    pub groups: Workgroups,
    /// Eight bones, a byte each; how many; the body's first bone in the palette `[runs]`.
    pub runs: Vec<[u32; 4]>,
    /// Vertices in the order of their runs, body after body `[vertices]`.
    pub vertices: Vec<FlatVertex>,
    /// What the bones but the first weigh: for each workgroup as many rows as its vertices need `[rows][64]`.
    pub weights: Vec<f32>,
    /// Places at rest (m), in the order of the meshes, 1 behind each `[vertices]`.
    pub positions: Vec<[f32; 4]>,
    /// Unit normals at rest likewise, 0 behind each `[vertices]`.
    pub normals: Vec<[f32; 4]>,
}

impl FlatSkins {
    /// Lays skins flat.
    pub fn new(jobs: &[&SkinningJob]) -> Self {
        let mut flat = Self::default();
        for (body, job) in (0..).zip(jobs) {
            flat.add(body, job);
        }
        flat
    }

    /// Bytes of the largest buffer.
    pub fn largest(&self) -> usize {
        let palette = 16 * super::kernels::ROWS * BONES * self.spans.len();
        [size_of_val(&*self.vertices), size_of_val(&*self.weights), palette].into_iter().max().unwrap_or(0)
    }

    fn add(&mut self, body: u32, job: &SkinningJob) {
        let (first, first_run) = (self.vertices.len(), self.runs.len() as u32);
        let bones: Vec<&[u8]> = job.runs().collect();
        self.runs.extend(bones.iter().map(|bones| run(body, bones)));
        let laid: Vec<LaidVertex> = job.laid().collect();
        self.groups.begin(body);
        for group in laid.chunks(WIDTH as usize) {
            let at = [self.vertices.len(), group.len(), self.weights.len()].map(|n| n as u32);
            self.groups.push([body, at[0], at[1], at[2]]);
            let most = group.iter().map(|laid| bones[laid.run].len()).max().unwrap_or(1);
            for k in 0..most - 1 {
                let row = group.iter().map(|laid| laid.weights[k]);
                self.weights.extend(row.chain(std::iter::repeat(0.0)).take(WIDTH as usize));
            }
            self.vertices.extend(group.iter().map(|laid| FlatVertex {
                position: laid.position.to_array(),
                run: first_run + laid.run as u32,
                normal: laid.normal.to_array(),
                place: (first + laid.vertex) as u32,
            }));
        }
        let rest = job.posed();
        let four = |v: Vec3, w: f32| [v.x, v.y, v.z, w];
        self.positions.extend((0..rest.vertices()).map(|v| four(rest.position(v), 1.0)));
        self.normals.extend((0..rest.vertices()).map(|v| four(rest.normal(v), 0.0)));
        self.spans.push(first..self.vertices.len());
    }
}

/// A run's bones, packed.
fn run(body: u32, bones: &[u8]) -> [u32; 4] {
    let mut packed = [0u8; 8];
    packed.iter_mut().zip(bones).for_each(|(to, bone)| *to = *bone);
    let four = |k: usize| u32::from_le_bytes([packed[k], packed[k + 1], packed[k + 2], packed[k + 3]]);
    [four(0), four(4), bones.len() as u32, body * BONES as u32]
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::limits::MAX_INFLUENCES;
    use toile_base::mesh::WideWeights;

    /// Vertices on one to eight bones.
    fn skin(vertices: usize) -> (SkinningJob, Vec<WideWeights>) {
        let points: Vec<Vec3> = (0..vertices).map(|v| Vec3::new(v as f32, 1.0, 0.0)).collect();
        let weights: Vec<WideWeights> = (0..vertices)
            .map(|v| {
                let count = 1 + v % MAX_INFLUENCES;
                let weight = |k: usize| if k < count { 1.0 / count as f32 } else { 0.0 };
                WideWeights {
                    bones: std::array::from_fn(|k| (v / 90 + 3 * k) as u8),
                    weights: std::array::from_fn(weight),
                }
            })
            .collect();
        (SkinningJob::new(&points, &points, &weights).expect("it is a skin"), weights)
    }

    #[test]
    fn every_vertex_of_every_body_is_laid_once_with_its_own_weights() {
        let ((one, few), (other, many)) = (skin(100), skin(333));
        let flat = FlatSkins::new(&[&one, &other]);
        assert_eq!(flat.spans, [0..100, 100..433]);
        assert_eq!(flat.groups.of(1), 2, "the first body's workgroups are a prefix");
        let mut seen = [false; 433];
        for group in &flat.groups.groups {
            let [body, first, count, weight] = group.map(|n| n as usize);
            for lane in 0..count {
                let vertex = flat.vertices[first + lane];
                let place = vertex.place as usize;
                assert!(!std::mem::replace(&mut seen[place], true), "vertex {place} is laid twice");
                assert!(flat.spans[body].contains(&place));
                assert_eq!(vertex.position, flat.positions[place][..3]);
                let [low, high, bones, palette] = flat.runs[vertex.run as usize];
                assert_eq!(palette as usize, body * BONES);
                let packed = [low.to_le_bytes(), high.to_le_bytes()].concat();
                let given = if body == 0 { &few[place] } else { &many[place - 100] };
                let given = |bone: u8| given.iter().filter(|(b, _)| *b == bone).map(|(_, w)| w).sum::<f32>();
                for (row, &bone) in packed[1..bones as usize].iter().enumerate() {
                    let got = flat.weights[weight + row * WIDTH as usize + lane];
                    assert_eq!(got, given(bone), "vertex {place}, bone {bone}");
                }
            }
        }
        assert!(seen.iter().all(|s| *s));
    }

    #[test]
    fn no_skin_needs_nothing() {
        let flat = FlatSkins::new(&[]);
        assert_eq!((flat.groups.groups.len(), flat.largest()), (0, 0));
    }
}
