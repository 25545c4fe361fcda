//! The baked garment: its data, and constraints that were checked against them.

use std::ops::{Deref, DerefMut};

use super::check::{self, LayoutError};
use super::data::GarmentData;
use super::layout::{self, Layout};
use super::link_curves::ONE_SLOPE;

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

    /// Takes away the resistance to bending: to see what bending is worth.
    pub fn leave_out_bending(&mut self) {
        let layout = &mut self.layout;
        (layout.bends, layout.skewed, layout.hubs) = (Default::default(), Default::default(), Default::default());
        layout.friction = Default::default();
    }

    /// Takes away the friction in shear and stretch.
    pub fn leave_out_link_friction(&mut self) {
        self.layout.link_curves.change(|[lower, below, upper, above, _]| [lower, below, upper, above, 0.0]);
    }

    /// Takes away the second slopes of stretch and shear; threads that buckle still do.
    pub fn leave_out_second_slopes(&mut self) {
        let [_, _, far, one, _] = ONE_SLOPE;
        self.layout.link_curves.change(|[lower, below, _, above, friction]| {
            let locks = below > 1.0;
            let [lower, below] = if locks && above > 1.0 { [-far, one] } else { [lower, below] };
            [lower, below, far, one, friction]
        });
    }

    /// Lets threads that are pushed together bear as much as they pull.
    pub fn leave_out_buckling(&mut self) {
        let [far, one, ..] = ONE_SLOPE;
        self.layout.link_curves.change(|[lower, below, upper, above, friction]| {
            let [lower, below] = if below < 1.0 { [far, one] } else { [lower, below] };
            [lower, below, upper, above, friction]
        });
    }

    /// Takes away the friction in bending: to see what it is worth.
    pub fn leave_out_bend_friction(&mut self) {
        self.layout.friction = Default::default();
    }

    /// Takes away the resistance to shear.
    pub fn leave_out_shear(&mut self) {
        (self.layout.diagonals, self.layout.shear) = (Default::default(), Default::default());
        (self.layout.link_curves.diagonals, self.layout.link_curves.shear) = (Default::default(), Default::default());
    }

    /// Makes threads that do not stretch.
    pub fn make_inextensible(&mut self) {
        let layout = &mut self.layout;
        let threads = [&mut layout.link_curves.weft, &mut layout.link_curves.fibers, &mut layout.link_curves.crossing];
        threads.into_iter().for_each(|link_curves| *link_curves = Default::default());
        let all = [&mut layout.weft.compliance, &mut layout.fibers.compliance, &mut layout.crossing.compliance];
        all.into_iter().flat_map(|c| c.iter_mut()).filter(|c| **c < layout::ENDED).for_each(|c| *c = 0.0);
    }

    /// Compliance of each link of the load-bearing fibers (m/N, in the layout's order), for a hard case that softens some.
    pub fn fiber_compliance_mut(&mut self) -> &mut [f32] {
        &mut self.layout.fibers.compliance
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
