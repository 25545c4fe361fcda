//! The JSON that a command prints: one object with the machine that its figures were measured on.

use serde::Serialize;
use toile_track::estimate::Estimate;

use crate::machine::Machine;

/// What every object carries, around what one command has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Document<T> {
    /// Name and version of the object's format: `toile.<command>/1`.
    pub schema: String,
    /// Version of the program.
    pub version: &'static str,
    /// The machine that the figures were measured on.
    pub machine: Machine,
    /// The command's own keys, on the same level.
    #[serde(flatten)]
    pub body: T,
}

impl<T> Document<T> {
    /// The object of a command, with the machine as it is now.
    pub fn new(command: &str, body: T) -> Self {
        Self {
            schema: format!("toile.{command}/1"),
            version: env!("CARGO_PKG_VERSION"),
            machine: Machine::here(),
            body,
        }
    }
}

/// One measure of the body.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct MeasuredLength {
    /// The value (mm).
    pub value: f64,
    /// Standard uncertainty (mm).
    pub sigma: f64,
}

/// A measure with its definition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DefinedMeasure {
    /// Name of the measure.
    pub name: &'static str,
    /// Where the tape lies (EN 13402-1, ISO 8559-1).
    pub definition: &'static str,
    /// The value (mm).
    pub value: f64,
    /// Standard deviation (mm).
    pub sigma: f64,
}

/// An estimate (m) in millimetres; tenths of a millimetre are all that a measure deserves.
pub fn in_mm(estimate: Estimate) -> MeasuredLength {
    let mm = |x: f32| (f64::from(x) * 1e4).round() / 10.0;
    MeasuredLength { value: mm(estimate.value), sigma: mm(estimate.sigma) }
}

/// A 64-bit state hash as the reports write it.
pub fn hash_text(hash: u64) -> String {
    format!("{hash:016x}")
}
