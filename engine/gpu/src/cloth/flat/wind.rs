//! Wind: triangles, and for each particle those around it, in the order in which the CPU adds them up.

use toile_base::garment::Garment;
use toile_engine::cloth::forces::wind::Faces;

use super::{GarmentSpan, Workgroups};

/// Triangles of all garments.
#[derive(Debug, Clone, Default)]
pub struct FlatWind {
    /// Corners, and the bits of the mass that moves with the triangle (kg) `[triangles]`.
    pub faces: Vec<[u32; 4]>,
    /// Where each particle's triangles begin `[particles + 1]`.
    pub starts: Vec<u32>,
    /// The triangles around each particle, in order.
    pub around: Vec<u32>,
    /// Workgroups over the triangles.
    pub groups: Workgroups,
}

impl FlatWind {
    /// Appends the triangles of one garment.
    pub fn add(&mut self, garment: &Garment, span: GarmentSpan) {
        let faces = Faces::new(&garment.triangles, &garment.start, &garment.inverse_mass, &garment.layout().owner);
        let begun = self.faces.len() as u32;
        let flat = faces.triangles().map(|([a, b, c], mass)| {
            let [a, b, c] = [a, b, c].map(|i| span.first + i);
            [a, b, c, mass.to_bits()]
        });
        self.faces.extend(flat);
        let mut sums = Vec::new();
        faces.sums(|face, particle| sums.push((particle, begun + face)));
        // By particle, each one's in their order.
        sums.sort_by_key(|(particle, _)| *particle);
        let mut sums = sums.into_iter().peekable();
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        for particle in 0..span.len {
            while let Some((_, face)) = sums.next_if(|(p, _)| *p == particle) {
                self.around.push(face);
            }
            self.starts.push(self.around.len() as u32);
        }
        self.groups.add(span.garment, begun, self.faces.len() as u32 - begun, 0);
    }
}
