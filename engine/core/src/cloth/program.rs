//! The program of a substep: which kernels run in which order, as phases that two workers share.
//!
//! Order decides the error: bending and the air are forces; then shear, which undoes the most; hoops; fibers, which carry
//! the weight; hoops and fibers in turn, because each undoes a little of the other, and hoops once more, because what
//! strain is left is theirs (on the benchmark's skirt at four substeps, ending with hoops instead of fibers took the mean
//! strain from .27 to .17 %, and hoops twice each time to .14 %); contact last, so that nothing is left inside the body.

use toile_assets::garment::Layout;

use super::Quality;

/// One phase: both owners' shares of it may run at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Op {
    /// What contact may meet in this step.
    Find,
    /// The wind on each owner's own triangles; then, one worker's, on those that cross.
    Wind,
    /// See [`Op::Wind`].
    CrossWind,
    /// What the root's motion is not to be felt of.
    Carry,
    /// Bending, set by set; the set that crosses the owners is one worker's.
    Bend(u16),
    /// Bending that is stiffer than a substep: before the forces of a stage; behind the last of them.
    Turn(u32),
    /// The forces of a stage, set by set.
    Stage(u32, u16),
    /// Gravity, air, wind; skinned particles move on.
    Predict,
    /// A family of fibers along the bias.
    Diagonals(u16),
    /// A set of shear links.
    Shear(u16),
    /// A set of weft links.
    Weft(u16),
    /// Warp fibers.
    Fibers,
    /// A set of warp fibers that cross others.
    Crossing(u16),
    /// Tethers.
    Tether,
    /// Contact with the body, new velocities.
    Finish,
}

/// Name of a stage, for the meters.
pub const STAGES: [&str; 8] = ["predict", "bend", "shear", "weft", "fibers", "contact", "wind", "tethers"];

/// What comes before the first substep of a step.
pub const BEFORE: [Op; 4] = [Op::Find, Op::Wind, Op::CrossWind, Op::Carry];

impl Op {
    /// Which of [`STAGES`] it counts towards.
    pub fn stage(self) -> usize {
        match self {
            Self::Predict | Self::Carry => 0,
            Self::Bend(_) | Self::Turn(_) | Self::Stage(..) => 1,
            Self::Diagonals(_) | Self::Shear(_) => 2,
            Self::Weft(_) => 3,
            Self::Fibers | Self::Crossing(_) => 4,
            Self::Finish | Self::Find => 5,
            Self::Wind | Self::CrossWind => 6,
            Self::Tether => 7,
        }
    }
}

/// Bending, which comes first in a substep: its sets, once as a force, or in stages with a turn before each and at the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bending {
    /// Sets of stencils.
    pub sets: u32,
    /// Stages; 1 for a force.
    pub stages: u32,
}

impl Bending {
    /// The sets of a layout.
    pub fn sets(layout: &Layout) -> u32 {
        layout.bends.tuples.sets.len().max(layout.skewed.tuples.sets.len()).max(layout.hubs.sets()) as u32
    }

    /// Its phases.
    pub fn phases(self) -> usize {
        (if self.stages < 2 || self.sets == 0 { self.sets } else { self.stages * (self.sets + 1) + 1 }) as usize
    }

    /// One of them.
    pub fn op(self, phase: usize) -> Op {
        if self.stages < 2 {
            return Op::Bend(phase as u16);
        }
        let (stage, part) = (phase as u32 / (self.sets + 1), phase as u32 % (self.sets + 1));
        if part == 0 { Op::Turn(stage) } else { Op::Stage(stage, part as u16 - 1) }
    }
}

/// The phases of one substep after bending.
pub fn substep(layout: &Layout, quality: Quality) -> Box<[Op]> {
    let numbered = |n: usize, op: fn(u16) -> Op| (0..n as u16).map(op);
    let wefts = || numbered(layout.weft.tuples.sets.len(), Op::Weft);
    let fibers = || numbered(layout.crossing.sets.len(), Op::Crossing).chain([Op::Fibers]);
    let mut ops = vec![Op::Predict];
    let shear = || numbered(layout.shear.tuples.sets.len(), Op::Shear);
    ops.extend(numbered(layout.diagonals.families.len(), Op::Diagonals));
    ops.extend(shear().chain(wefts()).chain(fibers()));
    match quality {
        Quality::Draft => {}
        Quality::Shop | Quality::Fine => {
            ops.extend(wefts().chain(wefts()).chain(fibers()).chain(wefts()).chain(wefts()));
        }
    }
    ops.push(Op::Tether);
    ops.push(Op::Finish);
    ops.into()
}
