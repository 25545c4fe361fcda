//! Study: from which size, and from how many garments on, a graphics device is worth it.
//!
//! Reads: the benchmark's skirt at several sizes and in several numbers. Writes: time and error of one and two threads of the
//! processor and of the device, the sizes at which their curves cross, and a chart.
//! Budget: a minute or so on a graphics card; a driver that computes on the processor takes some minutes. Never inside the frame.
//! Thread: one, and those of the engine; with nothing else running.

mod chart;
mod study;

pub use chart::chart;
pub use study::{Crossover, CrossoverRow, SideFigures, run};
