//! From edges and fibers to the constraints of a garment's layout.

use std::ops::Range;

use super::bend_friction;
use super::bending::{self, Stencil};
use super::diagonals::{self, BiasFiber};
use super::fibers::{Direction, Edge, Fiber};
use super::link_curves::CurveMaker;
use super::order::ParticleOrder;
use super::solver::SolverChoice;
use super::{hubs, runs, stiffness, tethers};
use crate::shape::Shape;
use toile_base::fabric::Fabric;
use toile_base::garment::Solver;
use toile_base::garment::layout::{
    Bends, BundleRow, Diagonals, ENDED, FiberBundle, FiberList, FiberLists, Fibers, Layout, Links, MAX_LISTED, OWNERS,
    Tethers,
};
use toile_base::garment::link_curves::{CurveTable, LinkCurves, ONE_SLOPE};
use toile_base::numeric::portable;

/// What baking has found out about a shape so far.
pub struct BakeInput<'a> {
    pub shape: &'a Shape,
    pub fabric: &'a Fabric,
    pub edges: &'a [Edge],
    /// All fibers, of every direction.
    pub chains: &'a [Fiber],
    /// The free pieces of the warp fibers.
    pub pieces: &'a [Fiber],
    pub order: &'a ParticleOrder,
    /// Inverse mass of each vertex (1/kg).
    pub weights: &'a [f32],
    /// What links do beyond one slope, where the fabric says so.
    pub link_curves: Option<&'a CurveMaker>,
}

impl BakeInput<'_> {
    /// Inverse mass of a particle (1/kg).
    fn weight(&self, particle: u32) -> f32 {
        self.weights[self.order.source[particle as usize] as usize]
    }

    /// Whether links along the bias, or along threads, have curves: then none is like another, because each has a state.
    fn curved(&self, bias: bool) -> bool {
        self.link_curves.is_some_and(|maker| maker.acts(bias))
    }

    /// Stretch curves of some edges, each as part of a fiber of a direction; nothing where one slope is all.
    fn link_curves<'e>(
        &self,
        bias: bool,
        edges: impl Iterator<Item = (Option<&'e Edge>, Direction)> + Clone,
    ) -> CurveTable {
        let Some(maker) = self.link_curves.filter(|maker| maker.acts(bias)) else { return CurveTable::default() };
        CurveTable::new(&edges.map(|(edge, role)| edge.map_or(ONE_SLOPE, |e| maker.link_curve(e, role))))
    }
}

/// Lays out all constraints of a shape: fibers, links, bending stencils and tethers, in sets.
pub fn lay_out(baking: &BakeInput<'_>) -> Layout {
    let mut role: Vec<Option<Direction>> = vec![None; baking.edges.len()];
    let chooser = SolverChoice::new(baking.shape, &baking.shape.solver);
    let moves = |f: &&Fiber| f.vertices.iter().any(|&v| !baking.shape.fixed[v as usize]);
    let across = || baking.chains.iter().filter(|f| f.direction != Direction::Warp).filter(moves);
    // Whole fibers along the bias lie side by side, or they are swept.
    let leans = |f: &Fiber| f.direction == Direction::Bias && chooser.choose(f) == Solver::SemiImplicit;
    for fiber in across().filter(|f| chooser.choose(f) == Solver::GaussSeidel || leans(f)) {
        fiber.edges.iter().for_each(|&e| role[e as usize] = Some(fiber.direction));
    }
    // Warp that no fiber carries, such as the link by which a fiber hangs from the middle of another.
    let mut carried = vec![false; baking.edges.len()];
    baking.pieces.iter().flat_map(|p| &p.edges).for_each(|&e| carried[e as usize] = true);
    for fiber in baking.chains.iter().filter(|f| f.direction == Direction::Warp) {
        let single = fiber.edges.iter().filter(|&&e| !carried[e as usize]);
        single.for_each(|&e| role[e as usize] = Some(Direction::Warp));
    }
    let free = |i: usize| {
        let e = &baking.edges[i];
        !(baking.shape.fixed[e.a as usize] && baking.shape.fixed[e.b as usize])
    };
    let of = |bias: bool| -> Vec<(usize, Direction)> {
        let roles = role.iter().enumerate().filter_map(|(i, r)| r.map(|r| (i, r)));
        roles.filter(|(i, r)| free(*i) && (*r == Direction::Bias) == bias).collect()
    };
    // Fibers that are solved directly but do not lie side by side: warp that crosses warp, and what is chosen to be.
    let crossing = baking.order.crossing.iter().map(|&i| &baking.pieces[i]);
    let chosen = across().filter(|f| chooser.choose(f) != Solver::GaussSeidel && !leans(f));
    let lists_of: Vec<(&Fiber, Solver)> = crossing.chain(chosen).map(|f| (f, chooser.choose(f))).collect();
    let shear = of(true);
    let (diagonals, diagonal_curves, whole) = diagonals(baking, &shear, baking.chains.iter().filter(|f| leans(f)));
    let shear: Vec<_> = shear.into_iter().filter(|(i, _)| !whole[*i]).collect();
    let stencils = bending::stencils(baking.shape, baking.edges, baking.fabric);
    let (shear, shear_curves) = links(baking, true, &shear);
    let (weft, weft_curves) = links(baking, false, &of(false));
    let (fibers, fiber_curves) = fibers(baking, &chooser);
    let (crossing, crossing_curves) = lists(baking, lists_of);
    let link_curves = LinkCurves {
        diagonals: diagonal_curves,
        shear: shear_curves,
        weft: weft_curves,
        fibers: fiber_curves,
        crossing: crossing_curves,
    };
    Layout {
        diagonals,
        shear,
        weft,
        fibers,
        crossing,
        link_curves,
        bends: bends(baking, &stencils),
        skewed: bends(baking, &stencils),
        hubs: hubs::hubs(baking.order, &stencils),
        friction: bend_friction::lay_out(baking.shape, baking.edges, baking.order, &stencils, baking.fabric),
        tethers: tethers(baking),
        spans: spans(&baking.order.owner),
        owner: baking.order.owner.clone().into(),
    }
}

