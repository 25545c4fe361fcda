//! Pace: in which steps a pair is searched, and how far ahead.
//!
//! Where pairs are searched in every second or fourth step, each has turns of its own, so that not all of the work falls
//! into one step: quality control looks at the longest.

/// What a step does to find a pair's contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Search {
    /// Nothing, and there are none.
    #[default]
    Off,
    /// Nothing: those of the last search stay.
    Keep,
    /// They are looked for, for so many steps.
    Anew(u8),
}

/// The pace of one pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PairPace {
    /// What is done in this step.
    pub search: Search,
    /// Number of the search, from 0.
    pub number: u64,
    /// Searches so far.
    count: u64,
    /// Steps after this one for which what was found holds.
    holds: u8,
}

impl PairPace {
    /// Decides on a step of this number, for the pair in this place, which is to be searched every so many steps; 0 is never.
    pub fn decide(&mut self, every: u8, tick: u64, place: usize) {
        let turn = every > 0 && (tick + place as u64).is_multiple_of(u64::from(every));
        self.search = match (every, turn || self.holds == 0) {
            (0, _) => Search::Off,
            (_, true) => Search::Anew(every),
            (_, false) => Search::Keep,
        };
        match self.search {
            Search::Off => self.holds = 0,
            Search::Keep => self.holds -= 1,
            Search::Anew(steps) => {
                (self.number, self.holds) = (self.count, steps - 1);
                self.count += 1;
            }
        }
    }

    /// What was found holds no longer.
    pub fn forget(&mut self) {
        self.holds = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn played(pace: &mut PairPace, every: u8, ticks: std::ops::Range<u64>, place: usize) -> Vec<Search> {
        let step = |tick| {
            pace.decide(every, tick, place);
            pace.search
        };
        ticks.map(step).collect()
    }

    #[test]
    fn pairs_take_turns_and_each_search_lasts_until_the_next() {
        use Search::{Anew, Keep, Off};
        let mut paces = [PairPace::default(); 2];
        assert_eq!(played(&mut paces[0], 2, 0..5, 0), [Anew(2), Keep, Anew(2), Keep, Anew(2)]);
        // What has never been searched is at once.
        assert_eq!(played(&mut paces[1], 2, 0..5, 1), [Anew(2), Anew(2), Keep, Anew(2), Keep]);
        assert_eq!(played(&mut paces[0], 4, 5..9, 0), [Keep, Anew(4), Keep, Anew(4)], "what was found for two steps");
        assert_eq!(played(&mut paces[0], 0, 9..11, 0), [Off, Off]);
        assert_eq!(played(&mut paces[0], 4, 11..14, 0), [Anew(4), Anew(4), Keep], "nothing was left of before");
        paces[0].forget();
        assert_eq!(played(&mut paces[0], 4, 14..15, 0), [Anew(4)]);
        assert_eq!(played(&mut paces[0], 1, 15..17, 0), [Anew(1), Anew(1)]);
    }

    #[test]
    fn in_no_step_a_search_is_older_than_it_was_made_for() {
        let (mut pace, mut age, mut made_for) = (PairPace::default(), u64::MAX, 0u8);
        for tick in 0..10_000u64 {
            let every = [1, 2, 4, 2, 0, 4, 8, 1][(tick / 7 % 8) as usize];
            pace.decide(every, tick, 3);
            match pace.search {
                Search::Anew(steps) => (age, made_for) = (0, steps),
                Search::Keep => age += 1,
                Search::Off => (age, made_for) = (u64::MAX, 0),
            }
            assert!(made_for == 0 || age < u64::from(made_for), "step {tick}: {age} steps old, made for {made_for}");
        }
    }
}
