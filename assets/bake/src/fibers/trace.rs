//! Following edges as fibers.
//!
//! Warp fibers are a cover of the vertices by paths that share none: each vertex chooses one edge on and one edge back
//! among those that lean little enough ([`ALONG_COS`]). That is a matching between the lower ends of some vertices and the upper
//! ends of others (the more edges it holds, the fewer and longer the paths): first greedily by how well the edges are
//! aligned, then by augmenting paths until no vertex that could hang is left without (Hopcroft and Karp 1973, in the
//! plain form of one breadth-first search a vertex). Weft fibers are found the same way among the edges that are left, and
//! close to hoops. What remains runs along the bias.

use glam::Vec3;
use toile_base::numeric::portable;

use super::{Direction, Edge, Fiber};

/// Stands for no edge, where the index of an edge is expected.
const NONE: u32 = u32::MAX;

/// An edge joins a fiber of warp or weft while it leans by less than 45 degrees; a vertex that finds no such edge takes
/// one that leans by less than 60, which in an irregular mesh makes fibers twice as long.
const ALONG_COS: [f32; 2] = [0.707, 0.5];

/// What no such edge leads into may hang by one that leans by less than 75 degrees.
const HANG_COS: f32 = 0.26;

/// A fiber along the bias runs on through a vertex while it turns by less than 45 degrees.
const STRAIGHT_COS: f32 = 0.7;

/// Follows the edges of a mesh as fibers: warp, weft, bias, in this order. Every edge is in exactly one, be it alone
/// ([`Fiber::is_loose`]). No two warp fibers cross, nor do two weft fibers; but a warp fiber that would start within the
/// cloth, because there is more cloth below than above, starts at a vertex of the fiber that it hangs from; such come
/// after all others of the warp.
pub fn trace(positions: &[Vec3], edges: &[Edge]) -> Vec<Fiber> {
    let mut used = vec![false; edges.len()];
    let mut fibers = Vec::new();
    for direction in [Direction::Warp, Direction::Weft] {
        let mut threads = FiberCandidates::new(direction, positions.len(), edges, &used);
        threads.greedy(ALONG_COS[0]);
        ALONG_COS.iter().for_each(|&least| threads.augment(least));
        let mut chains = threads.chains();
        if direction == Direction::Warp {
            threads.hang(&mut chains, &used);
            // Those that stand on their own come first, so that who hands out vertices hands them to these.
            chains.sort_by_key(|fiber| threads.behind[fiber.vertices[1] as usize] != fiber.edges[0]);
        }
        chains.iter().flat_map(|fiber| &fiber.edges).for_each(|&e| used[e as usize] = true);
        fibers.append(&mut chains);
    }
    fibers.extend(rest(positions, edges, &mut used));
    fibers
}

/// The candidates for the fibers of one direction and what was chosen among them.
struct FiberCandidates<'a> {
    direction: Direction,
    edges: &'a [Edge],
    /// Indices of the candidates, best aligned first.
    ranked: Vec<u32>,
    /// The candidates that lead into each vertex, best aligned first.
    into: Vec<Vec<u32>>,
    /// The chosen edge that leads on from each vertex, down the warp or along the weft.
    ahead: Vec<u32>,
    /// The chosen edge that leads into each vertex.
    behind: Vec<u32>,
}

impl<'a> FiberCandidates<'a> {
    fn new(direction: Direction, vertices: usize, edges: &'a [Edge], used: &[bool]) -> Self {
        let none = vec![NONE; vertices];
        let mut threads = Self {
            direction,
            edges,
            ranked: Vec::new(),
            into: vec![Vec::new(); vertices],
            ahead: none.clone(),
            behind: none,
        };
        let open = |&e: &u32| edges[e as usize].side && !used[e as usize];
        let mut ranked: Vec<u32> =
            (0..edges.len() as u32).filter(open).filter(|&e| threads.along(e).abs() > ALONG_COS[1]).collect();
        ranked.sort_by_key(|&e| threads.rank(e));
        for &e in &ranked {
            let head = threads.head(e);
            threads.into[head as usize].push(e);
        }
        threads.ranked = ranked;
        threads
    }

    /// By how far an edge is off the direction, rounded so that edges that are alike but for rounding tie; then those that
    /// lean one way come first.
    fn rank(&self, e: u32) -> (u32, bool, u32) {
        let off = portable::acos(self.along(e).abs().min(1.0));
        ((off * 1e5).round() as u32, self.lean(e) < 0.0, e)
    }

    /// Cosine between the edge from a to b and the direction.
    fn along(&self, e: u32) -> f32 {
        let angle = self.edges[e as usize].angle;
        let (sin, cos) = portable::sin_cos(angle);
        if self.direction == Direction::Warp { cos } else { sin }
    }

