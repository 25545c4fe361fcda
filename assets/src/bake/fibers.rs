//! Fibers: chains of edges that run on along warp, weft or bias, found by direction in any quad or triangle mesh.
//!
//! Three steps: [`warp`] says for each face where its threads run, [`edges`] gives each edge its angle to them, and
//! [`trace`] follows the edges as long paths, so that through each vertex runs at most one warp and one weft fiber.
//!
//! Reads: a mesh at rest. Writes: fibers, and how much of the mesh they cover. Budget: at load, some milliseconds a garment.
//! Thread: the loading thread.

pub mod coverage;
mod fiber;
mod trace;
pub mod warp;

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};

pub use crate::garment::Direction;
use crate::garment::check::{corners, is_quad};
use crate::garment::shape::{Face, Shape};
pub use coverage::Coverage;
pub use fiber::{Edge, Fiber};
pub use trace::trace;
use warp::normal;

/// The edges of a shape as cut, its warp by its texture where that is a pattern laid out flat.
pub fn edges_of(shape: &Shape) -> Vec<Edge> {
    let (cut, faces) = (&shape.cut, &shape.faces);
    let steepest = warp::steepest(cut, faces);
    if warp::is_pattern(cut, faces, &shape.uvs) {
        edges_along(cut, faces, &warp::from_uvs(cut, faces, &shape.uvs, &steepest))
    } else {
        edges_along(cut, faces, &steepest)
    }
}

/// All edges of a mesh with their directions: the sides of the faces, and both diagonals of each quad. A quad says
/// itself which way its threads run; in a triangle the warp is the steepest direction, as the garment hangs.
pub fn edges(positions: &[Vec3], faces: &[Face]) -> Vec<Edge> {
    edges_along(positions, faces, &warp::steepest(positions, faces))
}

/// The same for a warp that is given: a unit vector within the plane of each face.
pub fn edges_along(positions: &[Vec3], faces: &[Face], warp: &[Vec3]) -> Vec<Edge> {
    let mut found: BTreeMap<(u32, u32), EdgeDirection> = BTreeMap::new();
    for (face, &warp) in faces.iter().zip(warp) {
        let area = area(positions, face);
        let mut add = |p: u32, q: u32, along: Vec2, share: f32, side: bool| {
            let seen = found.entry((p.min(q), p.max(q))).or_default();
            seen.along += along.normalize_or_zero() * if p < q { area } else { -area };
            seen.share += share * area;
            seen.side |= side;
        };
        if is_quad(face) {
            let [a, b, c, d] = *face;
            let (down, right) = quad_axes(positions, face, warp);
            add(d, a, Vec2::X * down.signum(), 0.5, true);
            add(c, b, Vec2::X * down.signum(), 0.5, true);
            add(a, b, Vec2::Y * right.signum(), 0.5, true);
            add(d, c, Vec2::Y * right.signum(), 0.5, true);
            add(a, c, Vec2::new(-down, right), 0.5, false);
            add(b, d, Vec2::new(-down, -right), 0.5, false);
        } else {
            let weft = normal(positions, face).cross(warp);
            for (p, q) in [(face[0], face[1]), (face[1], face[2]), (face[2], face[0])] {
                let side = positions[q as usize] - positions[p as usize];
                add(p, q, Vec2::new(side.dot(warp), side.dot(weft)), 1.0, true);
            }
        }
    }
    found
        .into_iter()
        .map(|((a, b), seen)| seen.edge(a, b, positions[a as usize].distance(positions[b as usize])))
        .collect()
}

/// What the faces beside an edge say of it.
#[derive(Default)]
struct EdgeDirection {
    /// Components along warp and weft, weighted by area (m2).
    along: Vec2,
    /// Area that the edge stands for (m2).
    share: f32,
    side: bool,
}

/// Cosine of 30 degrees: what is nearer to a thread counts as its direction.
const NEAR_COS: f32 = 0.866;

impl EdgeDirection {
    fn edge(&self, a: u32, b: u32, rest: f32) -> Edge {
        let along = self.along.normalize_or_zero().abs();
        let direction = if self.side && along.x >= NEAR_COS {
            Direction::Warp
        } else if self.side && along.y >= NEAR_COS {
            Direction::Weft
        } else {
            Direction::Bias
        };
        Edge {
            a,
            b,
            rest,
            width: self.share / rest,
            direction,
            angle: self.along.y.atan2(self.along.x),
            side: self.side,
        }
    }
}

/// Mean length of a quad's warp sides from d and c to a and b, negative where the warp runs the other way; the same of
/// its weft sides from a and d to b and c (m).
fn quad_axes(positions: &[Vec3], face: &Face, warp: Vec3) -> (f32, f32) {
    let [a, b, c, d] = face.map(|i| positions[i as usize]);
    let (down, right) = (0.5 * ((a - d) + (b - c)), 0.5 * ((b - a) + (c - d)));
    let weft = normal(positions, face).cross(warp);
    (down.length().copysign(down.dot(warp)), right.length().copysign(right.dot(weft)))
}

/// Area of a face (m2).
pub(crate) fn area(positions: &[Vec3], face: &Face) -> f32 {
    let p = |i: u32| positions[i as usize];
    let ring = corners(face);
    (2..ring.len()).map(|k| 0.5 * (p(ring[k - 1]) - p(ring[0])).cross(p(ring[k]) - p(ring[0])).length()).sum()
}

#[cfg(test)]
mod tests;
