//! The benchmark of contact: cloth against itself, against other cloth and against the skin, with its targets.
//!
//! Crossings are counted by [`toile_fitting::crossings`], which shares no code with the engine.

mod exact;
mod off;
mod order;
mod pictures;
mod poses;
mod row;
mod scenes;
mod sheets;
mod skin;
mod table;
mod twist;
mod worn;

pub use pictures::{OutfitPicture, pictures};
pub use row::{ContactError, ContactRow};
pub use table::{ContactTable, run};