    /// Which way the edge leans as it leads on: its sine, towards the weft or against the warp.
    fn lean(&self, e: u32) -> f32 {
        let (sin, cos) = portable::sin_cos(self.edges[e as usize].angle);
        if self.direction == Direction::Warp { sin * cos.signum() } else { -cos * sin.signum() }
    }

    /// Where the edge comes from.
    fn tail(&self, e: u32) -> u32 {
        let edge = &self.edges[e as usize];
        if self.along(e) > 0.0 { edge.a } else { edge.b }
    }

    /// Vertex at which an edge ends, along the threads.
    fn head(&self, e: u32) -> u32 {
        let edge = &self.edges[e as usize];
        if self.along(e) > 0.0 { edge.b } else { edge.a }
    }

    /// Takes every candidate, best aligned first, whose both ends are free.
    fn greedy(&mut self, least: f32) {
        for k in 0..self.ranked.len() {
            let e = self.ranked[k];
            if self.along(e).abs() < least {
                break;
            }
            let (tail, head) = (self.tail(e) as usize, self.head(e) as usize);
            if self.ahead[tail] == NONE && self.behind[head] == NONE {
                self.ahead[tail] = e;
                self.behind[head] = e;
            }
        }
    }

    /// Finds an edge for every vertex that can have one. What a search that failed has seen can serve no later one
    /// either, so all failures together see each candidate once.
    fn augment(&mut self, least: f32) {
        let mut via = vec![NONE; self.ahead.len()];
        for k in 0..self.ranked.len() {
            let start = self.head(self.ranked[k]);
            if self.behind[start as usize] == NONE {
                self.search(start, least, &mut via);
            }
        }
    }

    /// Breadth first from a vertex without an edge into it; `via` keeps the edge by which each vertex was seen.
    fn search(&mut self, start: u32, least: f32, via: &mut [u32]) {
        let (mut queue, mut seen, mut next) = (vec![start], Vec::new(), 0);
        while next < queue.len() {
            let head = queue[next];
            next += 1;
            for &e in &self.into[head as usize] {
                let tail = self.tail(e);
                if via[tail as usize] != NONE || self.along(e).abs() < least {
                    continue;
                }
                via[tail as usize] = e;
                seen.push(tail);
                match self.ahead[tail as usize] {
                    NONE => {
                        self.swap(tail, via);
                        seen.iter().for_each(|&t| via[t as usize] = NONE);
                        return;
                    }
                    taken => queue.push(self.head(taken)),
                }
            }
        }
    }

    /// Exchanges the edges along the path that a search has found.
    fn swap(&mut self, end: u32, via: &[u32]) {
        let mut tail = end;
        loop {
            let e = via[tail as usize];
            let head = self.head(e);
            let before = self.behind[head as usize];
            self.ahead[tail as usize] = e;
            self.behind[head as usize] = e;
            if before == NONE {
                return;
            }
            tail = self.tail(before);
        }
    }

    /// The chosen edges as chains: open ones from their starts, then hoops.
    fn chains(&self) -> Vec<Fiber> {
        let mut walked = vec![false; self.ahead.len()];
        let mut chains = Vec::new();
        for open in [true, false] {
            for start in 0..self.ahead.len() {
                let starts = self.ahead[start] != NONE && !walked[start] && (!open || self.behind[start] == NONE);
                if starts {
                    chains.push(self.walk(start as u32, &mut walked));
                }
            }
        }
        chains
    }

    fn walk(&self, start: u32, walked: &mut [bool]) -> Fiber {
        let mut fiber = Fiber { direction: self.direction, vertices: vec![start], edges: Vec::new() };
        let mut at = start;
        while self.ahead[at as usize] != NONE && !walked[at as usize] {
            walked[at as usize] = true;
            let e = self.ahead[at as usize];
            at = self.head(e);
            fiber.edges.push(e);
            fiber.vertices.push(at);
        }
        fiber
    }

    /// Hangs what starts within the cloth, fibers and single vertices, from a neighbour: its best edge up is put in front
    /// of it. One fiber at most hangs from a vertex, so that few sets hold them all.
    fn hang(&self, chains: &mut Vec<Fiber>, used: &[bool]) {
        let mut chain_of = vec![NONE; self.ahead.len()];
        for (c, fiber) in chains.iter().enumerate() {
            fiber.vertices.iter().for_each(|&v| chain_of[v as usize] = c as u32);
        }
        let mut hung: Vec<bool> = self.behind.iter().map(|&e| e != NONE).collect();
        let mut carries = vec![false; self.ahead.len()];
        let open = |&e: &u32| self.edges[e as usize].side && !used[e as usize];
        let mut steep: Vec<u32> =
            (0..self.edges.len() as u32).filter(open).filter(|&e| self.along(e).abs() > HANG_COS).collect();
        steep.sort_by_key(|&e| self.rank(e));
        for e in steep {
            let (tail, head) = (self.tail(e), self.head(e));
            let (above, below) = (chain_of[tail as usize], chain_of[head as usize]);
            if hung[head as usize] || carries[tail as usize] || (below != NONE && above == below) {
                continue;
            }
            hung[head as usize] = true;
            carries[tail as usize] = true;
            if below == NONE {
                chains.push(Fiber { direction: self.direction, vertices: vec![tail, head], edges: vec![e] });
            } else {
                chains[below as usize].vertices.insert(0, tail);
                chains[below as usize].edges.insert(0, e);
            }
        }
    }
}

