//! A triangle or quad mesh becomes a garment that the engine steps.
//!
//! [`bake()`] takes a checked [`Shape`] and its fabric and gives an immutable [`Garment`]: particles in the order in which they
//! are solved, masses, fibers in sets, bending, tethers, and the vertices that are skinned. Baking 8,000 vertices takes 100 ms.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
mod diagonals;
pub mod overrides;
pub mod weights;
mod zigzags;

pub mod runs;
pub mod shape;

pub mod check;
pub mod look;
pub mod tethers;

pub mod fibers;

pub mod bending;
mod link_curves;
pub mod order;
pub mod solver;
pub mod stiffness;

mod bend_friction;
mod hubs;
pub mod survey;

mod links;

#[cfg(test)]
pub(crate) mod tests;

use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, GarmentData, Layout};

pub use check::MeshError;
use fibers::{Direction, Fiber};
pub use overrides::Overrides;
pub use shape::Shape;

/// Links between a particle and where it hangs that one substep can settle at the quality `shop`: one linearised solve of
/// a longer chain leaves too much of its sideways motion to the next. On the benchmark's skirt 4, 4 and 8 substeps keep
/// the mean strain of a walk below 0.2 % at 32, 64 and 128 rows; with half as many it is three times that.
const LINKS_A_SUBSTEP: f32 = 16.0;

/// Fewest substeps: what the legs do to the hem within a step does not get less with the mesh.
const LEAST_SUBSTEPS: f32 = 4.0;

/// Substeps of a mesh whose links lie in no rows, over those of one whose links do: each of its substeps solves everything
/// once ([`Layout::is_scattered`]). On the benchmark's irregular skirt 16 such substeps take 0.85 of the time of 10 that solve
/// hoops and fibers in turn, and leave as much strain in the mean and three quarters in the 99th percentile.
const SCATTERED: f32 = 1.6;

/// Bakes one shape in one fabric. Errors name the face or vertex at fault.
pub fn bake(name: &str, size: &str, shape: &Shape, fabric: &Fabric) -> Result<Garment, MeshError> {
    check_shape(shape)?;
    let edges = fibers::edges_of(shape);
    let chains = fibers::trace(&shape.cut, &edges);
    let warp = chains.iter().filter(|f| f.direction == Direction::Warp);
    let pieces: Vec<Fiber> = unhung(warp.flat_map(|f| f.split_at_pins(&shape.fixed)).collect(), shape.cut.len());
    let order = order::order(&pieces, &edges, shape.cut.len());
    let new = |v: u32| order.particle[v as usize];
    let old = |i: usize| order.source[i] as usize;
    let n = shape.cut.len();
    let masses = inverse_masses(shape, fabric.density_kg_m2);
    let warp_weft = edges.iter().filter(|e| e.direction != Direction::Bias);
    let hoop = |f: &&Fiber| f.direction == Direction::Weft && f.vertices.first() == f.vertices.last();
    let weft = chains.iter().filter(hoop).flat_map(|f| &f.edges).map(|&i| &edges[i as usize]);
    let fixed: Vec<usize> = (0..n).filter(|&i| shape.fixed[old(i)]).collect();
    let hung = pieces.iter().filter(|p| shape.fixed[p.vertices[0] as usize]).map(|p| p.edges.len()).sum::<usize>();
    let hanging = hung as f32 / (n - fixed.len()).max(1) as f32;
    let area = (0..shape.faces.len()).map(|i| f64::from(shape.face_area(i))).sum();
    let threads = stiffness::threads(&edges, &chains, area, &fabric.with_slopes(0));
    let link_curves = fabric.has_link_curves().then(|| link_curves::CurveMaker {
        fabric: fabric.clone(),
        threads: threads.clone(),
        beyond: stiffness::threads(&edges, &chains, area, &fabric.with_slopes(1)),
    });
    let layout = links::lay_out(&links::BakeInput {
        shape,
        fabric: &threads,
        edges: &edges,
        chains: &chains,
        pieces: &pieces,
        order: &order,
        weights: &masses,
        link_curves: link_curves.as_ref(),
    });
    let data = GarmentData {
        name: name.into(),
        size: size.into(),
        layer: 0,
        tuck: None,
        fabric: fabric.clone(),
        start: (0..n).map(|i| shape.worn[old(i)]).collect(),
        inverse_mass: (0..n).map(|i| masses[old(i)]).collect(),
        parts: (0..n).map(|i| shape.parts[old(i)]).collect(),
        triangles: shape.triangles().into_iter().map(|t| t.map(new)).collect(),
        look: look::look_of(shape),
        fixed_weights: fixed.iter().map(|&i| shape.weights[old(i)]).collect(),
        fixed: fixed.iter().map(|&i| i as u32).collect(),
        strain_edges: warp_weft.map(|e| ([new(e.a), new(e.b)], e.rest)).collect(),
        hoop_edges: weft.map(|e| ([new(e.a), new(e.b)], e.rest)).collect(),
        substeps: substeps(&edges, &layout, hanging),
        source: order.source.clone().into(),
    };
    // A layout that does not hold is a defect of this crate and not of the mesh.
    Ok(Garment::new(data, layout).expect("a baked layout keeps its workers apart"))
}

