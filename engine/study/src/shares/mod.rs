//! Results of rows: shares of people with intervals, zones where sizes fail, the step between sizes that would help.

mod grading;
mod interval;
mod summary;
mod typical;
mod wearers;

pub use grading::GradingStep;
pub use interval::Share;
pub use summary::{Convergence, DrapedFigures, GarmentSummary, SizeSummary, Summary, SummaryWearer, ZoneFailure};
