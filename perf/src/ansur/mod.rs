//! The parametric body compared with people: random subjects of ANSUR II, body by body.

mod study;
mod survey;
mod table;

pub(crate) use study::chosen;
pub use study::{BodyStudy, GIVEN, MeasureErrors, QUICK_MS, Spread, StudyError, TOO_ROUGH, study};
pub use survey::{Survey, SurveyError};
pub use table::table;
