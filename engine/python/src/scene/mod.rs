//! Scenes in motion.
//!
//! Budget: below 5 us a call beside what `toile-sdk` takes.
//! Thread: one call at a time, of any thread; steps, dressing and pictures run without the interpreter's lock.

mod class;
mod moments;
mod options;
mod state;

pub use class::Scene;
pub use options::strings;