/// Joins the edges that are left: at each vertex those two that continue each other best are linked.
fn rest(positions: &[Vec3], edges: &[Edge], used: &mut [bool]) -> Vec<Fiber> {
    let next = continuations(positions, edges, used);
    let mut visited = vec![NONE; positions.len()];
    let mut fibers: Vec<Fiber> = Vec::new();
    // Open chains first, from their ends; what is left over afterwards are hoops.
    for open in [true, false] {
        for start in 0..edges.len() {
            for from_a in [true, false] {
                let end_is_open = next[start][usize::from(!from_a)] == NONE;
                if !used[start] && (!open || end_is_open) {
                    let from = if from_a { edges[start].a } else { edges[start].b };
                    visited[from as usize] = fibers.len() as u32;
                    let mut pass =
                        EdgeWalk { edges, next: &next, used, visited: &mut visited, stamp: fibers.len() as u32 };
                    fibers.push(pass.walk(start, from));
                }
            }
        }
    }
    fibers
}

/// For each edge, the edge that continues it at its `a` end and at its `b` end.
fn continuations(positions: &[Vec3], edges: &[Edge], used: &[bool]) -> Vec<[u32; 2]> {
    let mut at_vertex: Vec<Vec<u32>> = vec![Vec::new(); positions.len()];
    for (i, e) in edges.iter().enumerate().filter(|(i, _)| !used[*i]) {
        at_vertex[e.a as usize].push(i as u32);
        at_vertex[e.b as usize].push(i as u32);
    }
    let mut next = vec![[NONE; 2]; edges.len()];
    for (v, around) in at_vertex.iter().enumerate() {
        let away = |i: u32| {
            let e = &edges[i as usize];
            let other = if e.a as usize == v { e.b } else { e.a };
            (positions[other as usize] - positions[v]).normalize_or_zero()
        };
        let mut pairs = Vec::new();
        for (k, &i) in around.iter().enumerate() {
            let straight = around[..k].iter().map(|&j| (-away(i).dot(away(j)), i, j));
            pairs.extend(straight.filter(|(cos, ..)| *cos > STRAIGHT_COS));
        }
        pairs.sort_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)).then(x.2.cmp(&y.2)));
        let slot = |e: u32| usize::from(edges[e as usize].a as usize != v);
        for (_, i, j) in pairs {
            if next[i as usize][slot(i)] == NONE && next[j as usize][slot(j)] == NONE {
                next[i as usize][slot(i)] = j;
                next[j as usize][slot(j)] = i;
            }
        }
    }
    next
}

/// One walk along linked edges.
struct EdgeWalk<'a> {
    edges: &'a [Edge],
    next: &'a [[u32; 2]],
    used: &'a mut [bool],
    /// The last fiber that came through each vertex.
    visited: &'a mut [u32],
    stamp: u32,
}

impl EdgeWalk<'_> {
    /// From an edge's end as far as the links go, but through no vertex twice: a fiber that meets itself ends there,
    /// unless it closes a hoop.
    fn walk(&mut self, start: usize, from: u32) -> Fiber {
        let mut fiber = Fiber { direction: Direction::Bias, vertices: vec![from], edges: Vec::new() };
        let (mut edge, mut at) = (start, from);
        loop {
            self.used[edge] = true;
            let e = &self.edges[edge];
            at = if e.a == at { e.b } else { e.a };
            fiber.edges.push(edge as u32);
            fiber.vertices.push(at);
            self.visited[at as usize] = self.stamp;
            let next = self.next[edge][usize::from(e.a != at)];
            if next == NONE || self.used[next as usize] {
                return fiber;
            }
            let n = &self.edges[next as usize];
            let beyond = if n.a == at { n.b } else { n.a };
            let closes = self.next[next as usize][usize::from(n.a != beyond)] == start as u32;
            if self.visited[beyond as usize] == self.stamp && !(beyond == from && closes) {
                return fiber;
            }
            edge = next as usize;
        }
    }
}
