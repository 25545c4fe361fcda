//! How the clusters of a garment lie and move at the start of a step.

use glam::Vec3A;

use crate::cloth::state::{ParticleColumns, get};
use crate::lanes::{MOST, ReadColumn, Store};
use crate::surface::Clusters;

/// The columns of [`FoldMotion`]: mean normal, least cosine to it, mean velocity (m/s), how far others are from that (m/s).
const COLUMNS: usize = 8;

/// Directions and velocities of the clusters of one garment.
#[derive(Debug, Clone)]
pub struct FoldMotion {
    columns: [Store; COLUMNS],
    /// Where the vertices are (m), cluster by cluster `[clusters][MOST]`.
    at: [Store; 3],
    clusters: usize,
}

impl FoldMotion {
    /// Room for those of a garment. At load.
    pub fn new(clusters: &Clusters) -> Self {
        let clusters = clusters.len();
        let columns = [(); COLUMNS].map(|()| Store::zeros(clusters.next_multiple_of(MOST)));
        Self { columns, at: [(); 3].map(|()| Store::zeros(clusters * MOST)), clusters }
    }

    /// Takes them; `normals` are those of the particles.
    pub fn take(&mut self, all: &Clusters, columns: ParticleColumns<'_>, normals: &[Vec3A]) {
        for c in 0..self.clusters {
            let vertices = all.vertices(c).map(|v| v as usize);
            let (fronts, velocities) = (vertices.map(|v| normals[v]), vertices.map(|v| get(columns.v, v)));
            let front = fronts.iter().sum::<Vec3A>().normalize_or_zero();
            let least = fronts.iter().map(|n| n.dot(front)).fold(1.0, f32::min);
            let mean = velocities.iter().sum::<Vec3A>() * (1.0 / MOST as f32);
            let other2 = velocities.iter().map(|v| (*v - mean).length_squared()).fold(0.0, f32::max);
            for (to, from) in self.at.iter_mut().zip(columns.x) {
                let to = &mut to.as_mut()[c * MOST..(c + 1) * MOST];
                to.iter_mut().zip(vertices).for_each(|(to, v)| *to = from.get(v));
            }
            let numbers = [front.x, front.y, front.z, least, mean.x, mean.y, mean.z, other2.sqrt()];
            self.columns.iter_mut().zip(numbers).for_each(|(column, x)| column.as_mut()[c] = x);
        }
    }

    /// The columns: mean normal, least cosine to it, mean velocity (m/s), how far others are from that (m/s).
    pub fn columns(&self) -> [ReadColumn<'_>; COLUMNS] {
        self.columns.each_ref().map(|c| ReadColumn::new(c.as_slice()))
    }

    /// Where the vertices are (m), cluster by cluster `[clusters][MOST]`.
    pub fn at(&self) -> [ReadColumn<'_>; 3] {
        self.at.each_ref().map(|c| ReadColumn::new(c.as_slice()))
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.columns.iter().chain(&self.at).map(Store::bytes).sum()
    }
}
