//! What rows come to: shares of people with intervals, where sizes fail, which step between sizes would help.

mod grading;
mod interval;
mod summary;
mod typical;
mod wearers;

pub use grading::GradingStep;
pub use interval::Share;
pub use summary::{Convergence, DrapedFigures, GarmentSummary, SizeSummary, Summary, SummaryWearer, ZoneFailure};
