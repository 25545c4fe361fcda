//! A posed surface: what skinning writes, in the order of its blocks, and the way back to the order of the mesh.

use std::sync::Arc;

use glam::Vec3;

use crate::lanes::{MOST, Store, WriteColumn};

/// Numbers of a posed block: three coordinates of position and three of normal, [`MOST`] of each.
pub(super) const BLOCK: usize = 6 * MOST;

/// World positions (m) and unit normals of a skin. Made by [`super::SkinningJob::posed`]; copies of it are made at load
/// and then filled again and again.
#[derive(Debug, Clone, PartialEq)]
pub struct Posed {
    /// Positions (m) and normals by column `[blocks][6][MOST]`.
    columns: Store,
    /// Lane of each vertex, counted over all blocks `[vertices]`.
    places: Arc<[u32]>,
}

impl Posed {
    pub(super) fn new(blocks: usize, places: Arc<[u32]>) -> Self {
        Self { columns: Store::zeros(blocks * BLOCK), places }
    }

    pub(super) fn column(&mut self) -> WriteColumn<'_> {
        self.columns.column()
    }

    pub(super) fn set(&mut self, vertex: usize, position: Vec3, normal: Vec3) {
        let place = self.places[vertex] as usize;
        let first = place / MOST * BLOCK + place % MOST;
        let numbers = position.to_array().into_iter().chain(normal.to_array());
        numbers.enumerate().for_each(|(k, x)| self.columns.as_mut()[first + k * MOST] = x);
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.places.len()
    }

    /// World position of a vertex of the mesh (m).
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn position(&self, vertex: usize) -> Vec3 {
        self.three(self.places[vertex], 0)
    }

    /// Unit normal of a vertex of the mesh.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn normal(&self, vertex: usize) -> Vec3 {
        self.three(self.places[vertex], 3)
    }

    /// All of it in the order of the mesh: positions (m) and unit normals `[vertices]`. Shorter outputs are filled as
    /// far as they go.
    pub fn read(&self, positions: &mut [Vec3], normals: &mut [Vec3]) {
        for ((&place, p), n) in self.places.iter().zip(positions).zip(normals) {
            (*p, *n) = (self.three(place, 0), self.three(place, 3));
        }
    }

    /// Where a vertex of the mesh is in what [`Self::columns_to`] fills.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn place(&self, vertex: usize) -> u32 {
        self.places[vertex]
    }

    /// How many places there are; of some no vertex is.
    pub fn places(&self) -> usize {
        self.columns.as_slice().len() / BLOCK * MOST
    }

    /// Copies positions (m) and unit normals to columns in the order of the places `[places]`: no vertex is looked up. Shorter
    /// columns are filled as far as they go.
    pub fn columns_to(&self, columns: [&mut [f32]; 6]) {
        let (blocks, _) = self.columns.as_slice().as_chunks::<BLOCK>();
        for (k, column) in columns.into_iter().enumerate() {
            let (to, _) = column.as_chunks_mut::<MOST>();
            let from = blocks.iter().map(|block| &block[k * MOST..(k + 1) * MOST]);
            to.iter_mut().zip(from).for_each(|(to, from)| to.copy_from_slice(from));
        }
    }

    #[inline]
    fn three(&self, place: u32, first: usize) -> Vec3 {
        let (blocks, _) = self.columns.as_slice().as_chunks::<BLOCK>();
        let (block, lane) = (&blocks[place as usize / MOST], place as usize % MOST);
        Vec3::new(block[first * MOST + lane], block[(first + 1) * MOST + lane], block[(first + 2) * MOST + lane])
    }
}
