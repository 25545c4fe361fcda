//! Runs: constraints coloured into sets without a common particle, and laid side by side where their particles are.

use super::zigzags;
use toile_base::garment::Direction;
use toile_base::garment::layout::{ConstraintRun, ConstraintSet, OWNERS, OwnerShare, Tuples, Zigzag};

/// Runs shorter than this are not worth a vector; their constraints are loose.
const LEAST_RUN: usize = 3;

/// Place of each constraint in the layout.
#[derive(Debug, Clone, PartialEq)]
pub struct RunPlaces {
    /// The constraint of each parameter place.
    pub places: Vec<usize>,
    /// The constraint of each number.
    pub serial: Vec<usize>,
}

/// Lays constraints over `K` particles out; `apart` demands that no two of a set share a particle. Gives the tuples and
/// for each parameter place the constraint it belongs to, or one of those that are `alike`. Constraints that touch both owners'
/// particles are the first owner's if sets are kept apart (no other constraint touches them in that set); otherwise they form a
/// last set of their own.
pub fn lay_out<const K: usize>(
    constraints: &[(Direction, [u32; K])],
    owner: &[u8],
    apart: bool,
    alike: &dyn Fn(usize, usize) -> bool,
) -> (Tuples<K>, RunPlaces) {
    let mut order: Vec<usize> = (0..constraints.len()).collect();
    order.sort_by_key(|&i| (std::cmp::Reverse(constraints[i].0), constraints[i].1));
    let crosses = |i: usize| {
        let v = &constraints[i].1;
        v.iter().any(|&p| owner[p as usize] != owner[v[0] as usize])
    };
    let mut out = Layouter::default();
    let mut all = Vec::new();
    if apart && K == 2 {
        let pairs: Vec<_> = constraints.iter().map(|(d, v)| (*d, [v[0], v[1]])).collect();
        let (zigzags, left) = zigzags::take(&pairs, &order, owner);
        order = left;
        all.extend(zigzags.iter().map(|set| ConstraintSet {
            direction: set[0].direction,
            crosses: false,
            shares: std::array::from_fn(|share| out.zigzags(set, share, owner, alike)),
        }));
    }
    let sets = if apart { coloured(constraints, &order, owner.len()) } else { gathered(&order, &crosses) };
    all.extend(sets.into_iter().map(|set| ConstraintSet {
        direction: set.first().map_or(Direction::Warp, |&i| constraints[i].0),
        crosses: !apart && set.first().is_some_and(|&i| crosses(i)),
        shares: std::array::from_fn(|share| {
            let mine = |i: &usize| usize::from(owner[constraints[*i].1[0] as usize]) == share;
            let part: Vec<usize> = set.iter().copied().filter(mine).collect();
            out.share(constraints, &part, owner, alike)
        }),
    }));
    let tuples = Tuples {
        zigzags: out.zigzags.into(),
        runs: out.runs.into(),
        loose: out.loose.into(),
        sets: all.into(),
        count: constraints.len(),
        places: out.places.len(),
    };
    (tuples, RunPlaces { places: out.places, serial: out.serial })
}

/// First fit in the order of the particles: on a grid neighbours side by side get one colour, which makes long runs.
fn coloured<const K: usize>(
    constraints: &[(Direction, [u32; K])],
    order: &[usize],
    particles: usize,
) -> Vec<Vec<usize>> {
    let mut taken: Vec<(Direction, Vec<bool>)> = Vec::new();
    let mut sets: Vec<Vec<usize>> = Vec::new();
    for &i in order {
        let (direction, v) = &constraints[i];
        let free = |t: &(Direction, Vec<bool>)| t.0 == *direction && v.iter().all(|&p| !t.1[p as usize]);
        let colour = taken.iter().position(free).unwrap_or_else(|| {
            taken.push((*direction, vec![false; particles]));
            sets.push(Vec::new());
            sets.len() - 1
        });
        v.iter().for_each(|&p| taken[colour].1[p as usize] = true);
        sets[colour].push(i);
    }
    sets
}

/// One set of what stays within an owner's particles, one of what crosses; the first is there if the second is, so that
/// two layouts side by side never cross while the other keeps within.
fn gathered(order: &[usize], crosses: &dyn Fn(usize) -> bool) -> Vec<Vec<usize>> {
    let (crossing, within): (Vec<usize>, Vec<usize>) = order.iter().partition(|&&i| crosses(i));
    let sets = if crossing.is_empty() { 1 } else { 2 };
    let any = !(within.is_empty() && crossing.is_empty());
    [within, crossing].into_iter().take(if any { sets } else { 0 }).collect()
}

#[derive(Default)]
struct Layouter<const K: usize> {
    zigzags: Vec<Zigzag>,
    runs: Vec<ConstraintRun<K>>,
    loose: Vec<[u32; K]>,
    places: Vec<usize>,
    /// The constraints in the order of their numbers.
    serial: Vec<usize>,
}

