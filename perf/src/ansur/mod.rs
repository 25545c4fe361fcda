//! The parametric body compared with people: random subjects of ANSUR II, body by body.
//!
//! Reads: the survey's files (a path is given; they are not embedded). Writes: the table of how measures go together,
//! and the errors, times and flaws of the bodies built.
//! Budget: none; a study, not a frame.
//! Thread: the caller's.

mod study;
mod survey;
mod table;

pub(crate) use study::chosen;
pub use study::{BodyStudy, GIVEN, MeasureErrors, QUICK_MS, Spread, StudyError, TOO_ROUGH, study};
pub use survey::{Survey, SurveyError};
pub use table::table;