/// Inverse stiffness of an edge as part of a fiber (m/N).
fn compliance(fabric: &Fabric, edge: &Edge, fiber: Direction) -> f32 {
    stiffness::stretch(edge, fiber, fabric).recip()
}

/// Relative difference below which two lengths or masses count as the same: what the rounding of coordinates of f32 a
/// metre from the origin does to an edge of a centimetre.
const SAME: f32 = 1e-5;

fn same(a: f32, b: f32) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs()) || a == b
}

/// Links of single edges, each with the direction of the fiber that it belongs to.
fn links(baking: &BakeInput<'_>, bias: bool, edges: &[(usize, Direction)]) -> (Links, CurveTable) {
    let edge = |i: usize| &baking.edges[edges[i].0];
    let soft = |i: usize| compliance(baking.fabric, edge(i), edges[i].1);
    let particle = |v: u32| baking.order.particle[v as usize];
    let constraints: Vec<_> = (0..edges.len())
        .map(|i| {
            let (a, b) = (particle(edge(i).a), particle(edge(i).b));
            (edges[i].1, [a.min(b), a.max(b)])
        })
        .collect();
    let weight = |i: usize, k: usize| baking.weight(constraints[i].1[k]);
    let alike = |i: usize, j: usize| {
        !baking.curved(bias)
            && same(edge(i).rest, edge(j).rest)
            && same(soft(i), soft(j))
            && (0..2).all(|k| same(weight(i, k), weight(j, k)))
    };
    let (tuples, laid) = runs::lay_out(&constraints, &baking.order.owner, true, &alike);
    let link_curves = baking.link_curves(bias, laid.places.iter().map(|&i| (Some(edge(i)), edges[i].1)));
    let links = Links {
        tuples,
        rest: laid.places.iter().map(|&i| edge(i).rest).collect(),
        compliance: laid.places.iter().map(|&i| soft(i)).collect(),
    };
    (links, link_curves)
}

