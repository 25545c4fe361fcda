//! Fibers: chains of edges that run on along warp, weft or bias, found by direction in any quad or triangle mesh.

use std::collections::BTreeMap;

use glam::Vec3;

use super::is_quad;
pub use crate::garment::Direction;
use crate::garment::check::corners;
use crate::garment::shape::Face;

/// An edge that carries a constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Smaller vertex index.
    pub a: u32,
    /// Larger vertex index.
    pub b: u32,
    /// Length as cut (m).
    pub rest: f32,
    /// Width of the strip of cloth that the edge stands for (m): half of the area of the faces beside it, a length.
    pub width: f32,
    /// Its direction.
    pub direction: Direction,
}

/// A chain of edges. A closed hoop repeats its first vertex at its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Fiber {
    /// The direction of all its edges.
    pub direction: Direction,
    /// Vertices in order: one more than edges.
    pub vertices: Vec<u32>,
    /// Indices of the edges in order.
    pub edges: Vec<u32>,
}

impl Fiber {
    /// The pieces of the fiber that can move: links between two fixed vertices are left out. Each piece starts at a
    /// fixed end if it has one, so that a sweep runs from the support outwards.
    pub fn split_at_pins(&self, fixed: &[bool]) -> Vec<Self> {
        let pinned = |v: u32| fixed[v as usize];
        let mut pieces = Vec::new();
        let mut start = 0;
        for link in 0..=self.edges.len() {
            let breaks = link == self.edges.len() || (pinned(self.vertices[link]) && pinned(self.vertices[link + 1]));
            if breaks {
                if link > start {
                    let mut piece = Self {
                        direction: self.direction,
                        vertices: self.vertices[start..=link].to_vec(),
                        edges: self.edges[start..link].to_vec(),
                    };
                    if !pinned(piece.vertices[0]) && pinned(piece.vertices[link - start]) {
                        piece.vertices.reverse();
                        piece.edges.reverse();
                    }
                    pieces.push(piece);
                }
                start = link + 1;
            }
        }
        pieces
    }
}

/// All edges of a mesh with their directions: the sides of the faces, and both diagonals of each quad.
pub fn edges(positions: &[Vec3], faces: &[Face]) -> Vec<Edge> {
    let mut found: BTreeMap<(u32, u32), (Direction, f32)> = BTreeMap::new();
    for face in faces {
        let area = area(positions, face);
        let mut add = |a: u32, b: u32, direction: Direction| {
            found.entry((a.min(b), a.max(b))).or_insert((direction, 0.0)).1 += area;
        };
        let [a, b, c, d] = *face;
        if is_quad(face) {
            add(a, b, Direction::Weft);
            add(d, c, Direction::Weft);
            add(a, d, Direction::Warp);
            add(b, c, Direction::Warp);
            add(a, c, Direction::Bias);
            add(b, d, Direction::Bias);
        } else {
            for (p, q) in [(a, b), (b, c), (c, a)] {
                add(p, q, by_slope(positions[q as usize] - positions[p as usize]));
            }
        }
    }
    let edge = |((a, b), (direction, area)): ((u32, u32), (Direction, f32))| {
        let rest = positions[a as usize].distance(positions[b as usize]);
        // A side drains half of each face beside it; in a grid of squares that makes the width one cell.
        Edge { a, b, rest, width: 0.5 * area / rest, direction }
    };
    found.into_iter().map(edge).collect()
}

/// In a triangle mesh nothing says which way the threads run: what is steeper than 60 degrees as worn is warp, flatter
/// than 30 weft, the rest bias.
fn by_slope(edge: Vec3) -> Direction {
    let slope = edge.y.abs() / edge.length();
    if slope > 0.866 {
        Direction::Warp
    } else if slope < 0.5 {
        Direction::Weft
    } else {
        Direction::Bias
    }
}

fn area(positions: &[Vec3], face: &Face) -> f32 {
    let p = |i: u32| positions[i as usize];
    let ring = corners(face);
    (2..ring.len()).map(|k| 0.5 * (p(ring[k - 1]) - p(ring[0])).cross(p(ring[k]) - p(ring[0])).length()).sum()
}

/// A fiber runs on through a vertex while it turns by less than 45 degrees.
const STRAIGHT_COS: f32 = 0.7;

/// Joins edges into fibers: at each vertex the two edges of one direction that continue each other best are linked.
pub fn trace(positions: &[Vec3], edges: &[Edge]) -> Vec<Fiber> {
    let next = continuations(positions, edges);
    let mut used = vec![false; edges.len()];
    let mut fibers = Vec::new();
    // Open chains first, from their ends; what is left over afterwards are hoops.
    for open in [true, false] {
        for start in 0..edges.len() {
            for from_a in [true, false] {
                let end_is_open = next[start][usize::from(!from_a)].is_none();
                if used[start] || (open && !end_is_open) {
                    continue;
                }
                fibers.push(walk(edges, &next, start, from_a, &mut used));
            }
        }
    }
    fibers
}

