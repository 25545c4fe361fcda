//! The program of a step: its stages in their order. Two workers share each stage.
//!
//! Order decides the error: bending and the air are forces; then shear, which undoes the most; hoops; fibers, which carry
//! the weight; hoops and fibers in turn, because each undoes a little of the other, and hoops once more, because what
//! strain is left is theirs (on the benchmark's skirt at four substeps, ending with hoops instead of fibers took the mean
//! strain from .27 to .17 %, and hoops twice each time to .14 %); contact last, so that nothing is left inside the body. Where
//! most links lie in no row, all is solved once a substep, of which the bake asks for more.

use toile_base::garment::Layout;

use crate::bounded::{BoundedVec, Fill};
use crate::cloth::Quality;
use crate::cloth::forces::bending_matrix::BendingMatrix;
use crate::cloth::forces::stiff_bending::MAX_BENDING_STAGES;

/// One stage of a step: both owners' shares of it may run at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// What contact may meet in this step.
    BroadPhase,
    /// The wind on each owner's own triangles.
    Wind,
    /// The wind on the triangles that cross the owners, by one worker.
    WindAcross,
    /// What of the root's motion the cloth is not to feel.
    RootMotion,
    /// The records of what bends.
    BendingRecords,
    /// The bending forces.
    Bending,
    /// What friction keeps of what is bent.
    FrictionMoments,
    /// What it keeps pushes the particles.
    FrictionForces,
    /// Bending that is stiffer than a substep: before the forces of a stage of this number; behind the last of them.
    StiffBendingTurn(u32),
    /// The records of what bends in such a stage.
    StiffBendingRecords(u32),
    /// The forces of such a stage.
    StiffBending(u32),
    /// Gravity, air, wind; skinned particles move on.
    Predict,
    /// What links are in this substep, by the strain that they had and are about to have.
    LinkCurves,
    /// A family of fibers along the bias.
    Diagonals(u16),
    /// The particles' records, for the links that follow.
    EnterRecords,
    /// The particles' places from their records.
    LeaveRecords,
    /// A set of shear links.
    Shear(u16),
    /// A set of weft links.
    Weft(u16),
    /// All warp fibers that cross no others.
    Fibers,
    /// A set of warp fibers that cross others.
    Crossing(u16),
    /// Tethers of all particles, whatever their set.
    Tethers,
    /// Contact, then the velocities that follow: both concern one particle alone, so no barrier is needed between them.
    ContactAndVelocities,
}

/// What the stages are metered as.
pub const METERED_STAGES: [&str; 9] =
    ["predict", "bend", "shear", "weft", "fibers", "contact", "wind", "tethers", "layers"];

/// Which of them is contact between garments, which is no stage of one garment.
pub const LAYERS_METERED: usize = 8;

/// What comes before the first substep of a step.
pub const BEFORE: [Stage; 4] = [Stage::BroadPhase, Stage::Wind, Stage::WindAcross, Stage::RootMotion];

impl Stage {
    /// Which of [`METERED_STAGES`] it counts towards.
    pub fn metered(self) -> usize {
        match self {
            Self::Predict | Self::RootMotion => 0,
            Self::BendingRecords
            | Self::Bending
            | Self::FrictionMoments
            | Self::FrictionForces
            | Self::StiffBendingTurn(_)
            | Self::StiffBendingRecords(_)
            | Self::StiffBending(_) => 1,
            Self::Diagonals(_) | Self::Shear(_) => 2,
            Self::Weft(_) | Self::LinkCurves | Self::EnterRecords | Self::LeaveRecords => 3,
            Self::Fibers | Self::Crossing(_) => 4,
            Self::ContactAndVelocities | Self::BroadPhase => 5,
            Self::Wind | Self::WindAcross => 6,
            Self::Tethers => 7,
        }
    }
}

/// Bending, which comes first in a substep: once as a force, or in stages with a turn before each and at the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bending {
    /// Whether anything bends.
    pub acts: bool,
    /// Whether it reads records.
    pub records: bool,
    /// Stages; 1 for a force.
    pub stages: u32,
    /// Whether it rubs.
    pub friction: bool,
}

impl Bending {
    /// As a force.
    pub fn plain(matrix: &BendingMatrix) -> Self {
        Self { acts: !matrix.values.is_empty(), records: matrix.reads_records(), stages: 1, friction: false }
    }

    /// How many stages it is in the program.
    pub fn len(self) -> usize {
        self.program().count()
    }

    /// Whether nothing bends.
    pub fn is_empty(self) -> bool {
        !self.acts
    }

