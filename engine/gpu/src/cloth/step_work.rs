//! Dispatches of a step and bytes that its kernels ask for, counted from the layout of the garments. A device is bound
//! by these two and its own figures: a dispatch waits for the one before.

use super::Offload;
use super::flat::Flat;
use super::kernels::Kernel;
use super::program::Dispatch;
use super::step::StepConditions;
use crate::device_work::StepWork;

impl Offload {
    /// Of a plain step with the settings of the last one: no wind, no jump.
    pub fn work(&self) -> StepWork {
        let mut work = StepWork::default();
        self.entries(StepConditions::default(), |entry, substep, garments| {
            let items = self.items(entry, garments);
            if items > 0 {
                let bytes = if self.acts(entry.kernel, substep) { each(&self.flat, entry.kernel) } else { 0.0 };
                work += StepWork { dispatches: 1, bytes: (items as f64 * bytes) as u64 };
            }
        });
        work
    }

    /// Whether a kernel does anything in a substep: bending and the bias pass some over, and bending that goes in stages all.
    fn acts(&self, kernel: Kernel, substep: u32) -> bool {
        self.own.iter().map(|own| &own.prepared).any(|p| match kernel {
            Kernel::Bending => p.bending.stages < 2 && substep.is_multiple_of(p.bend.every),
            Kernel::Diagonals => substep.is_multiple_of(p.shear_every),
            _ => true,
        })
    }

    /// Invocations that have something to do; of fibers that are solved by workgroups, the fibers.
    fn items(&self, entry: &Dispatch, garments: usize) -> u64 {
        let groups = &self.program.tables[entry.table].0;
        groups.groups[..groups.of(garments) as usize].iter().map(|g| u64::from(g[2])).sum()
    }
}

/// Bytes an item; of what is as long as its fiber or its list, the mean.
fn each(flat: &Flat, kernel: Kernel) -> f64 {
    let mean = |all: usize, of: usize| all as f64 / of.max(1) as f64;
    let fibers = || flat.fibers.bundles.iter().map(|b| b[1] as usize).sum();
    match kernel {
        // Place, velocity, last good place.
        Kernel::Repair | Kernel::Guard | Kernel::Publish => 64.0,
        Kernel::Teleport | Kernel::RootCompensation => 96.0,
        // Place, velocity, reach, what was found.
        Kernel::ContactCandidates => 44.0,
        Kernel::Wind | Kernel::WindForces => 120.0,
        Kernel::StageCombine => 96.0,
        // An entry and its particle's place each; ends of the list, place, velocity.
        Kernel::Bending | Kernel::StageBending => 56.0 + 24.0 * mean(flat.bending.entries.len(), flat.start.len()),
        // Place, previous, velocity, pin.
        Kernel::Predict => 84.0,
        // A slot down: lead, measure, place, what is kept; up: the same and two places written.
        Kernel::Diagonals => 16.0 + 160.0 * mean(flat.diagonals.leads.len(), flat.diagonals.heads.len()),
        // Ends, measures, two places read and written.
        Kernel::Shear | Kernel::Weft => 96.0,
        // A row: index, place, measures, direction, factors, and back.
        Kernel::Lists => 32.0 + 220.0 * mean(flat.lists.index.len(), flat.lists.heads.len()),
        // A link down: place, measure, factors; up: factors, place read and written.
        Kernel::Fibers => 32.0 + 104.0 * mean(flat.fibers.links, fibers()),
        // A link: two places, measures, place written; the rest stays with the workgroup.
        Kernel::Cyclic => 32.0 + 88.0 * mean(flat.fibers.links, fibers()),
        Kernel::Tethers => 40.0,
        // What was found, place and previous read and written.
        Kernel::Contact => 72.0,
        Kernel::Settle => 80.0,
        // A garment an invocation.
        Kernel::UpdateReports => 0.0,
        _ => 64.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::flat::WIDTH;
    use toile_assets::scene::skirt::{self, Stretch};
    use toile_bake::bake;
    use toile_engine::colliders::Colliders;

    #[test]
    fn what_an_item_asks_for_grows_with_what_it_has() {
        let bytes = |n| {
            let shape = skirt::shape(n);
            let garment = bake("skirt", "one", &shape, &skirt::fabric(&shape, Stretch::Physical)).expect("it bakes");
            let no_body = Colliders::new(&[], &[], false).expect("nothing is not too much");
            let flat = Flat::new(&[&garment], &[&no_body]);
            (each(&flat, Kernel::Fibers), each(&flat, Kernel::Weft))
        };
        let ((short, link), (long, same)) = (bytes(16), bytes(32));
        assert!(long > 1.8 * short && link == same && WIDTH == 64, "{short} {long}");
    }
}
