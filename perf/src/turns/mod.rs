//! Cases of the cloth's benchmark taken in turn, by this program and by another build of it: a machine's speed changes within
//! minutes, so that only what is run in turn can be laid side by side.

mod case;
mod error;
mod reading;
mod table;

pub use case::{CASES, TurnCase};
pub use error::TurnsError;
pub use reading::TurnReading;
pub use table::{TurnRatio, TurnReport, TurnRow, TurnTable, run};
