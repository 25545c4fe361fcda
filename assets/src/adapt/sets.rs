//! Disjoint sets: what is connected with what (Tarjan 1975, with path halving).

/// Sets of the numbers from 0 on; the smallest number of a set stands for it.
pub struct DisjointSets(Vec<u32>);

impl DisjointSets {
    /// Each number in a set of its own.
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// The number that stands for a number's set.
    pub fn find(&mut self, mut i: u32) -> u32 {
        let of = &mut self.0;
        while of[i as usize] != i {
            of[i as usize] = of[of[i as usize] as usize];
            i = of[i as usize];
        }
        i
    }

    /// Makes two sets one.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_is_found_together() {
        let mut sets = DisjointSets::new(6);
        sets.join(4, 2);
        sets.join(2, 5);
        assert_eq!([0, 1, 2, 3, 4, 5].map(|i| sets.find(i)), [0, 1, 2, 3, 2, 2]);
    }
}
