//! Diagonals: fibers along the bias, laid side by side so that they can be solved directly.
//!
//! Fibers that lean the same way go together in families that no particle is in twice. Within a family, links that
//! advance together are a run; a run comes after the runs that lead to its particles. What leads from one owner's
//! particles to the other's, and what lies in no run, stays a link of its own.

use std::collections::{BTreeMap, BTreeSet};

use toile_base::garment::layout::{ConstraintRun, DiagonalShare, Diagonals, OWNERS};

/// Fewest links of a run: with fewer, a link by itself is no dearer.
const LEAST: usize = 4;

/// One fiber: its links in order, each with its index and the particles that it leads from and to.
#[derive(Debug, Clone)]
pub struct BiasFiber {
    /// Whether it leans towards the weft as it runs down, or away from it.
    pub towards: bool,
    /// Index of each link, and its particles.
    pub links: Vec<(usize, [u32; 2])>,
}

impl BiasFiber {
    /// The same fiber, from its particle of the lower number on.
    fn upright(&self) -> Vec<(usize, [u32; 2])> {
        let ends = self.links.first().map(|l| l.1[0]).zip(self.links.last().map(|l| l.1[1]));
        if ends.is_some_and(|(first, last)| first > last) {
            self.links.iter().rev().map(|&(i, [a, b])| (i, [b, a])).collect()
        } else {
            self.links.clone()
        }
    }
}

/// Lays fibers out. Gives the families without their parameters, and the link of each parameter place and of each
/// number.
pub fn lay_out(
    fibers: &[BiasFiber],
    owner: &[u8],
    alike: &dyn Fn(usize, usize) -> bool,
) -> (Diagonals, Vec<usize>, Vec<usize>) {
    let mut out = Diagonals::default();
    let (mut runs, mut starts, mut families) = (Vec::new(), Vec::new(), Vec::new());
    let (mut places, mut numbers) = (Vec::new(), Vec::new());
    for family in families_of(fibers, owner.len()) {
        let strands = std::array::from_fn(|share| {
            let mine = |v: &[u32; 2]| v.iter().all(|&p| usize::from(owner[p as usize]) == share);
            let links: BTreeMap<[u32; 2], usize> = family.iter().filter(|l| mine(&l.1)).map(|&(i, v)| (v, i)).collect();
            let ordered = ordered(&side_by_side(&links));
            let (first_run, first_start) = (runs.len() as u32, starts.len() as u32);
            let reached: BTreeSet<u32> = ordered.iter().flat_map(|r| (0..r.len).map(|t| r.first[1] + t)).collect();
            for mut run in ordered {
                let tails = (0..run.len).map(|t| run.first[0] + t);
                starts.extend(tails.filter(|p| !reached.contains(p)));
                let link = |t: u32| links[&run.first.map(|f| f + t)];
                run.alike = (0..run.len).all(|t| alike(link(0), link(t)));
                (run.at, run.serial) = (places.len() as u32, numbers.len() as u32);
                numbers.extend((0..run.len).map(link));
                places.extend((0..if run.alike { 1 } else { run.len }).map(link));
                runs.push(run);
            }
            DiagonalShare { runs: first_run..runs.len() as u32, starts: first_start..starts.len() as u32 }
        });
        if strands.iter().any(|s: &DiagonalShare| !s.runs.is_empty()) {
            families.push(strands);
        }
    }
    (out.runs, out.starts, out.families) = (runs.into(), starts.into(), families.into());
    (out, places, numbers)
}

/// Fibers of one lean that share no particle, as the links of each family.
fn families_of(fibers: &[BiasFiber], particles: usize) -> Vec<Vec<(usize, [u32; 2])>> {
    let mut families: Vec<(bool, Vec<bool>, Vec<_>)> = Vec::new();
    for fiber in fibers {
        let all: Vec<u32> = fiber.links.iter().map(|l| l.1[0]).chain(fiber.links.last().map(|l| l.1[1])).collect();
        let once = all.iter().collect::<BTreeSet<_>>().len() == all.len();
        if !once {
            continue;
        }
        let free = |f: &(bool, Vec<bool>, _)| f.0 == fiber.towards && all.iter().all(|&p| !f.1[p as usize]);
        let at = families.iter().position(free).unwrap_or_else(|| {
            families.push((fiber.towards, vec![false; particles], Vec::new()));
            families.len() - 1
        });
        all.iter().for_each(|&p| families[at].1[p as usize] = true);
        families[at].2.extend(fiber.upright());
    }
    families.into_iter().map(|f| f.2).collect()
}

/// Runs of links that advance by one particle at both ends; no particle is at both ends of a run.
fn side_by_side(links: &BTreeMap<[u32; 2], usize>) -> Vec<ConstraintRun<2>> {
    let mut runs = Vec::new();
    let mut taken = BTreeSet::new();
    for &first in links.keys() {
        let mut len = 0;
        let apart = |len: u32| first[0].abs_diff(first[1]) > len;
        while apart(len) && links.contains_key(&first.map(|f| f + len)) && !taken.contains(&first.map(|f| f + len)) {
            taken.insert(first.map(|f| f + len));
            len += 1;
        }
        if len as usize >= LEAST {
            runs.push(ConstraintRun { first, len, at: 0, serial: 0, alike: false });
        }
    }
    runs
}

