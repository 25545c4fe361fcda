//! The program of a step: which kernel runs over which workgroups, in the CPU's order (`cloth::program`).

use toile_engine::cloth::Quality;

use super::flat::{Flat, Workgroups};
use super::kernels::Kernel;

/// One dispatch of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dispatch {
    /// The kernel to run.
    pub kernel: Kernel,
    /// Its workgroups, among [`StepProgram::tables`].
    pub table: usize,
    /// Whether tensions start from zero.
    pub fresh: bool,
    /// Which constants are its own.
    pub op: u32,
}

/// The dispatches of a step.
#[derive(Debug, Clone, Default)]
pub struct StepProgram {
    /// Workgroups that entries refer to, and where each begins among all.
    pub tables: Vec<(Workgroups, u32)>,
    /// Before the first substep; of wind, jumps and what is not to be felt of the root only what the step has.
    pub before: Vec<Dispatch>,
    /// Each stage of bending that is stiffer than a substep, and the first behind the last; none where none can be.
    pub stages: Vec<Dispatch>,
    /// Each substep at the quality `draft`.
    pub draft: Vec<Dispatch>,
    /// Each substep at the others.
    pub whole: Vec<Dispatch>,
    /// Dispatches after the last substep.
    pub after: Vec<Dispatch>,
}

/// Tables of workgroups of one kind, by number.
struct WorkgroupTables {
    everyone: usize,
    wind: usize,
    diagonals: Vec<usize>,
    shear: Vec<usize>,
    stretch: StretchTables,
    /// The same without the garments that are solved once a substep.
    again: StretchTables,
}

/// Tables of what is solved more than once a substep.
struct StretchTables {
    weft: Vec<usize>,
    lists: Vec<usize>,
    fibers: usize,
    cyclic: usize,
}

impl StepProgram {
    /// Of a scene; `stiff` says whether any garment's bending may have to go in stages.
    pub fn new(flat: &Flat, stiff: bool) -> Self {
        let mut this = Self::default();
        let tables = WorkgroupTables {
            everyone: this.table(&flat.everyone),
            wind: this.table(&flat.wind.groups),
            diagonals: flat.diagonals.families.iter().map(|g| this.table(g)).collect(),
            shear: flat.shear.halves.iter().map(|g| this.table(g)).collect(),
            stretch: this.stretch(flat, &vec![false; flat.scattered.len()]),
            again: this.stretch(flat, &flat.scattered),
        };
        let all = |kernel| Dispatch { kernel, table: tables.everyone, fresh: false, op: 0 };
        let first = [Kernel::Repair, Kernel::Teleport, Kernel::ContactCandidates];
        let forces = [
            Dispatch { table: tables.wind, ..all(Kernel::Wind) },
            all(Kernel::RootCompensation),
            all(Kernel::WindForces),
        ];
        this.before = first.map(all).into_iter().chain(forces).collect();
        if stiff {
            this.stages = vec![all(Kernel::StageCombine), all(Kernel::StageBending)];
        }
        this.draft = this.substep(&tables, false);
        this.whole = this.substep(&tables, true);
        this.after = vec![all(Kernel::Guard), all(Kernel::Publish), all(Kernel::UpdateReports)];
        if !flat.faces.starts.is_empty() {
            let faces = Dispatch { table: this.table(&flat.faces.groups), ..all(Kernel::Faces) };
            this.after.extend([faces, all(Kernel::Normals)]);
        }
        this.number();
        this
    }

    /// Gives each entry the number of its constants; those of a draft are among the whole substep's.
    fn number(&mut self) {
        let whole = self.before.iter_mut().chain(&mut self.stages).chain(&mut self.whole).chain(&mut self.after);
        (0..).zip(whole).for_each(|(op, entry)| entry.op = op);
        for entry in &mut self.draft {
            let same = |e: &&Dispatch| (e.kernel, e.table, e.fresh) == (entry.kernel, entry.table, entry.fresh);
            entry.op = self.whole.iter().find(same).map_or(0, |e| e.op);
        }
    }

    /// Each substep at a quality.
    pub fn each(&self, quality: Quality) -> &[Dispatch] {
        if quality == Quality::Draft { &self.draft } else { &self.whole }
    }

    /// Every entry there is: what has to have constants of its own.
    pub fn entries(&self) -> impl Iterator<Item = &Dispatch> {
        self.before.iter().chain(&self.stages).chain(&self.whole).chain(&self.after)
    }

    /// The workgroups of all tables, as one list.
    pub fn groups(&self) -> Vec<[u32; 4]> {
        self.tables.iter().flat_map(|(groups, _)| groups.groups.iter().copied()).collect()
    }

    fn stretch(&mut self, flat: &Flat, skipped: &[bool]) -> StretchTables {
        let mut table = |groups: &Workgroups| self.table(&groups.without(skipped));
        StretchTables {
            weft: flat.weft.halves.iter().map(&mut table).collect(),
            lists: flat.lists.sets.iter().map(&mut table).collect(),
            fibers: table(&flat.fibers.groups),
            cyclic: table(&flat.fibers.cyclic),
        }
    }

    /// The number of a table, which is a new one unless it is there already.
    fn table(&mut self, groups: &Workgroups) -> usize {
        if let Some(same) = self.tables.iter().position(|(known, _)| known == groups) {
            return same;
        }
        let first = self.tables.last().map_or(0, |(last, first)| first + last.groups.len() as u32);
        self.tables.push((groups.clone(), first));
        self.tables.len() - 1
    }

    /// The dispatches of a substep; `whole` solves hoops and fibers alternately.
    fn substep(&self, tables: &WorkgroupTables, whole: bool) -> Vec<Dispatch> {
        let entry = |kernel, table, fresh| Dispatch { kernel, table, fresh, op: 0 };
        let wefts =
            |of: &StretchTables, fresh| of.weft.iter().map(|&t| entry(Kernel::Weft, t, fresh)).collect::<Vec<_>>();
        let fibers = |of: &StretchTables, fresh| {
            let warps = [entry(Kernel::Fibers, of.fibers, fresh), entry(Kernel::Cyclic, of.cyclic, fresh)];
            of.lists.iter().map(|&t| entry(Kernel::Lists, t, fresh)).chain(warps).collect::<Vec<_>>()
        };
        let mut entries =
            vec![entry(Kernel::Bending, tables.everyone, false), entry(Kernel::Predict, tables.everyone, false)];
        entries.extend(tables.diagonals.iter().map(|&t| entry(Kernel::Diagonals, t, false)));
        entries.extend(tables.shear.iter().map(|&t| entry(Kernel::Shear, t, false)));
        entries.extend([wefts(&tables.stretch, true), fibers(&tables.stretch, true)].concat());
        if whole {
            let [hoops, warps] = [wefts(&tables.again, false), fibers(&tables.again, false)];
            entries.extend([&*hoops, &*hoops, &*warps, &*hoops, &*hoops].concat());
        }
        entries.push(entry(Kernel::Tethers, tables.everyone, false));
        entries.push(entry(Kernel::Contact, tables.everyone, false));
        entries.push(entry(Kernel::Settle, tables.everyone, false));
        entries.retain(|e| !self.tables[e.table].0.groups.is_empty());
        entries
    }
}
