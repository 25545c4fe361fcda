//! Trouser legs: where a garment ends in two edges side by side, it goes around two legs.

use glam::DVec2;

use super::outlines::coordinates;
use super::panels::{Around, ArrangedPanel};
use crate::tailor::SewnMesh;
use toile_bake::check::corners;

/// Legs of a garment.
#[derive(Debug, Clone, PartialEq)]
pub struct Legs {
    /// Height at which they part (m), in the coordinates of the panels.
    pub crotch: f64,
    /// Whose panel each is: of the left leg, the right one, or of neither `[panels]`.
    pub left: Vec<Option<bool>>,
}

/// Free edges whose middle is at least this far from that of the body (m) are a leg's.
const APART_M: f64 = 0.03;

/// The legs of a garment, if it has any.
pub fn legs(sewn: &SewnMesh, all: &[ArrangedPanel]) -> Option<Legs> {
    let hung = |m: &&[u32; 2]| all[m[0] as usize].around == Around::Trunk;
    // Sideways in space, at the wearer's left positive.
    let sideways = |m: &[u32; 2]| {
        let panel = &all[m[0] as usize];
        DVec2::new(coordinates(sewn, all, *m).x * panel.angle.cos(), coordinates(sewn, all, *m).y)
    };
    let height = |v: &u32| sewn.members[*v as usize].iter().find(hung).map(|m| sideways(m).y);
    let loops = free_loops(sewn);
    let mean = |l: &Vec<u32>| {
        let heights: Vec<f64> = l.iter().filter_map(height).collect();
        heights.iter().sum::<f64>() / heights.len().max(1) as f64
    };
    let lowest = loops.iter().filter(|l| l.iter().any(|v| height(v).is_some())).map(mean).fold(f64::MAX, f64::min);
    let low = loops.iter().filter(|l| mean(l) < lowest + 0.1 && l.iter().any(|v| height(v).is_some()));
    let mut left = vec![None; all.len()];
    let mut sides = [false; 2];
    for edge in low {
        let members: Vec<&[u32; 2]> = edge.iter().flat_map(|v| &sewn.members[*v as usize]).filter(hung).collect();
        let middle = members.iter().map(|m| sideways(m).x).sum::<f64>() / members.len().max(1) as f64;
        if middle.abs() < APART_M {
            return None;
        }
        sides[usize::from(middle > 0.0)] = true;
        members.iter().for_each(|m| left[m[0] as usize] = Some(middle > 0.0));
    }
    if sides != [true; 2] {
        return None;
    }
    // They part at the lowest point at which a panel of the one is sewn to one of the other.
    let joins = |m: &&Vec<[u32; 2]>| {
        let side = |s: bool| m.iter().any(|m| left[m[0] as usize] == Some(s));
        side(true) && side(false)
    };
    let heights = sewn.members.iter().filter(joins).flatten().filter(hung).map(|m| sideways(m).y);
    let crotch = heights.fold(f64::MAX, f64::min);
    (crotch < f64::MAX).then_some(Legs { crotch, left })
}

/// The free edges of a sewn mesh as closed loops of vertices.
pub fn free_loops(sewn: &SewnMesh) -> Vec<Vec<u32>> {
    let mut count = std::collections::BTreeMap::<[u32; 2], [u32; 3]>::new();
    for face in &sewn.faces {
        let ring = corners(face);
        for (k, &a) in ring.iter().enumerate() {
            let b = ring[(k + 1) % ring.len()];
            let seen = count.entry([a.min(b), a.max(b)]).or_insert([0, a, b]);
            seen[0] += 1;
        }
    }
    let mut next: Vec<Vec<u32>> = vec![Vec::new(); sewn.members.len()];
    for [faces, a, b] in count.into_values() {
        if faces == 1 {
            next[a as usize].push(b);
        }
    }
    let mut loops = Vec::new();
    for start in 0..next.len() as u32 {
        let mut found = Vec::new();
        let mut at = start;
        while let Some(to) = next[at as usize].pop() {
            found.push(at);
            at = to;
        }
        if !found.is_empty() {
            loops.push(found);
        }
    }
    loops
}
