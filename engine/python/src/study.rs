//! Rows of a study of a population, each by itself.

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use toile_sdk::ErrorKind;
use toile_study::{Study, StudyError};

use crate::failure::{Failure, guarded};
use crate::words;

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        let kind = match error {
            StudyError::Input(_) => ErrorKind::Input,
            StudyError::Device(_) => ErrorKind::Device,
            StudyError::Internal(_) => ErrorKind::Internal,
        };
        Self::new(kind, error)
    }
}

/// One row of a study of a population (docs/study.md), whatever others were asked for and on whatever machine.
///
/// The study is opened for each call, some milliseconds; a simulated try-on takes seconds, without the interpreter's lock.
///
/// Parameters
/// ----------
/// study : str or os.PathLike
///     A study file.
/// index : int
///     Number of the row, from 0.
///
/// Returns
/// -------
/// bytes
///     A Parquet file of one row, the same bytes for the same study and number.
///
/// Raises
/// ------
/// InputError
///     A part of the study that cannot be used; a row out of range.
#[pyfunction]
pub fn study_row<'py>(py: Python<'py>, study: &Bound<'py, PyAny>, index: i64) -> PyResult<Bound<'py, PyBytes>> {
    let path = words::path(study, "study")?;
    let index = words::counted(index, "row")? as u64;
    let row = guarded(|| Ok(py.detach(|| Study::open(&path)?.row_bytes(index))))?;
    Ok(PyBytes::new(py, &row.map_err(Failure::from)?))
}
