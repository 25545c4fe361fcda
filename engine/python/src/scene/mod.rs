//! Scenes in motion.
//!
//! A call takes less than 5 µs beside the time of `toile-sdk`. A scene takes one call at a time, of any thread. Steps, dressing and pictures
//! run without the interpreter's lock.

mod class;
mod moments;
mod options;
mod state;

pub use class::Scene;
pub use options::strings;