/// The fibers along the bias, of the edges given, that can be solved directly; and which edges those are.
fn diagonals<'a>(
    baking: &BakeInput<'_>,
    shear: &[(usize, Direction)],
    leaning: impl Iterator<Item = &'a Fiber>,
) -> (Diagonals, CurveTable, Vec<bool>) {
    let mut open = vec![false; baking.edges.len()];
    shear.iter().for_each(|&(i, _)| open[i] = true);
    let particle = |v: u32| baking.order.particle[v as usize];
    let mut fibers = Vec::new();
    for fiber in leaning {
        let ends = fiber.vertices.windows(2).map(|v| [particle(v[0]), particle(v[1])]);
        let links: Vec<_> = fiber.edges.iter().map(|&e| e as usize).zip(ends).collect();
        let (sin, cos) = portable::sin_cos(baking.edges[links[0].0].angle);
        // Links between two fixed particles belong to no fiber.
        for part in links.split(|l| !open[l.0]).filter(|p| !p.is_empty()) {
            fibers.push(BiasFiber { towards: sin * cos > 0.0, links: part.to_vec() });
        }
    }
    let edge = |i: usize| &baking.edges[i];
    let soft = |i: usize| compliance(baking.fabric, edge(i), Direction::Bias);
    let weights = |i: usize| [edge(i).a, edge(i).b].map(|v| baking.weights[v as usize]);
    let alike = |i: usize, j: usize| {
        let ([a, b], [c, d]) = (weights(i), weights(j));
        let same_masses = same(a, b) && same(a, c) && same(a, d);
        !baking.curved(true) && same(edge(i).rest, edge(j).rest) && same(soft(i), soft(j)) && same_masses
    };
    let (mut laid, places, numbers) = diagonals::lay_out(&fibers, &baking.order.owner, &alike);
    laid.rest = places.iter().map(|&i| edge(i).rest).collect();
    laid.compliance = places.iter().map(|&i| soft(i)).collect();
    let mut taken = vec![false; baking.edges.len()];
    numbers.iter().for_each(|&i| taken[i] = true);
    let link_curves = baking.link_curves(true, places.iter().map(|&i| (Some(edge(i)), Direction::Bias)));
    (laid, link_curves, taken)
}

fn fibers(baking: &BakeInput<'_>, chooser: &SolverChoice) -> (Fibers, CurveTable) {
    let mut laid: Vec<Option<&Edge>> = Vec::new();
    let (mut bundles, mut rows, mut rest, mut soft) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut links = 0;
    for side in &baking.order.sides {
        let pieces: Vec<&Fiber> = side.pieces.iter().map(|&p| &baking.pieces[p]).collect();
        let (first_row, at, serial) = (rows.len() as u32, rest.len() as u32, links as u32);
        links += pieces.len() * pieces[0].edges.len();
        let reach = |row: usize| pieces.iter().take_while(|p| p.vertices.len() > row).count() as u32;
        for row in 0..pieces[0].vertices.len() {
            let first = baking.order.particle[pieces[0].vertices[row] as usize];
            rows.push(BundleRow { first, lanes: reach(row) });
        }
        let alike = !baking.curved(false) && pieces.iter().all(|p| fibers_alike(baking, pieces[0], p));
        let solver = chooser.choose(pieces[0]);
        for link in 0..pieces[0].edges.len() {
            for piece in if alike { &pieces[..1] } else { &pieces[..] } {
                let edge = piece.edges.get(link).map(|&e| &baking.edges[e as usize]);
                rest.push(edge.map_or(0.0, |e| e.rest));
                soft.push(edge.map_or(ENDED, |e| compliance(baking.fabric, e, Direction::Warp)));
                laid.push(edge.filter(|_| solver != Solver::ZeroStretch));
            }
        }
        bundles.push(FiberBundle {
            solver,
            owner: side.owner,
            lanes: pieces.len() as u32,
            rows: first_row..rows.len() as u32,
            at,
            serial,
            alike,
        });
    }
    let link_curves = baking.link_curves(false, laid.into_iter().map(|edge| (edge, Direction::Warp)));
    (
        Fibers { bundles: bundles.into(), rows: rows.into(), links, rest: rest.into(), compliance: soft.into() },
        link_curves,
    )
}

/// Whether two fibers are the same, link by link and mass by mass.
fn fibers_alike(baking: &BakeInput<'_>, a: &Fiber, b: &Fiber) -> bool {
    let edge = |i: u32| &baking.edges[i as usize];
    let links = a.edges.iter().zip(&b.edges).all(|(&i, &j)| {
        let (i, j) = (edge(i), edge(j));
        same(i.rest, j.rest) && {
            let soft = |e| compliance(baking.fabric, e, Direction::Warp);
            same(soft(i), soft(j))
        }
    });
    let weight = |v: u32| baking.weights[v as usize];
    a.edges.len() == b.edges.len()
        && links
        && a.vertices.iter().zip(&b.vertices).all(|(&v, &w)| same(weight(v), weight(w)))
}

