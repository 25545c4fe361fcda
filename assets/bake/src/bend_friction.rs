//! From bending stencils to the friction in them.
//!
//! A stencil with the sum f, the stiffness k = B A / b over an area A of which the part b bends has the moment B A f. Friction that
//! keeps at most HB of moment a width keeps HB A of it, which over the root of the stiffness, within which the layout has its
//! coefficients, is (HB / B) b sqrt(k): the curvature at which the cloth stays, times what the stencil is.
//!
//! The twist between warp and weft does not rub: of a bend along the bias warp and weft see half each and hold half of their limits, so
//! that the loop there has the mean width of both.

use super::bending::{self, Stencil};
use super::fibers::{Direction, Edge};
use super::order::ParticleOrder;
use crate::shape::Shape;
use toile_base::fabric::Fabric;
use toile_base::garment::bend_friction::{BendFriction, FrictionSlot};

/// The friction of a garment's stencils.
pub fn lay_out(
    shape: &Shape,
    edges: &[Edge],
    order: &ParticleOrder,
    stencils: &[Stencil],
    fabric: &Fabric,
) -> BendFriction {
    let [warp, weft] = fabric.hysteresis.residual_curvatures([fabric.bend_warp_un_m, fabric.bend_weft_un_m]);
    if warp == 0.0 && weft == 0.0 {
        return BendFriction::default();
    }
    let kept = |direction| match direction {
        Direction::Warp => warp,
        Direction::Weft => weft,
        Direction::Bias => 0.0,
    };
    let chords = bending::chords(shape, edges);
    let particle = |v: u32| order.particle[v as usize];
    let mut taken = vec![[false; KINDS]; shape.cut.len()];
    let mut all: Vec<(FrictionSlot, &Stencil)> = Vec::new();
    for stencil in stencils.iter().filter(|s| kept(s.direction) > 0.0) {
        let centre = stencil.v[0];
        let Some(chords) = chords[centre as usize] else { continue };
        let places = &mut taken[centre as usize];
        let Some(kind) = (stencil.direction as usize..KINDS).find(|k| !places[*k]) else { continue };
        places[kind] = true;
        let limit = kept(stencil.direction) * stencil.bends * stencil.k.sqrt();
        let (centre, chords) = (particle(centre), chords.map(particle));
        all.push((FrictionSlot { centre, kind: kind as u32, chords, limit, first: 0, len: 0 }, stencil));
    }
    all.sort_by_key(|(slot, _)| (slot.kind, slot.centre));
    let (mut slots, mut particles, mut coefficients) = (Vec::new(), Vec::new(), Vec::new());
    for (slot, stencil) in all {
        let mut others: Vec<(u32, f32)> =
            stencil.v.iter().zip(&stencil.c).skip(1).map(|(v, c)| (particle(*v), c * stencil.k.sqrt())).collect();
        others.sort_unstable_by_key(|(p, _)| *p);
        slots.push(FrictionSlot { first: particles.len() as u32, len: others.len() as u32, ..slot });
        particles.extend(others.iter().map(|(p, _)| *p));
        coefficients.extend(others.iter().map(|(_, c)| *c));
    }
    BendFriction { slots: slots.into(), particles: particles.into(), coefficients: coefficients.into() }
}

/// Stencils around one vertex, at most: along warp and weft, and along both diagonals.
const KINDS: usize = 4;
