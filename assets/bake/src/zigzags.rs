//! Zigzags: two rows of particles and the links that go to and fro between them, as neighbours in a hoop do whose even
//! and odd particles lie apart. What one link has moved, the next one needs: solved together, a row is read once.

use std::collections::BTreeMap;

use toile_base::garment::Direction;

/// Fewest straights of a zigzag: with fewer, what is gained along the row is lost at its ends.
const LEAST: usize = 8;

/// Links in a zigzag between two rails (rows) of particles: a straight one and a slanted one in turn.
#[derive(Debug, Clone, PartialEq)]
pub struct ZigzagLinks {
    /// Direction of all its links.
    pub direction: Direction,
    /// First particle of each rail; the others follow it.
    pub rails: [u32; 2],
    /// The links from a particle of the first rail to the one of the second beside it.
    pub straights: Vec<usize>,
    /// The links from a particle of the second rail to the next one of the first; where there are as many as straights, the
    /// last one leads back to the beginning.
    pub slants: Vec<usize>,
}

impl ZigzagLinks {
    /// All its particles.
    pub fn particles(&self) -> impl Iterator<Item = u32> {
        let n = self.straights.len() as u32;
        self.rails.into_iter().flat_map(move |first| first..first + n)
    }
}

/// The links by their particles.
type Places = BTreeMap<(Direction, [u32; 2]), usize>;

/// Takes the zigzags out of links, whose smaller particle comes first; `order` is the order in which to look. Gives
/// them in sets within which no two share a particle, and what is left in its order.
pub fn take(links: &[(Direction, [u32; 2])], order: &[usize], owner: &[u8]) -> (Vec<Vec<ZigzagLinks>>, Vec<usize>) {
    let mut places: Places = order.iter().map(|&i| (links[i], i)).collect();
    let mut sets: Vec<(Direction, Vec<bool>, Vec<ZigzagLinks>)> = Vec::new();
    for &i in order {
        if places.get(&links[i]) != Some(&i) {
            continue;
        }
        let (direction, [p, q]) = links[i];
        let [one, two] = [[p, q], [q, p]].map(|rails| follow(&places, direction, rails, owner));
        let found = if one.slants.len() >= two.slants.len() { one } else { two };
        if found.straights.len() < LEAST {
            continue;
        }
        for &l in found.straights.iter().chain(&found.slants) {
            places.remove(&links[l]);
        }
        let apart = |s: &(Direction, Vec<bool>, _)| s.0 == direction && found.particles().all(|p| !s.1[p as usize]);
        let set = sets.iter().position(apart).unwrap_or_else(|| {
            sets.push((direction, vec![false; owner.len()], Vec::new()));
            sets.len() - 1
        });
        found.particles().for_each(|p| sets[set].1[p as usize] = true);
        sets[set].2.push(found);
    }
    let left = order.iter().copied().filter(|i| places.get(&links[*i]) == Some(i)).collect();
    (sets.into_iter().map(|s| s.2).collect(), left)
}

/// The zigzag that begins with the straight between two particles.
fn follow(places: &Places, direction: Direction, [a, b]: [u32; 2], owner: &[u8]) -> ZigzagLinks {
    let link = |p: u32, q: u32| places.get(&(direction, [p.min(q), p.max(q)])).copied();
    let owned = |p: u32| owner.get(p as usize) == owner.get(a as usize);
    let mut out = ZigzagLinks { direction, rails: [a, b], straights: Vec::new(), slants: Vec::new() };
    if !owned(b) {
        return out;
    }
    out.straights.extend(link(a, b));
    for t in 1..a.abs_diff(b) {
        let (Some(slant), Some(straight)) = (link(b + t - 1, a + t), link(a + t, b + t)) else { break };
        if !owned(a + t) || !owned(b + t) {
            break;
        }
        out.slants.push(slant);
        out.straights.push(straight);
    }
    let n = out.straights.len() as u32;
    // A closed one of two straights would go one way twice.
    if n > 2 {
        out.slants.extend(link(b + n - 1, a));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hoop of `2 n` particles, the even ones first.
    fn hoop(n: u32, closed: bool) -> Vec<(Direction, [u32; 2])> {
        let particle = |c: u32| if c.is_multiple_of(2) { c / 2 } else { n + c / 2 };
        let links = 0..2 * n - u32::from(!closed);
        let pair = |c: u32| [particle(c), particle((c + 1) % (2 * n))];
        links.map(pair).map(|[p, q]| (Direction::Weft, [p.min(q), p.max(q)])).collect()
    }

    #[test]
    fn a_hoop_is_one_zigzag_and_an_open_row_too() {
        for closed in [true, false] {
            let links = hoop(12, closed);
            let order: Vec<usize> = (0..links.len()).collect();
            let (sets, left) = take(&links, &order, &[0; 24]);
            assert!(left.is_empty() && sets.len() == 1 && sets[0].len() == 1);
            let zigzag = &sets[0][0];
            assert_eq!((zigzag.straights.len(), zigzag.slants.len()), (12, if closed { 12 } else { 11 }));
            let mut all: Vec<usize> = zigzag.straights.iter().chain(&zigzag.slants).copied().collect();
            all.sort_unstable();
            assert_eq!(all, order);
            let [a, b] = zigzag.rails;
            for (t, &i) in zigzag.straights.iter().enumerate() {
                let (p, q) = (a + t as u32, b + t as u32);
                assert_eq!(links[i].1, [p.min(q), p.max(q)]);
            }
            for (t, &i) in zigzag.slants.iter().enumerate() {
                let (p, q) = (b + t as u32, a + (t as u32 + 1) % 12);
                assert_eq!(links[i].1, [p.min(q), p.max(q)]);
            }
        }
    }

    #[test]
    fn what_has_two_owners_or_is_short_is_left_and_touching_zigzags_are_in_two_sets() {
        let links = hoop(12, true);
        let order: Vec<usize> = (0..links.len()).collect();
        let owner: Vec<u8> = (0..24).map(|p| u8::from(p % 12 >= 6)).collect();
        assert_eq!(take(&links, &order, &owner), (vec![], order));
        // Three rows of 10, links from each to the next.
        let between = |r: u32| {
            (0..10)
                .map(move |t| [10 * r + t, 10 * r + 10 + t])
                .chain((0..9).map(move |t| [10 * r + t + 1, 10 * r + 10 + t]))
        };
        let links: Vec<_> = (0..2).flat_map(between).map(|v| (Direction::Bias, v)).collect();
        let order: Vec<usize> = (0..links.len()).collect();
        let (sets, left) = take(&links, &order, &[0; 30]);
        assert_eq!((sets.len(), left.len()), (2, 0));
    }
}