/// Fibers as index lists: sets without a common particle, in each of them lists of equal length and like solver.
fn lists(baking: &BakeInput<'_>, mut left: Vec<(&Fiber, Solver)>) -> (FiberLists, CurveTable) {
    let mut out = FiberListsBuilder::default();
    left.sort_by_key(|(f, solver)| (std::cmp::Reverse(f.edges.len()), f.direction, *solver, !f.is_hoop()));
    while !left.is_empty() {
        let mut taken = vec![false; baking.order.particle.len()];
        let mut set = Vec::new();
        left.retain(|&(f, solver)| {
            let apart = f.vertices.iter().all(|&v| !taken[v as usize]);
            if apart {
                f.vertices.iter().for_each(|&v| taken[v as usize] = true);
                set.push((f, solver));
            }
            !apart
        });
        out.set(baking, &set);
    }
    let bias = out.laid.iter().all(|(_, role)| *role == Direction::Bias);
    let link_curves =
        baking.link_curves(bias, out.laid.iter().map(|(i, role)| (i.map(|i| &baking.edges[i as usize]), *role)));
    let lists = FiberLists {
        lists: out.lists.into(),
        sets: out.sets.into(),
        index: out.index.into(),
        rest: out.rest.into(),
        compliance: out.compliance.into(),
    };
    (lists, link_curves)
}

#[derive(Default)]
struct FiberListsBuilder {
    lists: Vec<FiberList>,
    sets: Vec<[Range<u32>; OWNERS]>,
    index: Vec<u32>,
    rest: Vec<f32>,
    compliance: Vec<f32>,
    /// The edge of each place, and its direction; none where threads must not stretch at all.
    laid: Vec<(Option<u32>, Direction)>,
}

impl FiberListsBuilder {
    fn set(&mut self, baking: &BakeInput<'_>, set: &[(&Fiber, Solver)]) {
        let first = self.lists.len() as u32;
        let kind = |(f, solver): &(&Fiber, Solver)| (f.edges.len(), f.direction, *solver, f.is_hoop());
        for alike in set.chunk_by(|a, b| kind(a) == kind(b)) {
            alike.chunks(MAX_LISTED).for_each(|fibers| self.list(baking, fibers));
        }
        // Half of the lists each: they are of much the same length.
        let end = self.lists.len() as u32;
        let middle = first + (end - first).div_ceil(2);
        self.sets.push([first..middle, middle..end]);
    }

    fn list(&mut self, baking: &BakeInput<'_>, chosen: &[(&Fiber, Solver)]) {
        let fibers: Vec<&Fiber> = chosen.iter().map(|(f, _)| *f).collect();
        let closed = fibers[0].is_hoop();
        let rows = fibers[0].vertices.len() - usize::from(closed);
        self.lists.push(FiberList {
            solver: chosen[0].1,
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
            self.compliance.extend(edges().map(|e| compliance(baking.fabric, e, fibers[0].direction)));
            let gives = chosen[0].1 != Solver::ZeroStretch;
            let laid = fibers.iter().map(|f| (gives.then_some(f.edges[link]), f.direction));
            self.laid.extend(laid);
        }
    }
}

/// The stencils of `K` particles, 3 or 4, the root of the stiffness within the coefficients.
fn bends<const K: usize>(baking: &BakeInput<'_>, stencils: &[Stencil]) -> Bends<K> {
    let mine: Vec<&Stencil> = stencils.iter().filter(|s| s.v.len() == K).collect();
    let (mut tuples, mut coefficients) = (Vec::new(), Vec::new());
    for stencil in mine {
        let particle = |k: usize| baking.order.particle[stencil.v[k] as usize];
        let mut order: [usize; K] = std::array::from_fn(|k| k);
        // The middle leads: rows of middles are what lies side by side. Its neighbours follow in the order of memory.
        order[1..].sort_by_key(|&k| particle(k));
        tuples.push((stencil.direction, order.map(particle)));
        coefficients.push(order.map(|k| stencil.c[k] * stencil.k.sqrt()));
    }
    let alike = |i: usize, j: usize| {
        let weight = |i: usize, k: usize| baking.weight(tuples[i].1[k]);
        (0..K).all(|k| same(coefficients[i][k], coefficients[j][k]) && same(weight(i, k), weight(j, k)))
    };
    let (tuples, laid) = runs::lay_out(&tuples, &baking.order.owner, false, &alike);
    let coefficients = std::array::from_fn(|k| laid.places.iter().map(|&i| coefficients[i][k]).collect());
    Bends { tuples, coefficients }
}

/// For each particle the fixed one nearest to it along the cloth, itself where there is none.
fn tethers(baking: &BakeInput<'_>) -> Tethers {
    let n = baking.order.particle.len();
    let mut out = Tethers { anchor: (0..n as u32).collect(), length: vec![0.0; n].into() };
    for tether in tethers::tethers(baking.shape) {
        let at = baking.order.particle[tether.vertex as usize] as usize;
        out.anchor[at] = baking.order.particle[tether.anchor as usize];
        out.length[at] = tether.length;
    }
    out
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
