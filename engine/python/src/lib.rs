//! Toile for programs in Python: a thin layer over `toile-sdk`, which computes nothing of its own.
//!
//! This is the compiled part of the package `toile`, whose part in Python stands in `package/`; docs/python.md is the guide. Nothing
//! here is for callers in Rust: they take `toile-sdk`.
//!
//! A call takes less than 5 µs beside the time of `toile-sdk`. Any thread that holds the interpreter's lock may call; the lock is released
//! during computations. Scenes take one call at a time.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
mod failure;

mod numbers;
mod results;
mod views;
mod words;

mod body;
mod pictures;
mod track;

mod garment;

mod recording;
mod scene;

mod study;
mod try_on;

use pyo3::prelude::*;

/// The compiled part of the package ``toile``.
#[pymodule]
mod _toile {
    use pyo3::prelude::*;
    use pyo3::types::PyTuple;

    #[pymodule_export]
    use crate::body::Body;
    #[pymodule_export]
    use crate::garment::{Garment, recommend};
    #[pymodule_export]
    use crate::pictures::fit_colours;
    #[pymodule_export]
    use crate::recording::{DepthFrame, Measured, Recording, measure};
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::study::study_row;
    #[pymodule_export]
    use crate::track::Track;
    #[pymodule_export]
    use crate::try_on::try_on;

    /// Names of the garments that are built in.
    #[pyfunction]
    fn garment_names(py: Python<'_>) -> PyResult<Bound<'_, PyTuple>> {
        PyTuple::new(py, toile_sdk::garment_names())
    }

    /// Names of the fabrics that are built in.
    #[pyfunction]
    fn fabric_names(py: Python<'_>) -> PyResult<Bound<'_, PyTuple>> {
        PyTuple::new(py, toile_sdk::fabric_names())
    }

    /// Names of the measures that a body has.
    #[pyfunction]
    fn measure_names(py: Python<'_>) -> PyResult<Bound<'_, PyTuple>> {
        PyTuple::new(py, toile_sdk::measure_names())
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("TIME_STEP", toile_sdk::TIME_STEP)?;
        module.add("JOINTS", PyTuple::new(module.py(), crate::track::names())?)
    }
}
