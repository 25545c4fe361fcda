//! Greedy colouring: constraints of one set share no particle, so a set may be solved in any order, or all at once.

use super::fibers::{Direction, Fiber};

/// Splits fibers into sets of one direction without a common particle, in the order bias, weft, warp: shear undoes most
/// of what the others reach, so it comes first; what carries the weight comes last. Indices into `fibers`.
pub fn sets(fibers: &[Fiber], vertices: usize) -> Vec<Vec<usize>> {
    let parts = fibers.iter().map(|f| (f.direction, f.vertices.as_slice())).collect::<Vec<_>>();
    colour(&parts, vertices)
}

/// The same for any constraints: a direction and the particles that each touches. Long ones first, so that the few long
/// fibers of a direction share the first sets and stragglers fill the last.
pub fn colour(parts: &[(Direction, &[u32])], vertices: usize) -> Vec<Vec<usize>> {
    let mut sets: Vec<Vec<usize>> = Vec::new();
    for direction in [Direction::Bias, Direction::Weft, Direction::Warp] {
        let mut order = (0..parts.len()).filter(|&i| parts[i].0 == direction).collect::<Vec<_>>();
        order.sort_by_key(|&i| std::cmp::Reverse(parts[i].1.len()));
        let mut taken: Vec<Vec<bool>> = Vec::new();
        let base = sets.len();
        for i in order {
            let touched = parts[i].1;
            let free = |t: &Vec<bool>| touched.iter().all(|&v| !t[v as usize]);
            let colour = taken.iter().position(free).unwrap_or_else(|| {
                taken.push(vec![false; vertices]);
                sets.push(Vec::new());
                taken.len() - 1
            });
            touched.iter().for_each(|&v| taken[colour][v as usize] = true);
            sets[base + colour].push(i);
        }
    }
    sets
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_set_holds_a_particle_twice_and_none_is_lost() {
        let links: Vec<[u32; 2]> = (0..20).flat_map(|i| [[i, i + 1], [i, (i * 7 + 3) % 20 + 1]]).collect();
        let links: Vec<[u32; 2]> = links.into_iter().filter(|l| l[0] != l[1]).collect();
        let parts: Vec<(Direction, &[u32])> = links.iter().map(|l| (Direction::Warp, l.as_slice())).collect();
        let sets = colour(&parts, 21);
        assert_eq!(sets.iter().map(Vec::len).sum::<usize>(), parts.len());
        for set in sets {
            let mut seen = [false; 21];
            for v in set.iter().flat_map(|&i| links[i]) {
                assert!(!seen[v as usize]);
                seen[v as usize] = true;
            }
        }
    }
}
