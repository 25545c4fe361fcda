//! Fibers: chains of edges that run on along warp, weft or bias, found by direction in any quad or triangle mesh.
//!
//! Three steps: [`warp`] says for each face where its threads run, [`edges`] gives each edge its angle to them, and
//! [`trace`] follows the edges as long paths, so that through each vertex runs at most one warp and one weft fiber.

pub mod coverage;
mod fiber;
mod trace;
pub mod warp;

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};
use toile_base::numeric::portable;

use crate::check::{corners, is_quad};
use crate::shape::{Face, NO_VERTEX, Shape, area as area_of};
pub use coverage::Coverage;
pub use fiber::{Edge, Fiber};
pub use toile_base::garment::Direction;
pub use trace::trace;
use warp::normal;

/// The edges of a shape as cut: its warp by its flat faces where it has them, or by its texture where that is a pattern laid
/// out flat.
pub fn edges_of(shape: &Shape) -> Vec<Edge> {
    let (cut, faces) = (&shape.cut, &shape.faces);
    if !shape.flat.is_empty() {
        return edges_of_faces(faces, |i| (shape.face_as_cut(i), Vec3::NEG_Y), true);
    }
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
    let laid = |i: usize| faces[i].map(|v| positions[if v == NO_VERTEX { faces[i][0] } else { v } as usize]);
    edges_of_faces(faces, |i| (laid(i), warp[i]), false)
}

/// The same for faces that each lie where `laid` says, with the warp that it gives. What panels on both sides of a seam call
/// down may be opposed, over a shoulder for example; with `opposed` that does not cancel their common direction.
fn edges_of_faces(faces: &[Face], laid: impl Fn(usize) -> ([Vec3; 4], Vec3), opposed: bool) -> Vec<Edge> {
    let mut found: BTreeMap<(u32, u32), EdgeDirection> = BTreeMap::new();
    for (i, face) in faces.iter().enumerate() {
        let (at, warp) = laid(i);
        let quad = is_quad(face);
        let own = [0, 1, 2, if quad { 3 } else { NO_VERTEX }];
        let area = area(&at, &own);
        let mut add = |[p, q]: [usize; 2], along: Vec2, share: f32, side: bool| {
            let (from, to) = (face[p], face[q]);
            let seen = found.entry((from.min(to), from.max(to))).or_default();
            let along = along.normalize_or_zero() * if from < to { area } else { -area };
            seen.along += if opposed && seen.along.dot(along) < 0.0 { -along } else { along };
            seen.share += share * area;
            seen.side |= side;
            seen.measure(at[p].distance(at[q]));
        };
        if quad {
            let (down, right) = quad_axes(&at, &own, warp);
            add([3, 0], Vec2::X * down.signum(), 0.5, true);
            add([2, 1], Vec2::X * down.signum(), 0.5, true);
            add([0, 1], Vec2::Y * right.signum(), 0.5, true);
            add([3, 2], Vec2::Y * right.signum(), 0.5, true);
            add([0, 2], Vec2::new(-down, right), 0.5, false);
            add([1, 3], Vec2::new(-down, -right), 0.5, false);
        } else {
            let weft = normal(&at, &own).cross(warp);
            for [p, q] in [[0, 1], [1, 2], [2, 0]] {
                let side = at[q] - at[p];
                add([p, q], Vec2::new(side.dot(warp), side.dot(weft)), 1.0, true);
            }
        }
    }
    found.into_iter().map(|((a, b), seen)| seen.edge(a, b)).collect()
}

/// What the faces beside an edge say of it.
#[derive(Default)]
struct EdgeDirection {
    /// Components along warp and weft, weighted by area (m2).
    along: Vec2,
    /// Area that the edge stands for (m2).
    share: f32,
    side: bool,
    /// Its lengths in these faces: sum, number, least and most (m).
    length: f32,
    faces: u32,
    least: f32,
    most: f32,
}

/// Sides of a seam that differ by more than this are gathered, and lie as long as the shorter one: its thread holds them.
/// Below, the longer side is eased in, and both meet in the middle.
const GATHER: f32 = 1.1;

/// Cosine of 30 degrees: what is nearer to a thread counts as its direction.
const NEAR_COS: f32 = 0.866;

impl EdgeDirection {
    fn measure(&mut self, length: f32) {
        self.least = if self.faces == 0 { length } else { self.least.min(length) };
        self.most = self.most.max(length);
        self.length += length;
        self.faces += 1;
    }

    /// Length at rest (m): that in its faces, which differ at seams alone.
    fn rest(&self) -> f32 {
        if self.most > GATHER * self.least { self.least } else { self.length / self.faces as f32 }
    }

    fn edge(&self, a: u32, b: u32) -> Edge {
        let rest = self.rest();
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
            angle: portable::atan2(self.along.y, self.along.x),
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
    let p = |k: usize| positions[face[if k < corners(face).len() { k } else { 0 }] as usize];
    area_of(&[p(0), p(1), p(2), p(3)][..corners(face).len()])
}

#[cfg(test)]
mod tests;
