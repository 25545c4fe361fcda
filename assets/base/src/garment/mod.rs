//! Garments as the engine steps them: particles, constraints in memory order, what is skinned, how the cloth is shown.

pub mod bend_friction;
pub mod bytes;
mod check;
pub mod direction;
pub mod gather;
pub mod layout;
pub mod link_laws;
pub mod look;
pub mod part;
pub mod solver;
pub mod trim;
pub mod tuck;

use std::ops::{Deref, DerefMut};

use glam::Vec3;

pub use bytes::BytesError;
pub use check::LayoutError;
pub use direction::Direction;
pub use layout::Layout;
pub use look::Look;
pub use part::Part;
pub use solver::Solver;
pub use tuck::Tuck;

use crate::fabric::Fabric;
use crate::mesh::SkinWeights;
use link_laws::ONE_SLOPE;

/// Everything about a garment that kernels check for themselves: names, particles, skinning, pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct GarmentData {
    /// The garment's name.
    pub name: String,
    /// Code of the size.
    pub size: String,
    /// Which layer it is worn in, the innermost lowest: it stays outside of what is worn in lower ones.
    pub layer: u8,
    /// What of it is worn inside of a garment of a lower layer, though its own lies outside.
    pub tuck: Option<Tuck>,
    /// The fabric that it is made of.
    pub fabric: Fabric,
    /// The vertex of the shape that each particle was `[particles]`.
    pub source: Box<[u32]>,
    /// Where each particle starts on the shopper, in the rest pose (m) `[particles]`.
    pub start: Box<[Vec3]>,
    /// Inverse mass (1/kg), 0 where the particle is skinned `[particles]`.
    pub inverse_mass: Box<[f32]>,
    /// The part of the body that each particle can touch `[particles]`.
    pub parts: Box<[Part]>,
    /// Triangles for pictures and normals.
    pub triangles: Box<[[u32; 3]]>,
    /// How they show their cloth.
    pub look: Look,
    /// The particles that are skinned.
    pub fixed: Box<[u32]>,
    /// Their weights, in the order of `fixed`.
    pub fixed_weights: Box<[SkinWeights]>,
    /// Substeps of a step of 1/120 s that the longest load-bearing fiber asks for, at the quality `shop`.
    pub substeps: u32,
    /// Warp and weft edges with their rest lengths (m): what strain is measured on.
    pub strain_edges: Box<[([u32; 2], f32)]>,
    /// The edges of weft fibers that close around the body or a limb: by them it is seen how tight a garment sits.
    pub hoop_edges: Box<[([u32; 2], f32)]>,
}

/// One garment in one size, baked: what the cloth borrows and never changes.
///
/// Its constraints are private. Kernels share them between workers without a check in each step, so they come only through
/// [`Garment::new`], which checks which particles a set holds and whose they are. All other data can be read and changed
/// through [`GarmentData`].
#[derive(Debug, Clone, PartialEq)]
pub struct Garment {
    data: GarmentData,
    layout: Layout,
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
        self.layout.laws.change(|[lower, below, upper, above, _]| [lower, below, upper, above, 0.0]);
    }

    /// Takes away the second slopes of stretch and shear; threads that buckle still do.
    pub fn leave_out_second_slopes(&mut self) {
        let [_, _, far, one, _] = ONE_SLOPE;
        self.layout.laws.change(|[lower, below, _, above, friction]| {
            let locks = below > 1.0;
            let [lower, below] = if locks && above > 1.0 { [-far, one] } else { [lower, below] };
            [lower, below, far, one, friction]
        });
    }

    /// Lets threads that are pushed together bear as much as they pull.
    pub fn leave_out_buckling(&mut self) {
        let [far, one, ..] = ONE_SLOPE;
        self.layout.laws.change(|[lower, below, upper, above, friction]| {
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
        (self.layout.laws.diagonals, self.layout.laws.shear) = (Default::default(), Default::default());
    }

    /// Makes threads that do not stretch.
    pub fn make_inextensible(&mut self) {
        let layout = &mut self.layout;
        let threads = [&mut layout.laws.weft, &mut layout.laws.fibers, &mut layout.laws.crossing];
        threads.into_iter().for_each(|laws| *laws = Default::default());
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
