//! The phases of a step of several garments, in their order. A barrier of the workers stands between any two of them.

use toile_base::limits::MAX_GARMENTS;

use crate::cloth::step::program::BEFORE;

/// One phase of a step: both workers' shares of it may run at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerPhase {
    /// Where each garment is and how fast.
    Motions,
    /// What is near what.
    Find,
    /// Which contacts act on each particle.
    Lists,
    /// One of the stages before the first substep, of each garment ([`BEFORE`]).
    Before(usize),
    /// The end of a shared garment's substep: contact with the body, last as ever, and the velocities.
    Finish(usize, usize),
    /// A stage of a shared garment before contact, counted within the substep, in a substep.
    Stage(usize, usize, usize),
    /// The same of all that are one worker's: the end of the substep before, then the stages of this one.
    Whole(usize),
    /// What the contacts make of it, in a substep and in one of its turns.
    Solve(usize, usize),
    /// What they do to the garments in a turn.
    Apply(usize),
    /// The end of the last substep of all garments.
    End,
}

/// The phases of a step. A garment that both workers own particles of is stepped by both, one stage after the other; each of the
/// others is one worker's, which takes it through all of a substep at once, so that what it needs of it stays near.
#[derive(Debug, Clone)]
pub struct LayerPhases {
    /// The garments that the workers share, and their stages of a substep before contact with the body.
    pub shared: heapless::Vec<(usize, usize), MAX_GARMENTS>,
    /// Whether there are others.
    pub whole: bool,
    /// Turns of a substep.
    pub turns: usize,
    /// Substeps.
    pub substeps: usize,
}

impl LayerPhases {
    fn of_substep(&self) -> usize {
        let shared = self.shared.iter().map(|(_, stages)| 1 + stages).sum::<usize>();
        shared + usize::from(self.whole) + 2 * self.turns
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        4 + BEFORE.len() + self.of_substep() * self.substeps
    }

    /// One of them.
    pub fn at(&self, phase: usize) -> LayerPhase {
        match phase {
            0 => LayerPhase::Motions,
            1 => LayerPhase::Find,
            2 => LayerPhase::Lists,
            before if before < 3 + BEFORE.len() => LayerPhase::Before(before - 3),
            last if last + 1 == self.count() => LayerPhase::End,
            later => {
                let later = later - 3 - BEFORE.len();
                self.within(later / self.of_substep(), later % self.of_substep())
            }
        }
    }

    fn within(&self, substep: usize, mut at: usize) -> LayerPhase {
        for &(garment, stages) in &self.shared {
            match at {
                0 => return LayerPhase::Finish(garment, substep),
                _ if at <= stages => return LayerPhase::Stage(garment, at - 1, substep),
                _ => at -= 1 + stages,
            }
        }
        match at.checked_sub(usize::from(self.whole)) {
            None => LayerPhase::Whole(substep),
            Some(at) if at.is_multiple_of(2) => LayerPhase::Solve(substep, at / 2),
            Some(at) => LayerPhase::Apply(at / 2),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_garment_ends_a_substep_before_it_begins_the_next_and_all_end_the_last() {
        use LayerPhase::{Apply, End, Finish, Solve, Stage, Whole};
        let shared = [(0, 2), (3, 1)].into_iter().collect();
        let phases = LayerPhases { shared, whole: true, turns: 3, substeps: 2 };
        let all: Vec<LayerPhase> = (3 + BEFORE.len()..phases.count()).map(|phase| phases.at(phase)).collect();
        let substep = |k| {
            let shared = [Finish(0, k), Stage(0, 0, k), Stage(0, 1, k), Finish(3, k), Stage(3, 0, k)];
            let turns = [Whole(k), Solve(k, 0), Apply(0), Solve(k, 1), Apply(1), Solve(k, 2), Apply(2)];
            shared.into_iter().chain(turns)
        };
        assert_eq!(all, substep(0).chain(substep(1)).chain([End]).collect::<Vec<_>>());
        assert_eq!(phases.at(0), LayerPhase::Motions);
    }
}
