//! From edges and fibers to the constraints of a garment's layout.

use std::ops::Range;

use super::fibers::{Direction, Edge, Fiber};
use super::order::Order;
use super::runs;
use crate::fabric::Fabric;
use crate::garment::layout::{Bends, Bundle, ENDED, Fibers, Layout, Links, List, Lists, MAX_LISTED, OWNERS, Row};
use crate::garment::{Shape, Solver};

/// What baking has found out about a shape so far.
pub struct Baking<'a> {
    pub shape: &'a Shape,
    pub fabric: &'a Fabric,
    pub edges: &'a [Edge],
    /// All fibers.
    pub chains: &'a [Fiber],
    /// The free pieces of the warp fibers.
    pub pieces: &'a [Fiber],
    pub order: &'a Order,
    /// Inverse mass of each vertex (1/kg).
    pub weights: &'a [f32],
}

impl Baking<'_> {
    /// Inverse mass of a particle (1/kg).
    fn weight(&self, particle: u32) -> f32 {
        self.weights[self.order.source[particle as usize] as usize]
    }
}

/// All constraints.
pub fn lay_out(baking: &Baking<'_>) -> Layout {
    let mut carried = vec![false; baking.edges.len()];
    baking.pieces.iter().flat_map(|p| &p.edges).for_each(|&e| carried[e as usize] = true);
    let free = |e: &Edge| !(baking.shape.fixed[e.a as usize] && baking.shape.fixed[e.b as usize]);
    let rest = || baking.edges.iter().enumerate().filter(|(i, e)| !carried[*i] && free(e)).map(|(_, e)| e);
    let shear: Vec<&Edge> = rest().filter(|e| e.direction == Direction::Bias).collect();
    let weft: Vec<&Edge> = rest().filter(|e| e.direction != Direction::Bias).collect();
    let crossing: Vec<&Fiber> = baking.order.crossing.iter().map(|&i| &baking.pieces[i]).collect();
    let closed = |f: &&Fiber| f.vertices.first() == f.vertices.last();
    let moves = |f: &&Fiber| f.vertices.iter().any(|&v| !baking.shape.fixed[v as usize]);
    let hoops: Vec<&Fiber> =
        baking.chains.iter().filter(|f| f.direction == Direction::Weft).filter(closed).filter(moves).collect();
    Layout {
        shear: links(baking, &shear),
        weft: links(baking, &weft),
        fibers: fibers(baking),
        crossing: lists(baking, &crossing),
        hoops: lists(baking, &hoops),
        bends: bends(baking),
        spans: spans(&baking.order.owner),
        owner: baking.order.owner.clone().into(),
    }
}

/// Inverse stiffness of an edge (m/N). A link of length h stands for a strip of cloth as wide as the area it drains:
/// k = E w / h. Both diagonals of a square cell together have the shear stiffness of the cell when each has k = G.
fn compliance(fabric: &Fabric, edge: &Edge) -> f32 {
    let k = match edge.direction {
        Direction::Warp => fabric.stretch_warp_n_m * edge.width / edge.rest,
        Direction::Weft => fabric.stretch_weft_n_m * edge.width / edge.rest,
        Direction::Bias => fabric.shear_n_m,
    };
    k.recip()
}

/// Relative difference below which two lengths or masses count as the same: what the rounding of coordinates of f32 a
/// metre from the origin does to an edge of a centimetre.
const SAME: f32 = 1e-5;

fn same(a: f32, b: f32) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs()) || a == b
}

fn links(baking: &Baking<'_>, edges: &[&Edge]) -> Links {
    let particle = |v: u32| baking.order.particle[v as usize];
    let ends = |e: &&Edge| {
        let (a, b) = (particle(e.a), particle(e.b));
        (e.direction, [a.min(b), a.max(b)])
    };
    let constraints: Vec<_> = edges.iter().map(ends).collect();
    let weight = |i: usize, k: usize| baking.weight(constraints[i].1[k]);
    let alike = |i: usize, j: usize| {
        same(edges[i].rest, edges[j].rest)
            && same(compliance(baking.fabric, edges[i]), compliance(baking.fabric, edges[j]))
            && (0..2).all(|k| same(weight(i, k), weight(j, k)))
    };
    let (tuples, places) = runs::lay_out(&constraints, &baking.order.owner, true, &alike);
    Links {
        tuples,
        rest: places.iter().map(|&i| edges[i].rest).collect(),
        compliance: places.iter().map(|&i| compliance(baking.fabric, edges[i])).collect(),
    }
}