/// Runs so that what leads to a run's particles comes before it; those that would have to come before themselves are
/// left out.
fn ordered(runs: &[ConstraintRun<2>]) -> Vec<ConstraintRun<2>> {
    let leads: BTreeMap<u32, usize> =
        runs.iter().enumerate().flat_map(|(r, run)| (0..run.len).map(move |t| (run.first[1] + t, r))).collect();
    let before = |r: usize| {
        let found: BTreeSet<usize> =
            (0..runs[r].len).filter_map(|t| leads.get(&(runs[r].first[0] + t)).copied()).collect();
        found
    };
    let mut waits: Vec<BTreeSet<usize>> = (0..runs.len()).map(before).collect();
    let mut follows = vec![Vec::new(); runs.len()];
    for (r, set) in waits.iter().enumerate() {
        set.iter().for_each(|&b| follows[b].push(r));
    }
    let mut ready: BTreeSet<usize> = (0..runs.len()).filter(|&r| waits[r].is_empty()).collect();
    let mut out = Vec::new();
    while let Some(r) = ready.pop_first() {
        out.push(runs[r]);
        for &f in &follows[r] {
            waits[f].remove(&r);
            if waits[f].is_empty() {
                ready.insert(f);
            }
        }
    }
    out
}

// A strand is one owner's.
const _: () = assert!(OWNERS == 2);

#[cfg(test)]
mod tests {
    use super::*;

    /// The diagonals of a grid, row after row, that lean one way; the upper half of the columns is the second owner's.
    fn grid(columns: u32, rows: u32) -> (Vec<BiasFiber>, Vec<u8>) {
        let starts = (0..columns).map(|c| (c, 0)).chain((1..rows).map(|r| (0, r)));
        let mut index = 0;
        let fibers = starts.map(|(c, r)| {
            let steps = (columns - 1 - c).min(rows - 1 - r);
            let links = (0..steps).map(|k| {
                index += 1;
                let at = (r + k) * columns + c + k;
                (index - 1, [at, at + columns + 1])
            });
            BiasFiber { towards: true, links: links.collect() }
        });
        let fibers: Vec<BiasFiber> = fibers.filter(|f| !f.links.is_empty()).collect();
        (fibers, (0..columns * rows).map(|p| u8::from(p % columns >= columns / 2)).collect())
    }

    #[test]
    fn every_link_within_an_owner_is_there_once_and_after_what_leads_to_it() {
        let (fibers, owner) = grid(16, 9);
        let (laid, places, numbers) = lay_out(&fibers, &owner, &|_, _| true);
        assert_eq!(laid.families.len(), 1);
        let all: BTreeMap<usize, [u32; 2]> = fibers.iter().flat_map(|f| f.links.iter().copied()).collect();
        let mut seen = BTreeSet::new();
        for (share, strand) in laid.families[0].iter().enumerate() {
            let (mut reached, mut left) = (BTreeSet::new(), BTreeSet::new());
            for run in &laid.runs[strand.runs.start as usize..strand.runs.end as usize] {
                for t in 0..run.len {
                    let [a, b] = run.first.map(|f| f + t);
                    assert_eq!(all[&numbers[(run.serial + t) as usize]], [a, b]);
                    assert!([a, b].iter().all(|&p| usize::from(owner[p as usize]) == share));
                    assert!(seen.insert([a, b]) && reached.insert(b) && left.insert(a));
                    assert!(!left.contains(&b), "what leads to {b} comes after what leads on from it");
                }
            }
            let starts = &laid.starts[strand.starts.start as usize..strand.starts.end as usize];
            assert!(left.difference(&reached).eq(starts.iter().collect::<BTreeSet<_>>()));
        }
        let within = all.values().filter(|v| owner[v[0] as usize] == owner[v[1] as usize]).count();
        assert_eq!(seen.len(), within);
        assert_eq!(places.len(), laid.runs.len(), "all alike: one place a run");
    }

    #[test]
    fn fibers_that_cross_go_to_families_of_their_own_and_a_knot_is_left_out() {
        let rail = |from: u32, by: u32| (0..6u32).map(move |t| (from + t) as usize + by as usize * 100);
        let parallel: Vec<BiasFiber> =
            (0..6u32).map(|t| BiasFiber { towards: true, links: vec![(t as usize, [t, 6 + t])] }).collect();
        let mut crossed = parallel.clone();
        crossed.extend((0..6u32).map(|t| BiasFiber { towards: false, links: vec![(6 + t as usize, [t, 12 + t])] }));
        let (laid, ..) = lay_out(&crossed, &[0; 18], &|_, _| false);
        assert_eq!(laid.families.len(), 2);
        // A fiber that meets itself, and a row whose links lead to each other's tails.
        let knot = BiasFiber { towards: true, links: vec![(0, [0, 1]), (1, [1, 2]), (2, [2, 0])] };
        let chain = BiasFiber { towards: true, links: rail(0, 0).map(|i| (i, [i as u32, i as u32 + 1])).collect() };
        for odd in [knot, chain] {
            assert!(lay_out(&[odd], &[0; 18], &|_, _| false).0.families.is_empty());
        }
    }
}
