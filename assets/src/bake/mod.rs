//! Baking: a garment's shape becomes what the cloth steps over.
//!
//! Reads: a checked [`Shape`] and its fabric. Writes: an immutable
//! [`Garment`]: particles in the order in which they are solved, masses, fibers in sets, bends, what is skinned.
//! Budget: 100 ms for 8,000 vertices; at load only.
//! Thread: the loading thread.

pub mod bending;
pub mod fibers;
mod links;
pub mod order;
pub mod runs;
pub mod solver;
pub mod stiffness;
pub mod survey;
pub mod tethers;
pub mod weights;

#[cfg(test)]
pub(crate) mod meshes;

use crate::fabric::Fabric;
use crate::garment::shape::NO_VERTEX;
use crate::garment::{Garment, MeshError, Shape, check};
use fibers::{Direction, Fiber};

/// Rows of a load-bearing fiber that one substep can settle at the quality `shop`: one linearised solve of a longer
/// chain leaves too much of its sideways motion to the next (a prototype needed 4 substeps for 64 rows, 8 for 128).
const ROWS_A_SUBSTEP: usize = 16;

/// Bakes one shape in one fabric. Errors name the face or vertex at fault.
pub fn bake(name: &str, size: &str, shape: &Shape, fabric: &Fabric) -> Result<Garment, MeshError> {
    check::check(&shape.cut, &shape.faces)?;
    check::check(&shape.worn, &shape.faces).or_else(|e| match e {
        MeshError::Degenerate { .. } => Ok(()), // the first steps unfold what started flat on the body
        other => Err(other),
    })?;
    let edges = fibers::edges_of(shape);
    let chains = fibers::trace(&shape.cut, &edges);
    let warp = chains.iter().filter(|f| f.direction == Direction::Warp);
    let pieces: Vec<Fiber> = warp.flat_map(|f| f.split_at_pins(&shape.fixed)).collect();
    let order = order::order(&pieces, &edges, shape.cut.len());
    let new = |v: u32| order.particle[v as usize];
    let old = |i: usize| order.source[i] as usize;
    let n = shape.cut.len();
    let masses = inverse_masses(shape, fabric.density_kg_m2);
    let warp_weft = edges.iter().filter(|e| e.direction != Direction::Bias);
    let hoop = |f: &&Fiber| f.direction == Direction::Weft && f.vertices.first() == f.vertices.last();
    let weft = chains.iter().filter(hoop).flat_map(|f| &f.edges).map(|&i| &edges[i as usize]);
    let longest = pieces.iter().map(|p| p.edges.len()).max().unwrap_or(0);
    let fixed: Vec<usize> = (0..n).filter(|&i| shape.fixed[old(i)]).collect();
    Ok(Garment {
        name: name.into(),
        size: size.into(),
        fabric: fabric.clone(),
        start: (0..n).map(|i| shape.worn[old(i)]).collect(),
        inverse_mass: (0..n).map(|i| masses[old(i)]).collect(),
        parts: (0..n).map(|i| shape.parts[old(i)]).collect(),
        triangles: shape.triangles().into_iter().map(|t| t.map(new)).collect(),
        fixed_weights: fixed.iter().map(|&i| shape.weights[old(i)]).collect(),
        fixed: fixed.iter().map(|&i| i as u32).collect(),
        strain_edges: warp_weft.map(|e| ([new(e.a), new(e.b)], e.rest)).collect(),
        hoop_edges: weft.map(|e| ([new(e.a), new(e.b)], e.rest)).collect(),
        substeps: longest.div_ceil(ROWS_A_SUBSTEP).max(2) as u32,
        layout: links::lay_out(&links::Baking {
            shape,
            fabric,
            edges: &edges,
            chains: &chains,
            pieces: &pieces,
            order: &order,
            weights: &masses,
        }),
        source: order.source.clone().into(),
    })
}

/// Lumped masses: each face's area in equal parts at its corners, so that the way a quad is split for pictures weighs
/// nothing; fixed vertices have inverse mass 0.
fn inverse_masses(shape: &Shape, density: f32) -> Vec<f32> {
    let mut mass = vec![0.0f32; shape.cut.len()];
    for face in &shape.faces {
        let ring = check::corners(face);
        let part = fibers::area(&shape.cut, face) * density / ring.len() as f32;
        for &v in ring {
            mass[v as usize] += part;
        }
    }
    mass.iter_mut().zip(&shape.heavier).for_each(|(m, times)| *m *= times);
    mass.iter().zip(&shape.fixed).map(|(m, fixed)| if *fixed { 0.0 } else { m.recip() }).collect()
}

/// Area that a face gives to each of its edges is counted by [`fibers::edges`]; a face without a fourth corner is a
/// triangle.
pub(crate) fn is_quad(face: &[u32; 4]) -> bool {
    face[3] != NO_VERTEX
}
