//! Lists: fibers by index list, an entry a fiber.

use toile_base::garment::Solver;
use toile_base::garment::layout::FiberLists;

use super::{GarmentSpan, Workgroups};

/// Flag: the fiber is closed, its last particle linked to the first.
const CLOSED: u32 = 1;
/// A fiber must not lengthen.
const ZERO_STRETCH: u32 = 2;

/// Fibers by index list, of all garments.
#[derive(Debug, Clone, Default)]
pub struct FlatLists {
    /// First index, distance of the rows, rows, bits; first measure, first of what is kept, nothing, nothing `[fibers]`.
    pub heads: Vec<[u32; 8]>,
    /// Particles of all lists.
    pub index: Vec<u32>,
    /// Rest length (m) and compliance (m/N).
    pub measures: Vec<[f32; 2]>,
    /// Sets in the order of solving.
    pub sets: Vec<Workgroups>,
}

impl FlatLists {
    /// Appends the fiber lists of one garment.
    pub fn add(&mut self, lists: &FiberLists, span: GarmentSpan) {
        let (index, at) = (self.index.len() as u32, self.measures.len() as u32);
        for (s, owners) in lists.sets.iter().enumerate() {
            let first = self.heads.len() as u32;
            for list in owners.iter().flat_map(|o| &lists.lists[o.start as usize..o.end as usize]) {
                let zero = if list.solver == Solver::ZeroStretch { ZERO_STRETCH } else { 0 };
                let bits = if list.closed { CLOSED | zero } else { zero };
                for lane in 0..list.lanes {
                    let place = index + list.first + lane;
                    self.heads.push([place, list.lanes, list.rows, bits, at + list.at + lane, place, 0, 0]);
                }
            }
            if self.sets.len() <= s {
                self.sets.push(Workgroups::default());
            }
            self.sets[s].add(span.garment, first, self.heads.len() as u32 - first, 0);
        }
        self.index.extend(lists.index.iter().map(|i| span.first + i));
        self.measures.extend(lists.rest.iter().zip(&lists.compliance).map(|(r, c)| [*r, *c]));
    }
}
