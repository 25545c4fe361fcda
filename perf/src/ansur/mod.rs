//! The survey ANSUR II: its files, random people of it, and the table of how measures go together.

mod survey;
mod table;

pub use survey::{Survey, SurveyError, chosen};
pub use table::table;
