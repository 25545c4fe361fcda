//! The baked garment: its data, and constraints that were checked against them.

use std::ops::Deref;
use std::sync::Arc;

use glam::Vec3;

use super::check::{self, LayoutError};
use super::data::GarmentData;
use super::layout::Layout;
use super::look::GarmentAppearance;
use super::tuck::Tuck;
use crate::fabric::Fabric;

/// One garment in one size, baked: what the cloth borrows and never changes.
///
/// Kernels share its constraints between workers without a check in each step. So constraints and data come together through
/// [`Garment::new`] alone, which checks which particles a set holds and whose they are. All data can be read through [`GarmentData`]. The
/// data that no check depends on have setters here; all other data change by [`Garment::into_parts`] and [`Garment::new`].
#[derive(Debug, Clone, PartialEq)]
pub struct Garment {
    pub(super) data: GarmentData,
    pub(super) layout: Arc<Layout>,
}

impl Deref for Garment {
    type Target = GarmentData;

    fn deref(&self) -> &GarmentData {
        &self.data
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
        Ok(Self { data, layout: Arc::new(layout) })
    }

    /// Takes a garment apart, to change its constraints and to put it together again.
    pub fn into_parts(self) -> (GarmentData, Layout) {
        (self.data, Arc::unwrap_or_clone(self.layout))
    }

    /// The constraints between its particles, as they lie in memory.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The same constraints, shared. Clones of a garment have one and the same, and with it the same number of particles, the same
    /// masses and the same skinned particles. Garments that were baked or read apart have different ones, even if these are equal.
    pub fn shared_layout(&self) -> &Arc<Layout> {
        &self.layout
    }

    /// Changes the garment's name.
    pub fn set_name(&mut self, name: String) {
        self.data.name = name;
    }

    /// Changes the layer that it is worn in.
    pub fn set_layer(&mut self, layer: u8) {
        self.data.layer = layer;
    }

    /// Changes the substeps of a step of 1/120 s at the quality `shop`.
    pub fn set_substeps(&mut self, substeps: u32) {
        self.data.substeps = substeps;
    }

    /// Changes what of it is tucked in.
    ///
    /// # Errors
    /// [`LayoutError::Length`] where the tuck does not say of each particle whether it is tucked in.
    pub fn set_tuck(&mut self, tuck: Option<Tuck>) -> Result<(), LayoutError> {
        if let Some(tuck) = &tuck {
            check::tuck(tuck, self.particles())?;
        }
        self.data.tuck = tuck;
        Ok(())
    }

    /// The fabric, to be changed. Constraints keep the stiffness that they were baked with.
    pub fn fabric_mut(&mut self) -> &mut Fabric {
        &mut self.data.fabric
    }

    /// The look of the cloth, to be changed.
    pub fn look_mut(&mut self) -> &mut GarmentAppearance {
        &mut self.data.look
    }

    /// Where each particle starts, to be changed (m) `[particles]`.
    pub fn start_mut(&mut self) -> &mut [Vec3] {
        &mut self.data.start
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::garment::part::Part;
    use crate::mesh::SkinWeights;

    /// A garment of two particles, the first of them skinned.
    fn pair() -> Garment {
        let data = GarmentData {
            name: "pair".into(),
            size: "one".into(),
            layer: 0,
            tuck: None,
            fabric: Fabric::cotton_lawn(),
            source: [0, 1].into(),
            start: [Vec3::ZERO, Vec3::X].into(),
            inverse_mass: [0.0, 1.0].into(),
            parts: [Part::All; 2].into(),
            triangles: Box::default(),
            look: GarmentAppearance::default(),
            fixed: [0].into(),
            fixed_weights: [SkinWeights::default()].into(),
            substeps: 1,
            strain_edges: Box::default(),
            hoop_edges: Box::default(),
        };
        let layout = Layout { spans: [vec![(0, 2)], Vec::new()], owner: [0, 0].into(), ..Layout::default() };
        Garment::new(data, layout).unwrap()
    }

    #[test]
    fn only_clones_share_their_constraints() {
        let (one, other) = (pair(), pair());
        let mut clone = one.clone();
        clone.set_layer(3);
        clone.fabric_mut().friction = 0.0;
        assert!(Arc::ptr_eq(one.shared_layout(), clone.shared_layout()), "no setter touches the constraints");
        assert_eq!(one, other, "equal");
        assert!(!Arc::ptr_eq(one.shared_layout(), other.shared_layout()), "and yet made apart");
        let (data, layout) = one.clone().into_parts();
        let again = Garment::new(data, layout).unwrap();
        assert!(!Arc::ptr_eq(one.shared_layout(), again.shared_layout()), "masses may have changed meanwhile");
    }

    #[test]
    fn a_tuck_knows_every_particle() {
        let mut garment = pair();
        let tuck = |particles: &[bool]| Some(Tuck { into: 0, band: 1.0, particles: particles.into() });
        let error = garment.set_tuck(tuck(&[true])).unwrap_err();
        assert_eq!(error, LayoutError::Length { what: "tuck.particles", found: 1, needed: 2 });
        assert!(garment.tuck.is_none(), "what was refused is not kept");
        garment.set_tuck(tuck(&[true, false])).unwrap();
        assert!(garment.tuck.is_some());
    }

    #[test]
    fn skinned_particles_follow_bones_that_exist() {
        let (mut data, layout) = pair().into_parts();
        data.fixed_weights[0].bones[0] = u8::MAX;
        let error = Garment::new(data, layout).unwrap_err();
        assert!(matches!(error, LayoutError::Bounds { what: "fixed_weights", found: 255, .. }), "{error}");
    }
}