/// For each edge, the edge that continues it at its `a` end and at its `b` end.
fn continuations(positions: &[Vec3], edges: &[Edge]) -> Vec<[Option<u32>; 2]> {
    let mut at_vertex: Vec<Vec<u32>> = vec![Vec::new(); positions.len()];
    for (i, e) in edges.iter().enumerate() {
        at_vertex[e.a as usize].push(i as u32);
        at_vertex[e.b as usize].push(i as u32);
    }
    let mut next = vec![[None; 2]; edges.len()];
    for (v, around) in at_vertex.iter().enumerate() {
        let away = |i: u32| {
            let e = &edges[i as usize];
            let other = if e.a as usize == v { e.b } else { e.a };
            (positions[other as usize] - positions[v]).normalize_or_zero()
        };
        let mut pairs = Vec::new();
        for (k, &i) in around.iter().enumerate() {
            for &j in &around[..k] {
                let cos = -away(i).dot(away(j));
                if edges[i as usize].direction == edges[j as usize].direction && cos > STRAIGHT_COS {
                    pairs.push((cos, i, j));
                }
            }
        }
        pairs.sort_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)).then(x.2.cmp(&y.2)));
        for (_, i, j) in pairs {
            let slot = |e: u32| usize::from(edges[e as usize].a as usize != v);
            if next[i as usize][slot(i)].is_none() && next[j as usize][slot(j)].is_none() {
                next[i as usize][slot(i)] = Some(j);
                next[j as usize][slot(j)] = Some(i);
            }
        }
    }
    next
}

fn walk(edges: &[Edge], next: &[[Option<u32>; 2]], start: usize, from_a: bool, used: &mut [bool]) -> Fiber {
    let mut fiber = Fiber { direction: edges[start].direction, vertices: Vec::new(), edges: Vec::new() };
    let mut edge = start;
    let mut at = if from_a { edges[start].a } else { edges[start].b };
    fiber.vertices.push(at);
    loop {
        used[edge] = true;
        let e = &edges[edge];
        at = if e.a == at { e.b } else { e.a };
        fiber.edges.push(edge as u32);
        fiber.vertices.push(at);
        match next[edge][usize::from(e.a != at)] {
            Some(n) if !used[n as usize] => edge = n as usize,
            _ => return fiber,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tube of `n` columns and `rows` rows.
    fn tube(n: u32, rows: u32) -> (Vec<Vec3>, Vec<Face>) {
        let at = |r: u32, c: u32| r * n + c % n;
        let point = |r: u32, c: u32| {
            let a = std::f32::consts::TAU * c as f32 / n as f32;
            Vec3::new(a.sin(), -(r as f32) * std::f32::consts::TAU / n as f32, a.cos())
        };
        let positions = (0..rows).flat_map(|r| (0..n).map(move |c| point(r, c))).collect();
        let face = |r, c| [at(r + 1, c), at(r + 1, c + 1), at(r, c + 1), at(r, c)];
        (positions, (0..rows - 1).flat_map(|r| (0..n).map(move |c| face(r, c))).collect())
    }

    #[test]
    fn a_tube_has_one_fiber_a_column_and_one_hoop_a_row() {
        let (positions, faces) = tube(12, 5);
        let edges = edges(&positions, &faces);
        let fibers = trace(&positions, &edges);
        let of = |d| fibers.iter().filter(|f| f.direction == d).collect::<Vec<_>>();
        assert_eq!(of(Direction::Warp).len(), 12);
        assert!(of(Direction::Warp).iter().all(|f| f.edges.len() == 4));
        assert_eq!(of(Direction::Weft).len(), 5);
        assert!(of(Direction::Weft).iter().all(|f| f.edges.len() == 12 && f.vertices[0] == f.vertices[12]));
        assert_eq!(fibers.iter().map(|f| f.edges.len()).sum::<usize>(), edges.len());
    }

    #[test]
    fn an_inner_edge_of_a_square_grid_is_one_cell_wide() {
        let (positions, faces) = tube(64, 5);
        let cell = std::f32::consts::TAU / 64.0;
        let inner = edges(&positions, &faces).into_iter().filter(|e| e.direction == Direction::Warp);
        for e in inner {
            assert!((e.width / cell - 1.0).abs() < 0.01, "{e:?}");
        }
    }

    #[test]
    fn fixed_links_are_cut_out_and_pieces_start_at_the_pin() {
        let fiber = Fiber { direction: Direction::Warp, vertices: vec![0, 1, 2, 3, 4], edges: vec![0, 1, 2, 3] };
        let pieces = fiber.split_at_pins(&[false, false, false, true, true]);
        assert_eq!(pieces.len(), 1);
        assert_eq!(pieces[0].vertices, [3, 2, 1, 0]);
        assert_eq!(pieces[0].edges, [2, 1, 0]);
        assert!(fiber.split_at_pins(&[true; 5]).is_empty());
    }
}