    /// Stages of bending in the program.
    pub fn program(self) -> impl Iterator<Item = Stage> {
        let Self { acts, records, stages, friction } = self;
        let plain = [
            (Stage::BendingRecords, records),
            (Stage::Bending, true),
            (Stage::FrictionMoments, friction),
            (Stage::FrictionForces, friction),
        ];
        let plain = plain.into_iter().filter(move |(_, there)| *there && acts && stages < 2);
        let stiff = if acts && stages > 1 { stages } else { 0 };
        let staged = move |j: u32| {
            let each = [
                (Stage::StiffBendingTurn(j), true),
                (Stage::FrictionMoments, friction && j == 0),
                (Stage::FrictionForces, friction && j == 0),
                (Stage::StiffBendingRecords(j), records),
                (Stage::StiffBending(j), true),
            ];
            each.into_iter().filter(|(_, there)| *there)
        };
        let last = (stiff > 0).then_some(Stage::StiffBendingTurn(stiff));
        plain.chain((0..stiff).flat_map(staged)).map(|(stage, _)| stage).chain(last)
    }
}

/// The stages of one substep after bending.
pub fn constraints(layout: &Layout, quality: Quality) -> Box<[Stage]> {
    let numbered = |n: usize, stage: fn(u16) -> Stage| (0..n as u16).map(stage);
    let shear = || numbered(layout.shear.tuples.sets.len(), Stage::Shear);
    let wefts = || numbered(layout.weft.tuples.sets.len(), Stage::Weft);
    let fibers = || numbered(layout.crossing.sets.len(), Stage::Crossing).chain([Stage::Fibers]);
    let mut stages = vec![Stage::Predict];
    stages.extend(layout.link_curves.acts().then_some(Stage::LinkCurves));
    stages.extend(numbered(layout.diagonals.families.len(), Stage::Diagonals));
    stages.extend(shear());
    stages.extend(wefts().chain(fibers()));
    if quality != Quality::Draft && !layout.is_scattered() {
        stages.extend(wefts().chain(wefts()).chain(fibers()).chain(wefts()).chain(wefts()));
    }
    stages.push(Stage::Tethers);
    stages.push(Stage::ContactAndVelocities);
    stages.into()
}

/// The stages of a whole step: [`BEFORE`], then the same for each substep.
#[derive(Debug, Clone)]
pub struct Program {
    /// After bending, at each quality, in columns alone.
    constraints: [Box<[Stage]>; Quality::ALL.len()],
    /// Those of a substep; has room for the longest.
    substep: BoundedVec<Stage>,
    substeps: u32,
    made_for: Option<(Quality, Bending, [bool; 2])>,
}

impl Program {
    /// Room for the programs of a garment at any quality; `stiff` says that its bending may have to go in stages. At load.
    pub fn new(layout: &Layout, bending: Bending, stiff: bool) -> Self {
        let constraints = Quality::ALL.map(|quality| constraints(layout, quality));
        let bending = Bending { stages: if stiff { MAX_BENDING_STAGES } else { 1 }, ..bending };
        // No more changes between columns and records than links.
        let longest = bending.len() + constraints.iter().map(|c| 2 * c.len()).max().unwrap_or(0);
        Self { constraints, substep: BoundedVec::new(longest), substeps: 0, made_for: None }
    }

    /// Lists the stages for some settings; `records` says whether shear and weft links are solved by records. Allocates
    /// nothing.
    pub fn make(&mut self, quality: Quality, bending: Bending, records: [bool; 2], substeps: u32) {
        self.substeps = substeps;
        if self.made_for == Some((quality, bending, records)) {
            return;
        }
        self.made_for = Some((quality, bending, records));
        let at = Quality::ALL.iter().position(|q| *q == quality).unwrap_or(0);
        self.substep.clear();
        self.substep.extend(bending.program());
        let mut entered = false;
        for &stage in &self.constraints[at] {
            let wanted = match stage {
                Stage::Shear(_) => records[0],
                Stage::Weft(_) => records[1],
                _ => false,
            };
            if wanted != entered {
                self.substep.push(if wanted { Stage::EnterRecords } else { Stage::LeaveRecords });
                entered = wanted;
            }
            self.substep.push(stage);
        }
    }

    /// Stages of a step.
    pub fn len(&self) -> usize {
        BEFORE.len() + self.substeps as usize * self.substep.len()
    }

    /// Whether nothing was listed yet.
    pub fn is_empty(&self) -> bool {
        self.substep.is_empty()
    }

    /// One of them, counted over the step, with its substep.
    pub fn stage(&self, phase: usize) -> (Stage, u32) {
        match phase.checked_sub(BEFORE.len()) {
            None => (BEFORE[phase], 0),
            Some(later) => (self.substep[later % self.substep.len()], (later / self.substep.len()) as u32),
        }
    }

    /// How full the list of a substep was so far.
    pub fn usage(&self) -> Fill {
        self.substep.usage()
    }

    /// The stages of one substep.
    pub fn of_substep(&self) -> &[Stage] {
        &self.substep
    }
}
