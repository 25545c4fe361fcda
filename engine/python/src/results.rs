//! Answers as plain objects: dataclasses that the package defines in Python.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use toile_sdk::{GarmentStats, Measure, Recommendation, WornGarment};

/// A class of answers.
macro_rules! answer {
    ($py:expr, $name:literal, $fields:expr) => {{
        static CLASS: pyo3::sync::PyOnceLock<Py<pyo3::types::PyType>> = pyo3::sync::PyOnceLock::new();
        CLASS.import($py, "toile.answers", $name)?.call1($fields)
    }};
}
pub(crate) use answer;

/// Objects of some values as a tuple, which is immutable.
fn tuple<'py, T>(
    py: Python<'py>,
    values: &[T],
    of: impl Fn(&T) -> PyResult<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyTuple>> {
    PyTuple::new(py, values.iter().map(of).collect::<PyResult<Vec<_>>>()?)
}

/// Size and fit.
pub fn recommendation<'py>(py: Python<'py>, fit: &Recommendation) -> PyResult<Bound<'py, PyAny>> {
    let sizes = tuple(py, &fit.sizes, |chance| answer!(py, "SizeChance", (&chance.size, chance.probability)))?;
    let zones = tuple(py, &fit.zones, |zone| {
        let says = (zone.verdict, zone.feel, zone.tightness, &zone.sentence);
        let (verdict, feel, tightness, sentence) = says;
        let fields = (zone.zone, zone.primary, zone.ease_mm, zone.sigma_mm, verdict, feel, tightness, sentence);
        answer!(py, "ZoneFit", fields)
    })?;
    let advice = fit.advice.as_ref();
    let advice = advice.map(|advice| answer!(py, "MeasureAdvice", (advice.zone, advice.probability, &advice.sentence)));
    let fields = (
        (&fit.garment, &fit.size, fit.probability),
        (sizes, fit.uncertain, advice.transpose()?),
        (&fit.verdict, zones, &fit.runner_up, &fit.note),
    );
    let ((garment, size, probability), (sizes, uncertain, advice), (verdict, zones, runner_up, note)) = fields;
    let fields = (garment, size, probability, sizes, uncertain, advice, verdict, zones, runner_up, note);
    answer!(py, "Recommendation", fields)
}

/// Size and fit of what has sizes.
pub fn optional_recommendation<'py>(
    py: Python<'py>,
    fit: Option<&Recommendation>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    fit.map(|fit| recommendation(py, fit)).transpose()
}

/// A measure of a person.
pub fn measure<'py>(py: Python<'py>, of: &Measure) -> PyResult<Bound<'py, PyAny>> {
    answer!(py, "Measure", (of.name, of.mm, of.sigma_mm, of.seen, of.definition))
}

/// A garment of a scene.
pub fn worn<'py>(py: Python<'py>, of: &WornGarment) -> PyResult<Bound<'py, PyAny>> {
    let fit = optional_recommendation(py, of.fit.as_ref())?;
    let notes = PyTuple::new(py, &of.notes)?;
    let fields = (&of.name, &of.size, &of.fabric, of.vertices, of.faces, of.layers, fit, notes);
    answer!(py, "WornGarment", fields)
}

/// How a garment does.
pub fn stats<'py>(py: Python<'py>, of: &GarmentStats) -> PyResult<Bound<'py, PyAny>> {
    let fields = (of.strain_mean, of.strain_p99, of.strain_max, of.penetration_mm, of.rolled_back);
    answer!(py, "GarmentStats", fields)
}