fn fibers(baking: &Baking<'_>) -> Fibers {
    let (mut bundles, mut rows, mut rest, mut soft) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for side in &baking.order.sides {
        let pieces: Vec<&Fiber> = side.pieces.iter().map(|&p| &baking.pieces[p]).collect();
        let (first_row, at) = (rows.len() as u32, rest.len() as u32);
        let reach = |row: usize| pieces.iter().take_while(|p| p.vertices.len() > row).count() as u32;
        for row in 0..pieces[0].vertices.len() {
            let first = baking.order.particle[pieces[0].vertices[row] as usize];
            rows.push(Row { first, lanes: reach(row) });
        }
        let alike = pieces.iter().all(|p| fibers_alike(baking, pieces[0], p));
        for link in 0..pieces[0].edges.len() {
            for piece in if alike { &pieces[..1] } else { &pieces[..] } {
                let edge = piece.edges.get(link).map(|&e| &baking.edges[e as usize]);
                rest.push(edge.map_or(0.0, |e| e.rest));
                soft.push(edge.map_or(ENDED, |e| compliance(baking.fabric, e)));
            }
        }
        bundles.push(Bundle {
            solver: Solver::SemiImplicit,
            owner: side.owner,
            lanes: pieces.len() as u32,
            rows: first_row..rows.len() as u32,
            at,
            alike,
        });
    }
    Fibers { bundles: bundles.into(), rows: rows.into(), rest: rest.into(), compliance: soft.into() }
}

/// Whether two fibers are the same, link by link and mass by mass.
fn fibers_alike(baking: &Baking<'_>, a: &Fiber, b: &Fiber) -> bool {
    let edge = |i: u32| &baking.edges[i as usize];
    let links = a.edges.iter().zip(&b.edges).all(|(&i, &j)| {
        let (i, j) = (edge(i), edge(j));
        same(i.rest, j.rest) && same(compliance(baking.fabric, i), compliance(baking.fabric, j))
    });
    let weight = |v: u32| baking.weights[v as usize];
    a.edges.len() == b.edges.len()
        && links
        && a.vertices.iter().zip(&b.vertices).all(|(&v, &w)| same(weight(v), weight(w)))
}

/// Fibers as index lists: sets without a common particle, in each of them lists of equal length.
fn lists(baking: &Baking<'_>, fibers: &[&Fiber]) -> Lists {
    let mut out = ListsMaker::default();
    let mut left: Vec<&Fiber> = fibers.to_vec();
    left.sort_by_key(|f| std::cmp::Reverse(f.edges.len()));
    while !left.is_empty() {
        let mut taken = vec![false; baking.order.particle.len()];
        let (set, rest): (Vec<&Fiber>, Vec<&Fiber>) = left.into_iter().partition(|f| {
            let apart = f.vertices.iter().all(|&v| !taken[v as usize]);
            if apart {
                f.vertices.iter().for_each(|&v| taken[v as usize] = true);
            }
            apart
        });
        left = rest;
        out.set(baking, &set);
    }
    Lists {
        lists: out.lists.into(),
        sets: out.sets.into(),
        index: out.index.into(),
        rest: out.rest.into(),
        compliance: out.compliance.into(),
    }
}

#[derive(Default)]
struct ListsMaker {
    lists: Vec<List>,
    sets: Vec<[Range<u32>; OWNERS]>,
    index: Vec<u32>,
    rest: Vec<f32>,
    compliance: Vec<f32>,
}

impl ListsMaker {
    fn set(&mut self, baking: &Baking<'_>, set: &[&Fiber]) {
        let first = self.lists.len() as u32;
        for alike in set.chunk_by(|a, b| (a.edges.len(), a.vertices.len()) == (b.edges.len(), b.vertices.len())) {
            alike.chunks(MAX_LISTED).for_each(|fibers| self.list(baking, fibers));
        }
        // Half of the lists each: they are of much the same length.
        let end = self.lists.len() as u32;
        let middle = first + (end - first).div_ceil(2);
        self.sets.push([first..middle, middle..end]);
    }

