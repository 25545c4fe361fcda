//! Turns: in which order the levels of an outfit are solved within a substep.
//!
//! Upwards, each level on what lies under it, which is in its place by then; then downwards, each level passing on what it
//! bears, until the body bears all of it.

/// One turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Turn {
    /// The level of the pairs, from 1.
    pub level: usize,
    /// Whether contacts are solved; otherwise what the upper garment bears is passed on.
    pub up: bool,
}

/// The turns of a substep.
#[derive(Debug, Clone, Copy)]
pub struct Turns {
    /// The highest level.
    pub top: usize,
}

impl Turns {
    /// How many: one where nothing lies on what lies on something.
    pub fn count(self) -> usize {
        2 * self.top - 1
    }

    /// One of them. Nothing lies on the highest level, so that it has nothing to pass on.
    pub fn at(self, turn: usize) -> Turn {
        let up = turn < self.top;
        Turn { level: if up { turn + 1 } else { 2 * self.top - 1 - turn }, up }
    }

    /// The last.
    pub fn last(self) -> Turn {
        self.at(self.count() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_solved_upwards_and_pass_on_downwards() {
        let turns = |top: usize| {
            let turns = Turns { top };
            (0..turns.count()).map(|t| turns.at(t)).map(|t| (t.level, t.up)).collect::<Vec<_>>()
        };
        assert_eq!(turns(1), [(1, true)]);
        assert_eq!(turns(3), [(1, true), (2, true), (3, true), (2, false), (1, false)]);
        assert_eq!(Turns { top: 3 }.last(), Turn { level: 1, up: false });
    }
}
