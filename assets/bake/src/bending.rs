//! Bending stencils: where and how the curvature of the cloth is measured.
//!
//! A stencil is a weighted sum of particles, f = sum c_i x_i, that vanishes for any flat state and whose
//! length is the curvature 1/R when the cloth is rolled up along the stencil's direction. With the energy k/2 |f|^2 bending
//! is linear in x, as in Bergou et al. 2006, "A quadratic bending model for inextensible surfaces"; but that model knows
//! no direction. Here each vertex of an even mesh has up to three stencils of three or four particles: along the warp, along
//! the weft, and of the twist between them. Where these would push otherwise than the whole ring of the vertex under the same moment,
//! as in an uneven mesh, up to three stencils over the whole ring take their place (`bending/whole.rs` says why).
//!
//! **Points.** The ring of neighbours is laid flat around the vertex. Four points in a plane have one affine dependence c
//! (the areas of the triangles that three of them form), and to second order its sum over a surface of curvature tensor S
//! is M : S with M = 1/2 sum c_i x_i x_i^T. Of all triples in the ring that is chosen whose M comes nearest to d d^T, d
//! being the direction; three points in a row give it exactly, with the second difference of unequal steps as c. Of the twist
//! sqrt2 k12 the four corners of a cell do.
//!
//! **Rigidities.** Stencils along warp and weft and of the twist with the rigidities b1, b2, b3 give a plate
//! B_0 = b1, B_90 = b2, B_45 = (b1 + b2)/4 + b3/2. That is solved for b, and is what the stencils around each
//! vertex together shall come to, whatever their directions are: least squares over the plate's quadratic form, b >= 0. Stencils along
//! both diagonals give B_45 as well, but a plate that curls across when it is bent along a thread: strips of a knit cut along it
//! hung 8 % too low.
//!
//! **Clamps.** At a fixed vertex with fixed cloth behind it only the half before it bends, twice as sharply: energy
//! k/2 |2 f|^2 over half of the area, so that k is doubled. Without it a cantilever of n links hangs by 2/n too low.

mod fit;
mod ring;
mod stencil;
mod whole;

use crate::shape::Shape;
use toile_base::fabric::Fabric;

use super::fibers::{Direction, Edge};
use fit::{Patches, QuadraticForm};
use ring::{Ring, RingMeasure, RingTensor, Rings};
pub use stencil::Stencil;
use whole::RingCurvature;

/// Rigidities (N m) of stencils along warp and weft and of the twist that give a plate the fabric's rigidities. Without a
/// rigidity along the bias the twist has none; one that no plate of such stencils can have (below a quarter of
/// warp and weft together) is met as nearly as can be.
pub fn rigidities(fabric: &Fabric) -> [f64; 3] {
    let micro = |b: f32| f64::from(b) * 1e-6;
    let (warp, weft) = (micro(fabric.bend_warp_un_m), micro(fabric.bend_weft_un_m));
    let Some(bias) = fabric.bend_bias_un_m.map(micro) else { return [warp, weft, 0.0] };
    fit::least_squares(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.25, 0.25, 0.5]], &[warp, weft, bias])
}

