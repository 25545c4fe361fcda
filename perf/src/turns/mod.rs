//! Cases of the cloth's benchmark taken in turn, by this program and by another build of it: a machine's speed changes within
//! minutes, so that only what is run in turn can be laid side by side.
//!
//! Reads: the reports of child processes. Writes: a table of times, strains and stages.
//! Budget: some seconds a case, turn and program.
//! Thread: one, which waits; with nothing else running.

mod case;
mod error;
mod reading;
mod table;

pub use case::{CASES, TurnCase};
pub use error::TurnsError;
pub use reading::Reading;
pub use table::{TurnRatio, TurnReport, TurnRow, TurnTable, run};
