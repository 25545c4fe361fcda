//! The order of the particles: what is solved together comes to lie side by side.
//!
//! Columns are the warp fibers. Columns of equal length that stand next to each other make a strip; its particles are
//! numbered row by row, in each row first the even columns and then the odd ones, so that the links between neighbours,
//! along the weft and across both diagonals, are runs too. Columns that stand in no strip are bundled by length.

use std::collections::BTreeMap;

use super::fibers::{Direction, Edge, Fiber};
use toile_base::garment::layout::{MAX_LISTED, OWNERS};

/// Garments with fewer particles than this are not shared between workers: the barriers would cost as much as sharing saves.
pub const SHARE_FROM: usize = 8_192;

/// Fewest columns of a strip.
const LEAST_STRIP: usize = 6;

/// Columns side by side; longest first. Indices into the pieces that were given.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnGroup {
    /// Owner (worker) of these particles.
    pub owner: u8,
    /// Indices of the warp pieces among them.
    pub pieces: Vec<usize>,
}

/// The order of particles in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct ParticleOrder {
    /// The vertex that each particle is.
    pub source: Vec<u32>,
    /// The particle that each vertex became.
    pub particle: Vec<u32>,
    /// Owner (worker) of each particle `[particles]`.
    pub owner: Vec<u8>,
    /// Pieces that lie side by side.
    pub sides: Vec<ColumnGroup>,
    /// Pieces that cross another one and are kept as index lists.
    pub crossing: Vec<usize>,
}

/// Orders the vertices by the warp pieces, each of which starts at its support.
pub fn order(pieces: &[Fiber], edges: &[Edge], vertices: usize) -> ParticleOrder {
    let mut claimed = vec![usize::MAX; vertices];
    let (mut columns, mut crossing) = (Vec::new(), Vec::new());
    for (i, piece) in pieces.iter().enumerate() {
        let closed = piece.vertices.first() == piece.vertices.last();
        if closed || piece.vertices.iter().any(|&v| claimed[v as usize] != usize::MAX) {
            crossing.push(i);
        } else {
            piece.vertices.iter().for_each(|&v| claimed[v as usize] = i);
            columns.push(i);
        }
    }
    let beside = neighbours(pieces, edges, &claimed);
    let (strips, single) = strips(&columns, &beside);
    let shared = vertices >= SHARE_FROM;
    let mut out = ParticleOrder {
        source: Vec::with_capacity(vertices),
        particle: vec![u32::MAX; vertices],
        owner: Vec::with_capacity(vertices),
        sides: Vec::new(),
        crossing,
    };
    for strip in strips {
        out.strip(pieces, &strip, shared);
    }
    out.bundle(pieces, single, shared);
    for v in 0..vertices as u32 {
        if out.particle[v as usize] == u32::MAX {
            out.push(v, 0);
        }
    }
    out
}

/// For each piece, the pieces beside it whose rows are linked to its own rows one to one.
fn neighbours(pieces: &[Fiber], edges: &[Edge], claimed: &[usize]) -> Vec<Vec<usize>> {
    let mut row = vec![0usize; claimed.len()];
    for (i, piece) in pieces.iter().enumerate() {
        for (r, &v) in piece.vertices.iter().enumerate() {
            if claimed[v as usize] == i {
                row[v as usize] = r;
            }
        }
    }
    let mut votes: Vec<BTreeMap<usize, usize>> = vec![BTreeMap::new(); pieces.len()];
    for e in edges.iter().filter(|e| e.direction == Direction::Weft) {
        let (a, b) = (e.a as usize, e.b as usize);
        let (p, q) = (claimed[a], claimed[b]);
        if p != usize::MAX && q != usize::MAX && p != q && row[a] == row[b] {
            *votes[p].entry(q).or_default() += 1;
            *votes[q].entry(p).or_default() += 1;
        }
    }
    let beside = |(i, votes): (usize, &BTreeMap<usize, usize>)| {
        let len = pieces[i].vertices.len();
        let alike = votes.iter().filter(|(q, n)| pieces[**q].vertices.len() == len && **n * 2 > len);
        let mut found: Vec<(usize, usize)> = alike.map(|(q, n)| (*n, *q)).collect();
        found.sort_by_key(|(n, q)| (std::cmp::Reverse(*n), *q));
        found.truncate(2);
        found.into_iter().map(|(_, q)| q).collect()
    };
    votes.iter().enumerate().map(beside).collect()
}

/// Walks from column to column: strips of at least [`LEAST_STRIP`], and the columns left over.
fn strips(columns: &[usize], beside: &[Vec<usize>]) -> (Vec<Vec<usize>>, Vec<usize>) {
    let mutual = |p: usize| beside[p].iter().copied().filter(move |&q| beside[q].contains(&p));
    let mut used = vec![false; beside.len()];
    let (mut found, mut single) = (Vec::new(), Vec::new());
    // Ends first, so that an open strip is walked from one side to the other; rings start anywhere.
    for ends in [true, false] {
        for &start in columns {
            if used[start] || (ends && mutual(start).count() > 1) {
                continue;
            }
            let mut strip = vec![start];
            used[start] = true;
            while let Some(next) = mutual(strip[strip.len() - 1]).find(|&q| !used[q]) {
                used[next] = true;
                strip.push(next);
            }
            if strip.len() < LEAST_STRIP { single.extend(strip) } else { found.push(strip) }
        }
    }
    (found, single)
}

impl ParticleOrder {
    fn push(&mut self, vertex: u32, owner: u8) {
        self.particle[vertex as usize] = self.source.len() as u32;
        self.source.push(vertex);
        self.owner.push(owner);
    }

    /// Rows of a strip, in each the even columns and then the odd ones. Owners have halves of their own in memory: where
    /// they took turns within a row, each core's prefetcher fetched the lines that the other was writing, and two workers
    /// took twice the time of one.
    fn strip(&mut self, pieces: &[Fiber], strip: &[usize], shared: bool) {
        let middle = if shared { strip.len() / 2 } else { strip.len() };
        for (owner, half) in [0..middle, middle..strip.len()].into_iter().enumerate() {
            let parity = |p: usize| half.clone().filter(move |c| c % 2 == p).map(|c| strip[c]).collect();
            let mut sides = [0, 1].map(|p| ColumnGroup { owner: owner as u8, pieces: parity(p) }).to_vec();
            sides.retain(|s| !s.pieces.is_empty());
            for row in 0..pieces[strip[0]].vertices.len() {
                for &p in sides.iter().flat_map(|s| &s.pieces) {
                    self.push(pieces[p].vertices[row], owner as u8);
                }
            }
            self.sides.extend(sides);
        }
    }

    /// Columns of unlike length, bundled by length; each bundle's rows lie one after the other.
    fn bundle(&mut self, pieces: &[Fiber], mut single: Vec<usize>, shared: bool) {
        single.sort_by_key(|&p| (std::cmp::Reverse(pieces[p].vertices.len()), p));
        for (k, group) in single.chunks(MAX_LISTED).enumerate() {
            let owner = if shared { (k % OWNERS) as u8 } else { 0 };
            for row in 0..pieces[group[0]].vertices.len() {
                for &p in group.iter().filter(|&&p| pieces[p].vertices.len() > row) {
                    self.push(pieces[p].vertices[row], owner);
                }
            }
            self.sides.push(ColumnGroup { owner, pieces: group.to_vec() });
        }
    }
}