/// All stencils of a garment that can move and have any stiffness. A direction in which the plate has no stencils of its
/// own gets none, though a skewed mesh might use them to come a little nearer: each costs time in every substep.
pub fn stencils(shape: &Shape, edges: &[Edge], fabric: &Fabric) -> Vec<Stencil> {
    let rings = Rings::new(shape, edges);
    let wanted = rigidities(fabric);
    let plate = QuadraticForm::plate(wanted);
    let flat: Vec<_> = (0..shape.cut.len()).map(|v| rings.flat(v)).collect();
    let measures: Vec<_> = flat.iter().map(|ring| measures(ring.as_ref(), wanted)).collect();
    let uneven = |(v, ring): (usize, &Option<Ring>)| {
        let whole = RingCurvature::new(ring.as_ref()?)?;
        differs(&whole, &measures[v], &plate, rings.area[v]).then_some(whole)
    };
    let wholes: Vec<Option<RingCurvature>> = flat.iter().enumerate().map(uneven).collect();
    let patches = Patches::new(&rings, &measures, wanted, |v| wholes[v].is_some());
    let mut out = Vec::new();
    for (v, around) in measures.iter().enumerate() {
        if let Some(whole) = &wholes[v] {
            let area = rings.bending[v].max(ring::LEAST_BENDS * rings.area[v]);
            out.extend(whole.parts(plate.0).into_iter().map(|part| part.stencil(&whole.v, area)));
        } else if !around.is_empty() {
            let rigidity = patches.rigidities(v, &plate);
            out.extend(around.iter().map(|(direction, m)| {
                let bends = m.bends(&shape.fixed);
                m.stencil(*direction, rigidity[*direction as usize] * rings.area[v] / bends, bends)
            }));
        }
    }
    out.retain(|s: &Stencil| s.k > 0.0 && s.v.iter().any(|&i| !shape.fixed[i as usize]));
    out
}

/// For each vertex the two chords of its ring whose product is its normal, as far apart along warp and weft as they can be:
/// from the second vertex to the first, and from the fourth to the third. `None` where its faces do not close a ring or a fan.
pub fn chords(shape: &Shape, edges: &[Edge]) -> Vec<Option<[u32; 4]>> {
    let rings = Rings::new(shape, edges);
    (0..shape.cut.len()).map(|v| rings.flat(v).and_then(|ring| ring.chords())).collect()
}

/// Largest difference between the force of a short stencil and that of the whole ring under the same moment (of 1) up to
/// which the short one is taken: it costs half.
const LIKE: f64 = 0.1;

/// Largest part of what a short stencil of the twist measures besides (of 1) up to which it is taken.
const TWIST_OFF: f64 = 0.3;

/// Whether the short stencils of a vertex push otherwise than its whole ring would, along the warp or the weft, or do not measure a
/// twist that the ring can.
fn differs(whole: &RingCurvature, around: &[(Direction, RingMeasure)], plate: &QuadraticForm, area: f64) -> bool {
    let rigid = |m: &glam::DMat3, k: usize| m.col(k)[k];
    let condensed = whole.plate(plate.0);
    let twists = rigid(&plate.0, 2) > 1e-3 * rigid(&plate.0, 0).max(rigid(&plate.0, 1));
    let twist = around.iter().find(|(d, _)| *d == Direction::Bias);
    if twists && twist.is_none_or(|(_, m)| m.off > TWIST_OFF) && whole.measures_twist() {
        return true;
    }
    [Direction::Warp, Direction::Weft].into_iter().enumerate().any(|(k, direction)| {
        let bends = rigid(&condensed, k) > 1e-3 * rigid(&plate.0, k);
        let short = around.iter().find(|(d, _)| *d == direction);
        match short {
            Some((_, m)) => !bends || whole.differs(k, &m.forces(area)) > LIKE,
            None => bends,
        }
    })
}

/// What the ring of a vertex can measure of the directions that are wanted.
fn measures(ring: Option<&Ring>, wanted: [f64; 3]) -> Vec<(Direction, RingMeasure)> {
    let Some(ring) = ring else { return Vec::new() };
    let along = |angle: f64| RingTensor::Along(glam::DVec2::from_angle(angle));
    let right = std::f64::consts::FRAC_PI_2;
    let all = [(Direction::Warp, along(0.0)), (Direction::Weft, along(right)), (Direction::Bias, RingTensor::Twist)];
    all.into_iter()
        .filter(|(direction, _)| wanted[*direction as usize] > 0.0)
        .filter_map(|(direction, tensor)| Some((direction, ring.measure(tensor)?)))
        .collect()
}

#[cfg(test)]
mod tests;
