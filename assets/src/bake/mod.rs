//! Baking: a garment's shape becomes what the cloth steps over.
//!
//! Reads: a checked [`Shape`] and its fabric. Writes: an immutable
//! [`Garment`]: masses, fibers in sets, bends, what is skinned.
//! Budget: 100 ms for 8,000 vertices; at load only.
//! Thread: the loading thread.

pub mod colour;
pub mod fibers;
pub mod weights;

use crate::fabric::Fabric;
use crate::garment::shape::NO_VERTEX;
use crate::garment::{Bend, Garment, MeshError, Set, Shape, Stretch, check};
use fibers::{Direction, Edge, Fiber};

/// Bakes one shape in one fabric. Errors name the face or vertex at fault.
pub fn bake(name: &str, size: &str, shape: &Shape, fabric: &Fabric) -> Result<Garment, MeshError> {
    check::check(&shape.cut, &shape.faces)?;
    check::check(&shape.worn, &shape.faces).or_else(|e| match e {
        MeshError::Degenerate { .. } => Ok(()), // the first steps unfold what started flat on the body
        other => Err(other),
    })?;
    let edges = fibers::edges(&shape.cut, &shape.faces);
    let chains = fibers::trace(&shape.cut, &edges);
    let free = chains.iter().flat_map(|fiber| fiber.split_at_pins(&shape.fixed)).collect::<Vec<_>>();
    let (stretch, stretch_sets) = stretches(shape, fabric, &edges, &free);
    let (bends, bend_sets) = bends(shape, fabric, &edges, &chains);
    let strain_edges = edges.iter().filter(|e| e.direction != Direction::Bias).map(|e| ([e.a, e.b], e.rest)).collect();
    let hoop = |f: &&Fiber| f.direction == Direction::Weft && f.vertices.first() == f.vertices.last();
    let weft = chains.iter().filter(hoop).flat_map(|f| &f.edges).map(|&i| &edges[i as usize]);
    let hoop_edges = weft.map(|e| ([e.a, e.b], e.rest)).collect();
    Ok(Garment {
        name: name.into(),
        size: size.into(),
        fabric: fabric.clone(),
        start: shape.worn.clone().into(),
        inverse_mass: inverse_masses(shape, fabric.density_kg_m2).into(),
        parts: shape.parts.clone().into(),
        triangles: shape.triangles().into(),
        fixed: shape.fixed.iter().enumerate().filter(|(_, f)| **f).map(|(i, _)| i as u32).collect(),
        fixed_weights: shape.fixed.iter().zip(&shape.weights).filter(|(f, _)| **f).map(|(_, w)| *w).collect(),
        stretch: stretch.into(),
        stretch_sets: stretch_sets.into(),
        bends: bends.into(),
        bend_sets: bend_sets.into(),
        strain_edges,
        hoop_edges,
    })
}

/// Lumped masses: a third of each triangle's area at each corner; fixed vertices have inverse mass 0.
fn inverse_masses(shape: &Shape, density: f32) -> Vec<f32> {
    let mut mass = vec![0.0f32; shape.cut.len()];
    for t in shape.triangles() {
        let [a, b, c] = t.map(|i| shape.cut[i as usize]);
        let third = (b - a).cross(c - a).length() * 0.5 * density / 3.0;
        for i in t {
            mass[i as usize] += third;
        }
    }
    mass.iter_mut().zip(&shape.heavier).for_each(|(m, times)| *m *= times);
    mass.iter().zip(&shape.fixed).map(|(m, fixed)| if *fixed { 0.0 } else { m.recip() }).collect()
}

/// Stretch constraints, interleaved a set at a time: first link of every fiber, then every second link, and so on, so
/// that neighbours in memory never share a particle.
fn stretches(shape: &Shape, fabric: &Fabric, edges: &[Edge], fibers: &[Fiber]) -> (Vec<Stretch>, Vec<Set>) {
    let colours = colour::sets(fibers, shape.cut.len());
    let (mut out, mut sets) = (Vec::new(), Vec::new());
    for set in colours {
        let first = out.len();
        let longest = set.iter().map(|&f| fibers[f].edges.len()).max().unwrap_or(0);
        for link in 0..longest {
            for fiber in set.iter().map(|&f| &fibers[f]).filter(|f| f.edges.len() > link) {
                let edge = &edges[fiber.edges[link] as usize];
                let (a, b) = (fiber.vertices[link], fiber.vertices[link + 1]);
                let modulus = match edge.direction {
                    Direction::Warp => fabric.stretch_warp_n_m,
                    Direction::Weft => fabric.stretch_weft_n_m,
                    Direction::Bias => fabric.shear_n_m,
                };
                // A link of length h stands for a strip of cloth as wide as the area it drains: k = E w / h. Both
                // diagonals of a square cell together have the shear stiffness of the cell when each has k = G.
                let k = if edge.direction == Direction::Bias { modulus } else { modulus * edge.width / edge.rest };
                out.push(Stretch { a, b, rest: edge.rest, compliance: k.recip() });
            }
        }
        let direction = fibers[set[0]].direction;
        sets.push(Set { direction, first: first as u32, end: out.len() as u32, fibers: set.len() as u32 });
    }
    (out, sets)
}

/// Bends: each three vertices in a row along a warp or weft fiber. Energy of a strip of width w bent over a span h:
/// (B w / 2 h^3) |x0 - 2 x1 + x2|^2, so the stiffness is B w / h^3.
fn bends(shape: &Shape, fabric: &Fabric, edges: &[Edge], fibers: &[Fiber]) -> (Vec<Bend>, Vec<Set>) {
    let mut triples: Vec<(Direction, [u32; 3], f32)> = Vec::new();
    for fiber in fibers.iter().filter(|f| f.direction != Direction::Bias) {
        let rigidity = 1e-6
            * match fiber.direction {
                Direction::Warp => fabric.bend_warp_un_m,
                _ => fabric.bend_weft_un_m,
            };
        for k in 1..fiber.edges.len() {
            let (before, after) = (&edges[fiber.edges[k - 1] as usize], &edges[fiber.edges[k] as usize]);
            let v = [fiber.vertices[k - 1], fiber.vertices[k], fiber.vertices[k + 1]];
            if v.iter().all(|&i| shape.fixed[i as usize]) || rigidity <= 0.0 {
                continue;
            }
            let (span, width) = (0.5 * (before.rest + after.rest), 0.5 * (before.width + after.width));
            triples.push((fiber.direction, v, span.powi(3) / (rigidity * width)));
        }
    }
    let parts = triples.iter().map(|(direction, v, _)| (*direction, v.as_slice())).collect::<Vec<_>>();
    let (mut out, mut sets) = (Vec::new(), Vec::new());
    for set in colour::colour(&parts, shape.cut.len()) {
        let first = out.len() as u32;
        out.extend(set.iter().map(|&i| Bend { v: triples[i].1, compliance: triples[i].2 }));
        let direction = triples[set[0]].0;
        sets.push(Set { direction, first, end: out.len() as u32, fibers: set.len() as u32 });
    }
    (out, sets)
}

/// Area that a face gives to each of its edges is counted by [`fibers::edges`]; a face without a fourth corner is a
/// triangle.
pub(crate) fn is_quad(face: &[u32; 4]) -> bool {
    face[3] != NO_VERTEX
}
