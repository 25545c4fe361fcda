//! Fibers: the bake's bundles as they are, one behind the other.

use toile_base::garment::Solver;
use toile_base::garment::layout::Fibers;

use super::{GarmentSpan, WIDTH, Workgroups};

/// Bundles of all garments.
#[derive(Debug, Clone, Default)]
pub struct FlatFibers {
    /// Solver, fibers, first row, rows, first measure, number of the first link, whether all are alike, nothing.
    pub bundles: Vec<[u32; 8]>,
    /// First particle of each row, and how many fibers reach so far.
    pub rows: Vec<[u32; 2]>,
    /// Rest length (m) and compliance (m/N).
    pub measures: Vec<[f32; 2]>,
    /// Links of all bundles.
    pub links: usize,
    /// Workgroups: the first fiber, how many, and the bundle.
    pub groups: Workgroups,
    /// Workgroups of one fiber each, of bundles of few and long ones.
    pub cyclic: Workgroups,
}

/// Links of a fiber from which on a workgroup is worth it: one invocation walks down and up all of them, two loads after each other a
/// link, where cyclic reduction takes 9 steps for any; below, that does not outweigh four times the work.
const LONG: u32 = 96;

/// Most links that it has room for, `CYCLIC_MOST` of `shaders/fibers.wgsl`.
const LONGEST: u32 = 512;

/// Most fibers that are few: as many workgroups fill a large device, and from there on it is the work that counts.
const FEW: u32 = 1_024;

/// Whether a bundle's fibers are few and long, and of the solver that this is for.
fn few_and_long(solver: Solver, fibers: u32, links: u32) -> bool {
    solver == Solver::SemiImplicit && fibers <= FEW && (LONG..=LONGEST).contains(&links)
}

impl FlatFibers {
    /// Appends the warp fibers of one garment.
    pub fn add(&mut self, fibers: &Fibers, span: GarmentSpan) {
        let (row, at) = (self.rows.len() as u32, self.measures.len() as u32);
        self.groups.begin(span.garment);
        self.cyclic.begin(span.garment);
        for b in &fibers.bundles {
            let solver = match b.solver {
                Solver::GaussSeidel => 0,
                Solver::SemiImplicit => 1,
                Solver::ZeroStretch => 2,
            };
            let bundle = self.bundles.len() as u32;
            let rows = [row + b.rows.start, b.rows.end - b.rows.start];
            let serial = self.links as u32 + b.serial;
            self.bundles.push([solver, b.lanes, rows[0], rows[1], at + b.at, serial, u32::from(b.alike), 0]);
            if few_and_long(b.solver, b.lanes, rows[1].saturating_sub(1)) {
                (0..b.lanes).for_each(|fiber| self.cyclic.push([span.garment, fiber, 1, bundle]));
                continue;
            }
            for first in (0..b.lanes).step_by(WIDTH as usize) {
                self.groups.push([span.garment, first, (b.lanes - first).min(WIDTH), bundle]);
            }
        }
        self.rows.extend(fibers.rows.iter().map(|r| [span.first + r.first, r.lanes]));
        self.measures.extend(fibers.rest.iter().zip(&fibers.compliance).map(|(r, c)| [*r, *c]));
        self.links += fibers.links;
    }
}
