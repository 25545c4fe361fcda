//! Sessions and measures as reports show them.

use toile_assets::sizes::Population;
use toile_cli::document::in_mm;
use toile_sensors::source;

use super::{SessionReport, ShopperMeasures};

/// The session, with more sentences beside its own.
pub fn session(session: &source::Session, more: &[String]) -> SessionReport {
    SessionReport {
        name: session.name.clone(),
        frames: session.joints.len().max(session.depth.len()) as u64,
        seconds: session.duration_ns() as f64 * 1e-9,
        notes: session.notes.iter().chain(more).cloned().collect(),
    }
}

/// The measures of the contract; what could not be seen is what such a body has on average, with that sigma.
pub fn measurements(measured: &toile_track::measure::Measurements, population: Population) -> ShopperMeasures {
    let [stature_mm, shoulder_breadth_mm, chest_girth_mm, waist_girth_mm, hip_girth_mm] =
        measured.completed(population).map(in_mm);
    ShopperMeasures { stature_mm, shoulder_breadth_mm, chest_girth_mm, waist_girth_mm, hip_girth_mm }
}
