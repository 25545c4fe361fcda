//! The baked garment: its data, and constraints that were checked against them.

use std::ops::{Deref, DerefMut};

use super::check::{self, LayoutError};
use super::data::GarmentData;
use super::layout::Layout;

/// One garment in one size, baked: what the cloth borrows and never changes.
///
/// Its constraints are private. Kernels share them between workers without a check in each step, so they come only through
/// [`Garment::new`], which checks which particles a set holds and whose they are. All other data can be read and changed
/// through [`GarmentData`].
#[derive(Debug, Clone, PartialEq)]
pub struct Garment {
    pub(super) data: GarmentData,
    pub(super) layout: Layout,
}

impl Deref for Garment {
    type Target = GarmentData;

    fn deref(&self) -> &GarmentData {
        &self.data
    }
}

impl DerefMut for Garment {
    fn deref_mut(&mut self) -> &mut GarmentData {
        &mut self.data
    }
}

impl Garment {
    /// Puts a garment together.
    ///
    /// # Errors
    /// [`LayoutError`] where two workers could meet at one particle, where an index leads past the particles or past the
    /// parameters, or where an array of the data does not have one entry a particle.
    pub fn new(data: GarmentData, layout: Layout) -> Result<Self, LayoutError> {
        check::check(&data, &layout)?;
        Ok(Self { data, layout })
    }

    /// Takes a garment apart, to change its constraints and to put it together again.
    pub fn into_parts(self) -> (GarmentData, Layout) {
        (self.data, self.layout)
    }

    /// The constraints between its particles, as they lie in memory.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.start.len()
    }

    /// Bytes that the cloth borrows: the constraints, and what is kept of each particle and triangle.
    pub fn bytes(&self) -> usize {
        self.layout.bytes()
            + size_of_val(&*self.source)
            + size_of_val(&*self.start)
            + size_of_val(&*self.inverse_mass)
            + size_of_val(&*self.parts)
            + self.tuck.as_ref().map_or(0, |tuck| size_of_val(&*tuck.particles))
            + size_of_val(&*self.triangles)
            + self.look.bytes()
            + size_of_val(&*self.fixed)
            + size_of_val(&*self.fixed_weights)
            + size_of_val(&*self.strain_edges)
            + size_of_val(&*self.hoop_edges)
    }
}
