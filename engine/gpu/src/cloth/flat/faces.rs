//! Faces: the triangles that meet at each particle, in the order in which the CPU sums their normals.

use toile_base::garment::Garment;
use toile_base::mesh::vertex_normals;

use super::{GarmentSpan, Workgroups};

/// Faces of all garments.
#[derive(Debug, Clone, Default)]
pub struct FlatFaces {
    /// First entry of each particle in `incident` `[particles + 1]`.
    pub starts: Vec<u32>,
    /// Triangles incident to each particle; a triangle counts once a corner.
    pub incident: Vec<u32>,
    /// Particles of each triangle, counter-clockwise seen from outside `[triangles]`.
    pub corners: Vec<[u32; 3]>,
    /// Unit normals where the garments start `[particles]`.
    pub normals: Vec<[f32; 4]>,
    /// Workgroups over the triangles.
    pub groups: Workgroups,
}

impl FlatFaces {
    /// Appends the triangles of one garment.
    pub fn add(&mut self, garment: &Garment, span: GarmentSpan) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        let first = self.corners.len() as u32;
        let mut at: Vec<Vec<u32>> = vec![Vec::new(); garment.particles()];
        for (face, triangle) in (first..).zip(&garment.triangles) {
            triangle.iter().for_each(|&i| at[i as usize].push(face));
            self.corners.push(triangle.map(|i| span.first + i));
        }
        for faces in at {
            self.incident.extend(faces);
            self.starts.push(self.incident.len() as u32);
        }
        self.groups.add(span.garment, first, garment.triangles.len() as u32, 0);
        let mut normals = vec![glam::Vec3::ZERO; garment.particles()];
        vertex_normals(&garment.start, &garment.triangles, &mut normals);
        self.normals.extend(normals.iter().map(|n| [n.x, n.y, n.z, 0.0]));
    }
}
