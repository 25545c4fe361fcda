//! Quality of a draped pattern: strain, open seams, crossings with the skin, and penetration.

use glam::Vec3;

use super::skin_field::SkinField;
use super::springs::Springs;
use crate::body::sound;
use toile_base::body::Body;
use toile_base::mesh::Mesh;
use toile_base::numeric::statistics::quantile;

/// What is measured on a draped mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrapeQuality {
    /// Mean of how much threads are longer or shorter than as cut (1).
    pub strain_mean: f64,
    /// 99th percentile of it (1).
    pub strain_p99: f64,
    /// Largest of it (1).
    pub strain_max: f64,
    /// Widest gap of a seam when its sides became one (m).
    pub seams_open: f64,
    /// Edges of the cloth that pass through triangles of the skin, and edges of the skin through those of the cloth.
    pub crossings: usize,
    /// Deepest vertex inside of the skin (m), 0 where none is.
    pub penetration: f64,
}

/// Strain of the threads: mean, 99th percentile, largest (1).
pub fn strain(springs: &Springs, at: &[Vec3]) -> [f64; 3] {
    let threads = springs.links.iter().filter(|l| l.thread);
    let mut all: Vec<f64> = threads
        .map(|l| f64::from((at[l.ends[0] as usize].distance(at[l.ends[1] as usize]) / l.rest - 1.0).abs()))
        .collect();
    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
    let largest = all.iter().copied().fold(0.0, f64::max);
    [mean, quantile(&mut all, 0.99).unwrap_or_default(), largest]
}

/// The deepest vertex inside of the skin (m).
pub fn penetration(field: &SkinField, at: &[Vec3]) -> f64 {
    let depth = |p: &Vec3| field.nearest(*p).map_or(0.0, |n| f64::from(-n.distance)).max(0.0);
    at.iter().map(depth).fold(0.0, f64::max)
}

/// Edges of each of two surfaces that pass through triangles of the other, once a pair.
pub fn crossings(body: &Body, at: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let skin = body.mesh.positions.len() as u32;
    let mut both = Mesh { uvs: Vec::new(), ..body.mesh.clone() };
    both.positions.extend_from_slice(at);
    both.triangles.extend(triangles.iter().map(|t| t.map(|v| v + skin)));
    sound::crossings(&both).iter().filter(|c| (c.edge[0] < skin) != (c.triangle[0] < skin)).count()
}