/// Checks a shape as cut and as worn. Where a flat pattern says how it was cut, `cut` only says where it lies.
fn check_shape(shape: &Shape) -> Result<(), MeshError> {
    let folded = |e| match e {
        MeshError::Degenerate { .. } => Ok(()), // the first steps unfold what started flat on the body
        other => Err(other),
    };
    if shape.flat.is_empty() {
        check::check(&shape.cut, &shape.faces)?;
    } else {
        check::check(&shape.cut, &shape.faces).or_else(folded)?;
        check::check_flat(&shape.flat, &shape.faces)?;
    }
    check::check(&shape.worn, &shape.faces).or_else(folded)
}

/// Substeps that a garment asks for: by how many links its lowest particle hangs, and up to three times as many where the
/// mesh is irregular and where no fiber hangs from a support, because there Gauss-Seidel has to do what fibers do
/// elsewhere. `hanging` is the share of free vertices that hang by a fiber.
fn substeps(edges: &[fibers::Edge], layout: &Layout, hanging: f32) -> u32 {
    let lengths = edges.iter().filter(|e| e.direction == Direction::Warp).map(|e| e.rest);
    let mean = lengths.clone().sum::<f32>() / lengths.count().max(1) as f32;
    let links = layout.tethers.length.iter().copied().fold(0.0, f32::max) / mean.max(f32::MIN_POSITIVE);
    let [loose, all] = layout.loose_links();
    let irregular = loose as f32 / (all.max(1)) as f32;
    let more = (1.0 + irregular + (1.0 - hanging).max(0.0)) * if layout.is_scattered() { SCATTERED } else { 1.0 };
    ((links / LINKS_A_SUBSTEP).max(LEAST_SUBSTEPS) * more).round() as u32
}

/// Fibers without the link by which they hang from the middle of another one: so that they share no particle and can be
/// laid side by side. The link is solved by itself.
fn unhung(mut pieces: Vec<Fiber>, vertices: usize) -> Vec<Fiber> {
    let mut taken = vec![false; vertices];
    pieces.iter().flat_map(|p| &p.vertices[1..]).for_each(|&v| taken[v as usize] = true);
    for piece in pieces.iter_mut().filter(|p| !p.is_hoop()) {
        if piece.edges.len() > 1 && taken[piece.vertices[0] as usize] {
            piece.vertices.remove(0);
            piece.edges.remove(0);
        } else {
            taken[piece.vertices[0] as usize] = true;
        }
    }
    pieces
}

/// Lumped masses: each face's area in equal parts at its corners, so that the way a quad is split for pictures weighs
/// nothing; fixed vertices have inverse mass 0.
fn inverse_masses(shape: &Shape, density: f32) -> Vec<f32> {
    let mut mass = vec![0.0f32; shape.cut.len()];
    for (i, face) in shape.faces.iter().enumerate() {
        let ring = check::corners(face);
        let part = shape.face_area(i) * density / ring.len() as f32;
        for &v in ring {
            mass[v as usize] += part;
        }
    }
    mass.iter_mut().zip(&shape.heavier).for_each(|(m, times)| *m *= times);
    mass.iter().zip(&shape.fixed).map(|(m, fixed)| if *fixed { 0.0 } else { m.recip() }).collect()
}