    fn list(&mut self, baking: &Baking<'_>, fibers: &[&Fiber]) {
        let closed = fibers[0].vertices.first() == fibers[0].vertices.last();
        let rows = fibers[0].vertices.len() - usize::from(closed);
        self.lists.push(List {
            solver: Solver::SemiImplicit,
            direction: fibers[0].direction,
            closed,
            lanes: fibers.len() as u32,
            rows: rows as u32,
            first: self.index.len() as u32,
            at: self.rest.len() as u32,
        });
        for row in 0..rows {
            self.index.extend(fibers.iter().map(|f| baking.order.particle[f.vertices[row] as usize]));
        }
        for link in 0..fibers[0].edges.len() {
            let edges = || fibers.iter().map(|f| &baking.edges[f.edges[link] as usize]);
            self.rest.extend(edges().map(|e| e.rest));
            self.compliance.extend(edges().map(|e| compliance(baking.fabric, e)));
        }
    }
}

/// Bends: each three vertices in a row along a warp or weft fiber. A strip of width w bent over spans h1 and h2 stores
/// (B w h / 2) kappa^2 with h their mean and kappa = |x0 / (h1 h) - 2 x1 / (h1 h2) + x2 / (h2 h)|.
fn bends(baking: &Baking<'_>) -> Bends {
    let Baking { shape, fabric, edges, order, .. } = baking;
    let (mut triples, mut coefficients) = (Vec::new(), Vec::new());
    for fiber in baking.chains.iter().filter(|f| f.direction != Direction::Bias) {
        let rigidity = 1e-6
            * match fiber.direction {
                Direction::Warp => fabric.bend_warp_un_m,
                _ => fabric.bend_weft_un_m,
            };
        let closed = fiber.vertices.first() == fiber.vertices.last();
        let count = fiber.edges.len();
        for k in usize::from(!closed)..count {
            let before = if k == 0 { count - 1 } else { k - 1 };
            let [e1, e2] = [before, k].map(|e| &edges[fiber.edges[e] as usize]);
            let v = [fiber.vertices[before], fiber.vertices[k], fiber.vertices[k + 1]];
            if v.iter().all(|&i| shape.fixed[i as usize]) || rigidity <= 0.0 {
                continue;
            }
            let mean = 0.5 * (e1.rest + e2.rest);
            let size = (rigidity * 0.5 * (e1.width + e2.width) * mean).sqrt();
            let (c0, c2) = (size / (e1.rest * mean), size / (e2.rest * mean));
            let mut ends = v.map(|i| order.particle[i as usize]);
            let mut c = [c0, -(c0 + c2), c2];
            if ends[0] > ends[2] {
                ends.reverse();
                c.reverse();
            }
            // The middle leads: rows of middles are what lies side by side.
            triples.push((fiber.direction, [ends[1], ends[0], ends[2]]));
            coefficients.push([c[1], c[0], c[2]]);
        }
    }
    let alike = |i: usize, j: usize| {
        let weight = |i: usize, k: usize| baking.weight(triples[i].1[k]);
        (0..3).all(|k| same(coefficients[i][k], coefficients[j][k]) && same(weight(i, k), weight(j, k)))
    };
    let (tuples, places) = runs::lay_out(&triples, &order.owner, false, &alike);
    Bends { tuples, coefficients: std::array::from_fn(|k| places.iter().map(|&i| coefficients[i][k]).collect()) }
}

/// Each owner's particles as ranges.
fn spans(owner: &[u8]) -> [Vec<(u32, u32)>; OWNERS] {
    let mut out: [Vec<(u32, u32)>; OWNERS] = Default::default();
    for (i, &o) in owner.iter().enumerate() {
        match out[usize::from(o)].last_mut() {
            Some((first, len)) if *first + *len == i as u32 => *len += 1,
            _ => out[usize::from(o)].push((i as u32, 1)),
        }
    }
    out
}
