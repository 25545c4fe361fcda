//! A posed surface in the order of its mesh: what is uploaded or drawn as it is.

use bytemuck::{Pod, Zeroable};

use crate::lanes::{DOUBLE, Store, WriteColumn};
use crate::workers::SHARES;

/// A vertex as shading languages lay out two vectors of three numbers: 32 bytes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PosedVertex {
    /// World position (m).
    pub position: [f32; 3],
    /// 0.
    pub after_position: f32,
    /// Unit normal; zero where the blend collapses it.
    pub normal: [f32; 3],
    /// 0.
    pub after_normal: f32,
}

const _: () = assert!(size_of::<PosedVertex>() == DOUBLE * size_of::<f32>(), "a vertex is a double record");

/// World positions (m) and unit normals of a skin, a vertex of the mesh after the other. Made by
/// [`super::SkinningJob::posed_mesh`]; copies of it are made at load and then filled again and again.
#[derive(Debug, Clone, PartialEq)]
pub struct PosedMesh {
    /// A double record a vertex, and a spare one a worker for the lanes that carry none.
    records: Store,
    vertices: usize,
}

impl PosedMesh {
    pub(super) fn new(vertices: usize) -> Self {
        Self { records: Store::zeros((vertices + SHARES) * DOUBLE), vertices }
    }

    pub(super) fn column(&mut self) -> WriteColumn<'_> {
        self.records.column()
    }

    /// All vertices in the order of the mesh. As bytes (`bytemuck::cast_slice`) they are a vertex buffer.
    pub fn vertices(&self) -> &[PosedVertex] {
        &bytemuck::cast_slice(self.records.as_slice())[..self.vertices]
    }

    pub(super) fn vertices_mut(&mut self) -> &mut [PosedVertex] {
        &mut bytemuck::cast_slice_mut(self.records.as_mut())[..self.vertices]
    }
}
