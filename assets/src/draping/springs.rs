//! Constraints of a draping mesh: threads, shear and bending from its flat faces, and the springs of open seams.

use glam::Vec3;

use crate::tailor::SewnMesh;
use toile_bake::Shape;
use toile_bake::bending;
use toile_bake::bending::Stencil;
use toile_bake::check::corners;
use toile_bake::fibers;
use toile_bake::fibers::Edge;
use toile_bake::shape::{Face, NO_VERTEX};
use toile_bake::stiffness;
use toile_base::fabric::Fabric;
use toile_base::garment::Direction;

/// One edge as a distance constraint.
#[derive(Debug, Clone, Copy)]
pub struct SpringLink {
    /// Its vertices.
    pub ends: [u32; 2],
    /// Length at rest (m).
    pub rest: f32,
    /// Inverse stiffness (m/N).
    pub compliance: f32,
    /// Whether it is warp or weft: what strain is measured on.
    pub thread: bool,
}

/// The constraints of one mesh.
#[derive(Debug, Clone)]
pub struct Springs {
    /// Edges of all directions.
    pub links: Vec<SpringLink>,
    /// Sums that bend.
    pub bends: Vec<Stencil>,
    /// Vertices of open seams that are to meet.
    pub seams: Vec<[u32; 2]>,
    /// Inverse mass (1/kg) `[vertices]`.
    pub inverse_mass: Vec<f32>,
}

/// A sewn mesh as a shape: where it lies, and its faces flat.
pub fn shape(sewn: &SewnMesh, at: Vec<Vec3>) -> Shape {
    Shape {
        fixed: vec![false; at.len()],
        parts: vec![toile_base::garment::Part::All; at.len()],
        cut: at.clone(),
        worn: at,
        faces: sewn.faces.clone(),
        split: sewn.split.clone(),
        uvs: sewn.flat.clone(),
        flat: sewn.flat.clone(),
        panels: sewn.face_panels.clone(),
        trims: sewn.trims.clone(),
        ..Shape::default()
    }
}

/// The same before its seams are closed: every panel has vertices of its own, one panel's after the other's.
pub fn unsewn_shape(sewn: &SewnMesh, at: Vec<Vec3>) -> Shape {
    let first = panel_starts(sewn);
    let mut merged = shape(sewn, at);
    // A panel that is sewn to itself has two vertices where there is one: which it was, its own faces say.
    let mut faces = sewn.panels.iter().enumerate().flat_map(|(p, m)| m.faces.iter().map(move |f| (p, f)));
    for face in &mut merged.faces {
        let Some((panel, own)) = faces.next() else { break };
        *face = face.map(|v| if v == NO_VERTEX { v } else { first[panel] as u32 + own_vertex(sewn, panel, own, v) });
    }
    merged
}

/// The corner of a panel's face that became a vertex.
fn own_vertex(sewn: &SewnMesh, panel: usize, face: &Face, v: u32) -> u32 {
    corners(face).iter().copied().find(|own| sewn.number[panel][*own as usize] == v).unwrap_or_default()
}

/// Where each panel's vertices begin when all panels have their own `[panels + 1]`.
pub fn panel_starts(sewn: &SewnMesh) -> Vec<usize> {
    let mut first = vec![0];
    sewn.panels.iter().for_each(|p| first.push(first[first.len() - 1] + p.points.len()));
    first
}

impl Springs {
    /// The springs of a shape with flat faces, in a fabric.
    pub fn new(shape: &Shape, fabric: &Fabric, seams: Vec<[u32; 2]>) -> Self {
        let edges = fibers::edges_of(shape);
        let link = |e: &Edge| SpringLink {
            ends: [e.a, e.b],
            rest: e.rest,
            compliance: stiffness::stretch(e, e.direction, fabric).recip(),
            thread: e.direction != Direction::Bias,
        };
        let mut mass = vec![0.0f32; shape.cut.len()];
        for (i, face) in shape.faces.iter().enumerate() {
            let ring = corners(face);
            let part = shape.face_area(i) * fabric.density_kg_m2 / ring.len() as f32;
            ring.iter().for_each(|&v| mass[v as usize] += part);
        }
        Self {
            links: edges.iter().map(link).collect(),
            bends: bending::stencils(shape, &edges, fabric),
            seams,
            inverse_mass: mass.iter().map(|m| m.recip()).collect(),
        }
    }
}