impl<const K: usize> Layouter<K> {
    /// One owner's zigzags of a set.
    fn zigzags(
        &mut self,
        set: &[zigzags::ZigzagLinks],
        share: usize,
        owner: &[u8],
        alike: &dyn Fn(usize, usize) -> bool,
    ) -> OwnerShare {
        let first = self.zigzags.len() as u32;
        for zigzag in set.iter().filter(|z| usize::from(owner[z.rails[0] as usize]) == share) {
            let [a, b] = zigzag.rails;
            let straights = self.run([a, b], &zigzag.straights, alike);
            let slants = self.run([b, a + 1], &zigzag.slants, alike);
            self.zigzags.push(Zigzag { straights, slants });
        }
        OwnerShare { zigzags: first..self.zigzags.len() as u32, ..OwnerShare::default() }
    }

    /// Constraints side by side get their places and numbers.
    fn run<const N: usize>(
        &mut self,
        first: [u32; N],
        run: &[usize],
        alike: &dyn Fn(usize, usize) -> bool,
    ) -> ConstraintRun<N> {
        let same = run.iter().all(|&i| alike(run[0], i));
        let (at, serial) = (self.places.len() as u32, self.serial.len() as u32);
        self.serial.extend(run);
        self.places.extend(if same { &run[..1] } else { run });
        ConstraintRun { first, len: run.len() as u32, at, serial, alike: same }
    }

    /// One owner's share: its runs first, then what is loose.
    fn share(
        &mut self,
        constraints: &[(Direction, [u32; K])],
        part: &[usize],
        owner: &[u8],
        alike: &dyn Fn(usize, usize) -> bool,
    ) -> OwnerShare {
        let (first_run, first_loose) = (self.runs.len() as u32, self.loose.len() as u32);
        let mut loose: Vec<usize> = Vec::new();
        let mut at = 0;
        while at < part.len() {
            let len = run_length(constraints, &part[at..], owner);
            if len >= LEAST_RUN {
                let run = self.run(constraints[part[at]].1, &part[at..at + len], alike);
                self.runs.push(run);
            } else {
                loose.extend(&part[at..at + len]);
            }
            at += len;
        }
        let loose_at = self.places.len() as u32;
        self.loose.extend(loose.iter().map(|&i| constraints[i].1));
        let loose_serial = self.serial.len() as u32;
        self.places.extend(&loose);
        self.serial.extend(&loose);
        OwnerShare {
            zigzags: 0..0,
            runs: first_run..self.runs.len() as u32,
            loose: first_loose..self.loose.len() as u32,
            loose_at,
            loose_serial,
        }
    }
}

/// How many constraints from the first on advance by one particle each, under one owner.
fn run_length<const K: usize>(constraints: &[(Direction, [u32; K])], part: &[usize], owner: &[u8]) -> usize {
    let (direction, first) = constraints[part[0]];
    let follows = |t: usize| {
        let (d, v) = constraints[part[t]];
        let owned = |p: u32| owner[p as usize] == owner[v[0] as usize];
        let like = (0..K).all(|k| {
            v[k] == first[k] + t as u32 && owned(v[k]) == (owner[first[k] as usize] == owner[first[0] as usize])
        });
        d == direction && like
    };
    (1..part.len()).take_while(|&t| follows(t)).count() + 1
}

// A share is worked on by one owner alone.
const _: () = assert!(OWNERS == 2);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_share_no_particle_and_lose_no_link() {
        // Two rails of 20 particles, the second rail's numbers after the first's.
        let straights = (0..20u32).map(|i| (Direction::Warp, [i, 20 + i]));
        let rails = (0..19u32).map(|i| (Direction::Weft, [i, i + 1]));
        let all: Vec<(Direction, [u32; 2])> = straights.chain(rails).collect();
        let owner: Vec<u8> = (0..40).map(|i| u8::from(i % 20 >= 10)).collect();
        let (tuples, RunPlaces { places, serial }) = lay_out(&all, &owner, true, &|_, _| false);
        assert_eq!(serial, places);
        let mut sorted = places.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..all.len()).collect::<Vec<_>>());
        tuples.for_each(|place, v| assert_eq!(v, all[places[place]].1));
        let (even, RunPlaces { places: few, serial }) = lay_out(&all, &owner, true, &|_, _| true);
        assert_eq!(serial.len(), all.len());
        assert!(few.len() < places.len() && even.places == few.len() && even.count == all.len());
        for set in &tuples.sets {
            let mut seen = [false; 40];
            for share in &set.shares {
                let runs = share.runs.clone().flat_map(|r| {
                    let run = tuples.runs[r as usize];
                    (0..run.len).flat_map(move |t| run.first.map(|f| f + t))
                });
                let loose = share.loose.clone().flat_map(|i| tuples.loose[i as usize]);
                for p in runs.chain(loose) {
                    assert!(!seen[p as usize], "{p} twice in a set");
                    seen[p as usize] = true;
                }
            }
        }
        assert!(tuples.runs.iter().any(|r| r.len == 10), "the straights of each owner are one run");
    }
}
