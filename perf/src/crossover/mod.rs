//! Study: from which size, and from how many garments on, a graphics device is worth it.

mod chart;
mod study;

pub use chart::chart;
pub use study::{Crossover, CrossoverRow, SideFigures, run};
