//! Positions and motion of a garment's clusters at the start of a step.

use super::flatness::Flatness;
use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, MOST, ReadColumn, Store, V3, Width};
use crate::surface::{Clusters, SurfaceMesh};

/// Positions and velocities of the clusters of one garment.
#[derive(Debug, Clone)]
pub struct FoldMotion {
    /// Least velocity along each axis, then the greatest (m/s) `[clusters]`.
    velocity: [Store; 6],
    /// Where the vertices are (m), then their velocities (m/s), cluster by cluster `[clusters][MOST]`.
    vertices: [Store; 6],
    /// Which of them lie flat.
    pub flatness: Flatness,
}

impl FoldMotion {
    /// Room for those of a garment. At load.
    pub fn new(clusters: &Clusters, mesh: &SurfaceMesh) -> Self {
        let velocity = [(); 6].map(|()| Store::zeros(clusters.len().next_multiple_of(MOST)));
        Self {
            velocity,
            vertices: [(); 6].map(|()| Store::zeros(clusters.len() * MOST)),
            flatness: Flatness::new(clusters, mesh),
        }
    }

    /// Takes them.
    pub fn take(&mut self, clusters: &Clusters, columns: ParticleColumns<'_>, width: Width) {
        width.run(TakeClusters { clusters, columns, to: self });
        self.flatness.look(columns, width);
    }

    /// Least velocity along each axis, then the greatest (m/s) `[clusters]`.
    pub fn velocity(&self) -> [ReadColumn<'_>; 6] {
        self.velocity.each_ref().map(|c| ReadColumn::new(c.as_slice()))
    }

    /// Where the vertices are (m), then their velocities (m/s), cluster by cluster `[clusters][MOST]`.
    pub fn vertices(&self) -> [[ReadColumn<'_>; 3]; 2] {
        let [x, y, z, vx, vy, vz] = self.vertices.each_ref().map(|c| ReadColumn::new(c.as_slice()));
        [[x, y, z], [vx, vy, vz]]
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.velocity.iter().chain(&self.vertices).map(Store::bytes).sum::<usize>() + self.flatness.bytes()
    }
}

/// Takes the positions of all clusters, and the range of their velocities.
struct TakeClusters<'a> {
    clusters: &'a Clusters,
    columns: ParticleColumns<'a>,
    to: &'a mut FoldMotion,
}

impl Kernel for TakeClusters<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let [x, y, z, vx, vy, vz] = self.to.vertices.each_mut().map(Store::column);
        let [lx, ly, lz, hx, hy, hz] = self.to.velocity.each_mut().map(Store::as_mut);
        for c in 0..self.clusters.len() {
            let vertices = self.clusters.vertices(c);
            let mut low = [f32::INFINITY; 3];
            let mut high = [f32::INFINITY; 3];
            let mut from = 0;
            while from < MOST {
                V3::<L>::gather(self.columns.x, &vertices[from..from + L::N], L::N).store(
                    [x, y, z],
                    c * MOST + from,
                    L::N,
                );
                let v = V3::<L>::gather(self.columns.v, &vertices[from..from + L::N], L::N);
                v.store([vx, vy, vz], c * MOST + from, L::N);
                low = [low[0].min(v.x.least()), low[1].min(v.y.least()), low[2].min(v.z.least())];
                high = [high[0].min((-v.x).least()), high[1].min((-v.y).least()), high[2].min((-v.z).least())];
                from += L::N;
            }
            (lx[c], ly[c], lz[c]) = (low[0], low[1], low[2]);
            (hx[c], hy[c], hz[c]) = (-high[0], -high[1], -high[2]);
        }
    }
}
