//! Solvers that a scene file chooses by hand.

use toile_base::garment::{Direction, Solver};

/// A part of a garment whose fibers a scene file can speak of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SolverRegion {
    /// Closed weft fibers that are sewn to what does not move, vertex by vertex: a waistband, a neckband.
    Waistband,
    /// Closed weft fibers where the cloth ends, below or above.
    Hem,
}

/// Solvers that are chosen by hand. A region goes before a direction, and either
/// before what the bake would choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Overrides {
    /// Of all fibers down the garment.
    pub warp: Option<Solver>,
    /// Of all fibers around it.
    pub weft: Option<Solver>,
    /// Solver of all fibers along the bias.
    pub bias: Option<Solver>,
    /// Of the hoops that the garment hangs by.
    pub waistband: Option<Solver>,
    /// Of the hoops at its edges.
    pub hem: Option<Solver>,
}

impl Overrides {
    /// What is said of a fiber of a direction that belongs to a region or to none.
    pub fn of(&self, direction: Direction, region: Option<SolverRegion>) -> Option<Solver> {
        let by_region = match region {
            Some(SolverRegion::Waistband) => self.waistband,
            Some(SolverRegion::Hem) => self.hem,
            None => None,
        };
        by_region.or(match direction {
            Direction::Warp => self.warp,
            Direction::Weft => self.weft,
            Direction::Bias => self.bias,
        })
    }
}
