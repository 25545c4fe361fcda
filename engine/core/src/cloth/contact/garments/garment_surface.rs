//! The surface of one garment, and how it moves.

use glam::Vec3A;
use toile_base::garment::{Garment, Part};
use toile_base::numeric::portable;

use super::fold_motion::FoldMotion;
use super::fold_surface::FoldSurface;
use super::thickness::thickness;
use crate::cloth::state::{ParticleColumns, get};
use crate::lanes::{Readable, Width};
use crate::surface::{ClusterBoxes, Clusters, FillBoxes, SurfaceMesh};

/// The surface of one garment.
#[derive(Debug, Clone)]
pub struct GarmentSurface {
    /// Its triangles.
    pub mesh: SurfaceMesh,
    /// Its vertices in groups.
    pub clusters: Clusters,
    /// The part of the body that each vertex lies on.
    pub parts: Box<[Part]>,
    /// Edges of its borders, by their first vertex.
    pub border_edges: Box<[[u32; 2]]>,
    /// How far its particles keep from each other.
    pub folds: Option<FoldSurface>,
}

/// What is known of a garment's motion at the start of a step.
#[derive(Debug, Clone)]
pub struct GarmentMotion {
    /// Boxes of the clusters.
    pub boxes: ClusterBoxes,
    /// Unit normals of its vertices, towards the front; 0 where the faces around have no area `[particles]`.
    pub normals: Box<[Vec3A]>,
    /// Where its clusters are and how they move.
    pub folds: FoldMotion,
}

impl GarmentSurface {
    /// The surface of a garment. At load.
    pub fn new(garment: &Garment) -> Self {
        let mesh = SurfaceMesh::new(&garment.triangles, garment.start.len());
        let clusters = Clusters::new(&mesh, &garment.start);
        let mut border_edges: Vec<[u32; 2]> = mesh.border_edges().collect();
        border_edges.sort_unstable();
        Self { clusters, border_edges: border_edges.into(), mesh, parts: garment.parts.clone(), folds: None }
    }

    /// The same, made ready to meet itself. At load.
    pub fn with_folds(self, garment: &Garment) -> Self {
        let thickness = thickness(&garment.fabric, &garment.fabric);
        let folds = if self.mesh.is_empty() {
            None
        } else {
            Some(FoldSurface::new(garment, &self.mesh, &self.clusters, thickness))
        };
        Self { folds, ..self }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.mesh.bytes()
            + self.clusters.bytes()
            + size_of_val(&*self.parts)
            + size_of_val(&*self.border_edges)
            + self.folds.as_ref().map_or(0, FoldSurface::bytes)
    }
}

impl GarmentMotion {
    /// Room for what is known of a surface. At load.
    pub fn new(surface: &GarmentSurface) -> Self {
        let normals = vec![Vec3A::ZERO; surface.parts.len()].into();
        Self {
            boxes: ClusterBoxes::new(&surface.clusters),
            normals,
            folds: FoldMotion::new(&surface.clusters, &surface.mesh),
        }
    }

    /// Takes the motion of a garment at the start of a step; the normals only where another garment asks for them.
    pub fn take(&mut self, surface: &GarmentSurface, columns: ParticleColumns<'_>, width: Width, normals: bool) {
        let x = columns.x.each_ref().map(Readable::reader);
        width.run(FillBoxes { clusters: &surface.clusters, surface: x, boxes: &mut self.boxes });
        if surface.folds.is_some() {
            self.folds.take(&surface.clusters, columns, width);
        }
        if !normals {
            return;
        }
        self.normals.fill(Vec3A::ZERO);
        for t in 0..surface.mesh.len() as u32 {
            let corners = surface.mesh.corners(t).map(|v| v as usize);
            let [a, b, c] = corners.map(|v| get(columns.x, v));
            // Weighted by the area.
            let normal = portable::cross(b - a, c - a);
            corners.into_iter().for_each(|v| self.normals[v] += normal);
        }
        self.normals.iter_mut().for_each(|n| *n = n.normalize_or_zero());
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.boxes.bytes() + size_of_val(&*self.normals) + self.folds.bytes()
    }
}
