//! The girths of a MakeHuman body along rows of its mesh, as its sliders are labelled with: the length of a closed
//! polyline around the body. A row runs straight on through the quads from its first edge until it comes back, or to
//! its last vertex, from where the tape goes straight across (from bust point to bust point). Where the tape bridges a
//! hollow (the spine, the navel, the cleft of the seat) the row does too.
//!
//! These follow the mesh, not a level: they are not the girths of EN 13402, which [`crate::body::tape`] reads.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;

use crate::import::avatar::Flaw;
use toile_bake::shape::NO_VERTEX;

/// Girths and height of a body (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MakehumanGirths {
    /// Sole to crown, over the body's own vertices.
    pub height: f32,
    /// Girth of the neck along its row of vertices (m).
    pub neck: f32,
    /// Around the bust.
    pub bust: f32,
    /// Around the waist.
    pub waist: f32,
    /// Around the hips.
    pub hips: f32,
}

/// A row of `hm08`: its first edge, the vertex where it ends before it has come around, the vertices that the tape
/// touches on its way straight back, and the pairs of vertices between which the row is bridged.
struct GirthRow {
    first: [u32; 2],
    last: Option<u32>,
    back: &'static [u32],
    bridges: &'static [[u32; 2]],
}

const NECK: GirthRow = GirthRow { first: [755, 756], last: None, back: &[], bridges: &[] };
const BUST: GirthRow = GirthRow {
    first: [8_462, 8_446],
    last: Some(1_790),
    back: &[1_783, 1_799, 8_471, 8_455],
    bridges: &[[10_606, 3_942]],
};
const WAIST: GirthRow = GirthRow { first: [4_108, 4_113], last: None, back: &[], bridges: &[[4_121, 10_760]] };
const HIPS: GirthRow = GirthRow { first: [4_226, 4_227], last: None, back: &[], bridges: &[[10_862, 4_227]] };

/// Longest row (vertices): one that is longer does not close.
const MAX_ROW: usize = 400;

/// Metres in a decimetre.
pub(super) const DECIMETRE: f32 = 0.1;

impl MakehumanGirths {
    /// Reads the rows of a body's faces; `positions` are of the whole base (dm).
    pub fn of(positions: &[Vec3], faces: &[[u32; 4]]) -> Result<Self, Flaw> {
        let net = EdgeNet::of(faces);
        let along = |row: &GirthRow, name: &str| {
            let missing = || format!("the row of its {name} is not there; use the base mesh hm08 as it is");
            let vertices = net.row(row.first, row.last).ok_or_else(missing)?;
            let mut vertices = bridged(vertices, row.bridges).ok_or_else(missing)?;
            vertices.extend(row.back);
            let next = vertices.iter().cycle().skip(1);
            let edges = vertices.iter().zip(next).map(|(a, b)| positions[*a as usize].distance(positions[*b as usize]));
            Ok::<f32, Flaw>(edges.sum::<f32>() * DECIMETRE)
        };
        let used: BTreeSet<u32> = faces.iter().flatten().copied().filter(|v| *v != NO_VERTEX).collect();
        let heights = used.iter().map(|v| positions[*v as usize].y);
        let [low, high] = heights.fold([f32::INFINITY, f32::NEG_INFINITY], |[l, h], y| [l.min(y), h.max(y)]);
        Ok(Self {
            height: (high - low) * DECIMETRE,
            neck: along(&NECK, "neck")?,
            bust: along(&BUST, "bust")?,
            waist: along(&WAIST, "waist")?,
            hips: along(&HIPS, "hips")?,
        })
    }

    /// The girths with their names.
    pub fn named(&self) -> [(&'static str, f32); 5] {
        let Self { height, neck, bust, waist, hips } = *self;
        [("height", height), ("neck", neck), ("bust", bust), ("waist", waist), ("hips", hips)]
    }
}

/// The edges of a mesh: the neighbours of each vertex, and the faces of each edge.
struct EdgeNet {
    neighbours: BTreeMap<u32, BTreeSet<u32>>,
    faces: BTreeMap<[u32; 2], Vec<usize>>,
}

impl EdgeNet {
    fn of(faces: &[[u32; 4]]) -> Self {
        let mut net = Self { neighbours: BTreeMap::new(), faces: BTreeMap::new() };
        for (f, face) in faces.iter().enumerate() {
            let corners: Vec<u32> = face.iter().copied().filter(|v| *v != NO_VERTEX).collect();
            for (k, &a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                net.neighbours.entry(a).or_default().insert(b);
                net.neighbours.entry(b).or_default().insert(a);
                net.faces.entry(sorted(a, b)).or_default().push(f);
            }
        }
        net
    }

    /// The row that begins with an edge: at each vertex of four edges it goes on by the one opposite.
    fn row(&self, [a, b]: [u32; 2], last: Option<u32>) -> Option<Vec<u32>> {
        self.faces.get(&sorted(a, b))?;
        let mut row = vec![a, b];
        while row.len() < MAX_ROW {
            let [from, here] = [row[row.len() - 2], row[row.len() - 1]];
            let around = self.neighbours.get(&here).filter(|n| n.len() == 4)?;
            let beside = self.faces.get(&sorted(from, here))?;
            let opposite = |n: &&u32| {
                **n != from && !self.faces.get(&sorted(here, **n)).is_some_and(|f| f.iter().any(|f| beside.contains(f)))
            };
            let next = *around.iter().find(opposite)?;
            if next == a {
                return Some(row);
            }
            row.push(next);
            if Some(next) == last {
                return Some(row);
            }
        }
        None
    }
}

fn sorted(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The row without what lies between the two ends of each bridge, on the shorter side.
fn bridged(mut row: Vec<u32>, bridges: &[[u32; 2]]) -> Option<Vec<u32>> {
    for ends in bridges {
        let [i, j] = ends.map(|v| row.iter().position(|w| *w == v));
        let (i, j) = (i?.min(j?), i?.max(j?));
        if j - i <= row.len() - (j - i) {
            row.drain(i + 1..j);
        } else {
            row.truncate(j + 1);
            row.drain(..i);
        }
    }
    Some(row)
}
