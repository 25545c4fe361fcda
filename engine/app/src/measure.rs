//! `toile measure`: the measures of the person in a recording or a depth frame.

use toile_assets::sizes::Population;

use crate::cli::MeasureArgs;
use crate::exit::AppError;
use crate::report::{Document, MeasureReport};
use crate::shopper;
use crate::summary;
use crate::terminal::{self, Paint};

/// Runs `toile measure`.
///
/// # Errors
/// A file that cannot be read or shows nobody, or a closed stdout.
pub fn run(args: &MeasureArgs) -> Result<(), AppError> {
    let session = shopper::open(Some(&args.file), args.camera.as_deref())?;
    let population = Population::Mixed;
    let measured = shopper::measure(&session, population)?;
    let report = MeasureReport {
        session: shopper::session_report(&session, &measured.notes),
        measurements: shopper::measures_report(&measured, population),
        valid_pixels: measured.valid_pixels as u64,
        people: measured.people as u32,
    };
    if args.json {
        return terminal::print_json(&Document::new("measure", report));
    }
    terminal::print(&summary::measure(&report, Paint::for_stdout()))
}
