//! Meters: how long the stages of a step take, always on, against what each of them may take.
//!
//! A value may take 10 ns, and a meter 24 KiB.

#[cfg(feature = "meters")]
mod distribution;

#[cfg(feature = "meters")]
pub use distribution::{LONGEST_NS, Meter};
use toile_base::limits::STEP_HZ;

/// Time between two steps (ns), rounded down.
pub const PERIOD_NS: u64 = 1_000_000_000 / STEP_HZ as u64;

/// A stage of a step and what it may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StageBudget {
    /// Its name, as reports have it.
    pub name: &'static str,
    /// What it may take in a step (us).
    pub budget_us: u64,
}

/// The stages of a step, in their order. Together they may take half of the step of 8,333 us, so that one late wake-up or
/// one step of twice the usual length is still in time.
pub const STAGES: [StageBudget; 6] = [
    // The newest joints, and where they are at the step's own time.
    StageBudget { name: "intake", budget_us: 10 },
    // Joint rotations within limits, and bone matrices.
    StageBudget { name: "pose", budget_us: 60 },
    // 15,000 vertices.
    StageBudget { name: "skin", budget_us: 150 },
    // Spheres, capsules and the posed triangles of the skin, which were measured at 52 to 67 us (docs/loop.md).
    StageBudget { name: "place", budget_us: 80 },
    // All garments of an outfit.
    StageBudget { name: "cloth", budget_us: 3_700 },
    // Copies into the snapshot.
    StageBudget { name: "publish", budget_us: 100 },
];

/// Place of each stage in [`STAGES`].
pub const INTAKE: usize = 0;
/// Place of this stage in [`STAGES`].
pub const POSE: usize = 1;
/// Place of this stage in [`STAGES`].
pub const SKIN: usize = 2;
/// Place of this stage in [`STAGES`].
pub const PLACE: usize = 3;
/// Place of this stage in [`STAGES`].
pub const CLOTH: usize = 4;
/// Place of this stage in [`STAGES`].
pub const PUBLISH: usize = 5;

/// What a whole step may take (us): the sum of its stages.
pub const STEP_BUDGET_US: u64 = {
    let (mut sum, mut i) = (0, 0);
    while i < STAGES.len() {
        sum += STAGES[i].budget_us;
        i += 1;
    }
    sum
};

const _: () = assert!(STEP_BUDGET_US * 1_000 * 2 <= PERIOD_NS, "the stages take more than half of a step");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_those_of_the_names() {
        let places = [INTAKE, POSE, SKIN, PLACE, CLOTH, PUBLISH];
        assert_eq!(places.map(|i| STAGES[i].name), ["intake", "pose", "skin", "place", "cloth", "publish"]);
    }
}
