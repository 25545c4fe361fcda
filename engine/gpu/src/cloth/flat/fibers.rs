//! Fibers: the bake's bundles as they are, one behind the other.

use toile_assets::garment::Solver;
use toile_assets::garment::layout::Fibers;

use super::{Groups, Span, WIDTH};

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
    pub groups: Groups,
}

impl FlatFibers {
    /// Appends a garment's.
    pub fn add(&mut self, fibers: &Fibers, span: Span) {
        let (row, at) = (self.rows.len() as u32, self.measures.len() as u32);
        self.groups.begin(span.garment);
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
            for first in (0..b.lanes).step_by(WIDTH as usize) {
                self.groups.push([span.garment, first, (b.lanes - first).min(WIDTH), bundle]);
            }
        }
        self.rows.extend(fibers.rows.iter().map(|r| [span.first + r.first, r.lanes]));
        self.measures.extend(fibers.rest.iter().zip(&fibers.compliance).map(|(r, c)| [*r, *c]));
        self.links += fibers.links;
    }
}
